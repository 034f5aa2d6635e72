"""A notebook is run by the kernel of Jupyter: what its cells show, in which form, and that no network is asked."""

import ast
from base64 import b64decode
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell, new_notebook

pytestmark = pytest.mark.slow  # IPython takes ten seconds

CELLS = {
    "watch": """
import sys

asked, watched = [], ("socket.getaddrinfo", "urllib.Request")
sys.addaudithook(lambda event, values: asked.append(values) if event in watched else None)
""",
    "drive": 'import beltdyn as bd\n\ndrive = bd.load("drive.toml")\ndrive',
    "run": 'run = bd.simulate(drive, "drive.nc")\nrun',
    "steady": "steady = bd.steady_state(drive)\nsteady",
    "modes": "modes = bd.modes(drive, count=3)\nmodes",
    "equilibrium": "rest = bd.equilibrium(drive)\nrest",
    "interactive": 'bd.interactive(run, "speeds", "span_tensions")',
    "figure": "axes = bd.plot.span_tensions(run)",
    "numbers": """
tension = float(rest.dataset.tension)
[tension, *modes.dataset.frequency.values.tolist()], [len(one.warnings) for one in (run, steady, modes, rest)]
""",
    "asked": "asked",
}
Shown = dict[str, dict[str, Any]]


class Page(HTMLParser):
    """What a browser reads of a page: text of the cells of tables, by rows, and what its elements refer to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows = list[list[str]]()
        self.tags, self.references, self.frames = list[str](), list[str](), list[str]()
        self._in_cell = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.references += [str(value) for name, value in attrs if name in ("src", "href", "srcset", "data", "poster")]
        self.frames += [str(value) for name, value in attrs if name == "srcdoc"]
        if tag == "tr":
            self.rows.append([])
        self._in_cell = tag in ("td", "th") or (tag == "br" and self._in_cell)
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag: str) -> None:
        self._in_cell = self._in_cell and tag not in ("td", "th")

    def handle_data(self, data: str) -> None:
        if self._in_cell:
            self.rows[-1][-1] += data

    def row(self, name: str) -> list[str]:
        """The cells beside a name, which one row has."""
        (found,) = [row[1:] for row in self.rows if row and row[0] == name]
        return found


@pytest.fixture(scope="module")
def notebook(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A notebook that has been run, as it is saved; an error in a cell is raised here."""
    folder = tmp_path_factory.mktemp("notebook")
    text = files("beltdyn.cli").joinpath("new_drive.toml").read_text(encoding="utf-8")
    text = text.replace("duration = 1.0", "duration = 0.08").replace("# elements = 60", "elements = 20")
    (folder / "drive.toml").write_text(text, encoding="utf-8")
    made = new_notebook(cells=[new_code_cell(source.strip()) for source in CELLS.values()])
    with pytest.MonkeyPatch.context() as patch:
        for name in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR"):
            patch.setenv(name, str(folder / name.lower()))
        patch.delenv("MPLBACKEND", raising=False)
        NotebookClient(made, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    nbformat.write(made, folder / "drive.ipynb")
    return folder / "drive.ipynb"


@pytest.fixture(scope="module")
def shown(notebook: Path) -> Shown:
    """What the cells of the saved notebook show, by MIME type; what is printed has the type "stdout" or "stderr"."""
    found: Shown = {}
    cells = nbformat.read(notebook, as_version=4).cells
    for name, cell in zip(CELLS, cells, strict=True):
        found[name] = {}
        for one in cell.outputs:
            found[name] |= {one.name: one.text} if one.output_type == "stream" else dict(one.data)
    return found


def test_drives_and_results_show_themselves_as_html(shown: Shown) -> None:
    kinds = {"drive": None, "run": "Run", "steady": "Steady running", "modes": "Modes", "equilibrium": "Equilibrium"}
    for name, kind in kinds.items():
        html = shown[name]["text/html"]
        assert Page(html).tags.count("circle") == 2, name
        assert kind is None or f"<p>{kind}, completed.</p>" in html
    assert Page(shown["drive"]["text/html"]).row("driven")[-2:] == ["180.0°", "inside"]
    assert [name for name, forms in shown.items() if {"stdout", "stderr"} & forms.keys()] == []


def test_numbers_stand_beside_their_names(shown: Shown) -> None:
    """In tables: lists of definitions lie in each other where a notebook's own style lets their terms float."""
    (tension, *frequencies), warnings = ast.literal_eval(shown["numbers"]["text/plain"])
    rest, modes = (Page(shown[name]["text/html"]) for name in ("equilibrium", "modes"))
    (told,) = rest.row("Mean tension of the spans")
    assert float(told.removesuffix(" N")) == pytest.approx(tension, rel=1e-4)  # five digits are shown
    assert [float(modes.row(number)[0]) for number in "123"] == pytest.approx(frequencies, rel=1e-4)
    for name, count in zip(("run", "steady", "modes", "equilibrium"), warnings, strict=True):
        html = shown[name]["text/html"]
        assert html.count("<strong>Warning:</strong>") == count, name
        assert "dl" not in Page(html).tags


def test_figures_are_charts_in_a_frame_or_pictures(shown: Shown) -> None:
    (frame,) = Page(shown["interactive"]["text/html"]).frames
    for part in ('id="speeds-0"', 'id="span_tensions-0"', "Bokeh"):
        assert part in frame
    assert b64decode(shown["figure"]["image/png"]).startswith(b"\x89PNG")


def test_nothing_is_asked_of_a_network(shown: Shown) -> None:
    """Neither by the kernel, nor by what the page holds."""
    assert shown["asked"]["text/plain"] == "[]"
    pages = [Page(forms["text/html"]) for forms in shown.values() if "text/html" in forms]
    assert len(pages) == 6
    pages += [Page(frame) for page in pages for frame in page.frames]
    assert len(pages) == 7
    references = [reference for page in pages for reference in page.references]
    assert references  # pictures for browsers without scripts
    assert [one[:80] for one in references if not one.startswith("data:")] == []
    assert [tag for page in pages for tag in page.tags if tag in ("link", "object", "embed")] == []

"""The page as a browser gets it: whole, without a network, and safe against what drive files say."""

import json
import re
from collections.abc import Callable, Mapping
from functools import cache
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.results import Result, Run
from beltdyn.show.report import report_file, write_report

_EMPTY = {"meta", "img", "input", "link", "br", "hr", "circle", "path"}
LARGEST = 5_000_000
COARSE = "6\nelements = 40"
"""Ribs of a belt on a coarse mesh."""
MARK = "# A line that the user wrote.\n"
EXAMPLES = files("beltdyn").joinpath("examples")
TENSION: dict[str, Any] = {"path": "belt.installed_tension", "least": "250 N", "largest": "400 N"}
OPTIMIZATION = bd.OptimizationStudy(
    number=[TENSION], goal={"result": "hub_load"}, requirement=[{"result": "slip_safety", "at_least": 1.1}]
)
STUDY = bd.ParameterStudy(
    analysis="equilibrium", results=["hub_load"], number=[{"path": "belt.installed_tension", "values": "280, 320 N"}]
)
MAKERS: Mapping[str, tuple[Callable[[bd.Drive], Result], tuple[str, ...], tuple[str, ...]]] = {
    "static": (bd.equilibrium, ("Largest hub load", "Wrap angle"), ("contact_pressure-0",)),
    "steady": (bd.steady_state, ("Least slip safety", "steady, completed", "efficiency"), ("contact_pressure-0",)),
    "map": (
        lambda drive: bd.operating_map(drive, speed="700, 1500 rpm", load="0.5, 1"),
        ("Largest slip", "speed 1500 rpm, load 1", "Efficiency map"),
        ("operating_points-0",),
    ),
    "traction": (lambda drive: bd.traction(drive, points=3), ("Largest torque", "Euler"), ("traction_curve-0",)),
    "tensioner_sheet": (bd.tensioner_sheet, ("longest belt", "Take-up rate"), ("tensioner_sheet-0",)),
    "modes": (lambda drive: bd.modes(drive, count=3), ("Parts with most of the energy", "Mode shape"), ()),
    "campbell": (
        lambda drive: bd.campbell(drive, speed="1000, 1500 rpm", count=3),
        ("Critical speed", "Flutter rate"),
        ("campbell-0", "campbell-1"),
    ),
    "response": (
        lambda drive: bd.response(drive, speed="1000, 1500 rpm"),
        ("Amplitude of span tension", "speed of crank, order 2"),
        ("response-0",),
    ),
    "duty": (
        lambda drive: bd.duty(drive, table=_table()),
        ("Largest slip", "duration"),
        ("operating_points-0",),
    ),
    "life": (
        lambda drive: bd.life(drive, table=_table()),
        ("Share in the damage of the ribs", "no temperature of the belt"),
        ("belt_history-0",),
    ),
    "sheet": (
        lambda drive: bd.sheet(drive, points=3, acceleration="1000 rpm/s"),
        ("Belts of standard length", "First modes", "shortest belt"),
        ("sheet_slip_safety-0",),
    ),
    "sensitivity": (
        lambda drive: bd.sensitivity(drive, about="rest", numbers="belt.installed_tension"),
        ("belt.installed_tension",),
        (),
    ),
    "run": (
        lambda _: bd.simulate(_given(ribs=COARSE, duration="0.02")),
        ("Least slip safety", "run, completed", "energy"),
        ("speeds-0", "span_tensions-0"),
    ),
    "sweep": (
        lambda _: bd.sweep(
            _given(ribs=COARSE), pulley="crank", from_="1400 rpm", to="1500 rpm", duration=0.04, settling=0.1
        ),
        ("Least slip safety", "sweep, completed"),
        ("speeds-0",),
    ),
    "optimize": (
        lambda drive: bd.optimize(drive, study=OPTIMIZATION, most=2),
        ("slip_safety at least 1.1", "belt.installed_tension"),
        (),
    ),
    "calibrate": (
        lambda drive: bd.calibrate(drive, study=_calibration()),
        ("belt.installed_tension", "Standard error"),
        (),
    ),
    "study": (
        lambda drive: bd.study(STUDY, drive, jobs=1),
        ("belt.installed_tension",),
        (),
    ),
    "open": (lambda _: bd.equilibrium(bd.loads(MARK + _text("band_brake"))), ("Largest hub load",), ()),
}
"""Name -> how it is made, words of its report, and places of its charts."""
MEANINGS = {
    "Kinds of modes": {"modes", "campbell"},
    "Critical speed": {"campbell"},
    "<dt>Amplitude": {"response"},
    "Tension set by a tensioner": {"tensioner_sheet"},
}
"""What is explained, and in reports of which kinds."""


class Page(HTMLParser):
    """Elements of a page, whose tags must close in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in _EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if tag not in _EMPTY:
            assert self.open.pop() == tag


@pytest.fixture(scope="module")
def limited(run: Run) -> Run:
    limits = {"largest_slip": 0.01, "largest_hub_load": 10.0}
    named = {"name": "Fan <script>alert(1)</script>", "project": "Hall B", "author": "A. Engineer"}
    return Run(run.dataset, run.drive.replace(**named, limits=limits))


@pytest.fixture(scope="module")
def text(limited: Run, tmp_path_factory: pytest.TempPathFactory) -> str:
    return write_report(limited, tmp_path_factory.mktemp("report") / "fan.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text: str) -> Page:
    return Page(text)


def data(text: str, name: str) -> Any:
    found = re.search(rf'<script type="application/json" id="{name}">(.*?)</script>', text, re.DOTALL)
    assert found
    return json.loads(found[1])


def test_the_page_is_whole_and_small(text: str, page: Page) -> None:
    assert len(text.encode()) < LARGEST
    identities = [one["id"] for _, one in page.elements if "id" in one]
    assert len(identities) == len(set(identities))
    links = {str(one["href"]) for tag, one in page.elements if tag == "a"}
    assert {link.removeprefix("#") for link in links} <= set(identities)


def test_nothing_is_fetched(text: str, page: Page) -> None:
    require_nothing_fetched(text, page)


def require_nothing_fetched(text: str, page: Page) -> None:
    """Neither by an element nor by a style; Bokeh names addresses in its texts, and calls none by itself."""
    for tag, one in page.elements:
        assert not str(one.get("src", "data:")).startswith(("http", "//", "/")), tag
        assert tag not in {"link", "iframe", "object"}
    style = text[text.index("<style>") : text.index("</style>")]
    assert "url(" not in style
    assert "@import" not in style


def test_what_a_drive_file_says_is_text(text: str) -> None:
    assert "<script>alert" not in text
    assert "Fan &lt;script&gt;alert(1)&lt;/script&gt;" in text


def test_limits_pass_and_fail(text: str) -> None:
    assert "✓ pass" in text
    assert "✗ fail" in text
    assert "1 of 2 limits are met" in text
    assert "at most 1 %" in text


def test_a_report_begins_with_what_is_asked_first(text: str) -> None:
    """Who and when, the verdict with what is broken, the numbers, tables, how to tension, and figures, contact last."""
    title, _, body = text.partition("</h1>")
    assert "Fan" in title
    places = [
        body.index(words)
        for words in (
            *("Project: Hall B", "Author: A. Engineer", "Date: 20", "1 of 2 limits are met: largest hub load"),
            *(
                'id="numbers"',
                'id="tables"',
                ">Pulleys",
                ">Spans",
                'id="tensioning"',
                "frequency meter",
                'id="figures"',
            ),
            *("<h3>Speeds", "<h3>Span tensions", "<h3>Slip", "<h3>Hub load sizes", "<h3>Contact pressure"),
            *('id="meaning"', 'id="origin"', 'id="file"'),
        )
    ]
    assert places == sorted(places)
    assert "<h3>Contact forces" not in body, "contact is shown once"


def test_charts_and_motion_stand_where_they_belong(text: str, page: Page) -> None:
    identities = {one["id"] for _, one in page.elements if "id" in one}
    charts, motions = data(text, "charts"), data(text, "motions")
    (item,) = charts["items"]
    assert set(item["roots"].values()) <= identities
    (document,) = charts["documents"].values()
    assert set(item["roots"]) == {root["id"] for root in document["roots"]}
    assert motions.keys() == {"motion-0"} <= identities
    assert len(data(text, "colors")) > 10


def test_every_figure_is_there_for_paper_too(page: Page) -> None:
    pictures = [one for tag, one in page.elements if tag == "img"]
    assert len(pictures) > 8
    assert all(str(one["src"]).startswith("data:image/") and one["alt"] for one in pictures)


@pytest.mark.slow
def test_several_runs_stand_side_by_side(limited: Run, run: Run, tmp_path: Path) -> None:
    other = Run(run.dataset, run.drive.replace(name="Other", belt=run.drive.belt.replace(width=0.02)))
    text = write_report([limited, other], tmp_path / "two.html").read_text(encoding="utf-8")
    Page(text)
    assert "<code>belt.width</code>" in text
    assert "+0.0% relative to the first" in text
    assert data(text, "motions").keys() == {"motion-0", "motion-1"}


def test_a_result_without_a_time_has_a_report(run: Run, tmp_path: Path) -> None:
    import xarray as xr

    tension = ("span", np.array([60.0, 30.0]), {"units": "N", "long_name": "Span tension"})
    attributes = {"kind": "other", "title": "Belt drive, other", "status": "completed", "warnings": "it is wrong."}
    dataset = xr.Dataset({"span_tension": tension}, {"span": ["a", "b"]}, attributes)
    text = write_report(Result(dataset, run.drive), tmp_path / "other.html").read_text(encoding="utf-8")
    Page(text)
    assert "it is wrong." in text
    assert "Bokeh" not in text
    assert 'id="numbers"' not in text
    assert "limit" not in text[: text.index('id="drive"')].partition("<body>")[2]


@pytest.mark.slow
def test_a_drive_that_stands_still_does_not_move(make_run: Callable[..., Run], tmp_path: Path) -> None:
    still = make_run(pulley_speed=np.zeros((101, 2)))
    assert data(write_report(still, tmp_path / "still.html").read_text(encoding="utf-8"), "motions") == {}


def test_only_a_report_is_replaced(limited: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "beltdyn.show.report.report._page", lambda *_: '<meta name="generator" content="beltdyn report">'
    )
    path = tmp_path / "report.html"
    assert write_report(limited, path) == write_report(limited, path) == path
    path.write_text("<p>Mine.</p>", encoding="utf-8")
    with pytest.raises(ModelError, match="already exists"):
        write_report(limited, path)
    assert path.read_text(encoding="utf-8") == "<p>Mine.</p>"
    assert write_report(limited, path, overwrite=True) == path


def test_an_error_leaves_no_file(limited: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ModelError, match=r"a report needs at least one result"):
        write_report([], tmp_path / "report.html")
    empty = Run(limited.dataset.isel(time=slice(0)), limited.drive)
    with pytest.raises(ModelError, match="ended before its first output"):
        write_report(empty, tmp_path / "report.html")
    monkeypatch.setattr("beltdyn.show.report.report._page", lambda *_: "")
    with pytest.raises(ModelError, match="cannot be written"):
        write_report(limited, tmp_path / "missing" / "report.html")
    assert list(tmp_path.iterdir()) == []


def test_the_name_of_a_report() -> None:
    assert report_file([Path("a/b.nc")]) == Path("a/b.html")
    assert report_file([Path("a/b.nc"), Path("c.nc")]) == Path("a/b-and-c.html")
    assert report_file([Path("a/b.nc"), Path("c.nc"), Path("d.nc")]) == Path("a/b-and-2-more.html")


def _text(example: str) -> str:
    return EXAMPLES.joinpath(f"{example}.toml").read_text(encoding="utf-8")


def _table() -> Path:
    """A duty table of two points."""
    path = Path(mkdtemp()) / "duty.csv"
    path.write_text("duration [s],crank speed [rpm],load\n10,1000,1\n20,1500,0.5\n", encoding="utf-8")
    return path


def _calibration() -> Path:
    """A study that fits the installed tension to slips."""
    folder = Path(mkdtemp())
    lines = ("alternator torque [N m],pulley_slip[alternator] [%]", "-3,0.09", "-7,0.2", "-9,0.26")
    (folder / "slip.csv").write_text("\n".join(lines), encoding="utf-8")
    number = "".join(f'{key} = "{value}"\n' for key, value in TENSION.items())
    study = folder / "study.toml"
    study.write_text(f'[[number]]\n{number}[[measurement]]\ntable = "slip.csv"\n', encoding="utf-8")
    return study


def _given(**settings: str) -> bd.Drive:
    """The drive of an alternator with limits and ripple, some numbers of which are changed in its file."""
    text = _text("alternator_drive").replace(
        "speed = {", "harmonics = [{ order = 2, amplitude = 0.001 }]\nspeed = {", 1
    )
    for key, value in settings.items():
        text = re.sub(rf"^{key} = .*$", f"{key} = {value}", text, flags=re.MULTILINE)
    return bd.loads(f"{MARK}{text}\n[limits]\nleast_slip_safety = 1.5\nlargest_hub_load = 10\n")


Reported = Callable[[str], tuple[Result, str]]


@pytest.fixture(scope="module")
def reported(tmp_path_factory: pytest.TempPathFactory) -> Reported:
    """A result of a kind, with its report."""
    drive = _given()

    @cache
    def of(kind: str) -> tuple[Result, str]:
        result = MAKERS[kind][0](drive)
        path = write_report(result, tmp_path_factory.mktemp(kind) / "report.html")
        return result, path.read_text(encoding="utf-8")

    return of


@pytest.mark.parametrize(
    "kind",
    [pytest.param(kind, marks=() if kind in ("steady", "sheet", "modes") else pytest.mark.slow) for kind in MAKERS],
)
def test_a_report_has_what_matters(kind: str, reported: Reported) -> None:
    _, words, charts = MAKERS[kind]
    result, text = reported(kind)
    assert len(text.encode()) < LARGEST
    require_nothing_fetched(text, Page(text))
    given = text.partition('<section id="file">')[2]
    assert MARK.strip() in given, "the drive file stands there as it was given, with its comments"
    for word in (*words, "Hub load" if kind != "modes" else "growth rate", "<math", "SHA-256", "[[pulley]]"):
        assert word in text, word
    roots = data(text, "charts").get("items", [{"roots": {}}])[0]["roots"].values()
    assert set(charts) <= set(roots)
    lead = re.findall(r'<p class="lead">(.*?)</p>', text)
    assert all(words != result.kind.replace("_", " ") for words in lead), "the sentence below the title is an answer"
    explained = text.partition('id="meaning"')[2].partition("</section>")[0]
    for meaning, kinds in MEANINGS.items():
        assert (meaning in explained) == (kind in kinds), meaning
    moving = data(text, "motions").values()
    assert [sorted(one.keys() & {"modes", "time"}) for one in moving] == {
        "modes": [["modes"]],
        **{key: [["time"]] for key in ("run", "steady", "sweep")},
    }.get(kind, [])
    kept = dict.fromkeys(("static", "run"), "0 of 1")  # a run of 20 ms has no slip yet
    kept |= dict.fromkeys(("sweep", "steady", "map", "duty", "sheet"), "1 of 2")
    limited = kept.get(kind)
    assert ("limits are met" in text) == (limited is not None)
    assert limited is None or f"{limited} limits are met" in text
    assert ('id="numbers"' in text) == (limited is not None or kind in ("open", "life"))
    if limited is not None or kind == "open":
        name = "peak_hub_load" if kind == "sheet" else "hub_load"
        loads = result.dataset[name].values if name in result.dataset else _hub_loads(result)
        (row,) = re.findall(r"<tr><th[^>]*>Largest hub load</th>(.*?)</tr>", text, re.DOTALL)
        assert f"<b>{np.nanmax(loads):.4g} N</b>" in row
        assert ("✗ fail" in row) == (limited is not None)


def _hub_loads(run: Result) -> Any:
    return np.linalg.norm(run.dataset["hub_force"].values, axis=-1)


def test_modes_stand_with_their_frequencies(reported: Reported) -> None:
    """To four digits, in the tables."""
    result, text = reported("modes")
    tables = text.partition('<section id="tables">')[2].partition("</section>")[0]
    found = np.array([float(one) for one in re.findall(r">(-?\d+\.?\d*(?:e[+-]?\d+)?)<", tables)])
    for frequency in result.dataset["frequency"].values:
        assert np.abs(found / frequency - 1.0).min() < 5e-3


def test_steady_running_names_no_instants(reported: Reported) -> None:
    _, text = reported("steady")
    assert "at 0 s" not in text
    assert "mean at the end" not in text
    titles = {one.get("text") for one in _parts(data(text, "charts")) if one.get("name") == "Title"}
    assert "t = " not in str(titles)


def _parts(content: object) -> list[dict[str, object]]:
    """All mappings within a document."""
    inner = list(content.values()) if isinstance(content, dict) else content if isinstance(content, list) else []
    found = [content] if isinstance(content, dict) else []
    return [*found, *(one for part in inner for one in _parts(part))]

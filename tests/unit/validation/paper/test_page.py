import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from validation.paper.departures import DEPARTURES
from validation.paper.page import write_page
from validation.paper.picture import picture
from validation.paper.statement import Finding, Number, Section, Statement, Table, Verdict

FACTS = {"Version": "beltdyn 1.2.3"}


@picture("A caption & more.")
def drawing() -> Figure:
    figure = Figure(figsize=(2.0, 1.0))
    figure.add_subplot().plot([0, 1], [0, 1])
    return figure


@pytest.fixture
def section() -> Section:
    holds = Finding("as published", [Number("speed <of> it", 0.5, "rad/s")], Verdict.HOLDS)
    fails = Finding("better settings", [Number("speed <of> it", 0.25, "rad/s")], Verdict.FAILS)
    quoted = Statement("first", "It holds", "the paper's words", 251, "More than 0.4.", [holds, fails], "A remark.")
    ours = Statement("second", "It is open", "", None, "None.", [Finding("as published", [], Verdict.OPEN)])
    table = Table("Some numbers", ["", "energy [J]"], [["one", 1.5]])
    return Section("part", "A part", "What was run.", [quoted, ours], [drawing()], [table])


def written(folder: Path, sections: list[Section], failures: dict[str, str] | None = None) -> str:
    write_page(folder / "page.html", sections, failures or {}, FACTS)
    return (folder / "page.html").read_text(encoding="utf-8")


class Balance(HTMLParser):
    """Tags that were opened and not closed."""

    VOID = ("meta", "img", "br")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_everything_is_on_the_page(tmp_path: Path, section: Section) -> None:
    text = written(tmp_path, [section])
    for part in (
        "the paper&#39;s words",
        "p. 251",
        "More than 0.4.",
        "0.500\u202frad/s",
        "0.250\u202frad/s",
        "A remark.",
    ):
        assert part in text
    for part in (
        "speed &lt;of&gt; it",
        "A caption &amp; more.",
        "beltdyn 1.2.3",
        "(our check)",
        "1.50",
        "What was run.",
    ):
        assert part in text


def test_the_summary_links_to_every_statement_with_its_verdicts(tmp_path: Path, section: Section) -> None:
    summary = written(tmp_path, [section]).partition("<main>")[0]
    first = summary.partition('href="#first"')[2].partition("</tr>")[0]
    assert re.findall(r'class="badge (\w+)"', first) == ["holds", "fails"]
    second = summary.partition('href="#second"')[2].partition("</tr>")[0]
    assert re.findall(r'class="badge (\w+)"', second) == ["open"]


def test_the_page_stands_alone(tmp_path: Path, section: Section) -> None:
    text = written(tmp_path, [section])
    assert re.findall(r'(?:src|href)="(?!#|data:)', text) == []
    assert "url(" not in text
    assert "@import" not in text
    assert "<script" not in text


def test_tags_are_balanced(tmp_path: Path, section: Section) -> None:
    balance = Balance()
    balance.feed(written(tmp_path, [section], {"a run": "<reason>"}))
    assert balance.open == []


def test_checks_of_our_own_are_counted_apart(tmp_path: Path, section: Section) -> None:
    summary = written(tmp_path, [section]).partition('<table class="counts">')[2].partition("</table>")[0]
    rows = [re.sub(r"<[^>]*>", " ", row).split() for row in summary.split("</tr>")]
    assert " ".join(rows[0]) == "Statements of the paper holds 1 does not hold 0 cannot be decided from the text 0"
    assert " ".join(rows[1]) == "Checks of our own holds 0 does not hold 0 cannot be decided from the text 1"


def test_departures_are_linked(tmp_path: Path) -> None:
    open_ended = [Finding("as published", [], Verdict.OPEN)]
    statement = Statement("name", "It", "words", 250, "None.", open_ended, departures=("start", "eq-11"))
    text = written(tmp_path, [Section("part", "A part", "What was run.", [statement])])
    linked = re.findall(r'href="#(departure-[\w-]+)"', text)
    assert linked == ["departure-start", "departure-eq-11"]
    assert all(f'id="{name}"' in text for name in linked)


def test_departures_are_headings_of_the_documentation() -> None:
    text = (Path(__file__).parents[4] / "docs" / "deviations.md").read_text(encoding="utf-8")
    titles = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
    anchors = {re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}
    assert DEPARTURES.keys() <= anchors


def test_failed_runs_are_named(tmp_path: Path) -> None:
    text = written(
        tmp_path, [Section("part", "A part", "This part could not be made: why.")], {"run_1": "no convergence"}
    )
    assert "<code>run_1</code>: no convergence" in text
    assert "could not be made: why." in text


def test_a_page_that_cannot_be_written(tmp_path: Path, section: Section) -> None:
    with pytest.raises(ModelError, match="cannot be written"):
        write_page(tmp_path / "missing" / "page.html", [section], {}, FACTS)

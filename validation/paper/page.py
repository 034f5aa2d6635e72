"""One self-contained HTML page from sections."""

from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, FunctionLoader, StrictUndefined

from beltdyn.results.atomic import MARK, atomic_path, is_marked
from validation.paper.departures import DEPARTURES
from validation.paper.numbers import shown
from validation.paper.statement import Section, Statement, Verdict

_MARK = f'<meta name="generator" content="{MARK}">'
_BADGES = {Verdict.HOLDS: "holds", Verdict.FAILS: "fails", Verdict.OPEN: "open"}


def write_page(path: Path, sections: Sequence[Section], failures: Mapping[str, str], facts: Mapping[str, str]) -> None:
    """Write the page; a page that is there already is replaced when the new one is complete.

    Parameters
    ----------
    path : Path
        The HTML file.
    sections : sequence of Section
        Parts of the page.
    failures : mapping
        Name -> reason of every run that failed.
    facts : mapping
        Where the page comes from: name -> fact.

    Raises
    ------
    ModelError
        If it cannot be written, or would replace a file that is no such page.
    """
    environment = Environment(
        loader=FunctionLoader(_read), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    environment.filters |= {"shown": shown, "badge": _BADGES.__getitem__}
    statements = [statement for section in sections for statement in section.statements]
    text = environment.get_template("page.html.jinja").render(
        sections=sections,
        failures=failures,
        facts=facts,
        counts={
            "Statements of the paper": _count([statement for statement in statements if not statement.ours]),
            "Checks of our own": _count([statement for statement in statements if statement.ours]),
        },
        departures=DEPARTURES,
        style=_read("page.css"),
    )
    with atomic_path(path, _is_page) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _is_page(path: Path) -> bool:
    return is_marked(path, _MARK)


def _count(statements: Sequence[Statement]) -> dict[Verdict, int]:
    """How many statements have each verdict."""
    return {verdict: sum(statement.verdict is verdict for statement in statements) for verdict in Verdict}


def _read(name: str) -> str:
    """Read a file of this package."""
    return files("validation.paper").joinpath(name).read_text(encoding="utf-8")

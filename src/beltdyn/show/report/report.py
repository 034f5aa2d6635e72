"""Report of results: content and file."""

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import ChoiceLoader, Environment, FunctionLoader, PackageLoader, StrictUndefined
from matplotlib.colors import to_hex

from beltdyn.errors import ModelError, Parts
from beltdyn.model.alignment import is_given
from beltdyn.parts.text_file import as_text
from beltdyn.results import Result, Run, StaticResult
from beltdyn.results.atomic import MARK, atomic_path, is_marked, require_replaceable
from beltdyn.results.cycles import ends_at_standstill
from beltdyn.results.limits import key_numbers
from beltdyn.results.provenance import mesh_facts
from beltdyn.results.schema import runs_steadily
from beltdyn.show.notebook import picture
from beltdyn.show.plot.headline import differing_keys, given_keys, headline, name_of, names_of_results
from beltdyn.show.plot.style import tension_colors
from beltdyn.show.report.chart import Shown, charted
from beltdyn.show.report.replay import motion, swinging
from beltdyn.show.rest_sheet import Tensioning, alignment_table, tensioning
from beltdyn.show.sheet import sheet_without_limits
from beltdyn.show.tables import Table, facts_beside, side_by_side
from beltdyn.show.verdict import compared, limit_in_words, unjudged_in_words, value_in_words, verdict

# The charting library of the page (Bokeh, BSD license), taken from its installation, and what it is given

_NAME = "figures"


def library() -> str:
    """The library as the text of a script; it fetches nothing."""
    from bokeh.resources import INLINE

    return str(INLINE.js_raw[0])


def embedded(parts: Mapping[str, Any]) -> str:
    """Write what the page's script reads, safe inside a page."""
    content: Any = dict(parts)
    if parts and not all(isinstance(part, dict) for part in parts.values()):
        content = _document(parts)
    return json.dumps(content, separators=(",", ":")).replace("<", "\\u003c")


def _document(charts: Mapping[str, Any]) -> dict[str, Any]:
    """A document of Bokeh as plain values, whose arrays are in base64, and where its parts stand."""
    from bokeh.core.json_encoder import serialize_json
    from bokeh.document import Document

    document = Document()
    with document.models.freeze():  # else all charts are gone through once more with each
        for chart in charts.values():
            document.add_root(chart)
    roots = {chart.id: place for place, chart in charts.items()}
    return {
        "documents": {_NAME: json.loads(serialize_json(document.to_json(deferred=False)))},
        "items": [{"docid": _NAME, "root_ids": list(roots), "roots": roots}],
    }


_MAX_DIFFERENCES = 40
"""Rows of the table of differing keys at most: drives that have little in common would fill pages."""
_MAX_NUMBERS = 3
"""Key numbers in the sentence below the title."""


def origin(result: Result) -> list[tuple[str, str]]:
    """Facts about how a result was made."""
    said = result.dataset.attrs
    packages = ("beltdyn", "numba", "numpy", "scipy", "python")
    versions = ", ".join(f"{name} {said[f'{name}_version']}" for name in packages if f"{name}_version" in said)
    facts = [
        ("analysis", f"{analysis_of(result)}, {result.status}"),
        ("versions", versions),
        ("computed", str(said.get("created", "unknown"))),
        ("format of the result file", str(said.get("format", "unknown"))),
        ("SHA-256 of the drive", _hash(result.drive.text.encode())),
    ]
    if result.path is not None and result.path.is_file():
        facts += [(f"SHA-256 of {as_text(result.path.name)}", _hash(result.path.read_bytes()))]
    settings = result.drive.simulation
    if isinstance(result, Run):
        integrator = said.get("integrator", settings.integrator)
        facts += [("integrator", f"{integrator}, rtol {settings.rtol:g}, start {settings.start}")]
    facts += mesh_facts(said)
    facts += [(choice.key, choice.words) for choice in result.prepared.choices]
    return facts


def analysis_of(result: Result) -> str:
    """Name of the analysis: of a run, whether it is steady running or a sweep."""
    if isinstance(result, Run) and runs_steadily(result.dataset):
        return "steady"
    return "sweep" if "swept_pulley" in result.dataset.attrs else result.kind.replace("_", " ")


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


_WIDEST_TABLE = 180
"""Characters of a line of a table that is printed across a page of A4 in letters of 5 pt; wider ones are divided."""
_COLOR_COUNT = 48
"""Number of colors of the scale of tension that the page gets: the steps between them are hard to see."""
_ALPHABET_SIZE = 26
"""Number of letters from A to Z, of which the marks of results are made."""
_SAYS_WHO_MADE_IT = f'<meta name="generator" content="{MARK} report">'


def write_report(results: Result | Sequence[Result], path: Path | str, overwrite: bool = False) -> Path:
    """Write a report of one or several results as a self-contained HTML page.

    It shows the key numbers beside the limits of the drive file, warnings with remedies, the moving drive, interactive
    figures, tables, the provenance, and the drive file. It can be printed and read without JavaScript; nothing is
    loaded from a network.

    Parameters
    ----------
    results : Result or sequence of Result
        A run, or the result of another analysis; or several, to compare them.
    path : Path or str
        The HTML file; an existing report of beltdyn is replaced.
    overwrite : bool
        Replace any regular file.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If there is no result, a run holds no output, or the file cannot be written or would replace another one.
    InternalError
        If a figure or a table has a fault; the page is written, and says so in its place.

    Examples
    --------
    >>> bd.write_report(run, "report.html").name
    'report.html'
    """
    path, several = Path(path), [results] if isinstance(results, Result) else list(results)
    require_report(path, overwrite)
    if not several:
        raise ModelError("a report needs at least one result.")
    for one in several:
        if isinstance(one, Run):
            one.require_output()
    with Parts() as parts:
        text = _page(several, parts)
        with atomic_path(path, _is_report, overwrite) as temporary:
            temporary.write_text(text, encoding="utf-8")
        parts.completed.append(path)
    return path


def require_report(path: Path, overwrite: bool = False) -> None:
    """Make sure that a report would replace nothing but a report."""
    require_replaceable(path, _is_report, overwrite)


def report_file(files: Sequence[Path]) -> Path:
    """The report of result files where none is named: beside the first, and named after it."""
    first, *more = files
    others = f"-and-{more[0].stem if len(more) == 1 else f'{len(more)}-more'}" if more else ""
    return first.with_name(f"{first.stem}{others}.html")


def _is_report(path: Path) -> bool:
    return is_marked(path, _SAYS_WHO_MADE_IT)


def environment() -> Environment:
    """What fills the templates of this package."""
    made = Environment(
        loader=ChoiceLoader([FunctionLoader(read), PackageLoader("beltdyn")]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {"value_of": value_in_words, "limit_of": limit_in_words}
    return made


def _page(results: Sequence[Result], parts: Parts) -> str:
    """The page; what of it has a fault is left out, and is among the errors of `parts`."""
    sources = results[0].source if len(results) == 1 else f"[{', '.join(one.source for one in results)}]"
    done: Callable[..., Any] = partial(parts.done, repeat=f"bd.write_report({sources}, 'report.html')")
    names = names_of_results(results) if len(results) > 1 else [name_of(results[0]) or results[0].drive.title]
    drawn, charts = charted(results, parts)
    motions = [done(partial(_moving, one, len(results)), {}) for one in results]
    moving = {f"motion-{number}": found for number, found in enumerate(motions) if found}
    pages = [
        _part(name, number, one, moving, parts) for number, (name, one) in enumerate(zip(names, results, strict=True))
    ]
    marks = list(map(_mark, range(len(results))))
    together, rest = done(lambda: side_by_side([part["tables"] for part in pages], marks), ([], []))
    facts = done(lambda: facts_beside([part["facts"] for part in pages], marks), None)
    if len(results) > 1:
        for part, tables in zip(pages, rest, strict=True):
            part |= {"tables": tables, "facts": []}
    return (
        environment()
        .get_template("page.html.jinja")
        .render(
            title=" and ".join(names) if len(names) <= 2 else f"{names[0]} and {len(names) - 1} more",
            mark=_SAYS_WHO_MADE_IT,
            compares=len(results) > 1,
            kinds={one.kind for one in results},
            slips=any(one.drive.belt.teeth is None for one in results),
            toothed=any(one.drive.belt.teeth is not None for one in results),
            standing=done(lambda: all(map(_stands, results)), False),
            verdict=done(partial(verdict, results), ("open", "No verdict")),
            lead=done(partial(lead, results[0]), "") if len(results) == 1 else "",
            parts=pages,
            marks=marks,
            together=[*together, *([facts] if facts and facts.rows else [])] if len(results) > 1 else [],
            widest=_WIDEST_TABLE,
            numbers=done(partial(compared, results), []),
            unjudged=done(partial(unjudged_in_words, results), []),
            differences=done(lambda: differing_keys(results)[:_MAX_DIFFERENCES], []),
            names=names,
            figures=drawn,
            faults=list(dict.fromkeys(map(str, parts.errors))),
            motions=embedded(moving),
            colors=json.dumps([to_hex(shade) for shade in tension_colors()(np.linspace(0.0, 1.0, _COLOR_COUNT))]),
            charts=embedded(charts),
            library=library() if charts else "",
            style=read("page.css"),
            script=script() if charts or moving else "",
        )
    )


def lead(result: Result) -> str:
    """The sentence below the title: the answer of the analysis, the operating point, or else the first key numbers."""
    if answer := str(result.dataset.attrs.get("answer", "")):
        return answer
    words = headline(result).removeprefix(f"{name_of(result)}: ")
    if words != result.kind.replace("_", " "):
        return words
    numbers = [number for number in key_numbers(result) if np.isfinite(number.value)]
    return "; ".join(f"{number.name} {value_in_words(number)}" for number in numbers[:_MAX_NUMBERS])


def _mark(number: int) -> str:
    """Letters for a result, from A to Z and on from AA."""
    rest, letter = divmod(number, _ALPHABET_SIZE)
    return (_mark(rest - 1) if rest else "") + chr(ord("A") + letter)


def _stands(result: Result) -> bool:
    """Whether a result is without power: of an axis over its stroke, or a run that ends at standstill."""
    if not isinstance(result, Run):
        return result.kind == "stroke"
    with result.recorded() as recorded:
        return ends_at_standstill(recorded, result.prepared)


def _moving(result: Result, results: int) -> dict[str, Any]:
    """What shows the drive moving: a run, if anything turns, or modes; nothing of other results."""
    if result.kind == "modes":
        return swinging(result)
    if isinstance(result, Run) and bool((result.dataset["pulley_speed"] != 0.0).any()):
        return motion(result, results)
    return {}


def _part(name: str, number: int, result: Result, moving: Mapping[str, Any], parts: Parts) -> dict[str, Any]:
    """What the page shows of one result."""
    done: Callable[..., Any] = partial(parts.done, repeat=f"bd.write_report({result.source}, 'report.html')")
    shown = sheet_without_limits(result)
    for error in shown.errors:
        parts.fail(error)
    tables = [part for part in shown.parts if isinstance(part, Table)]
    if isinstance(result, Run | StaticResult) and not result.drive.ends and is_given(result.drive):
        tables += done(lambda: [alignment_table(result.drive, result.drive.path)], [])
    head = {label.lower() for label, _ in _about(result)}
    facts = [fact for part in shown.parts if not isinstance(part, Table) for fact in part.facts if fact[0] not in head]
    target = f"motion-{number}"
    return {
        "name": name,
        "kind": result.kind.replace("_", " "),
        "title": result.dataset.attrs["title"],
        "status": result.status,
        "description": result.drive.description or "",
        "picture": done(lambda: picture(result.drive), None),
        "motion": target if target in moving else "",
        "swings": "modes" in moving.get(target, {}),
        "findings": done(lambda: result.findings if isinstance(result, Run) else [], []),
        "warnings": result.warnings,
        "tables": tables,
        "facts": facts,
        "origin": done(lambda: origin(result), []),
        "about": _about(result),
        "tensioning": done(lambda: _tensioning(result), None),
        "drive": result.drive_as_given,
    }


def _tensioning(result: Result) -> Tensioning | None:
    """How the belt is tensioned in the workshop; nothing of other results."""
    if not isinstance(result, Run | StaticResult):
        return None
    return tensioning(result.drive, given_keys(result).get("belt.installed_tension"))


def _about(result: Result) -> list[tuple[str, str]]:
    """Customer, position, order, project, author and date of a result."""
    created = str(result.dataset.attrs.get("created", "")).partition("T")[0]
    about = (("Project", result.drive.project), ("Author", result.drive.author), ("Date", created))
    return [*result.drive.sheet.entries, *((name, words) for name, words in about if words)]


def script() -> str:
    """The scripts of a page, one after the other."""
    parts = "".join(str(read(f"{name}.js")) for name in ("motion", "swing", "charts", "start"))
    return f'"use strict";\n(() => {{\n{parts}}})();\n'


def read(name: str) -> str | None:
    """Read a file of this package; None where there is none of this name."""
    file = files("beltdyn.show.report").joinpath(name)
    return file.read_text(encoding="utf-8") if file.is_file() else None


_ROW_HEIGHT, _HEADING_HEIGHT = 400, 90
"""Height for a row of charts, and for the name above, pixels."""
_MAX_HEIGHT = 900
"""Height of the frame in a notebook at most, pixels: a page that is longer is scrolled inside it."""


class InteractiveFigures:
    """Interactive figures of results in a notebook: a self-contained page in a frame of a height in pixels."""

    def __init__(self, page: str, names: tuple[str, ...], height: int) -> None:
        self.page, self.names, self.height = page, names, height

    def __repr__(self) -> str:
        return f"InteractiveFigures({', '.join(self.names)})"

    def _repr_html_(self) -> str:
        """Show the page in a frame of its own, so that it meets no other script of the notebook."""
        size = f"width:100%;height:{self.height}px;border:0"
        return f'<iframe srcdoc="{escape(self.page)}" style="{size}" title="{escape(", ".join(self.names))}"></iframe>'


def interactive(results: Result | Sequence[Result], *names: str) -> InteractiveFigures:
    """Draw interactive figures for a notebook.

    Parameters
    ----------
    results : Result or sequence of Result
        A run, or the result of another analysis; or several, whose lines are laid over each other.
    *names : str
        Names of figures, such as "span_tensions", as `beltdyn plot --figures` has them; by default those of a report.

    Returns
    -------
    InteractiveFigures
        An object that Jupyter displays as charts, offline. It contains the charting library (1.3 MB), so show all
        figures in one cell.

    Raises
    ------
    ModelError
        If there is no such figure, or it cannot be drawn of these results.

    Examples
    --------
    >>> bd.interactive(run, "slip", "span_tensions")
    InteractiveFigures(Slip, Span tensions)
    """
    several = [results] if isinstance(results, Result) else list(results)
    parts = Parts()
    shown, charts = charted(several, parts, names or None)
    if names:
        parts.end()
    if missing := [one.missing for one in shown if one.missing and names]:
        raise ModelError(missing[0])
    page = environment().get_template("interactive.html.jinja")
    text = page.render(
        figures=shown,
        charts=embedded(charts),
        colors=json.dumps([]),
        library=library() if charts else "",
        style=read("page.css"),
        script=script(),
    )
    return InteractiveFigures(text, tuple(one.name for one in shown), _height(shown))


def _height(shown: Sequence[Shown]) -> int:
    """Height that figures take, at two charts beside each other."""
    rows = sum(max(1, -(-len(one.charts) // 2)) * _ROW_HEIGHT + _HEADING_HEIGHT for one in shown)
    return min(rows, _MAX_HEIGHT)

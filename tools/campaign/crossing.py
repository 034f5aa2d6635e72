"""Every consumer of results with every kind of them: figures, reports, sheets, exports, derived quantities, analyses.

A consumer draws, writes or computes something, refuses with a message, or has a fault: an internal error, or a silent
gap, which is a picture, a table or a page that is empty and does not say why.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from functools import partial
from inspect import Parameter, signature
from io import StringIO
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import pyplot
from matplotlib.figure import Figure

import beltdyn as bd
from beltdyn.analyses import ANALYSES
from beltdyn.app.jobs import _outcome as page_outcome
from beltdyn.cli.app import run as run_command
from beltdyn.designs.study_columns import columns_of
from beltdyn.errors import InternalError, ModelError
from beltdyn.results import Result, derived, export, key_numbers, steady_comparison, summarize
from beltdyn.results.export import FORMATS
from beltdyn.show.plot.figures import FIGURES, Choice, chosen_by_default
from beltdyn.show.plot.gaps import has_values
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import as_text

Consumer = Callable[[Result, Path], str]
"""``consumer(result, folder) -> fault``: uses a result, with a folder for files; a fault in words, or nothing."""

_NAN = re.compile(r"(?<![\w.])-?(nan|inf)(?![\w.])", re.IGNORECASE)
"""A number that is none, among words for people."""
_BETWEEN = re.compile(r"<(script|style)\b.*?</\1>|<[^>]*>", re.DOTALL)
"""Parts of a page that nobody reads."""
_REDUCED = ("largest", "least", "mean", "deviation", "swing", "last")


def every_figure(result: Result, _: Path) -> str:
    """Every figure of the kind, on request; those that the result does not suit are refused."""
    faults = [
        f"{name}: {fault}"
        for name, registered in FIGURES.items()
        if result.kind in registered.of and (fault := _gaps_of(partial(registered.arrange, result, Choice())))
    ]
    return "; ".join(faults)


def other_figures(result: Result, _: Path) -> str:
    """Figures of other kinds are refused."""
    taken = [
        name
        for name, one in FIGURES.items()
        if result.kind not in one.of and not _refuses(partial(one.arrange, result, Choice()))
    ]
    return f"drawn of {result.kind}: {', '.join(taken)}" if taken else ""


def report(result: Result, folder: Path) -> str:
    """The page of `beltdyn app`, which writes a report; words of both are read."""
    ended = page_outcome(result, folder / "page.nc")
    text = "" if ended.report is None else _BETWEEN.sub(" ", ended.report.read_text(encoding="utf-8"))
    return _nan_in(text + "\n".join(map(str, ended.parts)))


def commands(result: Result, folder: Path) -> str:
    """The commands `plot`, for the first figure drawn by default, and `export`, of the result file."""
    if result.path is None:
        return ""
    file, figures = str(result.path), chosen_by_default([result])
    first = ["--figures", figures[0]] if figures else []
    faults = _command("plot", file, "-o", str(folder / "figures"), "--force", *first)
    return "; ".join([*faults, *_command("export", file, "--csv", "-o", str(folder), "--force")])


def sheet_text(result: Result, _: Path) -> str:
    """The sheet, as the command line prints it."""
    shown = as_text(sheet(result))
    return _nan_in(shown) if shown.strip() else "an empty sheet"


def notebook(result: Result, _: Path) -> str:
    """What a notebook shows."""
    return _nan_in(_BETWEEN.sub(" ", result._repr_html_()) + repr(result))


def exported(form: str, result: Result, folder: Path) -> str:
    """Files of other programs; every table has columns."""
    return "" if export(result, form, folder / "exported.nc", overwrite=True) else "no file, and no word"


def saved(result: Result, folder: Path) -> str:
    """A file that gives back the same."""
    again = bd.open_result(result.save(folder / "saved.nc", overwrite=True))
    with again.dataset:
        return "" if again.dataset.drop_attrs().equals(result.dataset.drop_attrs()) else "the file differs"


def columns(result: Result, _: Path) -> str:
    """Numbers of a study: all single ones, and all reductions."""
    found = columns_of(result, ["all", *(f"{name}(all)" for name in _REDUCED)])
    return "" if found.values or found.absent or found.unknown else "no number, and no word"


def quantities(result: Result, _: Path) -> str:
    """Derived quantities of runs; other results are refused."""
    return _of_runs(result, {name: getattr(derived, name) for name in derived.__all__} | OF_RUNS)


def analyses(result: Result, folder: Path) -> str:
    """Analyses that take a result as an option; those of another kind are refused."""
    faults = list[str]()
    for name, analysis in ANALYSES.items():
        for one in list(signature(analysis.function, eval_str=True).parameters.values())[1:]:
            if one.kind is Parameter.KEYWORD_ONLY and re.search(r"\b(Run|Result)\b", str(one.annotation)):
                options = _NEEDED.get(name, {}) | {one.name: result}
                faults += _fault(f"{name}({one.name})", partial(analysis.function, result.drive, **options))
    return "; ".join(faults)


CONSUMERS: Mapping[str, Consumer] = {
    "every figure": every_figure,
    "figures of other kinds": other_figures,
    "report and page": report,
    "sheet": sheet_text,
    "notebook": notebook,
    "commands": commands,
    **{f"export to {name}": partial(exported, name) for name in FORMATS},
    "file": saved,
    "numbers of a study": columns,
    "derived quantities": quantities,
    "analyses of results": analyses,
}
"""Name -> what uses a result."""

OF_RUNS: dict[str, Callable[..., object]] = {
    "summarize": summarize,
    "steady_comparison": steady_comparison,
    "key_numbers": key_numbers,
}
_NEEDED: dict[str, dict[str, Any]] = {"response": {"speed": "500, 1000 rpm"}}
"""Options without which an analysis is refused at once."""


def pair(results: Sequence[Result], folder: Path) -> str:
    """The commands `report`, which draws all that compares, and `plot`, of several results together."""
    files, page, figures = [str(one.path) for one in results], str(folder / "pair.html"), chosen_by_default(results)
    first = ["--figures", figures[0]] if figures else []
    faults = _command("report", *files, "-o", page, "--force")
    return "; ".join([*faults, *_command("plot", *files, "-o", str(folder / "pair"), "--force", *first)])


def _command(*words: str) -> list[str]:
    """The fault of a command: an internal error, an exit code of its own, or an end without a word."""
    with redirect_stdout(StringIO()) as said, redirect_stderr(StringIO()) as errors:
        code = run_command(list(words))
    if code not in (0, 2):
        return [f"{words[0]}: exit code {code}: {errors.getvalue()[:300]}"]
    return [] if (errors if code else said).getvalue().strip() else [f"{words[0]}: exit code {code}, and no word"]


def with_gaps(result: Result, seed: int | str) -> Result | None:
    """A result whose points failed in part, at random; None where it has no points.

    The share of failed points is random, too, and in one of four cases all are. In a study single results miss others.
    """
    if "failure" not in result.dataset:
        return None
    random, dataset = Random(seed), result.dataset.copy(deep=True)
    dims, shape = dataset["failure"].dims, dataset["failure"].shape
    share = random.choice((0.2, 0.5, 0.8, 1.0))
    failed = np.reshape([random.random() < share for _ in range(int(np.prod(shape)))], shape)
    for name, values in dataset.data_vars.items():
        if values.dtype.kind == "f" and set(dims) <= set(values.dims):
            lost = xr.DataArray(failed, dims=dims)
            if name in ("design_number", "seconds"):  # known of failed points, too
                continue
            if result.kind == "study":
                lost = lost | xr.DataArray([random.random() < 0.2 for _ in failed], dims=dims)
            dataset[name] = values.where(~lost).transpose(*values.dims).assign_attrs(values.attrs)
    reasons = np.where(failed, "the belt has no steady running there. Give less load.", "").astype(object)
    dataset["failure"] = dataset["failure"].copy(data=reasons)
    return Result(dataset, result.drive, result.path)


def _of_runs(result: Result, functions: Mapping[str, Callable[..., object]]) -> str:
    """Faults of functions of a run, called with the result alone, and with a pulley where they need one."""
    faults = list[str]()
    for name, function in functions.items():
        first, *others = signature(function).parameters.values()
        if first.name != "run" and name != "key_numbers":
            continue
        needed = [0 for one in others if one.default is Parameter.empty and one.name in ("pulley", "roller")]
        if len(needed) == sum(one.default is Parameter.empty for one in others):
            faults += _fault(name, partial(function, result, *needed))
    return "; ".join(faults)


def _fault(name: str, work: Callable[[], object]) -> list[str]:
    """The fault of some work, with its name; a refusal is none."""
    try:
        work()
    except bd.BeltdynError as error:
        if isinstance(error, InternalError):
            return [f"{name}: {error}"]
        return [] if str(error).strip() else [f"{name}: an empty message"]
    except Exception as error:
        place = error.__traceback__
        while place is not None and place.tb_next is not None:
            place = place.tb_next
        where = "" if place is None else f"{Path(place.tb_frame.f_code.co_filename).name}:{place.tb_lineno}"
        return [f"{name}: {type(error).__name__}: {str(error)[:150]} ({where})"]
    return []


def _refuses(draw: Callable[[], object]) -> bool:
    try:
        draw()
    except ModelError:
        return True
    return False


def _gaps_of(draw: Callable[[], Figure]) -> str:
    """The fault of a figure: an internal error, or a panel with neither values nor words; nothing if it is refused."""
    pages = list[Figure]()
    faults = _fault("", lambda: pages.append(draw()))
    pyplot.close("all")
    for one in pages:
        empty = [ax for ax in one.axes if ax.get_visible() and not has_values(ax) and not ax.texts]
        faults += [f"{len(empty)} panels are empty without a word"] if empty else []
    return ", ".join(fault.removeprefix(": ") for fault in faults)


def _nan_in(text: str) -> str:
    found = _NAN.search(text)
    return "" if found is None else f"says {text[max(found.start() - 60, 0) : found.end() + 20]!r}"

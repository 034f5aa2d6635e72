"""Results of every analysis on examples, each computed once, with all that reads them: consumers, studies, goals, fits.

Drives are the examples with short runs and coarse meshes; all trials are in one process, whose kernels and results they
share.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import beltdyn as bd
from beltdyn.analyses import ANALYSES
from beltdyn.designs.named_results import names_of, unit_of, variable_and_label
from beltdyn.errors import ModelError, is_internal
from beltdyn.model import Drive, ParameterStudy
from beltdyn.model.parameter_study import CalibrationStudy, OptimizationStudy
from beltdyn.results import Result
from tools.campaign.analyses import WORKS, driver_name, table_in
from tools.campaign.crossing import CONSUMERS, pair, with_gaps
from tools.campaign.trial import Outcome, attempt_here

Trial = tuple[str, Outcome]

LONGEST = 120.0
"""Processor time of an analysis or a consumer, s."""
_SHORT = 0.003
"""Duration of runs, s: too short for a mean of many drives."""
_COARSE = 0.2
"""Tolerance of contact forces to which meshes are refined."""
_GOALS = 3
"""Optimizations of each example, each for another result, and fits to results without a value."""
_PAIRS = 2
"""Results of each example that are set beside so many of other kinds."""
_EVERY = 3
"""Examples from one whose study of an analysis is tried to the next."""
_WATCHING = ("every figure", "report and page", "sheet", "export to csv")
"""Consumers of studies, and of results with gaps."""
_STATES = {"steady": "steady", "rest": "equilibrium"}
"""States about which sensitivities are, and which calibrations measure, and the analyses that find them."""


def crossed(seed: int, names: Sequence[str], folder: Path) -> Iterator[Trial]:
    """All consumers with results of all analyses of examples, and with studies, goals and fits of these."""
    before = dict[str, Result]()
    for place, name in enumerate(names):
        results = dict[str, Result]()
        for analysis in WORKS:
            if not analysis.startswith("check"):
                path = folder / f"{name}-{analysis.replace(' ', '-')}.nc"
                yield f"{analysis} of {name}", _try(_compute, name, analysis, path)
                if path.exists():
                    results[analysis] = bd.open_result(path)
                    yield from consumed(path.stem, results[analysis], folder, seed)
        yield from studied(name, folder, range(seed + place, seed + place + len(ANALYSES) * _EVERY, _EVERY))
        yield from aimed(name, folder, seed)
        yield from fitted(name, folder, seed)
        yield from paired(name, results, before, folder, seed)
        before = results


def consumed(label: str, result: Result, folder: Path, seed: int) -> Iterator[Trial]:
    """All consumers of a result, and of the result with gaps if it has points."""
    for consumer in CONSUMERS:
        yield f"{consumer} of {label}", _try(CONSUMERS[consumer], result, _folder(folder, label))
    gapped = with_gaps(result, f"{label} {seed}")
    if gapped is not None:
        for consumer in _WATCHING:
            yield f"{consumer} of {label} with gaps", _try(CONSUMERS[consumer], gapped, _folder(folder, label))


def studied(name: str, folder: Path, numbers: Sequence[int]) -> Iterator[Trial]:
    """Studies of some analyses, each with a point that fails, and what reads them."""
    analyses = list(ANALYSES)
    for analysis in dict.fromkeys(analyses[number % len(analyses)] for number in numbers[: len(analyses) // _EVERY]):
        path = folder / f"{name}-study-of-{analysis}.nc"
        yield f"study of {analysis} of {name}", _try(_study, name, analysis, path)
        if path.exists():
            result = bd.open_result(path)
            for consumer in _WATCHING:
                yield f"{consumer} of {path.stem}", _try(CONSUMERS[consumer], result, _folder(folder, path.stem))


def aimed(name: str, folder: Path, seed: int) -> Iterator[Trial]:
    """Sensitivities of all results of an example, and optimizations of some."""
    drive, random = coarse(name), Random(f"{name} {seed}")
    width = drive.belt.width
    for about in _STATES:
        work = partial(bd.sensitivity, drive, of="all", about=about, numbers="belt.width")
        yield f"sensitivity of all results, {about}, of {name}", _try(_computed, work)
    variables = list(dict.fromkeys(variable_and_label(one)[0] for one in names_of(drive)))
    for variable in random.sample(variables, min(_GOALS, len(variables))):
        free = [{"path": "belt.width", "least": 0.8 * width, "largest": 1.2 * width}]
        study = OptimizationStudy(number=free, goal={"result": variable})
        path = folder / f"{name}-optimize-{variable}.nc"
        work = partial(bd.optimize, drive, study=study, most=2, output=path, overwrite=True)
        yield f"optimization of {variable} of {name}", _try(_computed, work)


def fitted(name: str, folder: Path, seed: int) -> Iterator[Trial]:
    """Calibrations: by all results that have a value, and by some others, which are refused."""
    drive, random = coarse(name), Random(f"{name} {seed}")
    for state in _STATES:
        known = dict[str, float]()
        yield f"results to be measured, {state}, of {name}", _try(_measured, drive, state, known)
        if known:
            yield f"calibration by {len(known)} results, {state}, of {name}", _try(_fit, drive, state, known, folder)
            others = [one for one in names_of(drive, at_rest=state == "rest") if one not in known]
            for other in random.sample(others, min(_GOALS, len(others))):
                label = f"calibration by {other}, {state}, of {name}"
                yield label, _try(_refused, partial(_fit, drive, state, {other: 1.0}, folder))


def paired(
    name: str, results: Mapping[str, Result], before: Mapping[str, Result], folder: Path, seed: int
) -> Iterator[Trial]:
    """Pairs of results: of a kind with those of the example before, or with themselves, and of different kinds."""
    kinds = list(results)
    pairs = [(analysis, "another drive", before.get(analysis, results[analysis])) for analysis in kinds]
    for analysis in Random(f"{name} {seed}").sample(kinds, min(_PAIRS, len(kinds))):
        pairs += [(analysis, other, results[other]) for other in kinds if other != analysis][:_PAIRS]
    for analysis, label, second in pairs:
        yield f"{analysis} of {name} and {label}", _try(pair, [results[analysis], second], _folder(folder, name))


def coarse(name: str) -> Drive:
    """An example with short runs and coarse meshes."""
    drive = bd.example(name)
    interval = min(drive.simulation.output_interval, _SHORT / 3)
    settings = drive.simulation.replace(duration=_SHORT, output_interval=interval, field_interval=None)
    return drive.replace(simulation=settings).with_({"steady.force_tolerance": _COARSE})


def _try(work: Callable[..., str], *arguments: Any) -> Outcome:
    return attempt_here(partial(work, *arguments), LONGEST)


def _compute(name: str, analysis: str, path: Path) -> str:
    found = WORKS[analysis](coarse(name), _folder(path.parent, path.stem))
    assert isinstance(found, Result)
    found.save(path, overwrite=True)
    return _computed(lambda: found)


def _computed(work: Callable[[], Result]) -> str:
    """The internal error that a result tells among its warnings, or as the end of a point."""
    result = work()
    failures = result.dataset["failure"].values.ravel() if "failure" in result.dataset else ()
    return next((text[:300] for one in (*failures, *result.warnings) if is_internal(text := str(one))), "")


def _study(name: str, analysis: str, path: Path) -> str:
    """A study of two widths, of which the second is too large for most drives, of all that the analysis gives."""
    drive = coarse(name)
    options = {key: value(drive, _folder(path.parent, path.stem)) for key, value in _OPTIONS.get(analysis, {}).items()}
    given = ParameterStudy(
        analysis=analysis, options=options, number=[{"path": "belt.width", "values": [drive.belt.width, 1e3]}]
    )
    result = bd.study(given, drive, jobs=1, output=path, overwrite=True)
    return _computed(lambda: result) or gap_of_study(result)


def gap_of_study(result: Result) -> str:
    """The silent gap of a study: results without a value at any point, of which no warning speaks."""
    names = str(result.dataset.attrs["results"]).splitlines()
    unknown = [name for name in names if not np.isfinite(result.dataset[name].values).any()]
    failed = bool((result.dataset["failure"] != "").all())
    said = failed or not unknown or "no value" in " ".join(result.warnings)
    return "" if said else f"no value of {unknown[0]}, and no word"


def _measured(drive: Drive, state: str, known: dict[str, float]) -> str:
    """Put the results of a state that have a value into a mapping."""
    result = bd.sensitivity(drive, of="all", about=state, numbers=[])
    known |= zip(result.dataset["result"].values.tolist(), result.dataset["value"].values.tolist(), strict=True)
    return ""


def _fit(drive: Drive, state: str, measured: Mapping[str, float], folder: Path) -> str:
    """A fit of the width to two rows of results."""
    table, width = folder / "measured.csv", drive.belt.width
    headings = ",".join(f"{name} [{unit}]" if (unit := unit_of(name, drive)) else name for name in measured)
    rows = [",".join(map(repr, measured.values()))] * 2
    table.write_text("\n".join([headings, *rows, ""]), encoding="utf-8")
    study = CalibrationStudy(
        number=[{"path": "belt.width", "least": 0.8 * width, "largest": 1.2 * width}],
        measurement=[{"table": str(table), "state": state}],
    )
    return _computed(lambda: bd.calibrate(drive, study=study))


def _refused(work: Callable[[], str]) -> str:
    """A fault if some work is not refused."""
    try:
        work()
    except ModelError:
        return ""
    return "a result without a value was fitted, and no word"


def _folder(folder: Path, name: str) -> Path:
    """A folder for what a trial writes."""
    made = folder / f"{name}-files"
    made.mkdir(exist_ok=True)
    return made


Value = Callable[[Drive, Path], Any]
_OPTIONS: Mapping[str, Mapping[str, Value]] = {
    "sweep": {
        "pulley": lambda drive, _: driver_name(drive),
        "from_": lambda *_: "50 rad/s",
        "to": lambda *_: "60 rad/s",
        "duration": lambda *_: 0.003,
        "settling": lambda *_: 0.001,
    },
    "operating_map": {"speed": lambda *_: "500, 1000 rpm"},
    "traction": {"pulley": lambda drive, _: drive.pulleys[-1].name, "slip": lambda *_: "0, 0.2 %"},
    "duty": {"table": lambda _, folder: str(table_in(folder))},
    "life": {"table": lambda _, folder: str(table_in(folder))},
    "sheet": {"points": lambda *_: 2},
    "sensitivity": {"numbers": lambda *_: "belt.width"},
    "modes": {"count": lambda *_: 2},
    "campbell": {"speed": lambda *_: "500, 1000 rpm", "count": lambda *_: 2},
    "response": {"speed": lambda *_: "500, 1000 rpm"},
    "stroke": {"points": lambda *_: 2},
}
"""Options of analyses in a study."""

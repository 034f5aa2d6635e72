"""Results of every analysis on examples, made once, with all that reads them, and studies and goals of each."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import beltdyn as bd
from beltdyn.analyses import ANALYSES
from beltdyn.designs.named_results import names_of, variable_and_label
from beltdyn.errors import INTERNAL, ModelError
from beltdyn.model import Drive, ParameterStudy
from beltdyn.model.parameter_study import OptimizationStudy
from beltdyn.results import Result
from tools.campaign.analyses import WORKS, driver_name, table_in
from tools.campaign.crossing import CONSUMERS, pairs, with_gaps
from tools.campaign.trial import Outcome, attempt

Trial = tuple[str, Outcome]

LONGEST = 120.0
"""Processor time of an analysis or a consumer, s."""
_SHORT = 0.01
"""Duration of runs, s: too short for a mean of many drives."""
_GAPS = 2
"""Results with random gaps, of each result that has points."""
_GOALS = 3
"""Optimizations and sensitivities of each example, each for another result."""
_WATCHING = ("every figure", "report", "sheet", "export to csv")
"""Consumers of results with gaps, and of studies."""


def crossed(seed: int, names: Sequence[str], folder: Path) -> Iterator[Trial]:
    """All consumers with results of all analyses of examples, and with studies and goals of these."""
    made = list[Path]()
    for name in names:
        for analysis in WORKS:
            if analysis != "check":
                path = folder / f"{name}-{analysis.replace(' ', '-')}.nc"
                yield f"{analysis} of {name}", attempt(partial(_make, name, analysis, path), LONGEST)
                if path.exists():
                    made.append(path)
                    yield from consumed(path, folder, seed)
        yield from studied(name, folder, seed)
        yield from aimed(name, folder, seed)
    yield from paired(made, folder)


def consumed(path: Path, folder: Path, seed: int) -> Iterator[Trial]:
    """All consumers of a result file, and of the result with gaps."""
    for consumer in CONSUMERS:
        yield f"{consumer} of {path.stem}", attempt(partial(_consume, consumer, path, folder), LONGEST)
    for number in range(seed, seed + _GAPS):
        for consumer in _WATCHING:
            label = f"{consumer} of {path.stem} with gaps {number}"
            yield label, attempt(partial(_consume, consumer, path, folder, number), LONGEST)


def studied(name: str, folder: Path, seed: int) -> Iterator[Trial]:
    """A study of each analysis, of which one point fails, and what reads it."""
    for analysis in ANALYSES:
        path = folder / f"{name}-study-of-{analysis}.nc"
        yield f"study of {analysis} of {name}", attempt(partial(_study, name, analysis, path), LONGEST)
        if path.exists():
            for consumer in _WATCHING:
                yield f"{consumer} of {path.stem}", attempt(partial(_consume, consumer, path, folder), LONGEST)


def aimed(name: str, folder: Path, seed: int) -> Iterator[Trial]:
    """Optimizations and sensitivities for results of an example, in steady running and at rest."""
    drive, random = bd.example(name), Random(f"{name} {seed}")
    for at_rest in (False, True):
        variables = list(dict.fromkeys(variable_and_label(one)[0] for one in names_of(drive, at_rest=at_rest)))
        for variable in random.sample(variables, min(_GOALS, len(variables))):
            about = "rest" if at_rest else "steady"
            work = partial(bd.sensitivity, drive, of=variable, about=about, numbers="belt.width")
            yield f"sensitivity of {variable}, {about}, of {name}", attempt(partial(_quietly, work), LONGEST)
            if not at_rest:
                work = partial(_optimize, drive, variable)
                yield f"optimization of {variable} of {name}", attempt(partial(_quietly, work), LONGEST)


def paired(files: Sequence[Path], folder: Path) -> Iterator[Trial]:
    """Pairs of results: of a kind, of different drives where there are several, and of different kinds."""
    for one, other in zip(files, [*files[1:], *files[:1]], strict=True):
        for pair in ((one, one), (one, other)):
            label = f"{pair[0].stem} and {pair[1].stem}"
            yield label, attempt(partial(_pair, pair, folder), LONGEST)


def short(name: str) -> Drive:
    """An example with a run that ends soon."""
    drive = bd.example(name)
    return drive.replace(simulation=drive.simulation.replace(duration=min(_SHORT, drive.simulation.duration)))


def _make(name: str, analysis: str, path: Path) -> str:
    drive = short(name) if analysis == "simulate" else bd.example(name)
    found = WORKS[analysis](drive, _own_folder(path))
    assert isinstance(found, Result)
    found.save(path, overwrite=True)
    return ""


def _consume(consumer: str, path: Path, folder: Path, gaps: int | None = None) -> str:
    result = bd.open_result(path)
    if gaps is not None:
        gapped = with_gaps(result, gaps)
        if gapped is None:
            raise ModelError("a result without points has no gaps.")
        result = gapped
    return CONSUMERS[consumer](result, _own_folder(path))


def _study(name: str, analysis: str, path: Path) -> str:
    """A study of two widths, of which the second is too large for most drives, of all that the analysis gives."""
    drive = short(name)
    options = {key: value(drive, _own_folder(path)) for key, value in _OPTIONS.get(analysis, {}).items()}
    given = ParameterStudy(
        analysis=analysis, options=options, number=[{"path": "belt.width", "values": [drive.belt.width, 1e3]}]
    )
    result = bd.study(given, drive, jobs=1, output=path, overwrite=True)
    internal = [text for text in result.dataset["failure"].values if INTERNAL in str(text)]
    return str(internal[0]) if internal else gap_of_study(result)


def gap_of_study(result: Result) -> str:
    """The silent gap of a study: results without a value at any point, of which no warning speaks."""
    names = str(result.dataset.attrs["results"]).splitlines()
    unknown = [name for name in names if not np.isfinite(result.dataset[name].values).any()]
    failed = bool((result.dataset["failure"] != "").all())
    said = failed or not unknown or "no value" in " ".join(result.warnings)
    return "" if said else f"no value of {unknown[0]}, and no word"


def _optimize(drive: Drive, variable: str) -> Result:
    width = drive.belt.width
    study = OptimizationStudy(
        number=[{"path": "belt.width", "least": 0.8 * width, "largest": 1.2 * width}], goal={"result": variable}
    )
    return bd.optimize(drive, study=study, most=2)


def _pair(files: Sequence[Path], folder: Path) -> str:
    return pairs([bd.open_result(path) for path in files], _own_folder(files[0]))


def _quietly(work: Callable[[], object]) -> str:
    work()
    return ""


def _own_folder(path: Path) -> Path:
    """A folder beside a file for what a trial writes."""
    folder = path.with_suffix("")
    folder.mkdir(exist_ok=True)
    return folder


Value = Callable[[Drive, Path], Any]
_OPTIONS: Mapping[str, Mapping[str, Value]] = {
    "sweep": {
        "pulley": lambda drive, _: driver_name(drive),
        "from_": lambda *_: "50 rad/s",
        "to": lambda *_: "100 rad/s",
        "duration": lambda *_: 0.02,
        "settling": lambda *_: 0.01,
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

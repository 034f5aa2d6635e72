"""What a process does for a study: it analyses drives that differ in some numbers, one after another."""

import re
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version as version_of
from pathlib import Path
from threading import Lock
from typing import Any

from beltdyn.analyses import Analysis
from beltdyn.designs.processes import heeding, leaving, stopped, wait_for_the_end, working
from beltdyn.designs.study_columns import columns_of
from beltdyn.errors import SimulationError, cause_of
from beltdyn.model import Drive
from beltdyn.results import Result

_one_at_a_time = Lock()
"""A process of another engine may have several threads, which would share the memory of kernels."""


@dataclass(frozen=True)
class PointWork:
    """What is asked of every point."""

    drive: Drive
    analysis: Analysis
    options: Mapping[str, Any]
    results: tuple[str, ...]
    folder: Path | None
    """Where result files are kept; None if they are not."""
    version: str = field(default_factory=lambda: version_of("beltdyn"))
    """That of beltdyn where the study was started."""
    source: str = "drive"
    """The drive in Python, such as 'bd.load("drive.toml")'."""

    @cached_property
    def documented(self) -> frozenset[str]:
        """Variables that the docstring of the analysis names: some drives may have them, others not."""
        return frozenset(re.findall(r"``(\w+)``", self.analysis.function.__doc__ or ""))

    def call(self, changes: Mapping[str, Any]) -> str:
        """The study of a single point in Python, in one line."""
        numbers = [{"path": path, "values": [value]} for path, value in changes.items()]
        given = {
            "analysis": self.analysis.name,
            "options": {name: str(one) if isinstance(one, Path) else one for name, one in self.options.items()},
            "results": list(self.results),
        }
        keys = ", ".join(f"{key}={value!r}" for key, value in (given | {"number": numbers}).items())
        return f"bd.study(bd.ParameterStudy({keys}), {self.source}, jobs=1)"

    def file_of(self, point: int) -> Path:
        """The result file of a point, counted from zero."""
        return (self.folder or Path()) / f"{point + 1:06d}.nc"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a point."""

    point: int
    values: dict[str, float]
    failure: str
    """Why there are no values; empty where there are."""
    warnings: str
    """What makes them doubtful, one line each."""
    seconds: float
    """That it took."""
    missing: str = ""
    """Which requested results no point can have; see `Columns.unknown`."""


@dataclass(frozen=True, slots=True)
class ChunkOutcome:
    """What became of some points; those are left out that were not finished when the process was told to end."""

    outcomes: list[Outcome]
    units: dict[str, str]
    interrupted: bool = False


def compute_points(work: PointWork, points: Sequence[tuple[int, Mapping[str, Any]]]) -> ChunkOutcome:
    """Analyze drives."""
    wait_for_the_end()
    outcomes, units = list[Outcome](), dict[str, str]()
    with _one_at_a_time, working():
        for point, changes in points:
            if stopped() or leaving():
                return ChunkOutcome(outcomes, units, interrupted=True)
            try:
                outcomes.append(_outcome(work, point, changes, units))
            except KeyboardInterrupt:
                return ChunkOutcome(outcomes, units, interrupted=True)
    return ChunkOutcome(outcomes, units)


def _outcome(work: PointWork, point: int, changes: Mapping[str, Any], units: dict[str, str]) -> Outcome:
    """Analyze the drive of a point; units of results are added to those that are known."""
    begun = time.perf_counter()
    try:
        result = _analysed(work, point, changes)
        if result.status == "interrupted":
            raise KeyboardInterrupt
        columns = columns_of(result, work.results, work.options.keys(), work.documented)
        told = "\n".join([*result.warnings, *columns.absent])
    except Exception as error:
        return Outcome(point, {}, cause_of(error, work.call(changes)), "", time.perf_counter() - begun)
    units |= columns.units
    return Outcome(point, columns.values, "", told, time.perf_counter() - begun, columns.unknown)


def _analysed(work: PointWork, point: int, changes: Mapping[str, Any]) -> Result:
    """The result at a point, in memory or in a file."""
    if work.version != (own := version_of("beltdyn")):
        raise SimulationError(
            f"this worker has beltdyn {own}, but the study was started with {work.version}. Install the same version."
        )
    drive = work.drive.with_(changes)
    if work.folder is not None:
        result: Result = work.analysis.write(drive, work.file_of(point), heeding(), True, **work.options)
        return result
    taken = {"progress": heeding()} if work.analysis.tells else {}
    found: Result = work.analysis.function(drive, **taken, **work.options)
    return found

"""Parallel simulations on all cores, each into its own file."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from beltdyn.analyses import ANALYSES, SIMULATE, Analysis
from beltdyn.arrays import FloatArray
from beltdyn.designs.found_state import FoundState
from beltdyn.designs.named_results import unit_of
from beltdyn.designs.processes import SPAWN, Ending, LocalProcesses, Work, analyse, bare_workers, begin_batch
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.model.carrier import moved
from beltdyn.model.parameter_study import Obstacle, Order, Points
from beltdyn.model.path import Surroundings, distance_from_belt
from beltdyn.model.pulley import refuse_functions
from beltdyn.observation.compilation import usable_cores
from beltdyn.parts.kind_fields import refuse_kinds_of_scripts
from beltdyn.parts.quantity import RPM, numbers_in
from beltdyn.points.changed_drive import driver_of
from beltdyn.points.duty import Column, at_row, durations_of, duty_of, require_distinct_columns
from beltdyn.points.operating_points import at_point, load_factors
from beltdyn.results import Run
from beltdyn.solvers.run_progress import BatchProgress
from beltdyn.transient.beginning import compile_ahead, kind_of_kernels
from beltdyn.transient.sweep import without_schedules

# The operating points of a study: rows of a duty table, or places of a map


class OperatingPoint(NamedTuple):
    """An operating point of a study."""

    label: str
    """In words."""
    weight: float
    """Of its results in means; all sum up to 1."""
    of: Callable[[Drive], Drive]
    """A drive with constant speeds and torques -> the same at this point."""


def held(drive: Drive, points: Points) -> Drive:
    """The drive with speeds, torques and schedules as they are at the instant of a study."""
    return without_schedules(drive, drive.simulation.end if points.at is None else points.at)[0]


def study_points(drive: Drive, points: Points, base: Path, numbers: Sequence[str] = ()) -> list[OperatingPoint]:
    """The operating points of a study, none of which gives one of the numbers that vary, by their paths."""
    if points.table is not None:
        columns = duty_of(drive, base / points.table) or []
        require_distinct_columns(drive, columns, points.table, numbers)
        durations = durations_of(columns)
        return [
            OperatingPoint(f"row {row + 1}", weight, partial(at_row, columns=columns, row=row))
            for row, weight in enumerate((durations / durations.sum()).tolist())
        ]
    if points.speed is None and points.load is None:
        return [OperatingPoint("as the drive file says", 1.0, lambda one: one)]
    at_rest = held(drive, points)
    number = driver_of(at_rest) if points.pulley is None else drive.number_of(points.pulley)
    axes = dict[str, FloatArray]()
    if points.load is not None:
        axes["load"] = load_factors(points.load, points.load_count)
    if points.speed is not None:
        axes["speed"] = numbers_in("speed", points.speed, "rad/s", points.count)
        column = Column("speed", drive.pulleys[number].name, axes["speed"].tolist())
        require_distinct_columns(drive, [column], "[points]", numbers)
    places = [dict(zip(axes, map(float, place), strict=True)) for place in product(*axes.values())]
    return [
        OperatingPoint(_words(there), 1.0 / len(places), partial(at_point, pulley=number, there=there))
        for there in places
    ]


def _words(there: dict[str, float]) -> str:
    """An operating point in words."""
    told = {"speed": lambda value: f"{RPM * value:.4g} rpm", "load": lambda value: f"load {value:.3g}"}
    return ", ".join(told[name](there[name]) for name in ("speed", "load") if name in there)


def speed_of(drive: Drive, pulley: int) -> float:
    """Prescribed speed of a pulley at an operating point, rad/s; NaN without one."""
    speed = drive.pulleys[pulley].speed
    return np.nan if speed is None else abs(float(speed.at([0.0])[0]))


@dataclass(frozen=True)
class Watched:
    """A result that a study looks at."""

    name: str
    unit: str
    """SI unit; empty for a pure number."""
    read: Callable[[FoundState], float]
    at: FloatArray
    """1 at the operating points at which it counts, 0 at others."""


def named(name: str, drive: Drive, count: int) -> Watched:
    """A result of steady running."""
    return Watched(name, unit_of(name, drive), lambda state: state.value(name), np.ones(count))


def distance_from_order(order: Order, drive: Drive, points: Sequence[OperatingPoint]) -> Watched:
    """How far the nearest mode is from the band of frequencies of an order, over the end of the band that is near."""
    number = driver_of(drive) if order.pulley is None else drive.number_of(order.pulley)
    name = drive.pulleys[number].name
    speeds = np.array([speed_of(point.of(drive), number) for point in points])
    inside = (speeds >= order.least_speed * (1.0 - 1e-9)) & (speeds <= order.largest_speed * (1.0 + 1e-9))
    if not inside.any():
        raise ModelError(
            f"order {order.order:g} of {name} counts from {RPM * order.least_speed:g} to "
            f"{RPM * order.largest_speed:g} rpm, but no operating point prescribes a speed of {name} in this "
            "range. Add one under [points]."
        )
    low, high = (order.order * speed / (2.0 * np.pi) for speed in (order.least_speed, order.largest_speed))

    def read(state: FoundState) -> float:
        frequencies, kinds = state.modes_up_to((1.0 + order.distance) * high)
        counted = frequencies[[kind in order.kinds for kind in kinds]]
        return float(np.min(np.maximum(counted / high - 1.0, 1.0 - counted / low), initial=np.inf))

    return Watched(f"modes from order {order.order:g} of {name}", "", read, inside.astype(float))


def clearance(one: Obstacle, count: int) -> Watched:
    """Distance of a round part from the surface of the belt, with straight spans."""

    def read(state: FoundState) -> float:
        drive = state.drive
        positions = np.array([state.value(f"tensioner_position[{one.pulley}]") for one in drive.moving_tensioners])
        path, belt = moved(drive.path, prepare(drive).carriers, positions), drive.belt
        radii = np.array([pulley.radius for pulley in drive.pulleys])
        around = Surroundings(radii, belt.pitch_offset, belt.back_offset)
        return distance_from_belt(path, around, one.center, one.radius)

    return Watched(f"clearance of {one.name}", "m", read, np.ones(count))


_POLL_INTERVAL = 0.2
"""Longest wait for the end of a run, s: progress is reported at least this often."""


def simulate_all(
    drives: Mapping[Path, Drive] | Mapping[str, Drive],
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
    overwrite: bool = False,
    finish: Callable[[Run], None] | None = None,
) -> dict[Path, Ending]:
    """Simulate several drives in parallel, each in its own process; see `analyse_all`.

    Kernels are compiled once beforehand, unless they are on disk already.  A failed simulation does not affect the
    others.  Ctrl-C ends the running ones, which keep their results so far.  Processes do not import the caller's
    script, so it needs no ``if __name__ == "__main__"``.

    Parameters
    ----------
    drives : mapping
        Result file -> drive.
    progress : callable, optional
        Called at the start, and several times a second while simulations run.
    jobs : int, optional
        Number of parallel simulations; by default the number of cores.
    overwrite : bool
        Overwrite any regular files, not only earlier results.
    finish : callable, optional
        A function of a module, called with each completed run in its process; it may replace the file.

    Returns
    -------
    dict
        Result file -> `Ending` of its simulation, in the order of `drives`.
    """
    return analyse_all(ANALYSES[SIMULATE], drives, progress, jobs, overwrite, finish)


def analyse_all(
    analysis: Analysis,
    drives: Mapping[Path, Drive | Run] | Mapping[str, Drive | Run],
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
    overwrite: bool = False,
    finish: Callable[[Run], None] | None = None,
    **options: Any,
) -> dict[Path, Ending]:
    """Analyze several drives in parallel, each in its own process."""
    endings: dict[Path, Ending] = {}
    files = {Path(file): drive for file, drive in drives.items()}
    for file, drive in files.items():
        rule = f"{file.name} runs in another process, which a Python function cannot be passed to"
        given = _drive_of(drive)
        refuse_functions(given.pulleys, rule, "Call `simulate` or another analysis for this drive alone.")
        refuse_kinds_of_scripts(given.own_kinds)
    waiting, work = _longest_first(files), Work(analysis, options, overwrite, finish)
    going = True

    def tell(running: Mapping[Path, float], ended: int) -> None:
        if progress is not None:
            progress(BatchProgress(len(endings) + ended, len(files), running))

    tell({}, 0)
    if waiting:
        going = _compiled(_drive_of(waiting[0][1]))
    while waiting and going:
        found, going = _run_pool(waiting, min(jobs or usable_cores(), len(waiting)), tell, work)
        endings |= found
        waiting = [(file, drive) for file, drive in waiting if file not in endings]
    return {file: endings.get(file, Ending("not started")) for file in files}


def _drive_of(given: Drive | Run) -> Drive:
    return given.drive if isinstance(given, Run) else given


def _longest_first(drives: Mapping[Path, Drive | Run]) -> list[tuple[Path, Drive | Run]]:
    """Order drives so that no long run is left to the end: by number of contact points and simulated time.

    Before them comes one of each kind of kernels: processes compile several kinds then, and do not wait for one.
    """

    def size(item: tuple[Path, Drive | Run]) -> float:
        drive = _drive_of(item[1])
        return drive.elements * drive.contact.quadrature_points * drive.simulation.duration

    ordered = sorted(drives.items(), key=size, reverse=True)
    first = set({kind_of_kernels(_drive_of(drive)): file for file, drive in reversed(ordered)}.values())
    return sorted(ordered, key=lambda item: item[0] not in first)


def _compiled(drive: Drive) -> bool:
    """Compile the kernels; False after Ctrl-C."""
    try:
        compile_ahead(drive)
    except KeyboardInterrupt:
        return False
    return True


def _run_pool(
    drives: Sequence[tuple[Path, Drive | Run]],
    jobs: int,
    tell: Callable[[Mapping[Path, float], int], None],
    work: Work,
) -> tuple[dict[Path, Ending], bool]:
    """Simulate in a pool of processes; also whether to go on, False after Ctrl-C.

    If one of the processes is killed, what had not begun by then has no ending yet.
    """
    parts = SPAWN.RawArray("d", [math.nan] * len(drives))
    workers, going = LocalProcesses(jobs, begin_batch, (parts,)), True
    futures: list[Future[Ending]] = []
    try:
        with bare_workers():  # as a whole, so that Ctrl-C comes before or after
            futures += [workers.submit(analyse, place, *one, work) for place, one in enumerate(drives)]
        pending = set(futures)
        while pending:
            running = [place for place, future in enumerate(futures) if future in pending and parts[place] >= 0.0]
            tell({drives[place][0]: parts[place] for place in running}, len(drives) - len(pending))
            pending = wait(pending, timeout=_POLL_INTERVAL, return_when=FIRST_COMPLETED).not_done
        tell({}, len(drives))
    except KeyboardInterrupt:
        going = False
    finally:
        workers.close(stop=not going)
    lost = [workers.lost(future.exception()) for future in futures]
    begun = [part >= 0.0 for part in parts]
    endings = {
        file: _KILLED if gone else future.result()
        for (file, _), future, gone in zip(drives, futures, lost, strict=False)  # none before they were started
    }
    if any(begun) and any(lost):
        endings = {file: ending for (file, ending), it_began in zip(endings.items(), begun, strict=True) if it_began}
    return endings, going


_KILLED = Ending("failed", "its process or another one was killed, possibly because memory ran out. Run fewer at once.")

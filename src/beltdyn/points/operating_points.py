"""Steady running at many operating points: found one from the other, and written as they come."""

import re
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from functools import partial
from math import ceil
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError, ConvergenceError, InternalError, ModelError, classified
from beltdyn.model import Drive
from beltdyn.parts.options import ForceTolerance, RangeCount, takes_options
from beltdyn.parts.quantity import RPM, Numbers, numbers_in
from beltdyn.points.changed_drive import at_speed_under, driver_of, held_at, sense_of, with_load
from beltdyn.results import Result, Run, Variable, build_result
from beltdyn.results.atomic import locked_output, require_replaceable
from beltdyn.results.damage import VARIABLES as OF_FATIGUE
from beltdyn.results.damage import fatigue_by_name, known_variables
from beltdyn.results.dataset import is_result
from beltdyn.results.energy_balance import causes_of
from beltdyn.results.recorder import status_after
from beltdyn.results.schema import AXIS_NAMES, COORDINATES, RECORDED, SPAN_TENSIONS, runs_steadily
from beltdyn.results.summary import Means, means_of
from beltdyn.results.tooth_loads import ToothLoads, tooth_loads
from beltdyn.signals import closing, uninterrupted
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.state.steady import require_steady, steady_state

# What is known of an operating point, and how it follows from steady running

PULLEY, _SPAN, _TENSIONER = ("pulley",), ("span",), ("tensioner",)

VARIABLES = {
    "belt_speed": Variable((), "m/s", "Belt speed"),
    "power_in": Variable((), "W", "Power input"),
    "power_out": Variable((), "W", "Power output"),
    "efficiency": Variable((), "1", "Efficiency"),
    "largest_tension": Variable((), "N", "Largest tension"),
    "least_tension": Variable((), "N", "Least tension"),
    "least_slip_safety": Variable((), "1", "Least slip safety"),
    "least_safe_pulley": Variable((), "1", "Pulley with the least slip safety", "str"),
    "pulley_speed": Variable(PULLEY, "rad/s", "Pulley speed"),
    "shaft_torque": Variable(PULLEY, "N m", "Shaft torque"),
    "power": Variable(PULLEY, "W", "Power into the drive"),
    "pulley_slip": Variable(PULLEY, "1", "Slip"),
    "elastic_creep": Variable(PULLEY, "1", "Elastic creep"),
    "radial": Variable(PULLEY, "1", "Slip due to the sinking of the cord"),
    "bending": Variable(PULLEY, "1", "Slip due to bending"),
    "regularization": Variable(PULLEY, "1", "Slip due to the friction law slope"),
    "sliding": Variable(PULLEY, "1", "Gross slip"),
    "slip_safety": Variable(PULLEY, "1", "Slip safety: factor on all loads at gross slip"),
    "own_load_safety": Variable(PULLEY, "1", "Slip safety: factor on the pulley's own load at gross slip"),
    "tension_ratio": Variable(PULLEY, "1", "Tension ratio"),
    "allowed_tension_ratio": Variable(PULLEY, "1", "Tension ratio that friction allows"),
    "sliding_arc": Variable(PULLEY, "rad", "Sliding arc"),
    "wrap_angle": Variable(PULLEY, "rad", "Wrap angle"),
    "hub_load": Variable(PULLEY, "N", "Hub load"),
    "hub_force": Variable((*PULLEY, "axis"), "N", "Force of the belt on the pulley"),
    "rated_power": Variable(PULLEY, "W", "Rated power of the belt"),
    "utilization": Variable(PULLEY, "1", "Utilization: design power over rated power"),
    "teeth_in_mesh": Variable(PULLEY, "1", "Teeth in mesh"),
    "tooth_load": Variable(PULLEY, "N", "Largest tooth load"),
    "jump_margin": Variable(PULLEY, "1", "Margin to a jump: at 1 teeth lift"),
    **{name: Variable(_SPAN, "N", RECORDED[name].long_name) for name in SPAN_TENSIONS},
    "tensioner_position": Variable(_TENSIONER, "m or rad", "Tensioner position"),
    "tensioner_position_after_tensioning": Variable(
        _TENSIONER, "m or rad", "Position, held by dry friction after tensioning"
    ),
    "tensioner_position_after_yielding": Variable(
        _TENSIONER, "m or rad", "Position, held by dry friction after yielding"
    ),
    "loss": Variable(("cause",), "W", "Power loss"),
    "mesh_error": Variable((), "1", "Mesh error"),
    **OF_FATIGUE,
    "failure": Variable((), "1", "Why the operating point failed", "str"),
}
"""What is known of an operating point; dimensions of the table come first."""

_USUAL = [name for name in VARIABLES if name not in OF_FATIGUE]

_OF_PULLEYS = {
    "pulley_speed": "speed",
    "shaft_torque": "shaft_torque",
    "power": "power",
    "pulley_slip": "slip",
    "elastic_creep": "elastic_creep",
    "radial": "radial",
    "bending": "bending",
    "regularization": "regularization",
    "sliding": "sliding",
    "slip_safety": "slip_safety",
    "own_load_safety": "own_load_safety",
    "tension_ratio": "tension_ratio",
    "allowed_tension_ratio": "allowed_tension_ratio",
    "sliding_arc": "sliding_arc",
    "wrap_angle": "wrap_angle",
    "hub_load": "hub_load",
    "rated_power": "rated_power",
    "utilization": "utilization",
}
"""Variable -> attribute of a `PulleySummary`."""

_OF_SPANS = ("tension", "highest", "lowest", "at_start", "at_end")
"""Attributes of a `SpanSummary` in the order of `SPAN_TENSIONS`."""

_OF_TEETH = {"teeth_in_mesh": "in_mesh", "tooth_load": "largest", "jump_margin": "jump_margin"}
"""Variable -> attribute of `ToothLoads`."""

_COSTLY = (OF_FATIGUE.keys(), _OF_TEETH.keys(), {"mesh_error"})
"""Variables that are computed together, where one of them is asked for."""

_OF_RATING = ("rated_power", "utilization")
_CORDS = "[belt.cord_fatigue] with its source, or a profile that has it, such as SPZ"
_RIBS = "[belt.rib_fatigue] with its source, or a profile that has it, such as PK"
DATA = {name: _CORDS if name.startswith("cord") else _RIBS for name in OF_FATIGUE}
DATA["rib_life"] = "passages in [belt.rib_fatigue], the life in the reference condition, with their source"
DATA |= dict.fromkeys(_OF_TEETH, "the profile of a toothed belt, such as HTD 8M")
DATA |= dict.fromkeys(_OF_RATING, "a profile with a power rating, such as SPZ or PK")
"""What a belt must have for results that not all drives have, by their names."""


def _causes(drive: Drive) -> list[str]:
    """Causes of losses in steady running, which takes no steps."""
    causes = causes_of(toothed=drive.belt.teeth is not None)
    return [cause for name, cause in causes.items() if name != "numerical_loss"]


def labels_of(drive: Drive) -> dict[str, list[str]]:
    """Labels along the dimensions of `VARIABLES`."""
    return {
        "pulley": [one.name for one in drive.pulleys],
        "span": ["-".join(names) for names in drive.spans],
        "tensioner": [one.pulley for one in drive.moving_tensioners],
        "cause": _causes(drive),
        "axis": list(AXIS_NAMES),
    }


def variables_of(drive: Drive) -> dict[str, Variable]:
    """Those of `VARIABLES` for which a drive has data: of rating, fatigue and teeth not without those of the belt."""
    unknown = OF_FATIGUE.keys() - known_variables(drive)
    unknown |= {*(_OF_RATING if drive.rated_belt is None else ()), *(() if drive.belt.teeth else _OF_TEETH)}
    return {name: one for name, one in VARIABLES.items() if name not in unknown}


def variables_in(run: Run) -> dict[str, Variable]:
    """Those of `VARIABLES` that a run has: of fatigue in steady running alone, where an hour is like any other."""
    steadily = runs_steadily(run.dataset)
    return {name: one for name, one in variables_of(run.drive).items() if steadily or name not in OF_FATIGUE}


def computed_with(name: str) -> Collection[str]:
    """The variables that come with one at no further cost, itself among them."""
    return next((group for group in _COSTLY if name in group), VARIABLES.keys() - set().union(*_COSTLY))


def values_by_name(run: Run, means: Means, names: Collection[str]) -> dict[str, Any]:
    """The values of an operating point by the names of `VARIABLES`; of fatigue, teeth and mesh where some need them."""
    balance, dataset = means.balance, run.dataset
    known = variables_of(run.drive)
    values: dict[str, Any] = {
        name: [getattr(one, attribute) for one in means.pulleys]
        for name, attribute in _OF_PULLEYS.items()
        if name in known
    }
    values |= {
        "hub_force": dataset["hub_force"].values[-1],
        **{
            name: [getattr(one, attribute) for one in means.spans]
            for name, attribute in zip(SPAN_TENSIONS, _OF_SPANS, strict=True)
        },
        "belt_speed": np.mean([abs(one.belt_speed) for one in means.spans]),
        "largest_tension": np.fmax.reduce([one.highest for one in means.spans]),
        "least_tension": np.fmin.reduce([one.lowest for one in means.spans]),
        "power_in": balance.power_in,
        "power_out": balance.power_out,
        "efficiency": balance.efficiency,
        "loss": [balance.losses[cause] for cause in _causes(run.drive)],
    }
    if run.drive.belt.teeth and not _OF_TEETH.keys().isdisjoint(names):
        values |= _tooth_values(tooth_loads(run), [one.name for one in means.pulleys])
    safeties = np.array([one.least_safety for one in means.pulleys])
    if np.any(np.isfinite(safeties)):
        least = int(np.nanargmin(safeties))
        values |= {"least_slip_safety": safeties[least], "least_safe_pulley": means.pulleys[least].name}
    if means.tensioners:
        values["tensioner_position"] = stands = [one.position for one in means.tensioners]
        for name in ("tensioner_position_after_tensioning", "tensioner_position_after_yielding"):
            values[name] = dataset.attrs.get(name, stands)
    if "mesh_error" in names:
        values["mesh_error"] = run.resolution.errors["peak pressure"]
    return values if OF_FATIGUE.keys().isdisjoint(names) else values | fatigue_by_name(run)


def _tooth_values(loads: Sequence[ToothLoads], pulleys: Sequence[str]) -> dict[str, list[float]]:
    """What is known of the teeth on each pulley; NaN of pulleys without teeth."""
    found = {one.name: one for one in loads}
    return {
        name: [getattr(found[pulley], attribute) if pulley in found else np.nan for pulley in pulleys]
        for name, attribute in _OF_TEETH.items()
    }


Axes = Mapping[str, tuple[Variable, ArrayLike]]
"""Dimension -> what labels it, and its labels."""

_OFTEN = 1.0
"""Time between two writings of the file, s."""
_SHORTEST_PART = 1.0 / 16.0
"""Smallest step between two points in the search for the second."""


class OperatingPoints:
    """Operating points in a table, in a file if one is named; an interruption keeps what was found.

    A point that has no steady running is marked by its reason, and so is one at which anything else goes wrong; the
    others go on.
    """

    def __init__(
        self,
        kind: str,
        drive: Drive,
        axes: Axes,
        output: Path | str | None = None,
        progress: Report | None = None,
        overwrite: bool = False,
        *,
        names: Collection[str] = _USUAL,
    ) -> None:
        self._kind, self._drive, self._axes = kind, drive, axes
        require_steady(drive)
        self._path, self._overwrite = Path(output) if output is not None else None, overwrite
        if self._path is not None:
            require_replaceable(self._path, is_result, overwrite)
        self._progress = progress
        self._sizes = labels_of(drive)
        self.shape = tuple(len(np.atleast_1d(labels)) for _, labels in axes.values())
        kept = {name: one for name, one in variables_of(drive).items() if name in names and self._holds(one)}
        self.arrays = {name: self._blank(variable) for name, variable in kept.items()}
        self._held = ExitStack()
        self._warned: dict[str, list[tuple[float, str, str]]] = {}
        self._done, self._written, self._status = 0, time.perf_counter(), "running"
        self._near: Run | None = None
        self._near_at: Sequence[float] = ()
        self._run: Run | None = None
        self._error: BeltdynError | None = None
        """What went wrong first."""
        self.more: Axes = {}
        """Further coordinates."""
        self.derive: Callable[[Mapping[str, NDArray[Any]]], Axes] = lambda arrays: {}
        """Gives variables that an analysis adds, from the arrays of the table."""
        self.attributes: dict[str, str] = {}
        """Global attributes that it adds."""
        self.notes = list[str]()
        """Warnings that it adds."""
        self.expected = frozenset[str]()
        """Checks whose findings belong to what it looks for, and are no warnings."""

    def __enter__(self) -> Self:
        """Begin."""
        with ExitStack() as held:
            if self._path is not None:
                held.enter_context(locked_output(self._path))
            self._tell()
            self._held = held.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        """Close the table with its status."""
        self._status = status_after(kind)
        with closing(), self._held:
            self._save()
        return self._status == "interrupted"

    @property
    def found(self) -> bool:
        """Whether there is a point with steady running."""
        return self._near is not None

    @property
    def near(self) -> Run | None:
        """The operating point that was found last."""
        return self._near

    def each(
        self,
        at: Callable[..., Drive],
        force_tolerance: float | None,
        *,
        order: Iterable[tuple[int, ...]] | None = None,
        then: Callable[[tuple[int, ...], Run | None], None] | None = None,
        found_then: str = "further results",
        stride: float | None = None,
    ) -> None:
        """Find the operating points one after the other, each from the one before.

        Whatever goes wrong at a point is noted there, and the others are found all the same.
        """
        for index in np.ndindex(self.shape) if order is None else order:
            self._find(index, at, force_tolerance, stride)
            if then is not None:
                self._take_more(index, then, found_then)
            self._done += 1
            self._tell()
            if time.perf_counter() - self._written > _OFTEN:
                self._save()

    def _find(
        self, index: tuple[int, ...], at: Callable[..., Drive], force_tolerance: float | None, stride: float | None
    ) -> None:
        """Find an operating point, or note why there is none."""
        self._run = None
        there = [np.atleast_1d(labels)[k].item() for k, (_, labels) in zip(index, self._axes.values(), strict=True)]
        try:
            found = partial(self._search, at, force_tolerance)
            run = found(there) if stride is None else self._reach(found, np.array(there), stride)
            self._take(index, run, means_of(run))
        except Exception as error:
            self._fail(index, "no operating point", error)
        else:
            self._run = self._near = run
            self._near_at = there

    def _search(self, at: Callable[..., Drive], force_tolerance: float | None, there: Sequence[float]) -> Run:
        """Steady running from the point that was found last."""
        return steady_state(at(*there), force_tolerance=force_tolerance, start=self._near)

    def _reach(self, found: Callable[[Sequence[float]], Run], there: FloatArray, stride: float) -> Run:
        """Steady running, by strides, and by parts of the last one where it is not found at once."""
        if self._near is None:
            return found(there.tolist())
        begin = np.array(self._near_at)
        way = float(np.max(np.abs(there - begin)))
        for number in range(1, ceil(way / stride)):
            self._pass_by(found, begin + number * stride / way * (there - begin))
        try:
            return found(there.tolist())
        except ConvergenceError:
            begin, done, part = np.array(self._near_at), 0.0, 0.5
            while part >= _SHORTEST_PART:
                ahead = min(done + part, 1.0)
                if ahead == 1.0:
                    with suppress(ConvergenceError):
                        return found(there.tolist())
                    part *= 0.5
                elif self._pass_by(found, begin + ahead * (there - begin)):
                    done = ahead
                else:
                    part *= 0.5
            raise

    def _pass_by(self, found: Callable[[Sequence[float]], Run], there: FloatArray) -> bool:
        """Look for an operating point on the way to another one, without noting it."""
        with suppress(ConvergenceError):
            self._near, self._near_at = found(there.tolist()), there.tolist()
            return True
        return False

    def _take_more(
        self, index: tuple[int, ...], then: Callable[[tuple[int, ...], Run | None], None], found_then: str
    ) -> None:
        """Have more found about a point, or note why it is not."""
        try:
            then(index, self._run)
        except Exception as error:
            self._fail(index, f"no {found_then}", error)

    def _fail(self, index: tuple[int, ...], what: str, error: Exception) -> None:
        """Mark a point by the reason why something is not found there, and warn of it."""
        told = classified(error, f"{self._kind} at {self._place(index)}")
        self._error, reason = self._error or told, str(told)
        self.arrays["failure"][index] = reason
        text = f"{what}: {reason}"
        self._warn(index, re.sub(r"[\d.,e+\-−–%]+", "#", text), text)

    def result(self) -> Result:
        """The table as it is now."""
        if self._error and not self.found and self._status != "interrupted":
            if isinstance(self._error, InternalError):
                raise self._error
            kind = ModelError if isinstance(self._error, ModelError) else ConvergenceError
            points = f"no steady running at any of {self._done} points. The first one: " if self._done > 1 else ""
            raise kind(points + str(self._error)) from self._error
        kept = {name: (self._labelled(VARIABLES[name]), values) for name, values in self.arrays.items()}
        coordinates = {**self._axes, **self.more, **self._named()}
        variables = {**kept, **self._extremes(), **self.derive(self.arrays)}
        result = build_result(self._kind, self._drive, variables, coordinates, [*self._warnings(), *self.notes])
        result.dataset.attrs |= {"status": self._status, "axes": " ".join(self._axes), "points": self._done}
        result.dataset.attrs |= self.attributes
        return result

    def _named(self) -> dict[str, tuple[Variable, ArrayLike]]:
        """Names along the dimensions of variables."""
        known = {name: COORDINATES[name].long_name if name in COORDINATES else "Cause" for name in self._sizes}
        return {
            name: (Variable((name,), "1", known[name], "str"), labels) for name, labels in self._sizes.items() if labels
        }

    def _extremes(self) -> dict[str, tuple[Variable, ArrayLike]]:
        """The worst value of each pulley over all points; a belt always slips over guides that stand still."""
        over = tuple(range(len(self.shape)))
        arrays = {
            name: np.where(self._drive.guides & (name == "pulley_slip"), np.nan, values)
            for name, values in self.arrays.items()
            if name in ("pulley_slip", "slip_safety", "hub_load", "tooth_load", "jump_margin")
        }
        found = {
            "largest_slip": (Variable(PULLEY, "1", "Largest slip"), np.fmax.reduce, "pulley_slip"),
            "smallest_safety": (Variable(PULLEY, "1", "Least slip safety"), np.fmin.reduce, "slip_safety"),
            "largest_hub_load": (Variable(PULLEY, "N", "Largest hub load"), np.fmax.reduce, "hub_load"),
            "largest_tooth_load": (Variable(PULLEY, "N", "Largest tooth load"), np.fmax.reduce, "tooth_load"),
            "least_jump_margin": (Variable(PULLEY, "1", "Least margin to a jump"), np.fmin.reduce, "jump_margin"),
        }
        return {
            name: (variable, worst(arrays[of], over)) for name, (variable, worst, of) in found.items() if of in arrays
        }

    def _holds(self, variable: Variable) -> bool:
        """Whether the drive has what a variable is of."""
        return all(self._sizes[name] for name in variable.dims)

    def _labelled(self, variable: Variable) -> Variable:
        """A variable with the table's dimensions first, and the unit of the tensioners of the drive."""
        turning = {one.turns for one in self._drive.moving_tensioners}
        units = variable.units
        if units == "m or rad" and len(turning) == 1:
            units = "rad" if turning.pop() else "m"
        return Variable((*self._axes, *variable.dims), units, variable.long_name, variable.dtype)

    def _blank(self, variable: Variable) -> NDArray[Any]:
        shape = (*self.shape, *(len(self._sizes[name]) for name in variable.dims))
        return np.full(shape, "", dtype=object) if variable.dtype == "str" else np.full(shape, np.nan)

    def _take(self, index: tuple[int, ...], run: Run, means: Means) -> None:
        """Note an operating point."""
        values, findings = values_by_name(run, means, self.arrays), run.findings
        for name in self.arrays.keys() & values.keys():
            self.arrays[name][index] = values[name]
        for finding in findings:
            if finding.kind not in self.expected:
                self._warn(index, finding.kind, str(finding), finding.weight)

    def _warn(self, index: tuple[int, ...], kind: str, text: str, weight: float = 0.0) -> None:
        """Note a warning of a point, beside those of the same kind of other points."""
        self._warned.setdefault(kind, []).append((weight, self._place(index), text))

    def _warnings(self) -> Iterator[str]:
        """The warnings of points, each but once: that of the worst point, or else of the first one."""
        for said in self._warned.values():
            weight, place, text = max(said, key=lambda one: one[0])
            first, last, others = said[0][1], said[-1][1], len(said) - 1
            if not others:
                yield f"at {place}: {text}"
            elif weight > 0.0:
                yield f"at {place}: {text} This is the worst of {others + 1} points, from {first} to {last}."
            else:
                yield f"at {place}: {text} The same applies at {others} more point{'s'[: others != 1]}, up to {last}."

    def _place(self, index: tuple[int, ...]) -> str:
        """Where a point is, in words."""
        return ", ".join(
            f"{name} {_written(np.atleast_1d(labels)[number], variable.units)}"
            for number, (name, (variable, labels)) in zip(index, self._axes.items(), strict=True)
        )

    def _tell(self) -> None:
        if self._progress is not None:
            self._progress(Progress(self._done, float(np.prod(self.shape)), 0.0, self._done, "operating points"))

    def _save(self) -> None:
        """Write the file, if one is named and there is something to keep."""
        if self._path is not None and self.found:
            with uninterrupted():
                self.result().save(self._path, self._overwrite)
        self._written = time.perf_counter()


def _written(value: Any, units: str) -> str:
    """A label of an axis as a user would write it."""
    if units == "rad/s":
        return f"{RPM * value:.4g} rpm"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def serpentine(shape: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Places of a table so that each is next to the one before: every other row backwards."""
    if not shape:
        yield ()
        return
    inner = list(serpentine(shape[1:]))
    for number in range(shape[0]):
        yield from ((number, *rest) for rest in inner[:: 1 if number % 2 == 0 else -1])


@takes_options
def operating_map(
    drive: Drive,
    *,
    pulley: str | None = None,
    speed: Numbers | None = None,
    load: Numbers | None = None,
    points: RangeCount = 40,
    load_points: RangeCount = 10,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute operating points over speed, load, or both: tensions, slip, hub loads, efficiency.

    Each point is steady running as of `steady_state`, found from the previous point. Loads are those of the drive file
    at one instant; speed-dependent loads follow the speed. Points without steady running are marked as failed.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The pulley whose speed is prescribed, in place of its motor; by default the driver.
    speed
        Its speeds: a range such as "700..6000 rpm", a list "700, 1500, 3000 rpm", or an array in rad/s; positive in
        its sense of rotation. By default those of the drive file.
    load
        Factors on all torques and loads except motors, and on goods: a range such as "0.2..1.2", a list, or an array.
    points
        Number of speeds of a range.
    load_points
        Number of factors of a range.
    at
        Instant at which loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
        simulation.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    output
        Result file (NetCDF4), updated point by point; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Result
        Variables along ``speed`` (rad/s, of the pulley in the attribute ``pulley``), ``load``, or both.

    Raises
    ------
    ModelError
        If neither speed nor load is given, a range is invalid, or the drive cannot run steadily.
    ConvergenceError
        If no point has steady running.

    Examples
    --------
    >>> found = bd.operating_map(drive, speed="60..120 rpm", points=3)
    >>> found.dataset.efficiency.dims
    ('speed',)
    """
    if speed is None and load is None:
        raise ModelError('a map needs speed, load or both. Give speed = "700..6000 rpm", or load = "0.2..1.2".')
    held = held_at(drive, at)
    number = driver_of(held) if pulley is None else held.number_of(pulley)
    name = held.pulleys[number].name
    axes = dict[str, tuple[Variable, FloatArray]]()
    if speed is not None:
        axes["speed"] = Variable(("speed",), "rad/s", f"Speed of {name}"), numbers_in("speed", speed, "rad/s", points)
    if load is not None:
        axes["load"] = Variable(("load",), "1", "Load"), load_factors(load, load_points)
    with OperatingPoints("operating_map", held, axes, output, progress, overwrite) as table:
        table.attributes = {"drive_as_given": drive.text, "pulley": name}

        def drive_at(*values: float) -> Drive:
            return at_point(held, number, dict(zip(axes, values, strict=True)))

        table.each(drive_at, force_tolerance, order=serpentine(table.shape))
    return table.result()


def at_point(held: Drive, pulley: int, there: Mapping[str, float]) -> Drive:
    """The drive at an operating point of a map."""
    factor = there.get("load", 1.0)
    if "speed" not in there:
        return with_load(held, factor)
    return at_speed_under(held, pulley, sense_of(held, pulley) * there["speed"], factor)


def load_factors(load: Numbers, count: int) -> FloatArray:
    """Factors on loads."""
    factors = numbers_in("load", load, "", count)
    if factors[0] < 0.0:
        raise ModelError(
            f"load = {load!r} contains a negative factor, with which loads would drive. Start at zero or above."
        )
    return factors

"""Traction curve of one pulley: slip over torque beyond gross slip; tooth loads over torque up to the jump."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError, ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.model.pulley import flat_friction_on
from beltdyn.parts.options import ForceTolerance, RangeCount, takes_options
from beltdyn.parts.quantity import Numbers, numbers_in
from beltdyn.points.changed_drive import (
    at_speed,
    driver_of,
    held_at,
    require_belt,
    sense_of,
    under_torque,
    with_pulley,
)
from beltdyn.points.operating_points import Axes, OperatingPoints
from beltdyn.results import Result, Run, Variable, summarize
from beltdyn.results.checks.creep import gross_slip, near_gross_slip
from beltdyn.results.checks.machines import lifted_teeth, overloaded_teeth
from beltdyn.solvers.run_progress import Report
from beltdyn.state.staying import require_passing
from beltdyn.state.steady import steady_state
from beltdyn.system.meshing import TOOTH_PHASES

_FIRST_SLIP, _LARGEST_SLIP = 5e-4, 0.6
"""First and largest slip of the search for gross slip."""
_MIN_SLIP = 1e-5
"""Slip below which a drive that has no steady running with slip has none at all."""
_TRIAL_RATIO = 2.0
"""Ratio of successive trial slips or torques as long as no limit is known; bisection follows."""
_SLIP_TOLERANCE = 0.02
"""Relative error of the slip, or torque, at which the search ends."""
_SEARCH_TOLERANCE = 0.05
"""Error of contact forces during the search for gross slip, relative; the curve has a tolerance of its own."""
_CURVE_END = 1.2
"""Slip up to which a curve goes, over gross slip."""
_STRIDE = 0.02
"""Slip from one operating point to the next, at most."""
_FRICTION_RATIO = 1.002
"""Friction of the driver over its own, where its whole arc is about to slide together with that of the pulley."""
_SLIDING_SHARE = 0.7
"""Part of both arcs that slides then."""
_MIN_POINTS = 3
"""Least number of points of a curve: its two ends, and one between that shows a curvature."""
_WHOLE_ARC_SHARE = 0.99
"""Part of an arc that slides as a whole."""

_EXPECTED = frozenset({gross_slip.__name__, near_gross_slip.__name__, lifted_teeth.__name__, overloaded_teeth.__name__})
"""Findings that a traction curve leads to."""

_VARIABLES = {
    "torque": Variable(("slip",), "N m", "Torque"),
    "elastic": Variable(("slip",), "1", "Elastic creep"),
    "added": Variable(("slip",), "1", "Added by sinking, bending and the friction law"),
    "slid": Variable(("slip",), "1", "Sliding of whole arcs"),
    "sliding_share": Variable(("slip",), "1", "Sliding share of the arc"),
    "capstan_torque": Variable(("slip",), "N m", "Capstan limit (Euler)"),
    "limit_torque": Variable((), "N m", "Largest torque"),
    "wind_up": Variable(("torque",), "rad", "Wind-up against the driver, from the first point"),
}


class _Curve(NamedTuple):
    """The points of a curve: along which axis, how drives follow, and what is derived."""

    axis: str
    label: Variable
    values: FloatArray
    drive_at: Callable[[float, Run | None], Drive]
    """The drive at a value of the axis, from the operating point before."""
    stride: float | None
    derive: Callable[[Mapping[str, NDArray[Any]]], Axes]
    then: Callable[[tuple[int, ...], Run | None], None] | None = None


@takes_options
def traction(
    drive: Drive,
    *,
    pulley: str | None = None,
    slip: Numbers | None = None,
    torque: Numbers | None = None,
    points: Annotated[RangeCount, Field(ge=_MIN_POINTS)] = 30,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute the traction curve of a pulley: its slip over its torque, or its tooth loads up to the jump.

    *Pulleys without teeth*: the slip of the rim relative to that of the driver is prescribed, and the torque follows;
    beyond gross slip it stays constant. If both whole arcs would slide at once, the belt speed would be undetermined,
    so the friction of the driver is raised by 0.2 %. The result also holds the elastic creep under Coulomb friction,
    the slip added by the slope of the friction law, and the torque by Euler's formula with the tensions of each point.

    *Pulleys with teeth*: the torque is prescribed. The result holds tooth loads, teeth in mesh and margins to a jump of
    all pulleys, the wind-up of the pulley against the driver, and the largest torque that the belt holds without a jump
    (within 2 %).

    Other pulleys keep their loads. A hub chain of the pulley is ignored.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The pulley; by default the only loaded one.
    slip
        Slips of a pulley without teeth: a range such as "0..20 %", a list, or an array. By default from zero to a fifth
        beyond gross slip.
    torque
        Torques that a pulley with teeth takes: a range such as "0..40 N m", a list, or an array in N m. By default from
        zero to the jump.
    points
        Number of slips or torques of a range.
    at
        Instant at which speeds, loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
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
        Variables along ``slip``, or ``torque`` (N m) of a pulley with teeth; the attribute ``pulley`` names the pulley.

    Raises
    ------
    ModelError
        If there is no such pulley, it is the driver, the drive cannot run steadily, or slips are given for teeth.
    ConvergenceError
        If no point has steady running.

    Examples
    --------
    >>> found = bd.traction(drive, slip="0..0.2 %", points=3)
    >>> found.dataset.torque.dims
    ('slip',)
    """
    require_belt(drive, "a traction curve", "`beltdyn operating-map` over load, which has the slip safety of rollers")
    require_passing(drive)
    held = _driven_by_speed(held_at(drive, at), force_tolerance)
    driver = driver_of(held)
    number = _loaded(held, driver) if pulley is None else held.number_of(pulley)
    one = held.pulleys[number]
    if number == driver:
        raise ModelError(
            f"pulley = {one.name!r} is the driver, which is the reference of slip. Choose a driven pulley."
        )
    if one.teeth and slip is not None:
        raise ModelError(
            f"{one.name} holds the belt by its teeth, so that it does not slip: slip cannot be given. Give torque, or "
            "omit both."
        )
    if torque is not None and not one.teeth:
        raise ModelError(
            f"{one.name} has no teeth: its torque follows from its slip and stays the same beyond gross slip. Give "
            "slip, or omit both."
        )
    held = held.replace(pulley=[*held.pulleys[driver:], *held.pulleys[:driver]])  # slip is against the first
    number = (number - driver) % len(held.pulleys)
    if one.hub:
        held = held.replace(pulley=[other.replace(hub=()) if other is one else other for other in held.pulleys])
    rim = held.pulleys[0].driven_speed() * sense_of(held, 0) * held.rolling_radii[0] * held.pulleys[0].turning
    fastest = rim / (held.rolling_radii[number] * one.turning)
    if one.teeth:
        curve = _of_teeth(held, number, fastest, torque, points, force_tolerance)
    else:
        curve = _of_slip(held, number, fastest, slip, points)
    axes = {curve.axis: (curve.label, curve.values)}
    with OperatingPoints("traction", curve.drive_at(0.0, None), axes, output, progress, overwrite) as table:
        table.derive = curve.derive
        table.expected = _EXPECTED
        table.attributes = {"drive_as_given": drive.text, "pulley": one.name}
        table.each(
            lambda value: curve.drive_at(value, table.near), force_tolerance, stride=curve.stride, then=curve.then
        )
    return table.result()


def _of_slip(held: Drive, number: int, fastest: float, slip: Numbers | None, points: int) -> _Curve:
    """The curve of a pulley whose slip is prescribed; fastest is its speed without slip."""

    def slipping(part: float, firmer: float = 1.0) -> Drive:
        first = held.pulleys[0]
        friction = firmer * flat_friction_on(first, held.belt, held.contact)
        firm = held if firmer == 1.0 else with_pulley(held, 0, first.replace(friction=friction))
        return at_speed(firm, number, (1.0 - part) * fastest)

    slips = _past_gross_slip(slipping, number, points) if slip is None else numbers_in("slip", slip, "", points)
    return _Curve(
        "slip",
        Variable(("slip",), "1", f"Slip of {held.pulleys[number].name}"),
        slips,
        lambda part, near: slipping(part, _firmness(near, number)),
        _STRIDE,
        partial(_over_slip, number=number, sense=float(np.sign(fastest))),
    )


def _of_teeth(
    held: Drive, number: int, fastest: float, torque: Numbers | None, points: int, force_tolerance: float | None
) -> _Curve:
    """The curve of a pulley with teeth, whose torque is prescribed."""
    one, sense = held.pulleys[number], float(np.sign(fastest))

    def loaded(taken: float, _near: Run | None = None) -> Drive:
        return with_pulley(held, number, under_torque(one, -sense * taken))

    if torque is None:
        torques = np.linspace(0.0, _jump_torque(loaded, number, force_tolerance), points)
    else:
        torques = numbers_in("torque", torque, "N m", points)
    wind_up = np.full(torques.size, np.nan)

    def take(index: tuple[int, ...], run: Run | None) -> None:
        if run is not None:
            wind_up[index] = -sense * _ahead(run, number)

    return _Curve(
        "torque",
        Variable(("torque",), "N m", f"Torque on {one.name}"),
        torques,
        loaded,
        None,
        partial(_over_torque, torques=torques, wind_up=wind_up),
        take,
    )


def _driven_by_speed(drive: Drive, force_tolerance: float | None) -> Drive:
    """The drive with a driver that has a speed in place of its motor: that of steady running."""
    driver = driver_of(drive)
    if drive.pulleys[driver].prescribed:
        return drive
    run = steady_state(drive, force_tolerance=force_tolerance)
    return at_speed(drive, driver, drive.positive_sense * float(run.dataset["shaft_speed"][-1, driver]))


def _loaded(drive: Drive, driver: int) -> int:
    """Number of the only pulley beside the driver, and guides that stand still, that has a torque or loads."""
    taking = [number for number, one in enumerate(drive.pulleys) if number != driver and (one.load or one.torque)]
    others = [number for number, stands in enumerate(drive.guides) if number != driver and not stands]
    found = taking if taking or others[1:] else others
    if len(found) != 1:
        names = ", ".join(drive.pulleys[number].name for number in found or others)
        raise ModelError(f"a traction curve describes one pulley; there are {names}. Choose one with pulley.")
    return found[0]


def _sliding(run: Run, number: int) -> tuple[float, float]:
    """Parts of the arcs of the driver and of a pulley that slide."""
    pulleys = summarize(run).pulleys
    first, other = (one.sliding_arc / one.wrap_angle for one in (pulleys[0], pulleys[number]))
    return first, other


def _firmness(near: Run | None, number: int) -> float:
    """Friction of the driver, over its own, next to an operating point."""
    return _FRICTION_RATIO if near is not None and min(_sliding(near, number)) > _SLIDING_SHARE else 1.0


def _past_gross_slip(slipping: Callable[[float, float], Drive], number: int, points: int) -> FloatArray:
    """Slips from zero to some way beyond where the whole arc of the pulley slides, or that of the driver."""
    creeping, sliding, run = 0.0, _LARGEST_SLIP, None
    while sliding - creeping > _SLIP_TOLERANCE * sliding:
        part = min(_TRIAL_RATIO * creeping or _FIRST_SLIP, 0.5 * (creeping + sliding))
        try:
            found = steady_state(slipping(part, _FRICTION_RATIO), force_tolerance=_SEARCH_TOLERANCE, start=run)
        except BeltdynError as error:
            if part < _MIN_SLIP:
                raise ConvergenceError(f"no steady running found at any slip: {error}") from error
            sliding = part
            continue
        if max(_sliding(found, number)) > _WHOLE_ARC_SHARE:
            sliding = part
        else:
            creeping, run = part, found
    return np.linspace(0.0, _CURVE_END * sliding, points)


def _over_slip(arrays: Mapping[str, NDArray[Any]], number: int, sense: float) -> Axes:
    """What is known of the pulley itself, from the table of all."""
    torque = -sense * arrays["shaft_torque"][:, number]
    found = {
        "torque": torque,
        "elastic": arrays["elastic_creep"][:, number],
        "added": np.add.reduce([arrays[part][:, number] for part in ("radial", "bending", "regularization")]),
        "slid": arrays["sliding"][:, number],
        "sliding_share": arrays["sliding_arc"][:, number] / arrays["wrap_angle"][:, number],
        "capstan_torque": np.abs(torque) * arrays["slip_safety"][:, number],
        "limit_torque": np.nanmax(torque, initial=-np.inf),
    }
    return {name: (_VARIABLES[name], values) for name, values in found.items()}


def _jump_torque(loaded: Callable[[float], Drive], number: int, force_tolerance: float | None) -> float:
    """The largest torque that the belt holds by its teeth."""
    run = steady_state(loaded(0.0), force_tolerance=force_tolerance)
    radius = float(run.prepared.radii[number])
    holding, torque, jumping = 0.0, float(run.dataset["span_tension"][-1].max()) * radius, np.inf
    while holding < (1.0 - _SLIP_TOLERANCE) * jumping:
        try:
            run = steady_state(loaded(torque), force_tolerance=force_tolerance, start=run)
            holding = torque
        except ConvergenceError as error:
            if torque < _MIN_SLIP * float(run.prepared.belt.axial_stiffness) * radius:
                raise ConvergenceError(f"no steady running found under any torque: {error}") from error
            jumping = torque
        torque = min(_TRIAL_RATIO * holding or np.inf, 0.5 * (holding + jumping))
    return holding


def _ahead(run: Run, number: int) -> float:
    """Angle of a pulley ahead of where that of the first one has it by their teeth, rad, but for a constant."""
    phases, pulleys = np.asarray(run.dataset.attrs[TOOTH_PHASES]), run.prepared.pulleys
    first, other = pulleys[0].teeth, pulleys[number].teeth
    return float(phases[number] - phases[0] * first / other) if first and other else np.nan


def _over_torque(arrays: Mapping[str, NDArray[Any]], torques: FloatArray, wind_up: FloatArray) -> Axes:
    """What follows for the pulley and its teeth, from the table of all pulleys."""
    there = np.isfinite(arrays["belt_speed"])
    found = {
        "wind_up": wind_up - wind_up[there][:1] if there.any() else wind_up,
        "limit_torque": np.max(torques[there], initial=-np.inf),
    }
    return {name: (_VARIABLES[name], values) for name, values in found.items()}

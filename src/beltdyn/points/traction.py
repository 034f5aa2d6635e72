"""Traction curve: slip of one pulley over its torque, beyond gross slip."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError, cause_of
from beltdyn.model import Drive
from beltdyn.model.pulley import flat_friction_on
from beltdyn.parts.quantity import Numbers, numbers_in
from beltdyn.points.changed_drive import at_speed, driver_of, held_at, require_belt, sense_of, with_pulley
from beltdyn.points.operating_points import Axes, OperatingPoints
from beltdyn.results import Result, Run, Variable, summarize
from beltdyn.results.checks.creep import gross_slip, near_gross_slip
from beltdyn.solvers.run_progress import Report
from beltdyn.state.steady import steady_state

_FIRST, _LAST = 5e-4, 0.6
"""Slips between which gross slip is looked for."""
_LEAST = 1e-5
"""Slip below which a drive that has no steady running with slip has none at all."""
_FURTHER = 2.0
_NEAR = 0.02
"""Part of the slip up to which gross slip is found."""
_ROUGHLY = 0.05
"""Error of contact forces with which that is looked for."""
_BEYOND = 1.2
"""Slip up to which a curve goes, over gross slip."""
_STRIDE = 0.02
"""Slip from one operating point to the next, at most."""
_FIRMER = 1.002
"""Friction of the driver over its own, where its whole arc is about to slide together with that of the pulley."""
_ABOUT = 0.7
"""Part of both arcs that slides then."""
_FEWEST = 3
_ALL = 0.99
"""Part of an arc that slides as a whole."""

_EXPECTED = frozenset({gross_slip.__name__, near_gross_slip.__name__})
"""Findings that a traction curve leads to."""

_VARIABLES = {
    "torque": Variable(("slip",), "N m", "Torque"),
    "elastic": Variable(("slip",), "1", "Elastic creep"),
    "added": Variable(("slip",), "1", "Added by bending and the friction law"),
    "slid": Variable(("slip",), "1", "Sliding of whole arcs"),
    "sliding_share": Variable(("slip",), "1", "Sliding share of the arc"),
    "capstan_torque": Variable(("slip",), "N m", "Capstan limit (Euler)"),
    "limit_torque": Variable((), "N m", "Largest torque"),
}


def traction(
    drive: Drive,
    *,
    pulley: str | None = None,
    slip: Numbers | None = None,
    points: int = 30,
    at: float | str | None = None,
    force_tolerance: float | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute the traction curve of a pulley: its slip over its torque, beyond gross slip.

    The slip of the rim relative to that of the driver is prescribed, and the torque follows; beyond gross slip it stays
    constant. If both whole arcs would slide at once, the belt speed would be undetermined, so the friction of the
    driver is raised by 0.2 %. The result also holds the elastic creep under Coulomb friction, the slip added by the
    slope of the friction law, and the torque by Euler's formula with the tensions of each point. Other pulleys keep
    their loads. A hub chain of the pulley is ignored.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The pulley; by default the only loaded one.
    slip
        Slips: a range such as "0..20 %", a list, or an array. By default from zero to a fifth beyond gross slip.
    points
        Number of slips of a range.
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
        Variables along ``slip``; the attribute ``pulley`` names the pulley, ``driver`` the driver.

    Raises
    ------
    ModelError
        If there is no such pulley, it is the driver, or the drive cannot run steadily.
    ConvergenceError
        If no point has steady running.

    Examples
    --------
    >>> found = bd.traction(drive, slip="0..0.2 %", points=3)
    >>> found.dataset.torque.dims
    ('slip',)
    """
    require_belt(drive, "a traction curve", "`beltdyn operating-map` over load, which has the slip safety of rollers")
    held = _driven_by_speed(held_at(drive, at), force_tolerance)
    driver = driver_of(held)
    number = _loaded(held, driver) if pulley is None else held.number_of(pulley)
    if held.pulleys[number].teeth:
        raise ModelError(
            f"{held.pulleys[number].name} holds the belt by its teeth, so that it does not slip and has no traction "
            "curve. Use `bd.results.tooth_loads` of steady running, which has the margin to a jump, or a smooth pulley."
        )
    if number == driver:
        raise ModelError(
            f"pulley = {held.pulleys[number].name!r} is the driver, which is the reference of slip. Choose a driven "
            "pulley."
        )
    held = held.replace(pulley=[*held.pulleys[driver:], *held.pulleys[:driver]])  # slip is against the first
    number = (number - driver) % len(held.pulleys)
    rim = held.pulleys[0].driven_speed() * sense_of(held, 0) * held.rolling_radii[0] * held.pulleys[0].turning
    one = held.pulleys[number]
    fastest = rim / (held.rolling_radii[number] * one.turning)
    if one.hub:
        held = held.replace(pulley=[other.replace(hub=()) if other is one else other for other in held.pulleys])

    def slipping(part: float, firmer: float = 1.0) -> Drive:
        first = held.pulleys[0]
        friction = firmer * flat_friction_on(first, held.belt, held.contact)
        firm = held if firmer == 1.0 else with_pulley(held, 0, first.replace(friction=friction))
        return at_speed(firm, number, (1.0 - part) * fastest)

    slips = _past_gross_slip(slipping, number, points) if slip is None else numbers_in("slip", slip, "", points)
    axes = {"slip": (Variable(("slip",), "1", f"Slip of {one.name}"), slips)}
    with OperatingPoints("traction", slipping(0.0), axes, output, progress, overwrite) as table:
        table.derive = partial(_curve, number=number, sense=float(np.sign(fastest)))
        table.expected = _EXPECTED
        table.attributes = {"drive_as_given": drive.text, "pulley": one.name}

        def from_near(part: float) -> Drive:
            return slipping(part, _firmness(table.near, number))

        table.each(from_near, force_tolerance, stride=_STRIDE)
    return table.result()


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
    return _FIRMER if near is not None and min(_sliding(near, number)) > _ABOUT else 1.0


def _past_gross_slip(slipping: Callable[[float, float], Drive], number: int, points: int) -> FloatArray:
    """Slips from zero to some way beyond where the whole arc of the pulley slides, or that of the driver."""
    if points < _FEWEST:
        raise ModelError(f"points = {points} must be {_FEWEST} or more. Give more, or a list of slips.")
    creeping, sliding, run = 0.0, _LAST, None
    while sliding - creeping > _NEAR * sliding:
        part = min(_FURTHER * creeping or _FIRST, 0.5 * (creeping + sliding))
        try:
            found = steady_state(slipping(part, _FIRMER), force_tolerance=_ROUGHLY, start=run)
        except Exception as error:
            if part < _LEAST:
                raise ConvergenceError(f"no steady running found at any slip: {cause_of(error)}") from error
            sliding = part
            continue
        if max(_sliding(found, number)) > _ALL:
            sliding = part
        else:
            creeping, run = part, found
    return np.linspace(0.0, _BEYOND * sliding, points)


def _curve(arrays: Mapping[str, NDArray[Any]], number: int, sense: float) -> Axes:
    """What is known of the pulley itself, from the table of all."""
    torque = -sense * arrays["shaft_torque"][:, number]
    found = {
        "torque": torque,
        "elastic": arrays["elastic_creep"][:, number],
        "added": arrays["bending"][:, number] + arrays["regularization"][:, number],
        "slid": arrays["sliding"][:, number],
        "sliding_share": arrays["sliding_arc"][:, number] / arrays["wrap_angle"][:, number],
        "capstan_torque": np.abs(torque) * arrays["slip_safety"][:, number],
        "limit_torque": np.nanmax(torque, initial=-np.inf),
    }
    return {name: (_VARIABLES[name], values) for name, values in found.items()}

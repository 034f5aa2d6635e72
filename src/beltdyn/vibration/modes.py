"""Modes of a drive about rest, steady running or a state of a run: frequency, damping and shape."""

from collections.abc import Callable, Iterator
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, prepare
from beltdyn.parts.messages import listing
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.parts.quantity import RPM, Count, Number, numbers_in
from beltdyn.points.changed_drive import at_speed, driver_of, held_at, sense_of
from beltdyn.results import Result, Run, Variable, build_result
from beltdyn.results.schema import AXIS_NAMES, COORDINATES, runs_steadily
from beltdyn.solvers.eigenvalues import LIGHT, MOST_SWINGING, lightly_damped, pencil, swinging, swings
from beltdyn.solvers.run_progress import Report
from beltdyn.state.linearized import SmallMotions, growing
from beltdyn.state.steady import steady_state
from beltdyn.transient.beginning import compile_solving_ahead, instant_of
from beltdyn.vibration.creep_damping import CREEP_SHARE, creep_damping
from beltdyn.vibration.mode_shapes import Points, Shapes, Shares, belt_points, part_names, shapes_of, shares_of
from beltdyn.vibration.small_motions import (
    about_instant,
    about_rest,
    about_steady,
    dry_tensioners,
    require_closed,
    require_mesh_that_stays,
)
from beltdyn.vibration.squeal import squeal_of

# Modes of small motions about a state, with sliding and with stuck tensioners, as a result

SLIDING: str = "sliding"
STUCK: str = "stuck"
"""Whether tensioners with dry friction move in a mode, without it, or are held by it."""
FIRST_STUCK = MOST_SWINGING + 2
"""Number of the first mode with stuck tensioners, however many there are with sliding ones."""
_GROUPS = (f"lightly damped (damping ratio below {LIGHT:g})", f"heavily damped ({LIGHT:g} or above: barely resonates)")
_GROWS = 1e-6
"""Growth rate of an unstable mode, over its angular frequency."""
_DAMPED, _CREEPS = 1e-3, 0.05
"""Damping ratio, and part of it by the slope of the friction law, above which that is told."""
_MODE = ("mode",)

VARIABLES = {
    "frequency": Variable(_MODE, "Hz", "Frequency"),
    "damping_ratio": Variable(_MODE, "1", "Damping ratio"),
    "damping": Variable(_MODE, "1", "Damping class", "str"),
    "creep_damping": Variable(_MODE, "1", "Damping ratio by friction slope"),
    "growth_rate": Variable(_MODE, "1/s", "Growth rate, negative for decaying modes"),
    "kind": Variable(_MODE, "1", "Kind, by shares of kinetic energy", "str"),
    "moving_parts": Variable(_MODE, "1", "Parts with most of the energy", "str"),
    "dry_tensioners": Variable(_MODE, "1", "Tensioners with dry friction", "str"),
    "span_share": Variable((*_MODE, "span"), "1", "Share of kinetic energy, transverse motion of the span"),
    "pulley_share": Variable((*_MODE, "pulley"), "1", "Share of kinetic energy, rotation of the pulley"),
    "belt_share": Variable((*_MODE, "whole"), "1", "Share of kinetic energy, longitudinal motion of the belt"),
    "tensioner_share": Variable((*_MODE, "tensioner"), "1", "Share of kinetic energy, tensioner"),
    "belt_shape": Variable((*_MODE, "part", "point"), "1", "Displacement of the belt to its left"),
    "rim_shape": Variable((*_MODE, "part", "pulley"), "1", "Displacement of the rim, counter-clockwise"),
    "tensioner_shape": Variable((*_MODE, "part", "tensioner"), "1", "Displacement of the tensioned pulley"),
    "point_position": Variable(("point", "axis"), "m", "Position of the belt points"),
    "point_normal": Variable(("point", "axis"), "1", "Unit vector to the left of the belt"),
    "point_span": Variable(("point",), "1", "Number of the span, or of that behind the arc", "int64"),
}
"""What is known of modes; shapes are real and imaginary parts, over the largest displacement of the mode."""

_COORDINATES = {
    "mode": Variable(_MODE, "1", "Mode", "int64"),
    "part": Variable(("part",), "1", "Real or imaginary part", "str"),
    "axis": COORDINATES["axis"],
    "pulley": COORDINATES["pulley"],
    "span": COORDINATES["span"],
    "tensioner": COORDINATES["tensioner"],
    "point_coordinate": Variable(("point",), "m", "Belt coordinate of the point, unstretched"),
}


class _Found(NamedTuple):
    """Modes of a drive with tensioners that slide or stick."""

    values: ComplexArray
    shapes: Shapes
    shares: Shares
    dry: str
    creep: FloatArray
    """Part of the damping ratios by the slope of the friction law; NaN where it is not known."""


def modes_about(motions: SmallMotions, count: int, steeper: SmallMotions | None = None) -> Result:
    """Find the modes of small motions about a state, with sliding and with stuck tensioners.

    `steeper`: the same under steeper friction, see `creep_damping`; without it damping by creep is not known.
    """
    points, dry = belt_points(motions), dry_tensioners(motions.prepared)
    found = [_find(motions, points, count, SLIDING if dry.size else "", steeper)]
    if dry.size:
        stuck = None if steeper is None else steeper.with_stuck(dry)
        found.append(_find(motions.with_stuck(dry), points, count, STUCK, stuck))
    return _result(motions, points, found)


def eigenmodes(
    motions: SmallMotions, count: int, *, counted: Callable[[ComplexArray], BoolArray] = swings
) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues (1/s) and coordinates, shape (n, k), of a drive about a state, from the lowest frequency on.

    At most `count` of those `counted`, see `swinging`; ConvergenceError if nothing oscillates.
    """
    given = pencil(motions.stiffness, motions.damping, motions.mass, motions.free)
    values, vectors = swinging(given, count, counted=counted)
    if not values.size:
        raise ConvergenceError("the drive has no oscillating mode. Check its masses, stiffnesses and damping.")
    return values, given.coordinates(values, vectors)


def _find(motions: SmallMotions, points: Points, count: int, dry: str, steeper: SmallMotions | None) -> _Found:
    """Modes of a drive about a state."""
    values, coordinates = eigenmodes(motions, count, counted=lightly_damped)
    shapes = shapes_of(motions, points, coordinates)
    creep = np.full(values.size, np.nan)
    if steeper is not None:
        creep = creep_damping(motions, steeper, values, coordinates)
    return _Found(values, shapes, shares_of(motions, points, values, coordinates), dry, creep)


def _result(motions: SmallMotions, points: Points, found: list[_Found]) -> Result:
    """Modes as a result: lightly damped ones first, of these those with sliding tensioners."""
    drive, values = motions.drive, np.concatenate([one.values for one in found])
    shapes = Shapes(*(np.concatenate(parts) for parts in zip(*(one.shapes for one in found), strict=True)))
    shares = Shares(*(np.concatenate(parts) for parts in zip(*(one.shares for one in found), strict=True)))
    each, names = [shares.of(number) for number in range(values.size)], part_names(drive)
    light, creep = lightly_damped(values), np.concatenate([one.creep for one in found])
    firsts = (1, FIRST_STUCK)[: len(found)]
    numbers = np.concatenate([first + np.arange(one.values.size) for first, one in zip(firsts, found, strict=True)])
    tensioners = [one.pulley for one in drive.moving_tensioners]
    arrays: dict[str, ArrayLike] = {
        "frequency": values.imag / (2.0 * np.pi),
        "damping_ratio": -values.real / np.abs(values),
        "damping": [_GROUPS[0 if one else 1] for one in light],
        "creep_damping": creep,
        "growth_rate": values.real,
        "kind": [one.kind for one in each],
        "moving_parts": [one.parts(names) for one in each],
        "dry_tensioners": [one.dry for one in found for _ in one.values],
        "span_share": shares.span,
        "pulley_share": shares.pulley,
        "belt_share": shares.belt[:, None],
        "tensioner_share": shares.tensioner,
        "belt_shape": _parts(shapes.belt),
        "rim_shape": _parts(shapes.rims),
        "tensioner_shape": _parts(shapes.tensioners),
        "point_position": points.place,
        "point_normal": points.normal,
        "point_span": points.span,
    }
    labels: dict[str, ArrayLike] = {
        "mode": numbers,
        "part": ["real", "imaginary"],
        "axis": list(AXIS_NAMES),
        "pulley": [one.name for one in drive.pulleys],
        "span": ["-".join(span) for span in drive.spans],
        "tensioner": tensioners,
        "point_coordinate": points.along,
    }
    known = {
        "tensioner": bool(tensioners),
        "dry_tensioners": bool(found[0].dry),
        "creep_damping": not np.isnan(creep).all(),
    }
    absent = {name for name, is_known in known.items() if not is_known}
    made = build_result(
        "modes",
        drive,
        {name: (one, arrays[name]) for name, one in VARIABLES.items() if absent.isdisjoint((name, *one.dims))},
        {name: (one, labels[name]) for name, one in _COORDINATES.items() if name not in absent},
        [*_warnings(numbers, values), *_monotonic(motions), *_creeping(numbers[light], values[light], creep[light])],
    )
    ordered = made.dataset.isel(mode=np.argsort(~light, kind="stable")).assign_attrs(
        tables_by="damping", mesh_elements=motions.system.nodes
    )
    return Result(ordered, drive)


def _parts(shape: ComplexArray) -> ArrayLike:
    """Real and imaginary parts along a second axis."""
    return np.stack([shape.real, shape.imag], axis=1)


def _warnings(numbers: IntArray, values: ComplexArray) -> list[str]:
    """Unstable modes."""
    growing = [(number, one.real) for number, one in zip(numbers, values, strict=True) if one.real > _GROWS * one.imag]
    if not growing:
        return []
    named = ", ".join(f"{number} ({rate:.3g} 1/s)" for number, rate in growing)
    return [
        f"unstable modes: {named}. The drive does not remain in this state. Add damping, or simulate it over "
        "time with `beltdyn simulate`."
    ]


def _creeping(numbers: IntArray, values: ComplexArray, creep: FloatArray) -> Iterator[str]:
    """Modes that the slope of the friction law damps a good deal."""
    ratios = -values.real / np.abs(values)
    with np.errstate(invalid="ignore"):
        named = np.flatnonzero((ratios > _DAMPED) & (creep > _CREEPS * ratios))
    if named.size:
        parts = [f"{creep[place] / ratios[place]:.0%} of that of mode {numbers[place]}" for place in named.tolist()]
        yield (
            f"the slope of the friction law adds to the damping: it is {listing(parts)}. By this law a belt creeps "
            "where it would adhere under Coulomb's. A slope twice as steep, such as by half the contact.creep_ratio, "
            "leaves about half of that."
        )


def _monotonic(motions: SmallMotions) -> Iterator[str]:
    """Motions of a controlled drive that grow without swinging."""
    found = growing(motions) if motions.drive.is_controlled else np.zeros(0, complex)
    for one in found[~swings(found)]:
        yield (
            f"a motion grows by {one.real:.3g} 1/s without swinging. The drive does not remain in this state. Check "
            "the sign of the gain of its controller."
        )


REST: str = "rest"
STEADY: str = "steady"


@takes_options
def modes(
    drive: Drive | Run,
    *,
    about: str | Run = STEADY,
    speed: Number | None = None,
    pulley: str | None = None,
    at: float | str | None = None,
    count: Annotated[Count, Field(ge=1)] = 12,
    force_tolerance: ForceTolerance | None = None,
    squeal: str | None = None,
    progress: Report | None = None,
) -> Result:
    """Compute the modes of a drive: frequency, damping ratio and shape; and whether it squeals.

    Small vibrations about a steady state: at rest with a belt that sticks to its pulleys, or in steady running with its
    creep and sliding. Pulleys of prescribed speed do not vibrate. For tensioners with dry friction modes are given
    twice: with tensioners sliding without friction, and with stuck tensioners.

    Modes are numbered by frequency, those with stuck tensioners from 101. Modes with a damping ratio below 0.5 come
    first, then those that barely resonate, such as tensioner motions damped by belt creep.

    Parameters
    ----------
    drive
        The drive, or a run, which gives the drive and `about`.
    about
        "steady" or "rest"; or the result of `steady_state`, or of a run over time on a staying mesh, whose drive is
        then used. The state of a run at an instant is treated as a steady state.
    speed
        Speed of the driver, such as "800 rpm", or in rad/s, in place of its motor; by default that of the drive file.
    pulley
        The pulley whose speed is prescribed by `speed`; by default the driver.
    at
        Instant at which loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
        simulation. For a run over time an instant of its outputs along the belt, by default the last.
    count
        Number of lightly damped modes, from the lowest frequency, up to 99. Heavily damped modes in between are
        included, up to 99 modes in total, unless there are more than 12 and more than lightly damped ones: those are
        creeping motions of a belt near standstill.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh of steady running is
        refined; by default that of the drive, 0.01.
    squeal
        Whether the drive squeals, and from which load: by the friction of the drive, "given", or of a state, "dry",
        "wet" or "glazed". Self-excited vibrations up to 5 kHz are looked for under multiples of all loads, up to gross
        slip.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Variables along ``mode``, and along ``squeal_load``, the factor on all loads.

    Raises
    ------
    ModelError
        If the belt is open, the drive cannot run steadily, or options are incompatible.
    ConvergenceError
        If there is no such state, or no oscillating mode.

    Examples
    --------
    >>> found = bd.modes(drive, about="rest", count=3)
    >>> found.dataset.frequency.values.round(1).tolist()  # Hz
    [9.2, 21.0, 21.0]
    >>> found.dataset.kind.values.tolist()
    ['rotational', 'span', 'span']
    """
    given = drive.drive_as_given if isinstance(drive, Run) else drive.text
    if isinstance(drive, Run):
        if about != STEADY:
            raise ModelError("about cannot be given with a run, which is itself the state. Omit about.")
        about, drive = drive, drive.drive
    _require_sense(about, speed, pulley, at, count)
    require_closed(drive, web=about == STEADY or (isinstance(about, Run) and runs_steadily(about.dataset)))
    if squeal is not None and about != STEADY:
        raise ModelError(f'squeal = {squeal!r} requires about = "{STEADY}". Omit about.')
    steeper, answer = None, None
    if isinstance(about, Run) and not runs_steadily(about.dataset):
        require_mesh_that_stays(about)
        drive, instant = about.drive, instant_of(about, at)
        motions, state = about_instant(about, instant), f"in its run at t = {instant:.6g} s"
    elif isinstance(about, Run):
        motions, steeper, state = about_steady(about), _steeper(about), _running(about)
    elif about == REST:
        motions, state = about_rest(drive), "at rest"
    else:
        drive = drive.with_slides()
        held = drive if speed is None else _at_speed(drive, speed, pulley, at)
        if squeal is not None:
            answer = squeal_of(held, squeal, at, force_tolerance, progress)
        with compile_solving_ahead(prepare(held)):
            run = steady_state(held, at=at, force_tolerance=force_tolerance, progress=progress)
        motions, steeper, state = about_steady(run), _steeper(run), _running(run)
    result = modes_about(motions, count, steeper)
    told = {"title": f"Modes of {drive.title}, {state}", "drive_as_given": given}
    dataset = result.dataset if answer is None else answer.beside(result.dataset)
    return Result(dataset.assign_attrs(told), result.drive)


def _steeper(run: Run) -> SmallMotions | None:
    """Steady running under steeper friction; None if it is not found nearby."""
    try:
        return about_steady(run, smoothing=CREEP_SHARE)
    except ConvergenceError:
        return None


def _require_sense(
    about: str | Run, speed: Number | None, pulley: str | None, at: float | str | None, count: int
) -> None:
    """Make sure that the options make sense."""
    if count > MOST_SWINGING:
        raise ModelError(f"count = {count} exceeds the limit of {MOST_SWINGING} modes. Give fewer.")
    if not isinstance(about, Run) and about not in (REST, STEADY):
        raise ModelError(
            f'about = {about!r} is not a state. Give "{REST}", "{STEADY}", or a result of `steady_state` or `simulate`.'
        )
    if isinstance(about, Run) and not runs_steadily(about.dataset):
        if speed is not None or pulley is not None:
            raise ModelError(
                "speed and pulley cannot be given with a run over time, which has its own speeds. Omit them."
            )
    elif about != STEADY and any(one is not None for one in (speed, pulley, at)):
        raise ModelError(f'speed, pulley and at require about = "{STEADY}". Omit them.')
    if pulley is not None and speed is None:
        raise ModelError(f"pulley = {pulley!r} needs a speed to prescribe. Give speed.")


def _at_speed(drive: Drive, speed: Number, pulley: str | None, at: float | str | None) -> Drive:
    """The drive with a pulley at a speed."""
    values = numbers_in("speed", speed if isinstance(speed, str) else [float(speed)], "rad/s", 2)
    if values.size > 1:
        raise ModelError(f'speed = {speed!r} must be a single speed, such as "800 rpm".')
    held = held_at(drive, at)
    number = driver_of(held) if pulley is None else held.number_of(pulley)
    return at_speed(held, number, sense_of(held, number) * float(values[0]))


def _running(run: Run) -> str:
    """The state of steady running in words."""
    driver = run.drive.reference
    name, speed = (
        run.drive.pulleys[driver].name,
        run.drive.positive_sense * float(run.dataset["pulley_speed"][-1, driver]),
    )
    return f"in steady running with {name} at {RPM * speed:.4g} rpm"

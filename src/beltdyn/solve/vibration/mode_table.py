"""Modes of small motions about a state, with sliding and with stuck tensioners, as a result."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import BoolArray, ComplexArray, IntArray
from beltdyn.errors import ConvergenceError
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.schema import AXIS_NAMES, COORDINATES
from beltdyn.solve.vibration.eigenvalues import LIGHT, MOST_SWINGING, lightly_damped, pencil, swinging, swings
from beltdyn.solve.vibration.mode_shapes import Points, Shapes, Shares, belt_points, part_names, shapes_of, shares_of
from beltdyn.solve.vibration.small_motions import SmallMotions, dry_tensioners

SLIDING: str = "sliding"
STUCK: str = "stuck"
"""Whether tensioners with dry friction move in a mode, without it, or are held by it."""
FIRST_STUCK = MOST_SWINGING + 2
"""Number of the first mode with stuck tensioners, however many there are with sliding ones."""
_GROUPS = (f"lightly damped (damping ratio below {LIGHT:g})", f"heavily damped ({LIGHT:g} or above: barely resonates)")
_GROWS = 1e-6
"""Growth rate of a mode that grows by itself, over its angular frequency."""
_MODE = ("mode",)

VARIABLES = {
    "frequency": Variable(_MODE, "Hz", "Frequency"),
    "damping_ratio": Variable(_MODE, "1", "Damping ratio"),
    "damping": Variable(_MODE, "1", "Damping class", "str"),
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


def modes_about(motions: SmallMotions, count: int) -> Result:
    """Find the modes of small motions about a state, with sliding and with stuck tensioners.

    Parameters
    ----------
    motions
        The drive about the state.
    count
        How many lightly damped modes to give, from the lowest frequency on.
    """
    points, dry = belt_points(motions), dry_tensioners(motions.drive)
    found = [_find(motions, points, count, SLIDING if dry.size else "")]
    if dry.size:
        found.append(_find(motions.with_stuck(dry), points, count, STUCK))
    return _result(motions, points, found)


def eigenmodes(
    motions: SmallMotions, count: int, *, counted: Callable[[ComplexArray], BoolArray] = swings
) -> tuple[ComplexArray, ComplexArray]:
    """Modes of a drive about a state, from the lowest frequency on.

    Parameters
    ----------
    motions
        The drive about the state.
    count
        How many of those that are counted, at most.
    counted
        As for `swinging`.

    Returns
    -------
    values : ndarray, shape (k,)
        Growth rate and angular frequency, 1/s.
    coordinates : ndarray, shape (n, k)
        Unknowns of the eigenvectors.

    Raises
    ------
    ConvergenceError
        If nothing swings.
    """
    given = pencil(motions.stiffness, motions.damping, motions.mass, motions.free)
    values, vectors = swinging(given, count, counted=counted)
    if not values.size:
        raise ConvergenceError("the drive has no oscillating mode. Check its masses, stiffnesses and damping.")
    return values, given.coordinates(values, vectors)


def _find(motions: SmallMotions, points: Points, count: int, dry: str) -> _Found:
    """Modes of a drive about a state."""
    values, coordinates = eigenmodes(motions, count, counted=lightly_damped)
    shapes = shapes_of(motions, points, coordinates)
    return _Found(values, shapes, shares_of(motions, points, values, coordinates), dry)


def _result(motions: SmallMotions, points: Points, found: list[_Found]) -> Result:
    """Modes as a result: lightly damped ones first, of these those with sliding tensioners."""
    drive, values = motions.drive, np.concatenate([one.values for one in found])
    shapes = Shapes(*(np.concatenate(parts) for parts in zip(*(one.shapes for one in found), strict=True)))
    shares = Shares(*(np.concatenate(parts) for parts in zip(*(one.shares for one in found), strict=True)))
    each, names = [shares.of(number) for number in range(values.size)], part_names(drive)
    light = lightly_damped(values)
    firsts = (1, FIRST_STUCK)[: len(found)]
    numbers = np.concatenate([first + np.arange(one.values.size) for first, one in zip(firsts, found, strict=True)])
    tensioners = [one.pulley for one in drive.moving_tensioners]
    arrays: dict[str, ArrayLike] = {
        "frequency": values.imag / (2.0 * np.pi),
        "damping_ratio": -values.real / np.abs(values),
        "damping": [_GROUPS[0 if one else 1] for one in light],
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
    absent = {*(() if tensioners else ("tensioner",)), *(() if found[0].dry else ("dry_tensioners",))}
    made = build_result(
        "modes",
        drive,
        {name: (one, arrays[name]) for name, one in VARIABLES.items() if absent.isdisjoint((name, *one.dims))},
        {name: (one, labels[name]) for name, one in _COORDINATES.items() if name not in absent},
        list(_warnings(numbers, values)),
    )
    ordered = made.dataset.isel(mode=np.argsort(~light, kind="stable")).assign_attrs(
        tables_by="damping", mesh_elements=motions.system.nodes
    )
    return Result(ordered, drive)


def _parts(shape: ComplexArray) -> ArrayLike:
    """Real and imaginary parts along a second axis."""
    return np.stack([shape.real, shape.imag], axis=1)


def _warnings(numbers: IntArray, values: ComplexArray) -> list[str]:
    """What grows by itself."""
    growing = [(number, one.real) for number, one in zip(numbers, values, strict=True) if one.real > _GROWS * one.imag]
    if not growing:
        return []
    named = ", ".join(f"{number} ({rate:.3g} 1/s)" for number, rate in growing)
    return [
        f"unstable modes: {named}. The drive does not remain in this state. Add damping, or simulate it over "
        "time with `beltdyn run`."
    ]

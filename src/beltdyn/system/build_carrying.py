"""Arrays of supports and goods along the spans of a drive."""

from collections.abc import Sequence
from math import sqrt
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.machines.carrying.registry import GOODS, SUPPORT_ROWS
from beltdyn.machines.profiles.functions import NO_SCHEDULE
from beltdyn.model import Prepared
from beltdyn.model.carrying import Stretch, normal_load, stiffness_of, upper_side
from beltdyn.model.path import Path
from beltdyn.quadrature import gauss_points
from beltdyn.records import Records, offsets, records
from beltdyn.system.arrays import Bare, Carrying
from beltdyn.system.build_machines import scheduled

_POINTS = 6
"""Gauss points of an element: exact for mass and stiffness of a quintic."""
_BEYOND = 0.02
"""How far elements may move along a span, over its length, on either side."""


def carrying_arrays(prepared: Prepared, lengths: FloatArray) -> Bare | Carrying:
    """Supports and goods on a staying mesh with elements of lengths (m)."""
    if not prepared.carries:
        return Bare()
    supports, goods = _supports(prepared), _goods(prepared)
    of_supports = _by_element(prepared, lengths, [prepared.stretch(one) for one in prepared.supports])
    of_goods = _by_element(prepared, lengths, [prepared.stretch(one) for one in prepared.goods])
    return Carrying(supports, goods, *of_supports, *of_goods, np.array(prepared.gravity), gauss_points(_POINTS))


def on_other_lengths(prepared: Prepared, carrying: Bare | Carrying, lengths: FloatArray) -> Bare | Carrying:
    """The same supports and goods on another mesh."""
    if isinstance(carrying, Bare):
        return carrying
    mesh = carrying_arrays(prepared, lengths)
    assert isinstance(mesh, Carrying)
    return mesh._replace(supports=carrying.supports, goods=carrying.goods)


def with_resistance(carrying: Bare | Carrying, factor: float) -> Bare | Carrying:
    """The same supports with a factor on their resistances."""
    if isinstance(carrying, Bare) or np.all(carrying.supports.resisting == factor):
        return carrying
    supports = carrying.supports.copy()
    supports["resisting"] = factor
    return carrying._replace(supports=supports)


def _line(stretch: Stretch) -> dict[str, Any]:
    return {
        "origin": tuple(stretch.origin),
        "direction": tuple(stretch.direction),
        "first": stretch.start,
        "last": stretch.end,
    }


def _supports(prepared: Prepared) -> Records:
    """Rows of supports."""
    belt_mass, weight = prepared.belt.mass_per_length, float(np.hypot(*prepared.gravity))
    kinds = [type(one) for one in prepared.supports]
    table = records(SUPPORT_ROWS.row_type(kinds), resisting=np.ones(len(kinds)))
    for row, kind, one in zip(table, kinds, prepared.supports, strict=True):
        stretch = prepared.stretch(one)
        load = normal_load(one, prepared.goods, belt_mass, stretch.direction, prepared.gravity)
        stiffness = stiffness_of(one, load)
        for name, value in _line(stretch).items():
            row.line[name] = value
        row.normal = upper_side(stretch.direction, prepared.gravity)
        row.curvature = 0.0 if one.curve_radius is None else 1.0 / one.curve_radius
        own = normal_load(one, (), belt_mass, stretch.direction, prepared.gravity)
        row.raised = own / stiffness
        row.stiffness, row.rotating = stiffness, one.rotating_mass
        row.damping = 2.0 * sqrt(stiffness * belt_mass) if one.damping is None else one.damping
        row.both_sides = not one.needs_weight
        SUPPORT_ROWS.fill(row, kind, one.values(weight))
    return table


def _goods(prepared: Prepared) -> Records:
    """Rows of goods."""
    table = records(GOODS, mass=[one.mass_per_length for one in prepared.goods])
    table.schedule = NO_SCHEDULE
    number = scheduled(prepared.pulleys)
    for row, one in zip(table, prepared.goods, strict=True):
        for name, value in _line(prepared.stretch(one)).items():
            row.line[name] = value
        if one.schedule is not None:
            row.schedule, number = number, number + 1
    return table


def _by_element(prepared: Prepared, lengths: FloatArray, stretches: Sequence[Stretch]) -> tuple[IntArray, IntArray]:
    """Where the rows of each element begin, and the rows of one element after the other."""
    laid, path = prepared.laid, prepared.installation.path
    ends = np.cumsum(lengths)
    middles = ends - 0.5 * lengths
    rows: list[list[int]] = [[] for _ in lengths]
    for number, stretch in enumerate(stretches):
        start, stop = _near(path, stretch)
        first = (path.span_start(stretch.span) + start - laid.start) / laid.stretch
        size = (stop - start) / laid.stretch
        along = (middles - first) % prepared.belt_length
        near = (along <= size + 0.5 * lengths) | (along >= prepared.belt_length - 0.5 * lengths)
        for element in np.flatnonzero(near):
            rows[element].append(number)
    return offsets(map(len, rows)), np.array([number for own in rows for number in own], dtype=np.int64)


def _near(path: Path, stretch: Stretch) -> tuple[float, float]:
    """Between which places along a span elements may come to lie on a stretch of it, m from its start.

    Those beyond the middle of the next arc belong to another span, even if it runs along the stretch further away.
    """
    span, length = stretch.span, float(path.span_lengths[stretch.span])
    half = np.append(0.5 * path.wrap_angles * np.abs(path.radii), np.zeros(path.spans - path.count))
    margin = _BEYOND * length
    before, after = float(half[span]), float(half[(span + 1) % path.spans])
    return max(stretch.start - margin, -before), min(stretch.end + margin, length + after)

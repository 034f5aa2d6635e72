"""Supports and goods on the spans of a drive: where they lie, and whether the belt can lie on them."""

from collections.abc import Sequence
from math import hypot, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.machines.carrying.support import Goods, OnSpan, Support
from beltdyn.model.path import Path
from beltdyn.model.resolution import Laid
from beltdyn.parts.messages import beyond

SINKING = 1e-3
"""How far belt and goods sink into a support without a given stiffness, m, at most."""
HANGING = 4e-3
"""Length at either end of such a support over which its load hangs on the belt, over its own length, at most. Half of
it is not resolved by the mesh, whose waves add friction; twice as much loses 1.2 % of it."""
_LEAST_LINE_FORCE = 10.0
"""Normal force for which that stiffness is made at least, N/m."""
_STEEPEST = 0.05
"""Least share of the weight that is normal to a span whose supports carry by weight."""
_ROUNDING = 1e-6
"""Of the ends of a span, over its length."""


class Stretch(NamedTuple):
    """Where something lies on a span."""

    span: int
    origin: FloatArray
    """Start of the span, m, shape (2,)."""
    direction: FloatArray
    """Unit vector along the span, shape (2,)."""
    start: float
    """From the start of the span, m."""
    end: float

    @property
    def length(self) -> float:
        """Its length, m."""
        return self.end - self.start


def stretch_of(one: OnSpan, spans: Sequence[tuple[str, str]], path: Path) -> Stretch:
    """Where something lies on a span of a path."""
    span = list(spans).index(one.span)
    length = float(path.span_lengths[span])
    end = length if one.end is None else min(one.end, length)
    return Stretch(span, path.span_points[span, 0], path.span_directions[span], one.start, end)


def upper_side(direction: FloatArray, gravity: tuple[float, float]) -> FloatArray:
    """Unit normal of a span against gravity, or its left normal without gravity, shape (2,)."""
    left = np.array([-direction[1], direction[0]])
    return -left if left @ np.array(gravity) > 0.0 else left


def normal_load(
    support: Support, goods: Sequence[Goods], belt_mass: float, direction: FloatArray, gravity: tuple[float, float]
) -> float:
    """Weight of belt and full goods that presses on a support, N/m."""
    most = sum(one.mass_per_length for one in goods if one.span == support.span)
    return (belt_mass + most) * abs(float(upper_side(direction, gravity) @ np.array(gravity)))


def stiffness_of(support: Support, load: float, tension: float, bending: float, length: float) -> float:
    """Normal stiffness of a support of a length (m) under a load of belt and goods (N/m), N/m^2.

    At its ends a belt under the tension T (N) with the bending stiffness EI (N m^2) hangs on the stiffness k over the
    length a of k a^2 = T + 2 sqrt(EI k), and its load rests on the pulleys.
    """
    square = (HANGING * length) ** 2
    hanging = ((sqrt(bending) + sqrt(bending + max(tension, 0.0) * square)) / square) ** 2
    return support.stiffness or max(load, _LEAST_LINE_FORCE, SINKING * hanging) / SINKING


def lies_on(laid: Laid, stretch: Stretch, along: FloatArray) -> BoolArray:
    """Whether places of a laid belt (m) lie on a stretch of a span."""
    first = (laid.path.span_start(stretch.span) + stretch.start - laid.start) / laid.stretch
    length = laid.path.length / laid.stretch
    return np.asarray((along - first) % length <= stretch.length / laid.stretch)


def in_batch(laid: Laid, stretch: Stretch, goods: Goods, along: FloatArray, passed: ArrayLike = 0.0) -> BoolArray:
    """Whether goods are at places of a laid belt (m) when lengths of it have passed (m), by their batch."""
    if goods.batch is None:
        return np.ones(np.broadcast_shapes(np.shape(along), np.shape(passed)), dtype=bool)
    place = (laid.start + laid.stretch * along - laid.path.span_start(stretch.span)) % laid.path.length
    way = place - laid.stretch * np.asarray(passed)
    return np.asarray((way >= goods.batch[0]) & (way <= goods.batch[1]))


def hanging_parts(
    supports: Sequence[Support], spans: Sequence[tuple[str, str]], path: Path
) -> list[list[tuple[float, float]]]:
    """Starts and ends of the parts of each span that no support carries, from the start of the span, m."""
    parts = []
    for span, length in zip(spans, path.span_lengths.tolist(), strict=True):
        carried = [stretch_of(one, spans, path) for one in supports if one.span == span]
        place, hanging = 0.0, list[tuple[float, float]]()
        for start, end in sorted((one.start, one.end) for one in carried):
            hanging.append((place, max(start, place)))
            place = max(place, end)
        parts.append([*hanging, (place, max(length, place))])
    return parts


def hanging_lengths(supports: Sequence[Support], spans: Sequence[tuple[str, str]], path: Path) -> list[FloatArray]:
    """Lengths of the parts of each span that no support carries, m."""
    return [np.ptp(np.array(parts), axis=1) for parts in hanging_parts(supports, spans, path)]


def swinging_lengths(supports: Sequence[Support], spans: Sequence[tuple[str, str]], path: Path) -> FloatArray:
    """Longest length of each span that swings freely, also from idler to idler, m, shape (s,)."""
    found = [parts.max() for parts in hanging_lengths(supports, spans, path)]
    for one in supports:
        span = list(spans).index(one.span)
        found[span] = max(found[span], one.free_length)
    return np.array(found)


def check_carrying(
    supports: Sequence[Support],
    goods: Sequence[Goods],
    spans: Sequence[tuple[str, str]],
    path: Path,
    gravity: tuple[float, float],
) -> None:
    """Make sure that supports and goods lie on spans, and that there is a weight to carry."""
    for group, ones in (("support", supports), ("goods", goods)):
        for number, one in enumerate(ones, 1):
            _check_span(f"{group}[{number}]", one, spans, path)
    for number, support in enumerate(supports, 1):
        if support.needs_weight:
            _check_weight(f"support[{number}]", support, stretch_of(support, spans, path), gravity)


def _check_span(where: str, one: OnSpan, spans: Sequence[tuple[str, str]], path: Path) -> None:
    first, second = one.span
    known = ", ".join(f'["{a}", "{b}"]' for a, b in spans)
    if first == second and len(spans) > 1:
        raise ValueError(
            f'{where}.span = ["{first}", "{second}"] is the arc on a pulley, but only spans are carried. Choose one of '
            f"{known}; a convex curve is a pulley of its radius with speed = 0"
        )
    if one.span not in spans:
        raise ValueError(f'{where}.span = ["{first}", "{second}"] is no span of the belt. Choose one of {known}')
    length = float(path.span_lengths[list(spans).index(one.span)])
    for key, value in (("start", one.start), ("end", one.end)):
        if value is not None and value > length * (1.0 + _ROUNDING):
            raise ValueError(
                f'{where}.{key} = {value:.6g} m lies beyond the span "{first}-{second}" of {length:.6g} m. Reduce or '
                "omit it"
            )
    if one.start >= length * (1.0 - _ROUNDING):
        raise ValueError(
            f'{where}.start = {one.start:.6g} m leaves nothing of the span "{first}-{second}" of {length:.6g} m. '
            "Reduce or omit it"
        )


def _check_weight(where: str, support: Support, stretch: Stretch, gravity: tuple[float, float]) -> None:
    size = hypot(*gravity)
    if size == 0.0:
        raise ValueError(
            f'{where} of kind "{support.kind}" carries by weight, but gravity = [0, 0]. Give gravity, such as [0, '
            '-9.81], or kind = "guide", which also holds the belt down'
        )
    if float(upper_side(stretch.direction, gravity) @ np.array(gravity)) > -_STEEPEST * size:
        first, second = support.span
        raise ValueError(
            f'{where} of kind "{support.kind}" carries by weight, but the span "{first}-{second}" is vertical. Omit '
            'it, or choose kind = "guide"'
        )


def check_lift(
    supports: Sequence[Support],
    spans: Sequence[tuple[str, str]],
    path: Path,
    gravity: tuple[float, float],
    belt_mass: float,
    tension: float,
) -> None:
    """Make sure that the tension at rest (N) does not lift the empty belt off a concave curve."""
    for number, support in enumerate(supports, 1):
        if support.curve_radius is None or not support.needs_weight:
            continue
        load = normal_load(support, (), belt_mass, stretch_of(support, spans, path).direction, gravity)
        if tension > load * support.curve_radius:
            raise ValueError(
                f"support[{number}].curve_radius = {support.curve_radius:.5g} m is too small: the tension at rest of "
                f"{tension:.4g} N lifts the empty belt of {load:.4g} N/m off the idlers. Give more than "
                f"{beyond(support.curve_radius, tension / load, 4):.4g} m, or reduce the tension"
            )

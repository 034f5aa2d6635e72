"""A mesh graded towards the ends of arcs, where the curvature changes within boundary layers.

Nodes stand at the ends of arcs, and at the kinks of friction on them: within an element all is smooth.

At the end of an arc the deflection obeys EI w'''' - T w'' + k_p w = 0 inside of the pulley, and without the last term
outside.  It decays over sqrt(EI / T) and sqrt(T / k_p), or over (EI / k_p)^(1/4) where the second is the shorter.
"""

from itertools import pairwise
from math import ceil, pi, sqrt
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.path import Path

FINENESS = 1.4
"""Fineness of the mesh of a run without a given number of elements."""
_FIRST = 1.5
"""First element over the layer length."""
_GROWTH = 0.7
"""Growth of elements away from the end of an arc, over the distance from there."""
_WIDEST = pi / 3.0
"""Angle of an element on an arc, rad, at most."""
_FEWEST = 3
"""Least elements per span."""
_ENOUGH = 0.2
"""Length to resolve over sqrt(T / k_p), if the bending length is shorter: its effect goes with their ratio squared."""
_KINK = 0.1
"""Length of the elements at a kink, over the radius."""
_SAMPLES = 400
_MOST = 10_000
"""Limit of elements on a piece of belt: a centre in wrong units would need more memory than there is."""


class Arc(NamedTuple):
    """An arc of the belt on a pulley."""

    start: float
    """On the unstretched belt, m."""
    end: float
    radius: float
    """m."""
    kinks: tuple[float, ...] = ()
    """Points in between where sliding begins or ends, ascending; forces have kinks there."""


class Laid(NamedTuple):
    """A belt on the path of a drive; its coordinate is zero in the middle of a span."""

    path: Path
    start: float
    """Arc length of the coordinate zero on the path, m."""
    stretch: float
    """Length of the path over that of the belt."""

    @classmethod
    def on(cls, path: Path, length: float, span: int) -> "Laid":
        """Lay a belt of an unstretched length (m) on a path, from the middle of a span."""
        return cls(path, path.span_start(span) + 0.5 * float(path.span_lengths[span]), path.length / length)

    def arcs(self) -> list[Arc]:
        """Arcs of the belt on pulleys, in order along the belt."""
        found = list[Arc]()
        for p, (radius, wrap) in enumerate(zip(self.path.radii, self.path.wrap_angles, strict=True)):
            size = abs(float(radius))
            arrives = self.path.span_start((p - 1) % self.path.count) + float(self.path.span_lengths[p - 1])
            first = (arrives - self.start) % self.path.length
            found.append(Arc(first / self.stretch, (first + size * float(wrap)) / self.stretch, size))
        return sorted(found)

    def marks(self) -> FloatArray:
        """Both ends of the belt, and of the arcs between them, m."""
        ends = [place for arc in self.arcs() for place in (arc.start, arc.end)]
        return np.array([0.0, *ends, self.path.length / self.stretch])


def layer_length(bending: float, sinking: float) -> float:
    """Length over which the belt adopts the curvature of a pulley, m.

    Parameters
    ----------
    bending, sinking
        sqrt(EI / T) and sqrt(T / k_p), m.
    """
    return sqrt(bending * sinking) if sinking < bending else max(bending, _ENOUGH * sinking)


def graded_mesh(length: float, arcs: list[Arc], layer: float, fineness: float = FINENESS) -> FloatArray:
    """Divide a closed belt into elements.

    Parameters
    ----------
    length : float
        Unstretched length, m.
    arcs : list of Arc
        In the order in which they follow each other along the belt, within 0 and the length.
    layer : float
        Length of the layers at the ends of arcs, m.
    fineness : float
        Factor on the number of elements.

    Returns
    -------
    ndarray, shape (elements,)
        Lengths of the elements, m. The first begins at zero.
    """
    first = _FIRST * layer
    around = length - arcs[-1].end + arcs[0].start
    pieces = [_divide(arcs[0].start, first, around / _FEWEST, fineness, (False, True))]
    for number, arc in enumerate(arcs):
        kinked = tuple(kink - arc.start for kink in arc.kinks), _KINK * arc.radius
        pieces.append(_divide(arc.end - arc.start, first, _WIDEST * arc.radius, fineness, (True, True), kinked))
        if number + 1 < len(arcs):
            span = arcs[number + 1].start - arc.end
            pieces.append(_divide(span, first, span / _FEWEST, fineness, (True, True)))
    pieces.append(_divide(length - arcs[-1].end, first, around / _FEWEST, fineness, (True, False)))
    return np.concatenate(pieces)


def _divide(
    length: float,
    first: float,
    largest: float,
    fineness: float,
    graded: tuple[bool, bool],
    kinked: tuple[tuple[float, ...], float] = ((), 0.0),
) -> FloatArray:
    """Lengths of the elements of a piece of belt, with small ones at those of its ends that are ends of arcs.

    Kinks are given by their distances from its start, and the length of elements there. Those within the first elements
    get no node.
    """
    kinks, kink_size = kinked
    place = np.linspace(0.0, length, _SAMPLES + 1)
    from_start, from_end = (away if own else np.inf for own, away in zip(graded, (place, length - place), strict=True))
    size = np.minimum(first + _GROWTH * np.minimum(from_start, from_end), largest)
    for kink in kinks:
        size = np.minimum(size, kink_size + _GROWTH * np.abs(place - kink))
    size /= fineness
    passed = np.concatenate([[0.0], np.cumsum(0.5 * (1.0 / size[1:] + 1.0 / size[:-1]) * np.diff(place))])
    inner = [kink for kink in kinks if first < kink < length - first]
    marks = [0.0, *np.interp(inner, place, passed), passed[-1]]
    nodes = [
        np.linspace(start, end, max(ceil(min(end - start, _MOST)), 1), endpoint=False) for start, end in pairwise(marks)
    ]
    return np.diff(np.interp(np.append(np.concatenate(nodes), passed[-1]), passed, place))

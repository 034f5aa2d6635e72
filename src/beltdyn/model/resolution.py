"""Estimated discretization errors of a running drive, from element length, layout, stiffnesses and tension.

A belt takes on the curvature of a pulley within the length lambda = sqrt(l_s max(l_s, l_b)), where it sinks in over
l_s = sqrt(T / k_p) and bends over l_b = sqrt(E I alpha2 / T).  An element of length l covers phi = l / R of a pulley.
With the strain e = T / E A, y = l / lambda, and q = y^2 / (1 + (y / 12)^2), the errors grow as

    tension            sum over pulleys of R phi^3 q / (e L),
    peak pressure      y q,
    mean pressure      the same, and with the tension,
    slip, losses       phi^3 q / sqrt(e) on the smallest pulley.

The factors are those that leave hardly any error above twice its estimate in drives made at random; the documentation
has how they were found and how far they hold.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, pi, sqrt
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ConvergenceError
from beltdyn.model.belt import Belt
from beltdyn.model.path import Path
from beltdyn.parts.messages import Finding, listing
from beltdyn.quadrature import running_integral
from beltdyn.theory.nip import equivalent_radius, half_width

# A mesh graded towards the ends of arcs, where the curvature changes within boundary layers

FINENESS = 1.4
"""Fineness of the mesh of a run without a given number of elements."""
AXIS_FINENESS = 0.5
"""The same of an axis, where contact at the ends of arcs moves the carriage little."""
_FIRST_ELEMENT = 1.5
"""Length of the first element over that of the boundary layer."""
_GROWTH = 0.7
"""Growth of elements away from the end of an arc, over the distance from there."""
_MAX_ELEMENT_ANGLE = pi / 3.0
"""Angle of an element on an arc, rad, at most."""
SPAN_ELEMENTS = 3
"""Least elements per span."""
CARRIED_ELEMENTS = 20
"""Least elements per span of a belt that carries goods or lies on supports: for waves of stretch along it."""
_RESOLVED_LENGTH = 0.2
"""Length to resolve over sqrt(T / k_p), if the bending length is shorter: its effect goes with their ratio squared."""
_KINK_ELEMENT = 0.1
"""Length of the elements at a kink, over the radius."""
_NIP_ELEMENT = 0.1
"""Length of the elements in a nip, over its width."""
_SAMPLES = 400
"""Intervals in which the grading of a piece of belt is sampled, and again that of its ends and nips. A piece longer
than this many of its first elements is sampled closer at its ends, where an even spacing would miss them."""
_EVENLY = np.linspace(0.0, 1.0, _SAMPLES + 1)
_MAX_PIECE_ELEMENTS = 10_000
"""Limit of elements on a piece of belt: a center in wrong units would need more memory than there is."""


class Arc(NamedTuple):
    """An arc of the belt on a pulley."""

    start: float
    """On the unstretched belt, m."""
    end: float
    radius: float
    """m."""
    kinks: tuple[float, ...] = ()
    """Points in between where sliding begins or ends, ascending; forces have kinks there."""
    nips: tuple[tuple[float, float], ...] = ()
    """Start and end of the nips on it, m."""


class Laid(NamedTuple):
    """A belt on the path of a drive; its coordinate is zero in the middle of a span, or at the end of an open path."""

    path: Path
    start: float
    """Arc length of the coordinate zero on the path, m."""
    stretch: float
    """Length of the path over that of the belt."""

    @classmethod
    def on(cls, path: Path, length: float, span: int) -> "Laid":
        """Lay a belt of an unstretched length (m) on a path from the middle of a span, or on an open one."""
        if path.ends is not None:
            return cls(path, 0.0, path.length / length)
        return cls(path, path.span_start(span) + 0.5 * float(path.span_lengths[span]), path.length / length)

    def arcs(self) -> list[Arc]:
        """Arcs of the belt on pulleys, in order along the belt."""
        found = list[Arc]()
        for p in self.path.on.tolist():
            size, wrap = abs(float(self.path.radii[p])), float(self.path.wrap_angles[p])
            first = (self.path.arc_start(p) - self.start) % self.path.length
            start, end = first / self.stretch, (first + size * wrap) / self.stretch
            found.append(Arc(start, end, size, nips=tuple(self._nips(p, start))))
        return sorted(found)

    def _nips(self, pulley: int, start: float) -> Iterator[tuple[float, float]]:
        """Start and end of the nips on the arc of a pulley that starts at a place, m."""
        path = self.path
        for pair, depth, angle in zip(path.nips, path.indentations.tolist(), path.nip_angles.tolist(), strict=True):
            if pair[1] == pulley and depth > 0.0:
                sizes = np.abs(path.radii[list(pair)]).tolist()
                half = half_width(depth, equivalent_radius(*sizes))
                middle = start + angle * sizes[1] / self.stretch
                yield middle - half, middle + half

    def marks(self) -> FloatArray:
        """Both ends of the belt, and of the arcs between them, m."""
        ends = [place for arc in self.arcs() for place in (arc.start, arc.end)]
        return np.array([0.0, *ends, self.path.length / self.stretch])


def layer_length(bending: float, sinking: float) -> float:
    """Length over which the belt adopts the curvature of a pulley, m."""
    return sqrt(bending * sinking) if sinking < bending else max(bending, _RESOLVED_LENGTH * sinking)


def graded_mesh(
    length: float, arcs: list[Arc], layer: float, fineness: float = FINENESS, per_span: int = SPAN_ELEMENTS
) -> FloatArray:
    """Divide a closed belt into elements, with layers (m) at the ends of arcs; lengths in m, the first from zero.

    A span has at least `per_span` elements at a fineness of 1.

    Raises
    ------
    ConvergenceError
        If arcs overlap, as where a span lies against a pulley that a tensioner has moved too far.
    """
    limits = [0.0, *(place for arc in arcs for place in (arc.start, arc.end)), length]
    if any(end < start for start, end in pairwise(limits)):
        raise ConvergenceError(
            "the belt touches a pulley outside of its arc, as where a span lies against a pulley that a tensioner has "
            "moved too far. Move the pulleys apart, or give the tensioner stops."
        )
    first, closer = _FIRST_ELEMENT * layer, per_span > SPAN_ELEMENTS
    around = length - arcs[-1].end + arcs[0].start
    pieces = [_divide(arcs[0].start, first, around / per_span, fineness, (False, True), closer=closer)]
    for number, arc in enumerate(arcs):
        kinked = tuple(kink - arc.start for kink in arc.kinks), _KINK_ELEMENT * arc.radius
        pressed = tuple((start - arc.start, end - arc.start) for start, end in arc.nips)
        pieces.append(
            _divide(
                arc.end - arc.start, first, _MAX_ELEMENT_ANGLE * arc.radius, fineness, (True, True), kinked, pressed
            )
        )
        if number + 1 < len(arcs):
            span = arcs[number + 1].start - arc.end
            pieces.append(_divide(span, first, span / per_span, fineness, (True, True), closer=closer))
    pieces.append(_divide(length - arcs[-1].end, first, around / per_span, fineness, (True, False), closer=closer))
    return np.concatenate(pieces)


def _sampled(length: float, first: float, *, closer: bool) -> FloatArray:
    """Places on a piece of belt at which its grading is looked at: evenly, and closer at its ends if it is long."""
    place = length * _EVENLY
    if not closer or length < _SAMPLES * first:
        return place
    near = np.geomspace(0.1 * first, 0.5 * length, _SAMPLES)
    return np.unique(np.concatenate([place, near, length - near]))


def _divide(
    length: float,
    first: float,
    largest: float,
    fineness: float,
    graded: tuple[bool, bool],
    kinked: tuple[tuple[float, ...], float] = ((), 0.0),
    nips: tuple[tuple[float, float], ...] = (),
    *,
    closer: bool = False,
) -> FloatArray:
    """Lengths of the elements of a piece of belt, with small ones at those of its ends that are ends of arcs.

    Kinks are given by their distances from its start, and the length of elements there. Those within the first elements
    get no node.
    """
    kinks, kink_size = kinked
    place = _sampled(length, first, closer=closer)
    for start, end in nips:
        place = np.union1d(place, np.linspace(1.5 * start - 0.5 * end, 1.5 * end - 0.5 * start, _SAMPLES))
    place = place[(place >= 0.0) & (place <= length)]
    from_start, from_end = (away if own else np.inf for own, away in zip(graded, (place, length - place), strict=True))
    size = np.minimum(first + _GROWTH * np.minimum(from_start, from_end), largest)
    for kink in kinks:
        size = np.minimum(size, kink_size + _GROWTH * np.abs(place - kink))
    for start, end in nips:
        beyond = np.maximum(np.maximum(start - place, place - end), 0.0)
        size = np.minimum(size, _NIP_ELEMENT * (end - start) + _GROWTH * beyond)
    size /= fineness
    passed = running_integral(1.0 / size, place)
    inner = [kink for kink in kinks if first < kink < length - first]
    marks = [0.0, *np.interp(inner, place, passed), passed[-1]]
    counts = [max(ceil(min(end - start, _MAX_PIECE_ELEMENTS)), 1) for start, end in pairwise(marks)]
    nodes = np.interp(np.arange(sum(counts) + 1), np.cumsum([0, *counts]), marks)
    return np.diff(np.interp(nodes, passed, place))


def shifts_at_nodes(before: IntArray, after: IntArray, share: FloatArray, shifts: NDArray[Any]) -> NDArray[Any]:
    """Shifts at the N nodes of a mesh that stays at P arcs, from those of arcs, shape (..., P).

    Those of the arcs before and after a node, -1 for none, with the share of the second, shape (N,).
    """
    every = np.concatenate([shifts, np.zeros_like(shifts[..., :1])], axis=-1)
    return np.asarray((1.0 - share) * every[..., before] + share * every[..., after])


ERROR_LIMITS: Mapping[str, float] = MappingProxyType(
    {"tension": 0.01, "mean pressure": 0.05, "peak pressure": 0.2, "slip": 0.1, "losses": 0.2}
)
"""Quantities affected by the mesh, and the largest relative error of a mesh that resolves them."""

PRESSURES = ("mean pressure", "peak pressure")
"""Quantities that the default number of elements need not resolve."""

_TENSION_FACTOR, _MEAN_FACTOR, _PEAK_FACTOR, _SLIP_FACTOR, _LOSS_FACTOR = 2e-4, 2e-4, 1.2e-3, 3e-3, 1e-2
"""Factors of the estimated errors (dimensionless) of tension, mean pressure, peak pressure, slip and losses: those that
leave hardly any error of drives made at random above twice its estimate."""
_SAFETY_FACTOR = 2.0
"""Factor on an estimate that the error hardly ever exceeds."""
_COARSE_FINENESS = 12.0
"""y above which elements touch at single points, and errors grow more slowly."""
_MAX_ELEMENTS = 100_000
"""Upper end of the bisection for the number of elements, and its result where no fewer suffice: 17 evaluations."""


class OnPulleys(Protocol):
    """What the mesh of a belt on its pulleys depends on."""

    @property
    def belt(self) -> Belt:
        """The belt; its length and elements are ignored."""

    @property
    def belt_length(self) -> float:
        """Unstretched length of the belt, m."""

    @property
    def radii(self) -> FloatArray:
        """Effective radii, shape (n,), m."""

    @property
    def contact_stiffness(self) -> float:
        """Normal force per meter of belt and meter of penetration, N/m^2."""


@dataclass(frozen=True, slots=True)
class Running:
    """The operating point of a belt, as far as its mesh depends on it."""

    tension: float
    """Mean tension, N."""
    lifted: float = 0.0
    """Part of it that the belt's speed takes from the pulleys, m v^2, N."""


def layer_lengths(drive: OnPulleys, tension: float) -> tuple[float, float]:
    """Lengths over which a tensioned belt bends at the ends of an arc.

    Parameters
    ----------
    drive : Drive
        The drive.
    tension : float
        N.

    Returns
    -------
    bending, sinking : float
        sqrt(E I alpha2 / T) and sqrt(T / k_p), m.

    Examples
    --------
    >>> bending, sinking = bd.model.layer_lengths(drive, tension=30.0)
    >>> print(f"{1e3 * bending:.2f} mm, {1e3 * sinking:.2f} mm")
    5.27 mm, 1.73 mm
    """
    return math.sqrt(drive.belt.bending_stiffness / tension), math.sqrt(tension / drive.contact_stiffness)


def element_angles(drive: OnPulleys, elements: int) -> FloatArray:
    """Angle per element on each pulley, rad; for other kinds that of a cubic with the same error."""
    return drive.belt.element_kind.cubic_angle(drive.belt_length / (elements * drive.radii))


def mesh_errors(drive: OnPulleys, running: Running, elements: int) -> dict[str, float]:
    """Estimate the discretization errors of a mesh.

    Parameters
    ----------
    drive : Drive
        The drive.
    running : Running
        Its tension, which must exceed the centrifugal tension at its speed.
    elements : int
        Number of elements.

    Returns
    -------
    dict of str to float
        Relative error of each of `ERROR_LIMITS`, without sign; NaN of slip and losses of a belt with teeth, which does
        not slip.

    Examples
    --------
    >>> errors = bd.model.mesh_errors(drive, bd.model.Running(tension=30.0), elements=100)
    >>> print(f"{errors['slip']:.2%} of the slip, {errors['losses']:.1%} of the losses")
    0.33% of the slip, 1.1% of the losses
    """
    angles, radii = element_angles(drive, elements), drive.radii
    bending, sinking = layer_lengths(drive, running.tension - running.lifted)
    fineness = angles * radii / np.sqrt(sinking * max(sinking, bending))
    strain = float(drive.belt.stretch_parameters.stretch(running.tension)) - 1.0
    depth = fineness**2 / (1.0 + (fineness / _COARSE_FINENESS) ** 2)
    turning = angles**3 * depth
    tension = _TENSION_FACTOR * float(np.sum(radii * turning)) / (strain * drive.belt_length)
    peak = float(np.max(fineness * depth))
    creep = float(np.max(turning)) / math.sqrt(strain) if drive.belt.teeth is None else math.nan
    errors = tension, tension + _MEAN_FACTOR * peak, _PEAK_FACTOR * peak, _SLIP_FACTOR * creep, _LOSS_FACTOR * creep
    return dict(zip(ERROR_LIMITS, errors, strict=True))


def elements_needed(drive: OnPulleys, running: Running) -> dict[str, int]:
    """Number of elements for which twice the estimated error of each quantity is within its limit.

    Twice, because errors hardly ever exceed that.

    Parameters
    ----------
    drive : Drive
        The drive, with any number of elements.
    running : Running
        As for `mesh_errors`.

    Returns
    -------
    dict of str to int
        For each of `ERROR_LIMITS`.

    Examples
    --------
    >>> bd.model.elements_needed(drive, bd.model.Running(tension=30.0))["slip"]
    56
    """
    return {name: fewest(drive, running, name, limit / _SAFETY_FACTOR) for name, limit in ERROR_LIMITS.items()}


def fewest(drive: OnPulleys, running: Running, name: str, limit: float) -> int:
    """Fewest elements whose estimate of one of `ERROR_LIMITS` is within a limit or unknown, by bisection."""
    few, many = 0, _MAX_ELEMENTS
    while many - few > 1:
        middle = (few + many) // 2
        if mesh_errors(drive, running, middle)[name] > limit:
            few = middle
        else:
            many = middle
    return many


def unresolved(errors: Mapping[str, float], needed: Mapping[str, int], *, pressures: bool) -> list[Finding]:
    """Quantities that a mesh does not resolve, and meshes that would; empty if it resolves all."""
    asked = ERROR_LIMITS if pressures else ERROR_LIMITS.keys() - PRESSURES
    names = sorted((name for name in asked if errors[name] > ERROR_LIMITS[name]), key=lambda name: -needed[name])
    if not names:
        return []
    most, *fewer = names
    other = f", or {needed[fewer[0]]} for all but {most}" if fewer else ""
    return [
        Finding(
            f"the belt has too few elements for {listing([f'{name} ({_size(errors[name])})' for name in names])}.",
            "These have errors of about that size; speeds and torques need fewer elements.",
            f"Set belt.elements = {needed[most]} for all of these{other}.",
        )
    ]


def _size(error: float) -> str:
    """An error in percent, without a number above 100%."""
    return f"{error:.{0 if error > 0.1 else 1}%}" if error < 1.0 else "over 100%"

"""How the mesh stands to the belt: it travels with the material, or stays in place while the belt flows through it.

In a staying mesh, the point r(sigma, t) of the centerline is that of the material point sigma - s(t), with s the
length of unstretched belt that has passed.  Its velocity is dr/dt + (ds/dt) dr/dsigma.  Within an element the second
term is a polynomial like r itself, so that vectors D e of the element's own carry it exactly; derivatives of second and
third order, which jump from element to element, make these vectors differ from those of the neighbor.  Its
acceleration is

    d2r/dt2 + 2 (ds/dt) d2r/dt dsigma + (d2s/dt2) dr/dsigma + (ds/dt)^2 d2r/dsigma2.
"""

from collections.abc import Callable
from functools import cache
from math import comb
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray, record
from beltdyn.kernel import by_type, kernel
from beltdyn.model.resolution import shifts_at_nodes
from beltdyn.quadrature import gauss_points
from beltdyn.system.arrays import System
from beltdyn.system.state import curve_lengths

# Points of the centerline of a belt at any place along it


def centreline_points(
    system: System, position: FloatArray, along: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places r (m), slopes dr/dx and bends d2r/dx2 (1/m) at belt coordinates (m), shape (k, 2)."""
    lengths, (points, powers, curve) = curve_lengths(system), _on_its_curves(system, position, along)
    degree = points.shape[1] - 1
    first = degree * np.diff(points, axis=1) / lengths[:, None, None]
    second = (degree - 1) * np.diff(first, axis=1) / lengths[:, None, None]
    place, slope, bend = (_on_curves(powers, p, curve) for p in (points, first, second))
    return place, slope, bend


def centreline_places(system: System, position: FloatArray, along: FloatArray) -> FloatArray:
    """Places of material points alone, shape (k, 2), m; see `centreline_points`."""
    points, powers, curve = _on_its_curves(system, position, along)
    return _on_curves(powers, points, curve)


def _on_its_curves(system: System, position: FloatArray, along: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Control points of all curves, and of each point along the belt powers of xi and the number of its curve."""
    lengths, points = curve_lengths(system), _control_points(system, position)
    ends = np.cumsum(lengths)
    curve = np.minimum(np.searchsorted(ends, along, side="right"), lengths.size - 1)
    xi = (along - (ends - lengths)[curve]) / lengths[curve]
    return points, np.vander(xi, points.shape[1], increasing=True), curve


def _control_points(system: System, position: FloatArray) -> FloatArray:
    """Control points of the Bezier curves of a belt, shape (curves, degree + 1, 2), m."""
    nodes = position[: system.first_body].reshape(system.nodes, -1)
    after = np.arange(1, system.length.size + 1) % system.nodes
    both = np.concatenate([nodes[: system.length.size], nodes[after]], axis=1)
    vectors = both[:, np.add.outer(np.array(system.vectors), np.arange(2))]
    points = system.control @ vectors[:, None]
    return np.asarray(points.reshape(-1, *points.shape[2:]))


def _on_curves(powers: FloatArray, points: FloatArray, curve: IntArray) -> FloatArray:
    """Points (k, 2) of Bezier curves, from powers of xi (k, at least degree + 1) and the curves that they are on."""
    count = points.shape[1]
    coefficients = _polynomials(count - 1) @ points
    return np.asarray(np.einsum("ka,kax->kx", powers[:, :count], coefficients[curve]))


@cache
def _polynomials(degree: int) -> FloatArray:
    """Coefficients by powers of xi of the Bernstein polynomials, shape (degree + 1, degree + 1), a column of each."""
    return np.array(
        [
            [(-1.0) ** (power - k) * comb(degree, k) * comb(degree - k, power - k) if k <= power else 0.0]
            for power in range(degree + 1)
            for k in range(degree + 1)
        ]
    ).reshape(degree + 1, degree + 1)


class Travelling(NamedTuple):
    """The mesh travels with the belt."""

    speed: float = 0.0
    """Of the belt against the mesh, m/s."""


class Staying(NamedTuple):
    """The mesh stays in place."""

    speed: FloatArray
    """Length of unstretched belt that passes in a unit of time, m/s, shape (1,)."""
    derivative: FloatArray
    """D, vectors of dr/dsigma from those of r, 1/m, shape (elements, v, v)."""
    inertia: FloatArray
    """C, the integral of rho A S'^T S' over the vectors, kg/m, shape (elements, v, v)."""


class Flowing(NamedTuple):
    """The mesh stays in place, and the length of belt that has passed is a coordinate beside those of the bodies."""

    place: int
    """Of this coordinate s in a state."""
    derivative: FloatArray
    """As for `Staying`."""
    second: FloatArray
    """D D, vectors of d2r/dsigma2 from those of r, 1/m^2, shape (elements, v, v)."""
    mass: FloatArray
    """Integral of rho A S^T S over the vectors, kg, shape (elements, v, v)."""
    direction: FloatArray
    """t, unit vector along which node 0 does not move, shape (2,)."""


class ArcMesh(NamedTuple):
    """What a mesh is made of that stays at every arc, with the lengths of elements where no length has gone over."""

    node: IntArray
    """Node that stays at each of the P arcs, shape (P,)."""
    holding: FloatArray
    """Forces on nodes of a unit of the force that holds the belt at rest, on the arc of the driver, shape (N, 2)."""
    direction: FloatArray
    """Unit vector along the belt there, shape (P, 2)."""
    place: FloatArray
    """Where it stays if the tensioner of the pulley is at zero, m, shape (P, 2)."""
    carrier: IntArray
    """Tensioner of the pulley, -1 without one, shape (P,)."""
    gravity: FloatArray
    """m/s^2, shape (2,)."""
    before: IntArray
    """Arc that is next to a node on one side, or -1 for node 0, shape (N,)."""
    after: IntArray
    """The same on the other side."""
    share: FloatArray
    """Share of the arc after in the shift of a node, shape (N,)."""
    length: FloatArray
    """m, shape (elements,)."""
    control: FloatArray
    """As in a system."""
    derivative: FloatArray
    """As in `Staying`."""
    growth: FloatArray
    """G, shape (elements, v, v), 1/m."""
    mass: FloatArray
    """As in `Flowing`."""
    inertia: FloatArray
    """As in `Staying`."""
    metric: FloatArray
    """As in `hysteresis_record`, shape (elements, v, v), or (0, v, v)."""


class StayingByArcs(NamedTuple):
    """The mesh stays in place at every arc, and the belt runs steadily."""

    speed: FloatArray
    """As for `Staying`."""
    shift: FloatArray
    """Length of unstretched belt that has passed each arc beyond what has passed node 0, m, shape (P,)."""
    derivative: FloatArray
    """As for `Staying`, of the present lengths of elements."""
    growth: FloatArray
    """As in `ArcMesh`, of the present lengths, as are the others."""
    inertia: FloatArray
    arcs: ArcMesh


class FlowingByArcs(NamedTuple):
    """The mesh stays in place at every arc; lengths of belt that have passed are coordinates beside those of bodies."""

    place: int
    """Of that at node 0 in a state; those of the shifts at arcs come before."""
    derivative: FloatArray
    """As for `StayingByArcs`."""
    growth: FloatArray
    inertia: FloatArray
    direction: FloatArray
    """Unit vector along which node 0 does not move, shape (2,)."""
    arcs: ArcMesh


OverTime = Flowing | FlowingByArcs
"""A mesh that stays, in equations over time."""
ByArcs = StayingByArcs | FlowingByArcs
"""A mesh that stays at every arc."""


def staying(control: FloatArray, length: FloatArray, mass: float) -> Staying:
    """The frame of a staying mesh, with a belt at rest.

    Control points have shape (elements, 1, degree + 1, v), of as many vectors; `mass` is that of a meter, kg/m.
    """
    degree = control.shape[2] - 1
    basis = control[:, 0]
    derivative = np.linalg.solve(basis, _hodograph(degree) @ basis) / length[:, None, None]
    xi, weights = gauss_points(degree + 1)
    bernstein = np.array([comb(degree, k) * xi**k * (1.0 - xi) ** (degree - k) for k in range(degree + 1)]).T
    slopes = bernstein @ basis @ derivative
    inertia = mass * length[:, None, None] * (slopes.swapaxes(1, 2) * weights @ slopes)
    return Staying(np.zeros(1), np.ascontiguousarray(derivative), inertia)


def flowing(given: Staying, mass: FloatArray, vectors: tuple[int, ...], place: int, direction: FloatArray) -> Flowing:
    """The frame of a staying mesh, for equations over time.

    `vectors` are places of the vectors among the 2 n coordinates, `place` is that of the passed length in a state,
    `direction` a unit vector along which node 0 does not move.
    """
    first = np.array(vectors)
    own = np.ascontiguousarray(mass[:, first[:, None], first])
    return Flowing(place, given.derivative, given.derivative @ given.derivative, own, direction)


def flow_record(frame: Any, vectors: int, coordinates: int) -> np.dtype[np.void]:
    """Kind of the scratch arrays for the derivatives by velocity of one element."""
    pair, by_arcs = f"({vectors},2)f8", isinstance(frame, ByArcs)
    more = {
        "still": pair,  # vectors of dv/dt at places of the mesh
        "moved": pair,  # of the acceleration of material points
        "grown": pair,  # derivative of velocity by the rate of the shift at the second node, G e
        "still_by_end": pair,  # of dv/dt
        "moved_by_end": pair,  # of the acceleration
        "by_end": f"{coordinates}f8",  # derivative of the residual with respect to the shift at the second node
        "powers": f"({vectors},{vectors})f8",  # A A
        "gradient": f"{coordinates}f8",  # kept meanwhile
        "tangent": f"({coordinates},{coordinates})f8",  # likewise
    }
    return record(
        rate=pair,  # vectors D e
        by_speed=f"{coordinates}f8",  # derivative of the residual with respect to the unknown of the flow
        **(more if by_arcs else {}),
    )


def _hodograph(degree: int) -> FloatArray:
    """Control points of the derivative of a Bezier curve, raised to the same degree, from those of the curve."""
    change = degree * (np.eye(degree, degree + 1, 1) - np.eye(degree, degree + 1))
    raised, parts = np.zeros((degree + 1, degree)), np.arange(degree + 1) / degree
    for k in range(degree + 1):
        if k > 0:
            raised[k, k - 1] = parts[k]
        if k < degree:
            raised[k, k] = 1.0 - parts[k]
    return np.asarray(raised @ change)


@kernel(inline=True)
def _still(frame: Travelling, velocity: FloatArray) -> float:
    """Nodes move with the belt."""
    return 0.0


@kernel(inline=True)
def _given_speed(frame: Staying, velocity: FloatArray) -> float:
    """The speed of steady running."""
    return float(frame.speed[0])


@kernel(inline=True)
def _own_speed(frame: Flowing, velocity: FloatArray) -> float:
    """The rate of the coordinate."""
    return float(velocity[frame.place])


flow_speed: Callable[[Any, FloatArray], float] = by_type(
    {
        Travelling: _still,
        Staying: _given_speed,
        Flowing: _own_speed,
        StayingByArcs: _given_speed,
        FlowingByArcs: _own_speed,
    },
    "flow_speed",
)
"""Length of unstretched belt that passes node 0 in a unit of time, m/s, from velocities of shape (n N + D,)."""


@kernel(inline=True)
def _none_passed(frame: Any, position: FloatArray) -> float:
    """Places are told from where the belt is now."""
    return 0.0


@kernel(inline=True)
def _passed(frame: Flowing, position: FloatArray) -> float:
    """The coordinate."""
    return float(position[frame.place])


passed_length: Callable[[Any, FloatArray], float] = by_type(
    {Travelling: _none_passed, Staying: _none_passed, Flowing: _passed}
    | {StayingByArcs: _none_passed, FlowingByArcs: _passed},
    "passed_length",
)
"""Length of unstretched belt that has passed the mesh, m, at a position of shape (n N + D,)."""


def passed_lengths(frame: Any, positions: FloatArray, elements: int) -> FloatArray:
    """Lengths of unstretched belt that have passed elements in k states, m, shape (k, elements), of their positions."""
    if not isinstance(frame, OverTime):
        return np.zeros((len(positions), elements))
    passed = np.repeat(positions[:, frame.place, None], elements, axis=1)
    if isinstance(frame, FlowingByArcs):
        arcs = frame.arcs
        own = positions[:, frame.place - arcs.node.size : frame.place]
        shifts = shifts_at_nodes(arcs.before, arcs.after, arcs.share, own)
        passed += 0.5 * (shifts + np.roll(shifts, -1, axis=1))[:, :elements]
    return passed


@kernel(inline=True)
def _shift_at_rest(frame: StayingByArcs, position: FloatArray, arc: int) -> float:
    """Shift of the mesh at an arc."""
    return float(frame.shift[arc])


@kernel(inline=True)
def _shift_of_state(frame: FlowingByArcs, position: FloatArray, arc: int) -> float:
    """The coordinate."""
    return float(position[frame.place - frame.arcs.node.size + arc])


_shift_at: Callable[[Any, FloatArray, int], float] = by_type(
    {StayingByArcs: _shift_at_rest} | {FlowingByArcs: _shift_of_state}, "shift_at"
)


@kernel(inline=True)
def node_shift(frame: Any, position: FloatArray, node: int) -> float:
    """Length of belt that has passed a node beyond what has passed node 0, m, on a mesh that stays at every arc.

    From velocities or accelerations of shape (n N + D,) its rate.
    """
    arcs, total = frame.arcs, 0.0
    if arcs.before[node] >= 0:
        total += (1.0 - arcs.share[node]) * _shift_at(frame, position, arcs.before[node])
    if arcs.after[node] >= 0:
        total += arcs.share[node] * _shift_at(frame, position, arcs.after[node])
    return total


@kernel(inline=True)
def _same_at_both(frame: Any, element: int, velocity: FloatArray) -> tuple[float, float]:
    speed = flow_speed(frame, velocity)
    return speed, speed


@kernel(inline=True)
def _at_both(frame: FlowingByArcs, element: int, velocity: FloatArray) -> tuple[float, float]:
    speed, following = velocity[frame.place], (element + 1) % frame.arcs.share.size
    return speed + node_shift(frame, velocity, element), speed + node_shift(frame, velocity, following)


flow_at_ends: Callable[[Any, int, FloatArray], tuple[float, float]] = by_type(
    {Travelling: _same_at_both, Staying: _same_at_both, Flowing: _same_at_both, StayingByArcs: _same_at_both}
    | {FlowingByArcs: _at_both},
    "flow_at_ends",
)
"""Length of unstretched belt that passes both nodes of an element in a unit of time, m/s."""


@kernel(inline=True)
def element_speed(frame: Any, element: int, velocity: FloatArray) -> float:
    """Mean of both."""
    before, after = flow_at_ends(frame, element, velocity)
    return 0.5 * (before + after)


@kernel(inline=True)
def _no_flow(
    frame: Travelling,
    element: int,
    vectors: tuple[int, ...],
    rates: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
) -> None:
    """Leave the velocity: nodes move with the belt."""


@kernel(inline=True)
def _flow(
    frame: Any, element: int, vectors: tuple[int, ...], rates: FloatArray, position: FloatArray, velocity: FloatArray
) -> None:
    """Add speed D e to the velocity."""
    derivative, speed = frame.derivative[element], flow_speed(frame, rates)
    for a in range(len(vectors)):
        for axis in range(2):
            total = 0.0
            for b in range(len(vectors)):
                total += derivative[a, b] * position[vectors[b] + axis]
            velocity[vectors[a] + axis] += speed * total


@kernel(inline=True)
def _flow_by_arcs(
    frame: FlowingByArcs,
    element: int,
    vectors: tuple[int, ...],
    rates: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
) -> None:
    """Add A e to the velocity."""
    derivative, growth = frame.derivative[element], frame.growth[element]
    before, after = flow_at_ends(frame, element, rates)
    for a in range(len(vectors)):
        for axis in range(2):
            total = 0.0
            for b in range(len(vectors)):
                total += (before * derivative[a, b] + (after - before) * growth[a, b]) * position[vectors[b] + axis]
            velocity[vectors[a] + axis] += total


add_flow: Callable[[Any, int, tuple[int, ...], FloatArray, FloatArray, FloatArray], None] = by_type(
    {Travelling: _no_flow, Staying: _flow, Flowing: _flow, StayingByArcs: _flow, FlowingByArcs: _flow_by_arcs},
    "add_flow",
)
"""Add to the velocity of an element, shape (2 n,), what the belt's flow gives its material points; the fourth argument
are the velocities of the state."""

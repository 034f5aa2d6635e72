"""Arrays for what is observed at states, and scratch arrays for observing one."""

from collections.abc import Mapping
from math import atan2, hypot, pi
from typing import Annotated, NamedTuple, get_type_hints

import numpy as np

from beltdyn.arrays import FloatArray, IntArray, blank, record
from beltdyn.contact.contact_zone import combine, fill_bernstein, fill_bernstein_rates
from beltdyn.contact.law import PulleyState
from beltdyn.kernel import kernel
from beltdyn.system.arrays import PENALTY_ENERGY, SPRING_ENERGY, BodyForces, System
from beltdyn.system.element_state import element_workspace
from beltdyn.system.state import element_kind

# Wrap angle of the belt on a pulley, from the first place where it touches to the last

TOUCH = record(
    pulley="i8",  # its number, -1 for none
    x="f8",  # m, from the pulley's center
    y="f8",
    along="f8",  # length of belt from the first node, m
)
"""A place where the belt touches a pulley."""
WALK = record(
    along="f8",  # length of belt from the first node to the curve, m
    length="f8",  # of the curve, m
    first=TOUCH,
    last=TOUCH,
)
"""A walk along the belt: the first place that touches, and the last one so far."""


@kernel(inline=True)
def begin_walk(walk: np.record) -> None:
    """Begin at the first node of the belt."""
    walk.along = walk.length = 0.0
    walk.first.pulley = walk.last.pulley = -1


@kernel(inline=True)
def next_curve(walk: np.record, length: float) -> None:
    """Go on to the next curve of the belt, of a length in m."""
    walk.along += walk.length
    walk.length = length


@kernel(inline=True)
def turned_at(walk: np.record, xi: float, number: int, pulley: PulleyState, work: np.record) -> float:
    """Walk on to the next place that touches.

    `walk`: row of `WALK`; overwritten; `xi`: the place on the curve, 0 to 1; `number`, `pulley`: what it touches;
    `work`: from `element_workspace`, with the control points of the curve. Returns angle around the pulley from the
    last place, rad; zero where that is on another pulley, or where half a turn of belt or more lies between.
    """
    fill_bernstein(xi, work.contact.weights)
    x, y = combine(work.control, work.contact.weights)
    x, y, along = x - pulley.center_x, y - pulley.center_y, walk.along + xi * walk.length
    if walk.first.pulley < 0:
        _set(walk.first, number, x, y, along)
    angle = _turned(walk.last, number, x, y, along)
    _set(walk.last, number, x, y, along)
    return angle


@kernel(inline=True)
def turned_at_the_end(walk: np.record) -> float:
    """Angle around the pulley from the last place of a closed belt to its first, as of `turned_at`, rad.

    `walk`: row of `WALK`, at the end of the belt.
    """
    first = walk.first
    return _turned(walk.last, first.pulley, first.x, first.y, walk.along + walk.length + first.along)


@kernel(inline=True)
def _set(touch: np.record, number: int, x: float, y: float, along: float) -> None:
    """Write down a place."""
    touch.pulley, touch.x, touch.y, touch.along = number, x, y, along


@kernel(inline=True)
def _turned(before: np.record, number: int, x: float, y: float, along: float) -> float:
    """Angle at the pulley's center between two places, see `turned_at`."""
    if before.pulley != number or along - before.along >= pi * hypot(x, y):
        return 0.0
    return abs(atan2(before.x * y - before.y * x, before.x * x + before.y * y))


class Per(NamedTuple):
    """What an observation has a value for, at every state."""

    dims: tuple[str, ...] = ()
    """Names out of "pulley", "span", "curve" of the belt, "point" of contact, and "axis"."""
    shown: bool = False
    """Whether it is there for the states alone that are shown."""
    dtype: type = float


OfState = Annotated[FloatArray, Per()]
OfShownState = Annotated[FloatArray, Per(shown=True)]
OfPulley = Annotated[FloatArray, Per(("pulley",))]
OfSpan = Annotated[FloatArray, Per(("span",))]
OfPulleyByAxis = Annotated[FloatArray, Per(("pulley", "axis"))]
OfShownCurve = Annotated[FloatArray, Per(("curve",), shown=True)]
OfPoint = Annotated[FloatArray, Per(("point",))]
OfPointByAxis = Annotated[FloatArray, Per(("point", "axis"))]
NumberOfPoint = Annotated[IntArray, Per(("point",), dtype=np.int8)]


class Observations(NamedTuple):
    """Derived quantities at a number of states; the names are those of the results."""

    pulley_torque: OfPulley
    """Moment of the belt on each pulley, N m."""
    shaft_torque: OfPulley
    """Torque on each pulley from outside, N m."""
    hub_force: OfPulleyByAxis
    """Force of the belt on each pulley, N."""
    pulley_center: OfPulleyByAxis
    """m."""
    friction_power: OfPulley
    """Power lost in friction on each pulley, W."""
    contact_damping_power: OfPulley
    """Power lost in the contact dampers of each pulley, W."""
    wrap_angle: OfPulley
    """rad."""
    belt_tension: OfShownCurve
    """Mean axial force of each curve, N."""
    tension_variation: OfShownCurve
    """Root mean square deviation of the axial force within each curve from that mean, N."""
    span_tension: OfSpan
    """Mean tension of the free belt after each pulley, N; nan where the belt does not leave it. The last span of an
    open belt is the one before the first pulley."""
    largest_span_tension: OfSpan
    """N."""
    least_span_tension: OfSpan
    """N."""
    span_tension_at_start: OfSpan
    """Where the belt leaves a pulley, N."""
    span_tension_at_end: OfSpan
    """Where it reaches the next one, N."""
    belt_speed: OfSpan
    """Mean speed along the belt of the same, m/s."""
    normal_force: OfPoint
    """N/m."""
    friction_force: OfPoint
    """N/m."""
    slip_velocity: OfPoint
    """m/s, zero where the belt is free."""
    contact_position: OfPointByAxis
    """m."""
    contact_pulley: NumberOfPoint
    """Number of the pulley that a point touches, -1 where it is free."""
    kinetic_energy: OfShownState
    """J."""
    strain_energy: OfShownState
    """J."""
    penalty_energy: OfState
    """J."""
    spring_energy: OfState
    """Of hub chains and tensioners, J."""
    potential_energy: OfState
    """Of weight and of forces on the belt's ends, zero where everything is at the origin, J."""


OBSERVED: Mapping[str, Per] = {
    name: hint.__metadata__[0] for name, hint in get_type_hints(Observations, include_extras=True).items()
}
"""What each observation has a value for."""


class Samples(NamedTuple):
    """Scratch arrays for one state."""

    tension: FloatArray
    """Of the sampling points, N: the force of the span on its line of action."""
    speed: FloatArray
    velocity: FloatArray
    """Of the sampling points, m/s, shape (n c, 2)."""
    bending: float
    """N m^2: times the square of the curvature, what a bent belt takes off the axial force of its centerline."""
    mean: FloatArray
    """Weights of the sampling points in the mean over a curve, shape (c,)."""
    transmitted: FloatArray
    """Weights of the same in the force that a curve transmits, shape (curves of an element, c)."""
    weight: FloatArray
    """Length of the free belt in each span."""
    is_open: bool
    leaving: IntArray
    """Span that leaves each pulley."""
    touched: IntArray
    """The same of the pulley that each point counts to, -1 where it is free."""
    nearest: IntArray
    """A point that touches each pulley, or is nearest to where the belt touches it, -1 without contact."""
    walk: np.record
    """Row of `wrap_angle.WALK`."""
    work: np.record
    """From `element_workspace`."""


def span_count(system: System) -> int:
    """Number of spans: one for each pulley on the path, and one more of an open belt."""
    return int(np.count_nonzero(system.pulleys.beside == 0)) + _is_open(system)


def _is_open(system: System) -> bool:
    return not system.closed and not system.joint


def new_observations(system: System, forces: BodyForces, shown: int) -> Observations:
    """Make observations of states whose body forces are known."""
    curves = system.length.size * system.control.shape[1]
    sizes = {
        "pulley": system.pulleys.size,
        "span": span_count(system),
        "curve": curves,
        "point": curves * system.contact.points.size,
        "axis": 2,
    }
    states = len(forces.moment)
    empty = {
        name: np.zeros((shown if per.shown else states, *(sizes[dim] for dim in per.dims)), per.dtype)
        for name, per in OBSERVED.items()
    }
    return Observations(**empty)._replace(
        pulley_torque=forces.moment,
        shaft_torque=forces.shaft,
        hub_force=forces.hub,
        friction_power=forces.friction,
        contact_damping_power=forces.damping,
        penalty_energy=forces.stored[:, PENALTY_ENERGY].copy(),
        spring_energy=forces.stored[:, SPRING_ENERGY].copy(),
    )


def _bending(system: System) -> float:
    """EI (1/2 - e), N m^2, with the strain e of bending at the centerline over EI kappa^2 / EA (`ElementKind`).

    A span that pulls with T is an elastica: its axial force is T - EI kappa^2 / 2, and the stretch that elements take
    for the axial force differs by e EI kappa^2.
    """
    return float(system.element.section.bending * (0.5 - element_kind(system).bent_strain))


def _transmitted(system: System) -> FloatArray:
    """Weights of the points of a curve in the force that it transmits, shape (curves of an element, points).

    A curve transmits the integral of N dS, with the axial force N and the shape function S that moves its end. Within
    coarse elements beside arcs N swings about that force, and the swing has a mean. Points at the ends of a cubic,
    where dS vanishes, cannot tell: there the force is the mean.
    """
    kind, (points, weights) = element_kind(system), system.contact
    shares = np.empty((kind.curves, points.size))
    for curve, control in enumerate(kind.control(1.0)):
        first = int(np.flatnonzero(control[0])[0])
        end = control[:, first + 1 :] @ np.asarray(kind.shift)[first + 1 :]
        for point, xi in enumerate(points):
            rates = np.empty(end.size)
            fill_bernstein_rates(xi, rates)
            shares[curve, point] = weights[point] * (rates @ end)
    total = shares.sum(axis=1, keepdims=True)
    return np.where(total > 0.5, shares / np.where(total > 0.5, total, 1.0), weights / weights.sum())


def new_samples(system: System) -> Samples:
    """Make scratch arrays for a system."""
    points = system.length.size * system.control.shape[1] * system.contact.points.size
    return Samples(
        tension=np.zeros(points),
        speed=np.zeros(points),
        velocity=np.zeros((points, 2)),
        bending=_bending(system),
        mean=system.contact.weights / system.contact.weights.sum(),
        transmitted=_transmitted(system),
        weight=np.zeros(span_count(system)),
        is_open=_is_open(system),
        leaving=np.cumsum(system.pulleys.beside == 0) - 1,
        touched=np.zeros(points, dtype=np.int64),
        nearest=np.zeros(system.pulleys.size, dtype=np.int64),
        walk=blank(WALK),
        work=element_workspace(system),
    )

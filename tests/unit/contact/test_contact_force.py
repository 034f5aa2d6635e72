"""Contact forces of a curve of any degree (Eq. 24): tangent against differences, elevation of the degree, balance."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import (
    NO_CONTACT_TANGENT,
    ContactFactors,
    ContactTotals,
    contact_force,
    contact_workspace,
)
from beltdyn.contact.contact_zone import Curve
from beltdyn.contact.friction import AirFilm, friction_force
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.surface import Round
from beltdyn.quadrature import gauss_points

DEGREES = [1, 3, 5]
BOTH = ContactFactors(1.0, 300.0, 300.0, 0.0, 0.0, False)
RULE = gauss_points(6)
LENGTH = 0.06
BLOCKS = ("xx", "xy", "yx", "yy")


def sunk(pulley: PulleyState, degree: int) -> tuple[FloatArray, FloatArray]:
    """Control points of a curve that enters a pulley, 2 mm deep, and their velocities; creeping and sliding."""
    along = np.linspace(-0.6, 0.6, degree + 1)
    wave = 1e-3 * np.cos(7.0 * np.arange(degree + 1))
    out = np.stack([np.cos(along), np.sin(along)], axis=1)
    center = np.array([pulley.center_x, pulley.center_y])
    control = center + (pulley.surface.radius + wave + 0.002 * np.arange(degree + 1) / degree)[:, None] * out
    velocity = pulley.surface.radius * pulley.speed * np.stack([-out[:, 1], out[:, 0]], axis=1)
    return control, velocity * (1.0 + 0.3 * wave / 1e-3)[:, None] - 0.02 * out


def act(
    vectors: FloatArray,
    rates: FloatArray,
    basis: FloatArray,
    pulley: PulleyState,
    law: ContactLaw,
    by_position: float = 0.0,
    by_velocity: float = 0.0,
) -> tuple[Any, ContactTotals]:
    """Record of results and sums for vectors of nodal coordinates."""
    work = contact_workspace(*basis.shape)
    curve = Curve(basis @ vectors, basis @ rates, basis, LENGTH)
    totals = contact_force(
        curve, pulley, law, RULE, ContactFactors(by_position, by_velocity, by_velocity, 0.0, 0.0, False), work
    )
    return work, totals


def answer(*arguments: Any) -> FloatArray:
    """Forces on the vectors, then the moment on the pulley."""
    work, totals = act(*arguments)
    return np.append(work.force.ravel(), totals.moment)


@pytest.fixture(params=[("circle", 0.0), ("eccentric", 0.0), ("circle", 1.0), ("eccentric", 1.0)])
def any_pulley(
    request: pytest.FixtureRequest, pulley: PulleyState, eccentric: Callable[[float], PulleyState]
) -> PulleyState:
    """Either surface, with slip at the rim or at the cord."""
    surface, cord = request.param
    return (pulley if surface == "circle" else eccentric(0.9))._replace(cord=cord)


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize(("by_position", "by_velocity"), [(1.0, 0.0), (0.0, 1.0), (1.0, 300.0)])
def test_tangent(
    any_pulley: PulleyState, law: ContactLaw, degree: int, follow_zone: bool, by_position: float, by_velocity: float
) -> None:
    pulley = any_pulley
    vectors, rates = sunk(pulley, degree)
    law, basis = law._replace(follow_zone=follow_zone), np.eye(degree + 1)
    work, _ = act(vectors, rates, basis, pulley, law, by_position, by_velocity)
    count, step = degree + 1, 1e-8 if by_position else 1e-5
    tangent = np.block([[work.xx, work.xy], [work.yx, work.yy]])
    columns = []
    for axis in range(2):
        for b in range(count):
            change = np.zeros((count, 2))
            change[b, axis] = step
            there, back = (
                answer(vectors + s * by_position * change, rates + s * by_velocity * change, basis, pulley, law)
                for s in (1.0, -1.0)
            )
            columns.append((there - back) / (2.0 * step))
    found = np.array(columns).T
    forces = np.concatenate([found[:-1:2], found[1:-1:2]])
    size = np.abs(tangent).max()
    np.testing.assert_allclose(tangent, forces, atol=2e-6 * size)  # truncation and rounding of central differences
    np.testing.assert_allclose(work.moment.T.ravel(), found[-1], atol=2e-6 * max(1e-3 * size, abs(found[-1]).max()))


@pytest.mark.parametrize("degree", DEGREES)
def test_derivative_with_respect_to_the_speed(pulley: PulleyState, law: ContactLaw, degree: int) -> None:
    vectors, rates = sunk(pulley, degree)
    basis, step = np.eye(degree + 1), 1e-5
    work, _ = act(vectors, rates, basis, pulley, law, 0.0, 1.0)
    faster, slower = (
        answer(vectors, rates, basis, pulley._replace(speed=pulley.speed + s), law) for s in (step, -step)
    )
    expected = (faster - slower) / (2.0 * step)
    given = np.append(work.by_turn.ravel(), work.moment_by_turn)
    np.testing.assert_allclose(given, expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
@pytest.mark.parametrize("degree", [3, 5])
def test_tangent_of_a_belt_that_flows_through_the_curve(
    any_pulley: PulleyState,
    law: ContactLaw,
    elevate: Callable[[FloatArray, int], FloatArray],
    degree: int,
    follow_zone: bool,
) -> None:
    """Velocities v = de/dt + c D e, D the derivative along the curve: by e, which moves them too, and by c."""
    pulley, basis = any_pulley, np.eye(degree + 1)
    vectors, rates = sunk(pulley, degree)
    along = elevate(degree * np.diff(basis, axis=0), degree) / LENGTH
    law, speed, work = law._replace(follow_zone=follow_zone), 2.0, contact_workspace(*basis.shape)
    factors = ContactFactors(1.0, 300.0, 0.0, speed, 1.0, False)
    contact_force(Curve(vectors, rates, basis, LENGTH), pulley, law, RULE, factors, work)

    def difference(place: FloatArray, motion: FloatArray) -> FloatArray:
        sides = (answer(vectors + sense * place, rates + sense * motion, basis, pulley, law) for sense in (1.0, -1.0))
        return np.asarray(np.subtract(*sides))

    direction, step = np.random.default_rng(6).normal(size=vectors.shape), 1e-8
    x, y = direction.T
    forces = np.stack([work.xx @ x + work.xy @ y, work.yx @ x + work.yy @ y], axis=1)
    expected = np.append(forces.ravel(), np.sum(work.moment * direction))
    moved = difference(step * direction, step * (300.0 * direction + speed * along @ direction)) / (2.0 * step)
    scale = np.append(np.full(2 * degree + 2, np.abs(forces).max()), np.abs(expected[-1]))
    np.testing.assert_allclose(moved / scale, expected / scale, atol=1e-5)
    flow = np.append(work.by_flow.ravel(), work.moment_by_flow)
    by_flow = difference(0.0 * vectors, 1e-5 * along @ vectors) / 2e-5
    np.testing.assert_allclose(flow[:-1], by_flow[:-1], atol=1e-6 * np.abs(by_flow[:-1]).max())
    assert work.moment_by_flow == pytest.approx(by_flow[-1], rel=1e-6)


@pytest.mark.parametrize(("arm_to_rim", "cord"), [(False, 0.0), (True, 0.0), (True, 1.0)], ids=["point", "rim", "cord"])
@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
@pytest.mark.parametrize(("by_angle", "by_speed"), [(1.0, 0.0), (0.0, 1.0), (1.0, 300.0)])
def test_derivative_with_respect_to_the_turning_of_a_shaped_pulley(
    eccentric: Callable[[float], PulleyState],
    law: ContactLaw,
    follow_zone: bool,
    arm_to_rim: bool,
    cord: float,
    by_angle: float,
    by_speed: float,
) -> None:
    def turned(angle: float, speed: float) -> PulleyState:
        return eccentric(angle)._replace(speed=speed, cord=cord)

    angle, step = 0.9, 1e-7
    pulley = turned(angle, eccentric(angle).speed)
    vectors, rates = sunk(pulley, 3)
    law, basis = law._replace(follow_zone=follow_zone, arm_to_rim=arm_to_rim), np.eye(4)
    work, _ = act(vectors, rates, basis, pulley, law, by_angle, by_speed)
    there, back = (
        answer(vectors, rates, basis, turned(angle + s * by_angle, pulley.speed + s * by_speed), law)
        for s in (step, -step)
    )
    expected = (there - back) / (2.0 * step)
    given = np.append(work.by_turn.ravel(), work.moment_by_turn)
    np.testing.assert_allclose(given, expected, atol=1e-6 * np.abs(expected).max())  # truncation and rounding


@pytest.mark.parametrize("turn", [0.0, 0.4, 2.0, 5.0])
def test_an_eccentric_rim_acts_as_a_circle_about_its_own_centre(
    pulley: PulleyState, eccentric: Callable[[float], PulleyState], law: ContactLaw, turn: float
) -> None:
    """Its forces are those of a circle there, which moves; its moment is theirs about the shaft."""
    aside = 4e-3 * np.array([np.cos(turn + 0.3), np.sin(turn + 0.3)])
    pulley = pulley._replace(rolling=0.0)  # which goes by the velocity against the shaft
    moved = pulley._replace(
        center_x=pulley.center_x + aside[0],
        center_y=pulley.center_y + aside[1],
        velocity_x=-pulley.speed * aside[1],
        velocity_y=pulley.speed * aside[0],
    )
    vectors, rates = sunk(moved, 3)
    one, by_rim = act(vectors, rates, np.eye(4), eccentric(turn)._replace(rolling=0.0), law)
    other, by_circle = act(vectors, rates, np.eye(4), moved, law)
    rounding = 1e-9 * np.abs(other.force).max()  # ends of intervals, to 1e-13
    np.testing.assert_allclose(one.force, other.force, atol=rounding)
    about_shaft = by_circle.moment + aside[0] * by_circle.hub_y - aside[1] * by_circle.hub_x
    assert by_rim.moment == pytest.approx(about_shaft, abs=rounding)
    assert by_rim.friction_power == pytest.approx(by_circle.friction_power, rel=1e-9)
    assert by_rim.damping_power == pytest.approx(by_circle.damping_power, rel=1e-9)


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
def test_a_cubic_written_as_a_quintic(
    pulley: PulleyState, law: ContactLaw, elevate: Callable[[FloatArray, int], FloatArray], follow_zone: bool
) -> None:
    """The forces on the same vectors, and their tangent, do not see how the curve is written."""
    vectors, rates = sunk(pulley, 3)
    law, cubic = law._replace(follow_zone=follow_zone), np.eye(4)
    one, totals = act(vectors, rates, cubic, pulley, law, 1.0, 300.0)
    other, raised = act(vectors, rates, elevate(cubic, 5), pulley, law, 1.0, 300.0)
    rounding = 1e-12
    for name in ("force", "by_turn", "moment", *BLOCKS):
        size = np.abs(one[name]).max()
        np.testing.assert_allclose(other[name], one[name], atol=rounding * size, err_msg=name)
    np.testing.assert_allclose(raised, totals, rtol=rounding)


def test_rolling_resistance_takes_its_power_from_the_belt_alone(any_pulley: PulleyState, law: ContactLaw) -> None:
    vectors, rates = sunk(any_pulley, 3)
    rolling, lossy = act(vectors, rates, np.eye(4), any_pulley, law)
    free, plain = act(vectors, rates, np.eye(4), any_pulley._replace(rolling=0.0), law)
    lost = -float(np.sum((rolling.force - free.force) * rates))
    assert lossy.compression_power == pytest.approx(lost)
    assert lost > 0.0
    assert lossy.moment == plain.moment
    assert (lossy.friction_power, plain.compression_power) == (plain.friction_power, 0.0)


@pytest.mark.parametrize("degree", DEGREES)
def test_forces_on_the_vectors_add_up_to_that_on_the_pulley(pulley: PulleyState, law: ContactLaw, degree: int) -> None:
    work, totals = act(*sunk(pulley, degree), np.eye(degree + 1), pulley, law)
    np.testing.assert_allclose(work.force.sum(axis=0), [-totals.hub_x, -totals.hub_y], rtol=1e-12)
    assert totals.penalty_energy > 0.0
    assert totals.friction_power > 0.0


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
@pytest.mark.parametrize("arm_to_rim", [False, True], ids=["point", "rim"])
@pytest.mark.parametrize("speed", [90.0, -90.0])
def test_sums_along_a_chord_are_the_integrals_of_its_laws(
    pulley: PulleyState, law: ContactLaw, speed: float, arm_to_rim: bool, follow_zone: bool
) -> None:
    """A straight belt, 3 mm deep, that is pressed in at 0.5 m/s while the rim slides on it at 9 m/s.

    Lengths count in the unstretched belt, here 80 % of what lies there.  The published rule takes those of its points
    over the whole element that touch.  Air films stay thin: friction would have kinks, which Gauss points miss.
    """
    if isinstance(law.friction, AirFilm):
        law = law._replace(friction=law.friction._replace(roughness=1e-4))
    pulley, law = (
        pulley._replace(speed=speed, rolling=0.0),
        law._replace(arm_to_rim=arm_to_rim, follow_zone=follow_zone),
    )
    height, ends, velocity = 0.097, np.array([-0.05, 0.06]), np.array([0.1, -0.5])
    work = contact_workspace(2, 2)
    control = np.stack([pulley.center_x + ends, np.full(2, pulley.center_y + height)], axis=1)
    curve = Curve(control, np.tile(velocity, (2, 1)), np.eye(2), 0.8 * float(np.ptp(ends)))
    rule = gauss_points(12)
    totals = contact_force(curve, pulley, law, rule, NO_CONTACT_TANGENT, work)

    half = np.sqrt(pulley.surface.radius**2 - height**2)
    if follow_zone:
        places, weights = np.polynomial.legendre.leggauss(40)
        s, share = half * places, 0.8 * half * weights
    else:
        s, share = ends[0] + np.ptp(ends) * rule.points, curve.length * rule.weights
        s, share = s[np.abs(s) < half], share[np.abs(s) < half]
    distance = np.hypot(s, height)
    normal = np.stack([s, np.full(s.size, height)], axis=1) / distance[:, None]
    tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    depth, sinking = pulley.surface.radius - distance, -normal @ velocity
    pressure = law.normal.stiffness * depth + law.normal.damping * sinking
    rim = speed * pulley.surface.radius
    friction = np.array(
        [
            friction_force(law.friction, slip, at, pulley.friction, rim)[0]
            for slip, at in zip(tangent @ velocity - rim, pressure, strict=True)
        ]
    )
    force = pressure[:, None] * normal + friction[:, None] * tangent
    arm = np.full(s.size, pulley.surface.radius) if arm_to_rim else distance
    toward_end = (s - ends[0]) / np.ptp(ends)
    expected = ContactTotals(
        moment=-share @ (arm * friction),
        hub_x=-share @ force[:, 0],
        hub_y=-share @ force[:, 1],
        penalty_energy=share @ (0.5 * law.normal.stiffness * depth**2),
        damping_power=share @ (law.normal.damping * sinking**2),
        friction_power=share @ (friction * (arm * speed - tangent @ velocity)),
        compression_power=0.0,
    )
    np.testing.assert_allclose(totals, expected, rtol=1e-9)
    np.testing.assert_allclose(
        work.force, [(share * (1.0 - toward_end)) @ force, (share * toward_end) @ force], rtol=1e-9
    )
    assert totals.friction_power > 0.0


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
def test_belt_and_pulley_that_move_on_together(pulley: PulleyState, law: ContactLaw, follow_zone: bool) -> None:
    """What one feels of the other depends on their relative motion and place alone."""
    vectors, rates = sunk(pulley, 3)
    law, shift, drift = law._replace(follow_zone=follow_zone), np.array([0.25, -0.5]), np.array([4.0, -7.0])
    moved = pulley._replace(
        center_x=pulley.center_x + 0.25, center_y=pulley.center_y - 0.5, velocity_x=4.0, velocity_y=-7.0
    )
    here, totals = act(vectors, rates, np.eye(4), pulley, law, 1.0, 300.0)
    there, same = act(vectors + shift, rates + drift, np.eye(4), moved, law, 1.0, 300.0)
    for name in ("force", "by_turn", "moment", *BLOCKS):
        np.testing.assert_allclose(there[name], here[name], atol=1e-10 * np.abs(here[name]).max(), err_msg=name)
    np.testing.assert_allclose(same, totals, rtol=1e-10)


def test_without_a_tangent_the_forces_are_the_same(pulley: PulleyState, law: ContactLaw) -> None:
    vectors, rates = sunk(pulley, 3)
    with_it, totals = act(vectors, rates, np.eye(4), pulley, law, 1.0, 300.0)
    without, same = act(vectors, rates, np.eye(4), pulley, law)
    np.testing.assert_array_equal(without.force, with_it.force)
    assert same == totals
    assert not any(np.any(without[name]) for name in ("by_turn", "moment", *BLOCKS))


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
def test_a_record_is_used_again(pulley: PulleyState, law: ContactLaw, follow_zone: bool) -> None:
    """What an element leaves in the arrays, its zone too, does not count for the next one."""
    vectors, rates = sunk(pulley, 3)
    first, totals = act(vectors, rates, np.eye(4), pulley, law._replace(follow_zone=follow_zone), 1.0, 300.0)
    work = contact_workspace(4, 4)
    for left in (work, work.zone):
        for name in set(left.dtype.names or ()) - {"zone"}:
            left[name] = 0.3
    curve = Curve(vectors, rates, np.eye(4), LENGTH)
    again = contact_force(curve, pulley, law._replace(follow_zone=follow_zone), RULE, BOTH, work)
    assert again == totals
    for name in ("force", "by_turn", "moment", "moment_by_turn", *BLOCKS):
        np.testing.assert_array_equal(work[name], first[name])


@pytest.mark.parametrize("depth", [0.0, -1e-12])
def test_a_belt_that_hits_the_rim_meets_the_damper_first(law: ContactLaw, depth: float) -> None:
    """At no penetration the springs are not yet strained; just outside there is no force at all."""
    pulley, speed = PulleyState(0.0, 0.0, Round(1.0), speed=0.0, friction=0.5), 2.0
    control = np.array([[1.0 - depth, -0.01], [1.0 - depth, 0.01]])
    curve = Curve(control, np.tile([-speed, 0.0], (2, 1)), np.eye(2), LENGTH)
    work = contact_workspace(2, 2)
    totals = contact_force(curve, pulley, law._replace(follow_zone=False), gauss_points(1), NO_CONTACT_TANGENT, work)
    damping = law.normal.damping if depth == 0.0 else 0.0
    assert -totals.hub_x == pytest.approx(damping * speed * LENGTH)
    assert totals.damping_power == pytest.approx(damping * speed**2 * LENGTH)
    assert totals.penalty_energy == 0.0


def test_an_element_that_touches_all_along_is_its_own_zone(pulley: PulleyState, law: ContactLaw) -> None:
    vectors, rates = sunk(pulley, 3)
    out = vectors - [pulley.center_x, pulley.center_y]
    vectors = vectors - 0.1 * out  # 9 mm deeper
    zone, whole = (
        act(vectors, rates, np.eye(4), pulley, law._replace(follow_zone=follow), 1.0, 300.0) for follow in (True, False)
    )
    assert zone[1] == whole[1]
    assert whole[1].penalty_energy > 0.0
    for name in ("force", "by_turn", "moment", *BLOCKS):
        np.testing.assert_array_equal(zone[0][name], whole[0][name])


@pytest.mark.parametrize(
    "depths", [(-4.0, 6.0), (6.0, -4.0), (6.0, 6.0), (-4.0, -4.0)], ids=["in", "out", "all", "dip"]
)
@pytest.mark.parametrize(("by_position", "by_velocity"), [(1.0, 0.0), (1.0, 300.0)])
def test_tangent_along_a_direction_where_either_end_is_inside(
    pulley: PulleyState, law: ContactLaw, depths: tuple[float, float], by_position: float, by_velocity: float
) -> None:
    """Ends of an element that belong to its zone stay where they are; those of the zone within the element move."""
    vectors, rates = sunk(pulley, 3)
    out = vectors - [pulley.center_x, pulley.center_y]
    vectors = vectors - np.linspace(*depths, 4)[:, None] * 1e-3 * out / pulley.surface.radius
    work, _ = act(vectors, rates, np.eye(4), pulley, law, by_position, by_velocity)
    ends = work.zone.intervals[0]
    assert (ends[0] == 0.0, ends[1] == 1.0) == (depths[0] > 0.0, depths[1] > 0.0)
    direction, step = np.random.default_rng(3).normal(size=(4, 2)), 1e-8
    there, back = (
        answer(vectors + s * by_position * direction, rates + s * by_velocity * direction, np.eye(4), pulley, law)
        for s in (step, -step)
    )
    x, y = direction.T
    forces = np.stack([work.xx @ x + work.xy @ y, work.yx @ x + work.yy @ y], axis=1)
    expected = np.append(forces.ravel(), np.sum(work.moment * direction))
    scale = np.append(np.full(8, np.abs(forces).max()), 1e-3 * np.abs(forces).max())
    np.testing.assert_allclose((there - back) / (2.0 * step) / scale, expected / scale, atol=1e-5)

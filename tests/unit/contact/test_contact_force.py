"""Contact forces of a curve of any degree (Eq. 24): tangent against differences, elevation of the degree, balance."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Curve
from beltdyn.contact.contact_force import ContactTotals, contact_force, contact_workspace
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.quadrature import gauss_points

DEGREES = [1, 3, 5]
RULE = gauss_points(6)
LENGTH = 0.06
BLOCKS = ("xx", "xy", "yx", "yy")


def sunk(pulley: PulleyState, degree: int) -> tuple[FloatArray, FloatArray]:
    """Control points of a curve that enters a pulley, 2 mm deep, and their velocities; creeping and sliding."""
    along = np.linspace(-0.6, 0.6, degree + 1)
    wave = 1e-3 * np.cos(7.0 * np.arange(degree + 1))
    out = np.stack([np.cos(along), np.sin(along)], axis=1)
    center = np.array([pulley.center_x, pulley.center_y])
    control = center + (pulley.radius + wave + 0.002 * np.arange(degree + 1) / degree)[:, None] * out
    velocity = pulley.radius * pulley.speed * np.stack([-out[:, 1], out[:, 0]], axis=1)
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
    totals = contact_force(curve, pulley, law, RULE, by_position, by_velocity, work)
    return work, totals


def answer(*arguments: Any) -> FloatArray:
    """Forces on the vectors, then the moment on the pulley."""
    work, totals = act(*arguments)
    return np.append(work.force.ravel(), totals.moment)


@pytest.mark.parametrize("follow_zone", [True, False], ids=["zone", "whole"])
@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize(("by_position", "by_velocity"), [(1.0, 0.0), (0.0, 1.0), (1.0, 300.0)])
def test_tangent(
    pulley: PulleyState, law: ContactLaw, degree: int, follow_zone: bool, by_position: float, by_velocity: float
) -> None:
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
    work, totals = act(vectors, rates, basis, pulley, law, 0.0, 1.0)
    faster, slower = (
        answer(vectors, rates, basis, pulley._replace(speed=pulley.speed + s), law) for s in (step, -step)
    )
    expected = (faster - slower) / (2.0 * step)
    given = np.append(work.by_speed.ravel(), totals.moment_by_speed)
    np.testing.assert_allclose(given, expected, atol=1e-6 * np.abs(expected).max())


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
    for name in ("force", "by_speed", "moment", *BLOCKS):
        size = np.abs(one[name]).max()
        np.testing.assert_allclose(other[name], one[name], atol=rounding * size, err_msg=name)
    np.testing.assert_allclose(raised, totals, rtol=rounding)


@pytest.mark.parametrize("degree", DEGREES)
def test_forces_on_the_vectors_add_up_to_that_on_the_pulley(pulley: PulleyState, law: ContactLaw, degree: int) -> None:
    work, totals = act(*sunk(pulley, degree), np.eye(degree + 1), pulley, law)
    np.testing.assert_allclose(work.force.sum(axis=0), [-totals.hub_x, -totals.hub_y], rtol=1e-12)
    assert totals.penalty_energy > 0.0
    assert totals.friction_power > 0.0

"""The assembled tangent against central differences of the residual, in real contact and for every law and joint."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.system.arrays import NO_TANGENT, Equations, RingMatrix, System, TangentFactors
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import assemble, border_size, new_equations

Dense = Callable[[RingMatrix, bool], tuple[FloatArray, FloatArray]]
MULTIPLIERS = np.array([9.0, -4.0, 0.3, 0.2, -0.1, 0.5])
STEP = 1e-8
"""m; rounding and truncation of central differences are then both near 1e-8 of the largest entry."""


@pytest.fixture
def equations(system: System) -> Equations:
    return new_equations(system)


@pytest.fixture
def linear(system: System, equations: Equations, dense: Dense) -> Callable[..., tuple[FloatArray, FloatArray]]:
    """Dense tangent and residual at a state."""

    def at(
        state: State, multipliers: FloatArray, factors: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> tuple[FloatArray, FloatArray]:
        assemble(system, state.at(0.3), multipliers, TangentFactors(*factors), equations)
        return dense(equations.matrix, system.closed)

    return at


@pytest.mark.parametrize(
    "factors",
    [(1.0, 0.0, 1e-9), (0.0, 1.0, 1e-9), (0.0, 0.0, 1.0), (1.0, 2e3, 1e6)],
    ids=["position", "velocity", "acceleration", "step"],
)
def test_tangent(
    system: System,
    moving: State,
    scale: FloatArray,
    linear: Callable[..., tuple[FloatArray, FloatArray]],
    factors: tuple[float, float, float],
) -> None:
    tangent = linear(moving, MULTIPLIERS, factors)[0]
    unknowns = np.concatenate(
        [np.arange(system.first_body), system.first_body + np.flatnonzero(system.bodies.unknown >= 0)]
    )
    step = STEP / max(factors[0], factors[1] / 1e3, factors[2] / 1e6)

    def residual(unknown: int, side: float) -> FloatArray:
        change = np.zeros_like(scale)
        change[unknown] = side * step * scale[unknown]
        moved = State(
            moving.position + factors[0] * change,
            moving.velocity + factors[1] * change,
            moving.acceleration + factors[2] * change,
        )
        return np.asarray(linear(moved, MULTIPLIERS)[1])

    found = [(residual(k, 1.0) - residual(k, -1.0)) / (2 * step * scale[k]) for k in unknowns]
    rounding = 1e-7 * np.max(np.abs(tangent))
    np.testing.assert_allclose(tangent[:, : len(unknowns)], np.transpose(found), atol=rounding, rtol=0)


def test_residual_is_linear_in_the_multipliers(
    system: System, moving: State, linear: Callable[..., tuple[FloatArray, FloatArray]]
) -> None:
    tangent, with_them = linear(moving, MULTIPLIERS, (0.0, 0.0, 1.0))
    without = linear(moving, 0.0 * MULTIPLIERS)[1]
    ties = len(MULTIPLIERS)
    columns = tangent[:, tangent.shape[1] - ties :] if system.joint else np.zeros((tangent.shape[0], ties))
    np.testing.assert_allclose(with_them - without, columns @ MULTIPLIERS, atol=1e-9)  # rounding of 1e5 N


def test_residual_alone_keeps_the_tangent(
    system: System, moving: State, linear: Callable[..., tuple[FloatArray, FloatArray]]
) -> None:
    tangent, residual = linear(moving, MULTIPLIERS, (1.0, 2e3, 1e6))
    kept, alone = linear(moving, MULTIPLIERS)
    np.testing.assert_array_equal(kept, tangent)
    np.testing.assert_allclose(alone, residual, rtol=1e-12, atol=1e-12 * np.abs(residual).max())


def test_border(system: System) -> None:
    assert border_size(system) == (7 if system.joint else 1)


def test_belt_and_hubs_push_each_other(system: System, moving: State, equations: Equations) -> None:
    """Elastic forces balance within the belt: what its residual lacks at rest is the force on the hubs."""
    steady = State(moving.position, moving.velocity, 0.0 * moving.acceleration)
    assemble(system, steady.at(0.3), 0.0 * MULTIPLIERS, NO_TANGENT, equations)
    hubs = equations.forces.hub.sum(axis=0)
    assert np.linalg.norm(hubs) > 1.0
    forces = equations.matrix.node_side.reshape(system.points * system.nodes, -1)[:, :2]
    np.testing.assert_allclose(forces.sum(axis=0), hubs, rtol=1e-9, atol=1e-8)

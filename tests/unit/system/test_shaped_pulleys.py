"""Pulleys with surfaces that turn with them, in the assembled equations of a drive."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.surface import RoundRims, ShapedRims
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Path, prepare
from beltdyn.system.arrays import NO_TANGENT, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.build import drive_system
from beltdyn.system.state import State, laid
from beltdyn.system.steady_assembly import assemble, new_equations

ECCENTRIC = {"kind": "eccentric", "eccentricity": "1 mm", "eccentric_angle": 0.4}


def shaped(drive: Drive, *surfaces: object) -> Drive:
    pulleys = [pulley.replace(surface=surface) for pulley, surface in zip(drive.pulleys, surfaces, strict=True)]
    return drive.replace(pulley=pulleys)


@pytest.fixture(scope="module", params=["zone", "fixed"])
def drive_of(request: pytest.FixtureRequest, make_drive: Callable[..., Drive]) -> Drive:
    return make_drive("force_slope", request.param)


@pytest.fixture
def turned(drive_of: Drive) -> tuple[System, State]:
    """Both pulleys are eccentric, have turned, and creep; the belt is 0.3 mm deep and shaken."""
    system = drive_system(prepare(shaped(drive_of, ECCENTRIC, ECCENTRIC)))
    state = laid(system, Path(system.pulleys.center, system.pulleys.radius - 3e-4))
    noise = np.random.default_rng(3).normal(size=(2, system.first_body)) * np.tile(
        1.0 / np.array(system.scale), system.nodes
    )
    position, velocity = state.position.copy(), state.velocity.copy()
    position[: system.first_body] += 1e-4 * noise[0]
    velocity[: system.first_body] += 0.1 * noise[1]
    position[system.first_body :] += [0.7, -1.1]
    velocity[system.first_body :] = [3.0, 2.0]
    return system, State(position, velocity, 0.0 * position)


def test_only_a_drive_with_a_shaped_pulley_knows_of_shapes(drive_of: Drive) -> None:
    circle = {"kind": "circle"}
    assert isinstance(drive_system(prepare(drive_of)).rims, RoundRims)
    assert isinstance(drive_system(prepare(shaped(drive_of, None, circle))).rims, RoundRims)
    rims = drive_system(prepare(shaped(drive_of, None, ECCENTRIC))).rims
    assert isinstance(rims, ShapedRims)
    assert rims.table.eccentric.eccentricity[1] == 1e-3
    np.testing.assert_array_equal(rims.table.reach, [0.0, 1e-3])


@pytest.mark.slow
@pytest.mark.parametrize("factors", [(1.0, 0.0), (0.0, 1.0), (1.0, 2e3)], ids=["angle", "speed", "step"])
def test_tangent_by_the_angle_of_the_driven_pulley(
    turned: tuple[System, State],
    dense: Callable[[RingMatrix, bool], tuple[FloatArray, FloatArray]],
    factors: tuple[float, float],
) -> None:
    system, state = turned
    equations, driven, step = new_equations(system), system.first_body + 1, 1e-8

    def linear(side: float, wanted: TangentFactors = NO_TANGENT) -> tuple[FloatArray, FloatArray]:
        position, velocity = state.position.copy(), state.velocity.copy()
        position[driven] += side * step * factors[0]
        velocity[driven] += side * step * factors[1]
        motion = Motion(0.3, position, velocity, state.acceleration)
        assemble(system, motion, np.zeros(len(system.scale)), wanted, equations)
        return dense(equations.matrix, system.closed)

    found = (linear(1.0)[1] - linear(-1.0)[1]) / (2.0 * step)
    column = linear(0.0, TangentFactors(*factors))[0][:, -1]
    np.testing.assert_allclose(column, found, atol=1e-5 * np.abs(found).max())  # rounding of 1e2 N over the step


def test_a_surface_that_reaches_the_shaft_is_refused(drive_of: Drive) -> None:
    with pytest.raises(ModelError, match=r"deviates by 0\.09 m"):
        drive_of.pulleys[0].replace(surface={"kind": "eccentric", "eccentricity": 0.09})

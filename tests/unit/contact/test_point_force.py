"""Contact force at a point (Eqs. 17-22): its parts, and its tangent against central differences."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction import AirFilm, ForceSlope
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.normal import Published
from beltdyn.contact.penetration import Approach, approach, slip_velocity
from beltdyn.contact.point_force import point_force, point_tangent

Place = Callable[[PulleyState, float, float], tuple[float, float]]
CASES = {
    "creeping": (1e-3, 0.5, (0.1, 0.02)),
    "sliding": (1e-3, 2.0, (3.0, -2.0)),
    "sliding back": (1e-3, -2.5, (-3.0, 4.0)),
    "leaving fast": (1e-5, 0.3, (3.0, 1.0)),
    "free": (-1e-3, 0.3, (3.0, 1.0)),
}


@pytest.fixture(params=[0.0, 1.0], ids=["at the rim", "at the cord"])
def pulley(request: pytest.FixtureRequest, pulley: PulleyState) -> PulleyState:
    """With slip at either radius."""
    return pulley._replace(cord=request.param)


@pytest.fixture(params=list(CASES.values()), ids=list(CASES))
def state(request: pytest.FixtureRequest, pulley: PulleyState, place: Place) -> FloatArray:
    """Position and velocity of a point, shape (4,)."""
    penetration, angle, velocity = request.param
    return np.array([*place(pulley, penetration, angle), *velocity])


@pytest.fixture(params=[(False, False), (True, False), (False, True)], ids=["no_pull", "published", "rim"])
def every_law(request: pytest.FixtureRequest, law: ContactLaw) -> ContactLaw:
    """Either normal law and either arm of friction, with either friction law."""
    may_pull, arm_to_rim = request.param
    return law._replace(normal=Published(1e6, 40.0) if may_pull else law.normal, arm_to_rim=arm_to_rim)


def point(state: FloatArray, pulley: PulleyState) -> Approach:
    x, y, velocity_x, velocity_y = state
    return approach(x, y, velocity_x, velocity_y, pulley)


def act(state: FloatArray, pulley: PulleyState, law: ContactLaw) -> FloatArray:
    """Force and moment."""
    here = point(state, pulley)
    force = point_force(here, pulley, law)
    return np.array([force.x, force.y, force.moment])


def difference(state: FloatArray, change: FloatArray, pulley: PulleyState, law: ContactLaw) -> FloatArray:
    return np.asarray((act(state + change, pulley, law) - act(state - change, pulley, law)) / 2)


def test_force_is_made_of_normal_and_friction(state: FloatArray, pulley: PulleyState, every_law: ContactLaw) -> None:
    here = point(state, pulley)
    force = point_force(here, pulley, every_law)
    normal, tangent = (here.normal_x, here.normal_y), (-here.normal_y, here.normal_x)
    assert force.x * normal[0] + force.y * normal[1] == pytest.approx(force.normal.force, abs=1e-10)
    along = force.friction + force.rolling.force
    assert force.x * tangent[0] + force.y * tangent[1] == pytest.approx(along, abs=1e-10)
    assert abs(force.friction) <= pulley.friction * abs(force.normal.force) * (1 + 1e-15)


def test_secant_of_friction_reaches_back_to_no_slip(
    state: FloatArray, pulley: PulleyState, every_law: ContactLaw
) -> None:
    here = point(state, pulley)
    force, secant = (point_force(here, pulley, every_law, wanted) for wanted in (False, True))
    assert secant.by_slip * slip_velocity(here, pulley) == pytest.approx(force.friction, rel=1e-14)
    assert secant._replace(by_slip=force.by_slip) == force  # the force itself is the same
    full = float(every_law.friction.saturation(force.normal.force, pulley.friction, 1.0))
    faster = pulley._replace(speed=pulley.speed + max(100.0, 100.0 * full / pulley.surface.radius))
    force, secant = (point_force(point(state, faster), faster, every_law, wanted) for wanted in (False, True))
    slides = force.by_slip >= 0.0  # by its slope nothing would hold the belt, but for the air that it draws in
    assert slides or isinstance(every_law.friction, AirFilm)
    assert secant.by_slip < 0.0 or force.friction == 0.0


@pytest.mark.parametrize(("by_position", "by_velocity"), [(1.0, 0.0), (0.0, 1.0), (1.0, 250.0)])
def test_tangent(
    state: FloatArray, pulley: PulleyState, every_law: ContactLaw, by_position: float, by_velocity: float
) -> None:
    here = point(state, pulley)
    tangent = point_tangent(here, point_force(here, pulley, every_law), pulley.speed, by_position, by_velocity)
    columns, step = [], 1e-9 if by_position else 1e-6
    for axis in range(2):
        change = np.zeros(4)
        change[axis], change[2 + axis] = step * by_position, step * by_velocity
        columns.append(difference(state, change, pulley, every_law) / step)
    given = [[tangent.xx, tangent.xy], [tangent.yx, tangent.yy], [tangent.moment_x, tangent.moment_y]]
    scale = every_law.normal.stiffness * by_position + every_law.normal.damping * by_velocity
    np.testing.assert_allclose(given, np.array(columns).T, atol=1e-6 * scale)  # rounding of 1e3 N/m over the step


def test_tangent_with_respect_to_the_speed_of_the_pulley(
    state: FloatArray, pulley: PulleyState, every_law: ContactLaw
) -> None:
    here = point(state, pulley)
    force = point_force(here, pulley, every_law)
    by_speed = force.by_speed - force.by_slip * here.rim
    faster, slower = (act(state, pulley._replace(speed=pulley.speed + s), every_law) for s in (1e-5, -1e-5))
    expected = np.array([-here.normal_y, here.normal_x, -force.arm]) * by_speed
    np.testing.assert_allclose(
        (faster - slower) / 2e-5, expected, atol=1e-6 * (300.0 if isinstance(every_law.friction, ForceSlope) else 0.4)
    )  # rounding over the step


def test_a_solid_roller_gives_way_in_series(state: FloatArray, pulley: PulleyState, every_law: ContactLaw) -> None:
    """The foundation bears K d + c dd/dt with d less A f^2; energy and tangent go along."""
    soft = pulley._replace(foundation=0.5, damping=2.0, hertz=1e-9)
    plain = soft._replace(hertz=0.0)
    here = point(state, soft)
    force, without = point_force(here, soft, every_law).normal, point_force(here, plain, every_law).normal
    if without.force <= 0.0:
        assert force.force == without.force
        return
    stiffness = 0.5 * every_law.normal.stiffness
    assert force.force / stiffness + 1e-9 * force.force**2 == pytest.approx(without.force / stiffness, rel=1e-12)
    deeper = point_force(here._replace(penetration=here.penetration * (1.0 + 1e-6)), soft, every_law).normal
    step = 1e-6 * here.penetration
    assert (deeper.force - force.force) / step == pytest.approx(force.by_penetration, rel=1e-5)
    assert (deeper.energy - force.energy) / step == pytest.approx(force.elastic, rel=1e-5)
    faster = point_force(here._replace(radial=here.radial - 1e-6), soft, every_law).normal
    assert (faster.force - force.force) / 1e-6 == pytest.approx(force.by_rate, rel=1e-4)


def test_a_belt_that_stays_compressed_lets_go_early(state: FloatArray, pulley: PulleyState, law: ContactLaw) -> None:
    """Where it leaves, K' (d - set) with K' = K / (1 - set / peak) in place of K d; the rest is lost."""
    deep = float(np.abs(point(state, pulley).penetration))
    lasting, rest = 0.2 * deep, pulley._replace(damping=0.0)
    here = point(state, pulley)._replace(penetration=deep)
    whole = point_force(here, rest, law).normal
    kept = point_force(here, rest._replace(lasting=lasting, unloading=1.25), law).normal
    assert kept.force == pytest.approx(whole.force)
    half = here._replace(penetration=0.5 * deep)
    given = point_force(half, rest._replace(lasting=lasting, unloading=1.25), law).normal
    leaves = here.radial > 0.0
    assert given.force == pytest.approx(whole.force * (1.25 * 0.3 if leaves else 0.5))
    assert given.elastic == pytest.approx(0.5 * whole.force)
    gone = here._replace(penetration=0.1 * deep)
    left = point_force(gone, rest._replace(lasting=lasting, unloading=1.25), law).normal
    assert (left.force == 0.0) == leaves

"""The moment on a pulley (Eq. 23): as the cross product of arm and force, with the arm of the point, R - d."""

from collections.abc import Callable

import pytest

from beltdyn.contact.law import ContactLaw, Wheel
from beltdyn.contact.penetration import approach
from beltdyn.contact.point_force import point_force
from beltdyn.contact.pulley_moment import pulley_moment

Place = Callable[[Wheel, float, float], tuple[float, float]]


@pytest.mark.parametrize("angle", [0.0, 1.0, 3.0, -2.0])
@pytest.mark.parametrize("velocity", [(0.0, 0.0), (2.0, -1.0), (-0.5, 0.6)])
def test_is_the_moment_of_the_reaction(
    wheel: Wheel, law: ContactLaw, place: Place, angle: float, velocity: tuple[float, float]
) -> None:
    x, y = place(wheel, 2e-3, angle)
    here = approach(x, y, *velocity, wheel)
    force = point_force(here, wheel, law)
    arm_x, arm_y = x - wheel.center_x, y - wheel.center_y
    moment = pulley_moment(force.arm, force.friction)
    assert moment == pytest.approx(-(arm_x * force.y - arm_y * force.x), rel=1e-12)
    assert moment == pytest.approx(-(wheel.radius - 2e-3) * force.friction, rel=1e-12)


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (2.0, -1.0), (-0.5, 0.6), (-0.02, 0.01)])
def test_with_the_arm_to_the_rim_friction_never_gives_energy(
    wheel: Wheel, law: ContactLaw, place: Place, velocity: tuple[float, float]
) -> None:
    here = approach(*place(wheel, 2e-3, 1.0), *velocity, wheel)
    force = point_force(here, wheel, law._replace(arm_to_rim=True))
    moment = pulley_moment(force.arm, force.friction)
    assert moment == -wheel.radius * force.friction
    assert force.friction * here.circumferential + moment * wheel.speed <= 0.0

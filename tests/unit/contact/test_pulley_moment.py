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
    assert pulley_moment(here, force.friction) == pytest.approx(-(arm_x * force.y - arm_y * force.x), rel=1e-12)
    assert pulley_moment(here, force.friction) == pytest.approx(-(wheel.radius - 2e-3) * force.friction, rel=1e-12)

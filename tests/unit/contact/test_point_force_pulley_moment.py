"""The moment on a pulley (Eq. 23): as the cross product of arm and force, with the arm of the point, R - d."""

from collections.abc import Callable

import pytest

from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.penetration import approach
from beltdyn.contact.point_force import point_force

Place = Callable[[PulleyState, float, float], tuple[float, float]]


@pytest.mark.parametrize("angle", [0.0, 1.0, 3.0, -2.0])
@pytest.mark.parametrize("velocity", [(0.0, 0.0), (2.0, -1.0), (-0.5, 0.6)])
def test_is_the_moment_of_the_reaction(
    pulley: PulleyState, law: ContactLaw, place: Place, angle: float, velocity: tuple[float, float]
) -> None:
    """But for rolling resistance, which acts on the shaft."""
    x, y = place(pulley, 2e-3, angle)
    here = approach(x, y, *velocity, pulley)
    force = point_force(here, pulley._replace(rolling=0.0), law)
    arm_x, arm_y = x - pulley.center_x, y - pulley.center_y
    moment = force.moment
    assert moment == pytest.approx(-(arm_x * force.y - arm_y * force.x), rel=1e-12)
    assert moment == pytest.approx(-(pulley.surface.radius - 2e-3) * force.friction, rel=1e-12)


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (2.0, -1.0), (-0.5, 0.6), (-0.02, 0.01)])
@pytest.mark.parametrize("cord", [0.0, 1.0])
def test_with_the_arm_of_slip_friction_never_gives_energy(
    pulley: PulleyState, law: ContactLaw, place: Place, velocity: tuple[float, float], cord: float
) -> None:
    pulley = pulley._replace(cord=cord)
    here = approach(*place(pulley, 2e-3, 1.0), *velocity, pulley)
    force = point_force(here, pulley, law._replace(arm_to_rim=True))
    moment = force.moment
    assert moment == pytest.approx(-(pulley.surface.radius - cord * 2e-3) * force.friction)
    assert force.friction * here.circumferential + moment * pulley.speed <= 0.0


def test_rolling_resistance_does_not_turn_the_pulley(pulley: PulleyState, law: ContactLaw, place: Place) -> None:
    here = approach(*place(pulley, 2e-3, 1.0), 2.0, -1.0, pulley)
    free, held = (point_force(here, pulley._replace(rolling=share), law) for share in (0.0, 0.02))
    assert held.moment == free.moment
    assert (held.x, held.y) != (free.x, free.y)

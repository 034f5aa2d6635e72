"""Distance, penetration, normal and slip velocity of a point (Eqs. 18, 19, 21 and 22) against their definitions."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.contact.law import PulleyState
from beltdyn.contact.penetration import Approach, approach, slip_velocity, tooth_approach

Place = Callable[[PulleyState, float, float], tuple[float, float]]


@given(st.floats(-0.05, 0.05), st.floats(-7.0, 7.0), st.floats(-9.0, 9.0), st.floats(-9.0, 9.0))
def test_frame_of_a_point(
    pulley: PulleyState, place: Place, penetration: float, angle: float, radial: float, around: float
) -> None:
    normal, tangent = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    x, y = place(pulley, penetration, angle)
    velocity_x, velocity_y = radial * normal + around * tangent
    here = approach(x, y, velocity_x, velocity_y, pulley)
    rounding = 1e-13
    assert here.penetration == pytest.approx(penetration, abs=rounding)
    assert here.lever == pytest.approx(pulley.surface.radius - penetration, abs=rounding)
    np.testing.assert_allclose([here.normal_x, here.normal_y], normal, atol=rounding)
    np.testing.assert_allclose([here.radial, here.circumferential], [radial, around], atol=20 * rounding)


def test_penetration_grows_against_the_radial_velocity(pulley: PulleyState, place: Place) -> None:
    x, y = place(pulley, 1e-3, 0.4)
    velocity, step = (0.3, -0.8), 1e-6
    before, after = (
        approach(x + s * velocity[0], y + s * velocity[1], *velocity, pulley).penetration for s in (-step, step)
    )
    assert (after - before) / (2 * step) == pytest.approx(-approach(x, y, *velocity, pulley).radial, rel=1e-8)


def test_a_rim_point_that_turns_with_the_pulley_does_not_slip(pulley: PulleyState, place: Place) -> None:
    x, y = place(pulley, 0.0, 2.0)
    velocity = -pulley.speed * (y - pulley.center_y), pulley.speed * (x - pulley.center_x)
    assert slip_velocity(approach(x, y, *velocity, pulley), pulley) == pytest.approx(0.0, abs=1e-14)


def test_slip_is_measured_against_the_rim_at_any_depth(pulley: PulleyState, place: Place) -> None:
    here = approach(*place(pulley, 0.02, 2.0), 0.0, 0.0, pulley)
    assert slip_velocity(here, pulley) == -pulley.speed * pulley.surface.radius


@pytest.mark.parametrize("kind", [approach, tooth_approach])
def test_only_the_motion_against_the_centre_counts(
    pulley: PulleyState, place: Place, kind: Callable[..., Approach]
) -> None:
    x, y = place(pulley, 1e-3, 0.4)
    still = kind(x, y, 0.3, -0.8, pulley)
    moving = kind(x, y, 0.3 + 2.0, -0.8 - 5.0, pulley._replace(velocity_x=2.0, velocity_y=-5.0))
    np.testing.assert_allclose(moving, still, rtol=1e-12)

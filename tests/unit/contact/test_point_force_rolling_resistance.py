"""Rolling resistance: its size at speed, its sign, and its derivatives against differences."""

import pytest

from beltdyn.contact.point_force import CREEPING, rolling_resistance

RHO = 0.02


@pytest.mark.parametrize("normal", [0.5, 500.0])
@pytest.mark.parametrize("velocity", [-30.0, -1.0, 1.0, 30.0])
def test_a_share_of_the_normal_force_at_any_speed(velocity: float, normal: float) -> None:
    """Less by v_0^2 / 2 v^2."""
    found = rolling_resistance(RHO, normal, velocity).force
    assert found == pytest.approx(-RHO * normal * (1.0 if velocity > 0.0 else -1.0), rel=(CREEPING / velocity) ** 2)


@pytest.mark.parametrize("velocity", [-3.0, -0.01, 0.0, 0.02, 3.0])
def test_it_never_gives_power(velocity: float) -> None:
    assert rolling_resistance(RHO, 500.0, velocity).force * velocity <= 0.0


@pytest.mark.parametrize(("coefficient", "normal"), [(0.0, 500.0), (RHO, 0.0), (RHO, -5.0)])
def test_none_without_a_coefficient_or_pressure(coefficient: float, normal: float) -> None:
    assert rolling_resistance(coefficient, normal, 3.0) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("velocity", [-0.03, 0.0, 0.004, 0.02, 3.0])
def test_derivatives(velocity: float) -> None:
    step, found = 1e-6, rolling_resistance(RHO, 500.0, velocity)
    there, back = (rolling_resistance(RHO, 500.0, velocity + s).force for s in (step, -step))
    assert found.by_velocity == pytest.approx((there - back) / (2.0 * step), rel=1e-4, abs=1e-6)
    assert found.by_normal * 500.0 == pytest.approx(found.force)

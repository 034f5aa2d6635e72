"""Both friction laws (Eq. 20, Fig. 3; Leamy and Wasfy 2002): odd, capped, continuous, with exact derivatives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.contact.friction import FrictionParameters, friction_force

MU = 0.5
SLIPS = st.floats(-5.0, 5.0)
NORMALS = st.floats(0.0, 1e4)


def force_at(law: FrictionParameters, slip: float, normal: float) -> tuple[float, float, float]:
    return friction_force(law, slip, normal, MU)


def break_away(law: FrictionParameters, normal: float) -> float:
    """Slip velocity at which the Coulomb limit is reached, as the law tells it."""
    return float(law.saturation(normal, MU))


@given(SLIPS, NORMALS)
def test_is_odd(friction: FrictionParameters, slip: float, normal: float) -> None:
    there, back = force_at(friction, slip, normal), force_at(friction, -slip, normal)
    assert back == (-there[0], there[1], -there[2])


@given(SLIPS, NORMALS)
def test_opposes_slip_within_the_coulomb_limit(friction: FrictionParameters, slip: float, normal: float) -> None:
    force = force_at(friction, slip, normal)[0]
    assert force * slip <= 0.0
    assert abs(force) <= MU * normal * (1 + 1e-15)


@given(st.floats(-10.0, 10.0), st.floats(0.1, 1e4))
def test_equals_its_clipped_line(friction: FrictionParameters, ratio: float, normal: float) -> None:
    force = force_at(friction, ratio * break_away(friction, normal), normal)[0]
    assert force == pytest.approx(-MU * normal * np.clip(ratio, -1, 1), rel=1e-12)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_has_no_jump_at_break_away(friction: FrictionParameters, side: float) -> None:
    edge = side * break_away(friction, 200.0)
    below, above = (force_at(friction, edge * factor, 200.0)[0] for factor in (1 - 1e-12, 1 + 1e-12))
    assert above == pytest.approx(below, rel=1e-11)


@pytest.mark.parametrize("ratio", [-3.0, -0.9, -0.1, 0.0, 0.4, 0.99, 1.01, 2.0])
def test_derivatives(friction: FrictionParameters, ratio: float) -> None:
    normal, share = 200.0, 1e-6
    slip = ratio * break_away(friction, normal)
    _, by_slip, by_normal = force_at(friction, slip, normal)

    def difference(d_slip: float, d_normal: float) -> float:
        return (
            force_at(friction, slip + d_slip, normal + d_normal)[0]
            - force_at(friction, slip - d_slip, normal - d_normal)[0]
        )

    rounding = 1e-8  # 1e-16 over the step
    assert difference(share, 0.0) / (2 * share) == pytest.approx(by_slip, rel=rounding, abs=1e-5)
    assert difference(0.0, share) / (2 * share) == pytest.approx(by_normal, rel=rounding, abs=1e-5)


@given(SLIPS, NORMALS)
def test_depends_on_the_magnitude_of_the_normal_force(friction: FrictionParameters, slip: float, normal: float) -> None:
    pushed, pulled = force_at(friction, slip, normal), force_at(friction, slip, -normal)
    assert pulled[:2] == pushed[:2]
    assert abs(pulled[2]) == abs(pushed[2])
    if normal > 0.0:
        assert pulled[2] == -pushed[2]

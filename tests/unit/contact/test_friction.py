"""Friction laws (Eq. 20, Fig. 3; Leamy and Wasfy 2002; relative creep): odd, capped, continuous, exact derivatives."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.contact.friction import (
    AirFilm,
    CommonFriction,
    FrictionParameters,
    RelativeCreep,
    as_common,
    friction_force,
)
from beltdyn.contact.friction.law import saturation_at

MU = 0.5
RIM = 0.8
"""Speed of the rim, m/s."""
IN_COMMON = {type(one) for one in CommonFriction(0)[1:]}
SLIPS = st.floats(-5.0, 5.0)
NORMALS = st.floats(0.0, 1e4)


def force_at(
    law: FrictionParameters, slip: float, normal: float, rim: float = RIM
) -> tuple[float, float, float, float]:
    return friction_force(law, slip, normal, MU, rim)


def break_away(law: FrictionParameters, normal: float) -> float:
    """Slip velocity at which the Coulomb limit is reached, as the law tells it."""
    return float(law.saturation(normal, MU, RIM))


@given(SLIPS, NORMALS)
def test_is_odd(friction: FrictionParameters, slip: float, normal: float) -> None:
    """With slip and rim reversed; where no film is drawn in, with the slip alone as well."""
    there, back = force_at(friction, slip, normal), force_at(friction, -slip, normal, -RIM)
    assert back == (-there[0], there[1], -there[2], there[3])
    if not isinstance(friction, AirFilm):
        assert force_at(friction, -slip, normal) == (-there[0], there[1], -there[2], -there[3])


@given(SLIPS, NORMALS)
def test_opposes_slip_within_the_coulomb_limit(friction: FrictionParameters, slip: float, normal: float) -> None:
    force = force_at(friction, slip, normal)[0]
    assert force * slip <= 0.0
    assert abs(force) <= MU * normal * (1 + 1e-15)


@pytest.mark.parametrize("friction", ["coefficient_slope", "force_slope", "relative_creep"], indirect=True)
@given(ratio=st.floats(-10.0, 10.0), normal=st.floats(0.1, 1e4))
def test_equals_its_clipped_line(friction: FrictionParameters, ratio: float, normal: float) -> None:
    force = force_at(friction, ratio * break_away(friction, normal), normal)[0]
    assert force == pytest.approx(-MU * normal * np.clip(ratio, -1, 1), rel=1e-12)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_has_no_jump_at_break_away(friction: FrictionParameters, side: float) -> None:
    edge = side * break_away(friction, 200.0)
    below, above = (force_at(friction, edge * factor, 200.0)[0] for factor in (1 - 1e-12, 1 + 1e-12))
    assert above == pytest.approx(below, rel=1e-11)


@pytest.mark.parametrize("states", [(), (2,)])
def test_saturation_at_points_is_that_of_their_pulleys(friction: FrictionParameters, states: tuple[int, ...]) -> None:
    """Three points on two pulleys whose speeds may differ from state to state; some touch none."""
    chosen = np.broadcast_to([True, False, True], (*states, 3)).copy()
    chosen[..., 1] = np.arange(chosen[..., 1].size).reshape(states) == 1
    touched, normal = (
        np.broadcast_to([1, 0, 0], chosen.shape),
        np.linspace(100.0, 200.0, chosen.size).reshape(chosen.shape),
    )
    mu, rim = np.array([0.3, 0.6]), 1.0 + np.arange(2.0 * chosen.size / 3.0).reshape(*states, 2)
    expected = [
        float(friction.saturation(normal[place], mu[touched[place]], rim[(*place[:-1], touched[place])]))
        for place in np.ndindex(chosen.shape)
        if chosen[place]
    ]
    np.testing.assert_array_equal(saturation_at(friction, chosen, touched, normal, mu, rim), expected)


@pytest.mark.parametrize("ratio", [-3.0, -0.9, -0.1, 0.0, 0.4, 0.99, 1.01, 2.0])
def test_derivatives(friction: FrictionParameters, ratio: float) -> None:
    normal, share = 200.0, 1e-6
    slip = ratio * break_away(friction, normal)
    _, by_slip, by_normal, by_rim = force_at(friction, slip, normal)

    def difference(d_slip: float, d_normal: float, d_rim: float = 0.0) -> float:
        return (
            force_at(friction, slip + d_slip, normal + d_normal, RIM + d_rim)[0]
            - force_at(friction, slip - d_slip, normal - d_normal, RIM - d_rim)[0]
        )

    rounding = 1e-8  # 1e-16 over the step
    assert difference(share, 0.0) / (2 * share) == pytest.approx(by_slip, rel=rounding, abs=1e-5)
    assert difference(0.0, share) / (2 * share) == pytest.approx(by_normal, rel=rounding, abs=1e-5)
    assert difference(0.0, 0.0, share) / (2 * share) == pytest.approx(by_rim, rel=rounding, abs=1e-5)


@given(SLIPS, NORMALS)
def test_depends_on_the_magnitude_of_the_normal_force(friction: FrictionParameters, slip: float, normal: float) -> None:
    pushed, pulled = force_at(friction, slip, normal), force_at(friction, slip, -normal)
    assert pulled[:2] == pushed[:2]
    assert abs(pulled[2]) == abs(pushed[2])
    if normal > 0.0:
        assert pulled[2] == -pushed[2]


@given(st.floats(1e-3, 1e2), st.floats(-2.0, 2.0))
def test_relative_creep_scales_with_the_speed(speed: float, ratio: float) -> None:
    """Where a pulley runs, slip over its speed makes the force; either way alike."""
    law = RelativeCreep(creep_ratio=0.01, standstill_creep=0.0)
    force = friction_force(law, 0.01 * ratio * speed, 200.0, MU, speed)
    back = friction_force(law, 0.01 * ratio * speed, 200.0, MU, -speed)
    assert force[0] == pytest.approx(-MU * 200.0 * np.clip(ratio, -1, 1), rel=1e-12)
    assert back == (*force[:3], -force[3])


def test_relative_creep_at_rest() -> None:
    """A pulley that stands still is held by a slope of its own."""
    law = RelativeCreep(creep_ratio=0.01, standstill_creep=1e-4)
    assert friction_force(law, 5e-5, 200.0, MU, 0.0) == pytest.approx((-50.0, -1e6, -0.25, 0.0), rel=1e-12)


FILM = AirFilm(0.01, 1e-4, film_radius=0.05, web_width=0.1, roughness=3e-6, air_viscosity=1.8e-5)
"""Of a web with f_n = 200 N/m, and so 100 N/m of tension per width."""


@pytest.mark.parametrize(("height", "share"), [(0.5, 1.0), (1.0, 1.0), (1.4, 0.8), (2.0, 0.5), (2.9, 0.05), (3.1, 0.0)])
@pytest.mark.parametrize("slip", [-0.2, 0.2])
def test_air_film_takes_its_share_of_friction(height: float, share: float, slip: float) -> None:
    """At heights over the roughness h / sigma, from the speed of the film by Knox and Sweeney."""
    entrained = 100.0 * (height * 3e-6 / (0.643 * 0.05)) ** 1.5 / (6.0 * 1.8e-5)
    rim = (entrained - slip) / 2.0
    force = friction_force(FILM, slip, 200.0, MU, rim)[0]
    assert force == pytest.approx(-np.sign(slip) * share * MU * 200.0, rel=1e-9, abs=1e-9)


def test_air_film_of_a_known_web() -> None:
    """At 2 m/s, 100 N/m and R = 50 mm the film is 0.643 R (12 eta v / T')^(2/3) = 8.53 um high."""
    law = FILM._replace(roughness=4.265e-6)
    assert friction_force(law, 1.0, 200.0, MU, 1.5)[0] == pytest.approx(-0.5 * MU * 200.0, rel=2e-3)


def test_air_film_carries_what_does_not_press() -> None:
    assert friction_force(FILM, 0.3, 0.0, MU, 5.0)[0] == 0.0


@pytest.mark.parametrize("slip", [-3.0, -0.01, 0.0, 2e-3, 0.7])
def test_a_law_under_the_common_type_is_itself(friction: FrictionParameters, slip: float) -> None:
    common = as_common(friction)
    if type(friction) not in IN_COMMON:
        assert common is friction  # a law that was added with a file and a line; kernels are compiled for it
        return
    assert isinstance(common, CommonFriction)
    assert common.own == friction
    assert common.smoothed(2.0).own == friction.smoothed(2.0)
    for pressed in (0.0, 30.0, -5.0):
        assert friction_force(common, slip, pressed, 0.6, 4.0) == friction_force(friction, slip, pressed, 0.6, 4.0)
    pressures = np.array([10.0, 200.0])
    np.testing.assert_array_equal(common.saturation(pressures, 0.6, 4.0), friction.saturation(pressures, 0.6, 4.0))


def test_a_law_from_outside_keeps_its_type() -> None:
    law: Any = object()
    assert as_common(law) is law

"""Fans, pumps, brakes and generators: closed forms of their torque, senses, kinks, and what is refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.machines import BandBrake, Brake, Fan, Generator, Load
from beltdyn.machines.loads.load import LoadTorque

Torque = Callable[..., LoadTorque]
Kinks = Callable[..., list[float]]


def steady(value: float) -> dict[str, Any]:
    return {"kind": "constant", "value": value}


FAN: dict[str, Any] = {"kind": "fan", "rated_power": "15 kW", "rated_speed": "1100 rpm", "friction_share": 0.05}
PUMP: dict[str, Any] = {
    "kind": "pump", "displacement": "16 cm^3", "pressure": steady(180e5), "efficiency": 0.92
}  # fmt: skip
BRAKE: dict[str, Any] = {"kind": "brake", "torque": {"kind": "ramp", "start": 1.0, "end": 2.0, "value": "80 N m"}}
BAND: dict[str, Any] = {
    "kind": "band_brake",
    "force": steady(200.0),
    "radius": 0.15,
    "friction": 0.3,
    "wrap": "270 deg",
}
GENERATOR: dict[str, Any] = {
    "kind": "generator", "power": steady(1200.0), "efficiency": 0.6, "cut_in_speed": 120.0, "full_field_power": 2400.0
}  # fmt: skip


@pytest.mark.parametrize("sense", [-1, 1])
def test_a_fan_takes_its_rated_power_at_its_rated_speed_and_grows_with_the_square(torque: Torque, sense: int) -> None:
    rated = 1100 * np.pi / 30
    assert -torque(FAN, sense * rated).torque * sense * rated == pytest.approx(15e3, rel=1e-12)
    plain = FAN | {"friction_share": 0.0}
    assert torque(plain, 0.5 * rated).torque == pytest.approx(torque(plain, rated).torque / 4, rel=1e-12)
    assert torque(FAN, 2.0).torque == pytest.approx(-(0.05 + 0.95 * (2 / rated) ** 2) * 15e3 / rated, rel=1e-12)


@pytest.mark.parametrize("speed", [-150.0, 20.0, 150.0])
def test_a_pump_turns_shaft_power_into_that_of_its_flow(torque: Torque, speed: float) -> None:
    flow = 16e-6 * abs(speed) / (2 * np.pi)
    assert -torque(PUMP, speed).torque * speed == pytest.approx(180e5 * flow / 0.92, rel=1e-12)


def test_a_brake_is_clamped_over_time_and_may_be_weaker_backwards(torque: Torque) -> None:
    assert [torque(BRAKE, 30.0, time=time).torque for time in (0.5, 1.5, 3.0)] == pytest.approx([0.0, -40.0, -80.0])
    assert torque(BRAKE | {"backward_ratio": 0.5}, -30.0, time=3.0).torque == pytest.approx(40.0)


@pytest.mark.parametrize(("strong", "sense"), [("counter-clockwise", 1), ("clockwise", -1)])
def test_a_band_brake_is_eytelweins(torque: Torque, strong: str, sense: int) -> None:
    band, ratio = BAND | {"self_energizing": strong}, np.exp(0.3 * 1.5 * np.pi)
    with_it, against = torque(band, sense * 40.0).torque, torque(band, -sense * 40.0).torque
    assert with_it == pytest.approx(-sense * 200.0 * 0.15 * (ratio - 1), rel=1e-12)
    assert against == pytest.approx(sense * 200.0 * 0.15 * (1 - 1 / ratio), rel=1e-12)
    assert abs(with_it / against) == pytest.approx(ratio, rel=1e-12)


def test_what_brakes_alike_in_both_senses_is_smooth_at_standstill(kinks: Kinks) -> None:
    assert kinks(BRAKE | {"torque": steady(80.0)}, -5.0, 5.0) == kinks(PUMP, -5.0, 5.0) == []
    assert kinks(BAND, -5.0, 5.0) == kinks(BAND, 5.0, -5.0) == [0.0]


@pytest.mark.parametrize(("holds", "sense"), [("clockwise", -1), ("counter-clockwise", 1)])
def test_a_holdback_is_free_in_one_sense(torque: Torque, kinks: Kinks, holds: str, sense: int) -> None:
    holdback = {"kind": "holdback", "torque": 60.0, "holds": holds, "creep_speed": 0.1}
    assert torque(holdback, -sense * 40.0).torque == 0.0
    assert torque(holdback, sense * 40.0).torque == pytest.approx(-sense * 60.0, rel=1e-12)
    assert torque(holdback, sense * 0.1).torque == pytest.approx(-sense * 60.0 * np.tanh(1.0), rel=1e-12)
    assert kinks(holdback, -5.0, 5.0) == [0.0]


@pytest.mark.parametrize("sense", [-1, 1])
def test_a_generator_gives_its_power_as_far_as_its_field_allows(torque: Torque, sense: int) -> None:
    for speed, power in ((100.0, 0.0), (180.0, 2400.0 / 3), (240.0, 1200.0), (300.0, 1200.0), (900.0, 1200.0)):
        assert -torque(GENERATOR, sense * speed).torque * sense * speed == pytest.approx(power / 0.6, rel=1e-12)


def test_a_generator_bends_where_it_cuts_in_and_where_its_field_is_enough(kinks: Kinks) -> None:
    assert kinks(GENERATOR, 0.0, 500.0) == pytest.approx([120.0, 240.0])
    assert kinks(GENERATOR, 0.0, -500.0) == pytest.approx([-120.0, -240.0])
    assert kinks(GENERATOR | {"power": steady(3e3)}, 500.0, 0.0) == pytest.approx([120.0])


@pytest.mark.parametrize(
    ("kind", "given", "sentence"),
    [
        (Fan, FAN | {"rated_speed": 0.0}, "must be greater than 0"),
        (Fan, FAN | {"friction_share": 1.0}, "must be less than 1"),
        (Brake, BRAKE | {"torque": steady(-5.0)}, "brake.torque.value = -5.0 must be at least 0"),
        (BandBrake, BAND | {"force": steady(-5.0)}, "must be at least 0"),
        (Generator, GENERATOR | {"power": steady(-1.0)}, "must be at least 0"),
        (Generator, GENERATOR | {"efficiency": 1.2}, "must be at most 1"),
    ],
)
def test_errors(kind: type[Load], given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        kind(**given)
    assert sentence in str(caught.value)

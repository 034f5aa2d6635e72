"""An induction motor by its catalogue: the points of its curve, supply, limit, star and delta, and what is refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import row
from beltdyn.errors import ModelError
from beltdyn.machines.loads.induction_motor import INDUCTION_MOTOR, induction_torque
from beltdyn.machines.loads.load import LoadTorque, ShaftState
from beltdyn.model import InductionMotor

Torque = Callable[..., LoadTorque]
Kinks = Callable[..., list[float]]

RPM = np.pi / 30.0
MOTOR: dict[str, Any] = {
    "kind": "induction_motor",
    "rated_power": "15 kW",
    "rated_speed": "1465 rpm",
    "locked_rotor_ratio": 2.4,
    "pull_up_ratio": 1.9,
    "breakdown_ratio": 3.0,
}
RATED = 15e3 / (1465.0 * RPM)
SYNCHRONOUS = 1500.0 * RPM


def inverter(frequency: float, **more: Any) -> dict[str, Any]:
    return MOTOR | {"supply": {"kind": "constant", "value": frequency}} | more


@pytest.mark.slow
def test_the_curve_goes_through_the_points_of_the_catalogue(torque: Torque) -> None:
    assert torque(MOTOR, 1465.0 * RPM).torque == pytest.approx(RATED, rel=1e-12)
    assert torque(MOTOR, SYNCHRONOUS).torque == pytest.approx(0.0, abs=1e-9)
    assert torque(MOTOR, 0.0).torque == pytest.approx(2.4 * RATED, rel=1e-12)
    curve = np.array([torque(MOTOR, speed).torque for speed in np.linspace(0.0, SYNCHRONOUS, 3001)])
    assert curve.max() == pytest.approx(3.0 * RATED, rel=1e-5)
    falling = curve[: int(curve.argmax())]
    assert falling.min() == pytest.approx(1.9 * RATED, rel=1e-5)
    assert falling.argmin() == pytest.approx(3000 / 7, abs=1)


def test_without_a_pull_up_torque_it_falls_steadily_towards_standstill(torque: Torque) -> None:
    plain = {key: value for key, value in MOTOR.items() if key != "pull_up_ratio"}
    breakdown = SYNCHRONOUS * (1 - InductionMotor(**plain).values()["breakdown_slip"])
    curve = [torque(plain, speed).torque for speed in np.linspace(0.0, breakdown, 200)]
    assert np.all(np.diff(curve) > 0.0)


@pytest.mark.parametrize("slip", [0.01, 0.1, 0.5, 0.9, 1.4])
def test_it_brakes_above_the_synchronous_speed_as_it_drives_below(torque: Torque, slip: float) -> None:
    below, above = (torque(MOTOR, SYNCHRONOUS * (1 + side * slip)) for side in (-1, 1))
    assert above.torque == pytest.approx(-below.torque, rel=1e-12)
    assert above.by_speed == pytest.approx(below.by_speed, rel=1e-12)


@pytest.mark.parametrize("speed", [-400.0, 0.0, 700.0, 1465.0, 1600.0])
def test_a_clockwise_motor_is_the_mirror_image(torque: Torque, speed: float) -> None:
    mirrored = torque(MOTOR | {"rated_speed": -1465.0 * RPM}, -speed * RPM)
    assert mirrored.torque == pytest.approx(-torque(MOTOR, speed * RPM).torque, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize(
    ("speed", "frequency", "synchronous"),
    [(2930, 50, 3000), (1465, 50, 1500), (970, 50, 1000), (1750, 60, 1800), (-710, 50, -750)],
)
def test_poles_follow_from_rated_speed_and_frequency(speed: float, frequency: float, synchronous: float) -> None:
    motor = InductionMotor(**MOTOR | {"rated_speed": speed * RPM, "frequency": frequency})
    assert motor.synchronous_speed == pytest.approx(synchronous * RPM, rel=1e-12)


@pytest.mark.parametrize("frequency", [5.0, 25.0, 50.0])
@pytest.mark.parametrize("lag", [-6.0, 1.0, 4.0])
def test_up_to_the_rated_frequency_the_supply_shifts_the_curve(torque: Torque, frequency: float, lag: float) -> None:
    shifted = torque(inverter(frequency), SYNCHRONOUS * frequency / 50.0 - lag).torque
    assert shifted == pytest.approx(torque(MOTOR, SYNCHRONOUS - lag).torque, rel=1e-9)


@pytest.mark.slow
def test_above_the_rated_frequency_the_breakdown_torque_falls_with_its_square(torque: Torque) -> None:
    curve = [torque(inverter(80.0), speed).torque for speed in np.linspace(0.0, 1.6 * SYNCHRONOUS, 5001)]
    assert max(curve) == pytest.approx(3.0 * RATED * (50.0 / 80.0) ** 2, rel=1e-5)


@pytest.mark.parametrize("frequency", [20.0, 49.0, 70.0, -30.0])
@pytest.mark.parametrize("speed", [-40.0, 60.0, 150.0])
def test_derivative_with_respect_to_the_frequency(frequency: float, speed: float) -> None:
    constants = row(INDUCTION_MOTOR, **InductionMotor(**MOTOR).values())
    step = 1e-5
    before, here, after = (
        induction_torque(constants, np.zeros(0), ShaftState(0.0, 0.0, speed, frequency + h, 0.0))
        for h in (-step, 0.0, step)
    )
    assert here.by_command == pytest.approx((after.torque - before.torque) / (2 * step), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("frequency", [20.0, 50.0, 70.0])
def test_an_inverter_limits_the_torque_and_says_from_which_speed_to_which(
    torque: Torque, kinks: Kinks, frequency: float
) -> None:
    limited, free = inverter(frequency, limit_ratio=1.2), inverter(frequency)
    top = SYNCHRONOUS * frequency / 50.0
    ends = kinks(limited, top - 12.0, top + 12.0)
    assert ends == pytest.approx(sorted(kinks(limited, top + 12.0, top - 12.0)), rel=1e-12)
    assert [torque(free, speed).torque for speed in ends] == pytest.approx([1.2 * RATED, -1.2 * RATED], rel=1e-9)
    middle = sum(ends) / 2.0 + 1.0
    assert torque(limited, middle) == torque(free, middle)
    assert torque(limited, ends[0] - 0.5).torque == pytest.approx(1.2 * RATED, rel=1e-12)
    assert torque(limited, ends[1] + 0.5) == pytest.approx((-1.2 * RATED, 0.0, 0.0, 0.0), rel=1e-12)


def test_in_star_it_has_a_third_of_the_torque(torque: Torque) -> None:
    started = MOTOR | {"star_until": "2 s"}
    full = torque(MOTOR, 50.0).torque
    assert [torque(started, 50.0, time=time).torque for time in (0.0, 1.9, 2.1)] == pytest.approx(
        [full / 3, full / 3, full], rel=1e-12
    )


def test_it_drives_up_to_the_highest_frequency_of_its_supply() -> None:
    ramp = {"kind": "ramp", "start": 0.0, "end": 2.0, "value": "60 Hz"}
    assert InductionMotor(**MOTOR | {"supply": ramp}).driven_speed == pytest.approx(1.2 * SYNCHRONOUS, rel=1e-12)
    assert InductionMotor(**MOTOR).driven_speed == pytest.approx(SYNCHRONOUS, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"rated_speed": 0.0}, "rated_speed = 0 rad/s must be below 314.16 rad/s, that of two poles at 50 Hz"),
        ({"rated_speed": 2.2e-308}, "rated_speed = 0 rad/s must be below"),
        ({"rated_speed": 1e-9}, "and above 0.31416 rad/s, that of 2000"),
        ({"rated_speed": "3100 rpm"}, "Give the speed at the rated power"),
        ({"rated_speed": "1500 rpm"}, "breakdown would be at a slip of 2.91. Correct rated_speed or frequency"),
        ({"breakdown_ratio": 1.0}, "must be greater than 1"),
        ({"breakdown_ratio": "290 N m"}, "must be a number without a unit"),
        ({"pull_up_ratio": 2.5}, "pull_up_ratio = 2.5 must not be above locked_rotor_ratio = 2.4"),
        ({"limit_ratio": 1.5}, "has limit_ratio but no supply, although only an inverter limits torque. Give supply"),
        (
            {"star_until": 1.0, "supply": {"kind": "constant", "value": 50.0}},
            "star_until and supply exclude each other. Keep one starting method",
        ),
        ({"star_until": 1.0, "schedule": {"kind": "step", "time": 1, "value": 1}}, "star_until and schedule exclude"),
        ({"frequency": "3000 rpm"}, 'must be a frequency in Hz, not "rpm"'),
    ],
)
def test_errors(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        InductionMotor(**MOTOR | changes)
    assert sentence in str(caught.value)

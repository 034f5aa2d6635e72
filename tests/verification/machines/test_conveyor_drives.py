"""Conveyors with two drives: shares of the load by the lines of their motors, and a stop on a slope."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import beltdyn as bd
from tests.verification.machines.test_conveyors import BELT, CARRYING, EA, GRAVITY, RADIUS, RETURN, STRIP, idlers

FRICTION, GOODS = 0.02, 104.0
MOTORS = {"head": (60e3, 0.05, 8.1), "second": (30e3, 0.06, 8.1)}
"""Breakdown torque (N m) and slip, synchronous speed (rad/s), seen from the drums."""


def motor(name: str, **more: Any) -> dict[str, Any]:
    torque, slip, speed = MOTORS[name]
    return {
        "kind": "motor",
        "breakdown_torque": torque,
        "breakdown_slip": slip,
        "synchronous_speed": speed,
    } | more


def conveyor(
    length: float, lift: float, weight: float, loads: list[list[dict[str, Any]]], **simulation: Any
) -> bd.Drive:
    """A conveyor that drives at the head and at a second drum on its lower strand, and that a weight pulls (N)."""
    free = {"radius": RADIUS, "inertia": 1200.0}
    return bd.Drive(
        gravity=[0.0, -GRAVITY],
        belt=STRIP,
        pulley=[
            free | {"name": "head", "center": [0.0, lift], "load": loads[0]},
            free | {"name": "second", "center": [12.0, lift - 4.0], "load": loads[1]},
            {"name": "bend", "center": [9.0, lift - 2.8], "radius": 0.3, "side": "outside", "inertia": 15.0},
            {"name": "tail", "center": [length, 0.0], "radius": 0.4, "inertia": 60.0, "mass": 800.0},
        ],
        tensioner=[
            {
                "kind": "sliding",
                "pulley": "tail",
                "direction": [1.0, 0.0],
                "mass": weight / GRAVITY,
                "preload": weight,
                "damping": 2e4,
            }
        ],
        support=[idlers("tail", "head", CARRYING, FRICTION), idlers("bend", "tail", RETURN, FRICTION)],
        goods=[{"span": ["tail", "head"], "mass_per_length": GOODS}],
        contact={"friction": 0.35, "standstill_creep": 1e-4},
        simulation={"duration": 60.0} | simulation,
    )


def kloss(name: str, speed: float) -> float:
    """Torque of a motor at a speed (rad/s), N m."""
    torque, slip, synchronous = MOTORS[name]
    part = (1.0 - speed / synchronous) / slip
    return 2.0 * torque / (part + 1.0 / part)


@pytest.mark.slow
def test_two_drums_share_the_pull_by_the_lines_of_their_motors() -> None:
    """The belt that comes to the second drum is less stretched by the pull of the first, and so much slower it turns.

    The slip safety of each drum is the factor on all loads at which Euler's ratio is reached: the weight holds the
    tension at the tail, and the resistance of the lower strand, which grows with the loads, takes from the slack side.
    """
    length, lift = 1000.0, 15.0
    run = bd.steady_state(conveyor(length, lift, 120e3, [[motor("head")], [motor("second")]]))
    upper, lower = math.hypot(length, lift), math.hypot(length - 9.0, lift - 2.8)
    carried = (BELT + GOODS) * length + CARRYING[1] / CARRYING[0] * upper
    returned = BELT * (length - 9.0) + RETURN[1] / RETURN[0] * lower
    pull = FRICTION * GRAVITY * (carried + returned) + lift * GRAVITY * GOODS

    def second(speed: float) -> float:
        return speed * (1.0 - kloss("head", speed) / RADIUS / EA)

    def missing(speed: float) -> float:
        return kloss("head", speed) + kloss("second", second(speed)) - pull * RADIUS

    head = float(brentq(missing, 7.9, 8.0999))
    torques = run.dataset.shaft_torque[-1].values[:2]
    expected = [kloss("head", head), kloss("second", second(head))]
    np.testing.assert_allclose(torques, expected, rtol=0.01)
    tension, wraps = run.dataset.span_tension[-1], run.dataset.wrap_angle[-1].values
    slack = float(tension.sel(span="second-bend"))
    inertia = BELT * float(run.dataset.belt_speed[-1].mean()) ** 2
    pulls, resistance = np.array(expected) / RADIUS, FRICTION * GRAVITY * returned

    def use(factor: float, drum: int) -> float:
        behind = slack - (factor - 1.0) * resistance - inertia + factor * (pulls[1] if drum == 0 else 0.0)
        return float(np.log1p(factor * pulls[drum] / behind) / (0.35 * wraps[drum]))

    euler = [brentq(lambda factor, drum=drum: use(factor, drum) - 1.0, 1.0, 8.0) for drum in (0, 1)]
    safeties = [one.slip_safety for one in bd.summarize(run).pulleys[:2]]
    np.testing.assert_allclose(safeties, euler, rtol=0.01)


@pytest.mark.slow
def test_a_loaded_slope_is_stopped_and_held() -> None:
    """Motors off and brake on after a second; the holdback bears the lift, less what idlers bear."""
    length, lift, stop = 300.0, 45.0, 1.0
    off = {"schedule": {"kind": "step", "time": stop, "before": 1.0, "value": 0.0}}
    brake = {"kind": "brake", "torque": {"kind": "ramp", "start": stop, "end": stop + 0.5, "value": 1e4}}
    hold = {"kind": "holdback", "torque": 60e3}
    loads = [[motor("head", **off), brake, hold], [motor("second", **off)]]
    drive = conveyor(length, lift, 120e3, loads, duration=25.0, start="steady", output_interval=0.02)
    run = bd.simulate(drive).dataset
    speed, time = run.shaft_speed.values[:, 0], run.time.values
    assert speed[0] > 7.9
    assert speed.min() > -2e-3
    assert np.abs(speed[time > 10.0]).max() < 2e-3
    assert float(np.abs(run.energy_closure).max()) < 1e-3
    held = float(run.shaft_torque.values[time > 20.0, 0].mean())
    lifted, idle = lift * GRAVITY * GOODS * RADIUS, FRICTION * GRAVITY * length * (2.0 * BELT + GOODS + 24.4) * RADIUS
    assert lifted - idle < held < lifted + idle


@pytest.mark.slow
def test_an_overland_conveyor_stops_in_eight_seconds() -> None:
    """The motor goes off and the brake comes on, with default settings: momentum over resistance, brake and slope."""
    drive, stop, brake = bd.example("conveyor_1km"), 1.0, 18e3
    off = {"kind": "step", "time": stop, "before": 1.0, "value": 0.0}
    loads = [
        {
            "kind": "motor",
            "breakdown_torque": 60e3,
            "breakdown_slip": 0.05,
            "synchronous_speed": 8.1,
            "schedule": off,
        },
        {"kind": "brake", "torque": {"kind": "ramp", "start": stop, "end": stop + 0.5, "value": brake}},
    ]
    head = drive.pulleys[0].replace(speed=None, inertia=500.0, load=loads)
    settings = {"duration": 12.0, "start": "steady", "output_interval": "50 ms"}
    run = bd.simulate(drive.replace(pulley=[head, drive.pulleys[1]], simulation=settings))
    time, speed = run.dataset.time.values, run.dataset.belt_speed.values.mean(axis=1)
    assert run.dataset.attrs["status"] == "completed"
    assert float(np.abs(run.dataset.energy_closure).max()) < 1e-3
    standing = time[np.abs(speed) < 0.05 * speed[0]]
    assert stop + 6.5 < standing[0] < stop + 8.5
    assert any("the belt goes slack" in text for text in run.warnings)
    assert not any("inf" in text or " 0 m apart" in text for text in run.warnings)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("example", "stop", "within"),
    [("conveyor_1km", 8.0, 0.03), ("conveyor_1km", 20.0, 0.02), ("package_conveyor", 0.5, 0.02)],
)
def test_a_conveyor_stops_along_a_speed_profile(example: str, stop: float, within: float) -> None:
    """With default settings: what the head drum pulls less over nine tenths of the stop is lost momentum.

    The speed at mid-span is the mean of the span but for waves, which take 0.7 s over 1 km.
    """
    drive, begin = bd.example(example), 1.0
    speed = {"conveyor_1km": 8.0, "package_conveyor": 19.0}[example]
    ends = {"kind": "table", "times": [0.0, begin, begin + stop, 100.0], "values": [speed, speed, 0.0, 0.0]}
    head = drive.pulleys[0].replace(speed=ends, load=[])
    settings = {"duration": begin + stop + 2.0, "start": "steady", "output_interval": 5e-3}
    run = bd.simulate(drive.replace(pulley=[head, drive.pulleys[1]], simulation=settings))
    assert run.dataset.attrs["status"] == "completed"
    assert abs(float(run.dataset.pulley_speed.values[-1, 0])) < 1e-6
    assert float(np.abs(run.dataset.energy_closure).max()) < 1e-3
    time, tail = run.dataset.time.values, drive.pulleys[1]
    torque = run.dataset.pulley_torque.values[:, 0]
    pull = torque * np.sign(torque[0]) / float(drive.radii[0])
    stretches = [run.prepared.stretch(support) for support in (*run.prepared.supports, *run.prepared.goods)]
    along = [one.rotating_mass for one in drive.supports] + [one.mass_per_length for one in drive.goods]
    mass = drive.belt.mass_per_length * run.drive.belt_length + sum(
        each * stretch.length for each, stretch in zip(along, stretches, strict=True)
    )
    mass += (tail.inertia or 0.0) / float(drive.radii[1]) ** 2
    braked = (time >= begin) & (time <= begin + 0.9 * stop)
    rim = run.dataset.belt_speed.values.mean(axis=1)
    lost = mass * float(rim[braked][0] - rim[braked][-1])
    assert float(np.trapezoid(pull[0] - pull[braked], time[braked])) == pytest.approx(lost, rel=within)

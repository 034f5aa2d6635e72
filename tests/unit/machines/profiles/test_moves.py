"""Moves to angles: they end where they should, within their limits, in the shortest time."""

from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles.functions import profile_integral, profile_rows, profile_value
from beltdyn.model import PositionTable, Profile, SCurve, Trapezoid, loads

SPEED, ACCELERATION, JERK = 50.0, 1000.0, 4e4
LIMITS = {"speed": SPEED, "acceleration": ACCELERATION}
TIMES = np.linspace(0.0, 1.0, 4001)


def angles_of(profile: Profile, times: FloatArray) -> FloatArray:
    rows = profile_rows([profile], [()])
    return np.array([interpreted(profile_integral)(rows, 0, time) for time in times.tolist()])


def rates_of(profile: Profile) -> FloatArray:
    rows = profile_rows([profile], [()])
    return np.array([interpreted(profile_value)(rows, 0, time)[1] for time in TIMES.tolist()])


@pytest.mark.parametrize("way", [10.0, -10.0, 1.0, 0.02])
def test_a_move_of_constant_acceleration(way: float) -> None:
    """The shortest time over a way D: D / V + V / A, or 2 sqrt(D / A) where V is not reached."""
    move = Trapezoid(times=(0.1,), angles=(way,), **LIMITS)
    size = abs(way)
    whole = size / SPEED + SPEED / ACCELERATION if size > SPEED**2 / ACCELERATION else 2.0 * sqrt(size / ACCELERATION)
    assert angles_of(move, np.array([0.1, 0.1 + whole, 1.0])) == pytest.approx([0.0, way, way], abs=1e-12)
    assert move.breakpoints()[-1] == pytest.approx(0.1 + whole)
    assert move.at([0.1 + 0.5 * whole])[0] == pytest.approx(
        np.sign(way) * min(SPEED, sqrt(size * ACCELERATION)), rel=1e-12
    )
    assert np.max(np.abs(rates_of(move))) == pytest.approx(ACCELERATION)
    assert move.largest() == pytest.approx(min(SPEED, sqrt(size * ACCELERATION)))


@pytest.mark.parametrize("way", [10.0, -10.0, 3.0, 1.0, 0.05])
def test_a_move_of_limited_jerk(way: float) -> None:
    """All of speed, acceleration and jerk are within their limits, and one of them is reached at any time."""
    move = SCurve(times=(0.1,), angles=(way,), jerk=JERK, **LIMITS)
    end = move.breakpoints()[-1]
    assert angles_of(move, np.array([0.1, 0.5 * (0.1 + end), end, 1.0])) == pytest.approx(
        [0.0, 0.5 * way, way, way], abs=1e-12
    )
    speeds, rates = move.at(TIMES), rates_of(move)
    assert np.max(np.abs(speeds)) <= SPEED * (1.0 + 1e-9)
    assert np.max(np.abs(rates)) <= ACCELERATION * (1.0 + 1e-9)
    inside = (TIMES > 0.101) & (end - 1e-3 > TIMES)
    jerks = np.diff(rates)[inside[1:]] / TIMES[1]
    assert np.max(np.abs(jerks)) <= JERK * (1.0 + 1e-6)
    at_limit = [
        np.isclose(np.abs(values[1:][inside[1:]]), most, rtol=1e-6)
        for values, most in ((speeds, SPEED), (rates, ACCELERATION))
    ]
    jumps = 20
    assert np.count_nonzero(~(at_limit[0] | at_limit[1] | np.isclose(np.abs(jerks), JERK, rtol=1e-3))) <= jumps
    assert np.max(np.abs(np.diff(rates))) <= JERK * TIMES[1] * (1.0 + 1e-6)  # no jump of the acceleration


def test_a_large_jerk_leaves_the_move_of_constant_acceleration() -> None:
    steep = SCurve(times=(0.0,), angles=(5.0,), jerk=1e9, **LIMITS)
    assert steep.at(TIMES) == pytest.approx(Trapezoid(times=(0.0,), angles=(5.0,), **LIMITS).at(TIMES), abs=2e-3)


def test_there_and_back_with_a_rest() -> None:
    move = SCurve(times=(0.0, 0.4), angles=(6.0, -2.0), jerk=JERK, **LIMITS)
    assert angles_of(move, np.array([0.0, 0.39, 0.4, 1.0])) == pytest.approx([0.0, 6.0, 6.0, -2.0], abs=1e-12)
    back = move.reversed()
    assert back.at(TIMES) == pytest.approx(-move.at(TIMES), abs=1e-12)


def test_a_move_must_end_before_the_next_begins() -> None:
    with pytest.raises(ModelError, match=r"move 1 takes from 0 to 0\.17 s, but the next one begins at 0\.1 s"):
        Trapezoid(times=(0.0, 0.1), angles=(6.0, 0.0), **LIMITS)


def test_a_table_of_positions_goes_through_its_points_smoothly(tmp_path: Path) -> None:
    times, angles = (0.1, 0.2, 0.4, 0.5), (0.0, 1.0, -2.0, 0.5)
    table = PositionTable(times=times, angles=angles)
    assert angles_of(table, np.array([0.0, *times, 1.0])) == pytest.approx([0.0, *angles, 0.5], abs=1e-12)
    inside = np.diff(rates_of(table))[401:1999]
    assert np.max(np.abs(inside)) < 2.0 * np.max(np.abs(table.segments().curvature)) * TIMES[1]
    assert table.largest() == pytest.approx(np.max(np.abs(table.at(TIMES))), rel=1e-6)
    (tmp_path / "way.csv").write_text(
        "time s, angle rad\n" + "\n".join(f"{t}, {a}" for t, a in zip(times, angles, strict=True))
    )
    text = """
    [belt]
    profile = "PK"
    ribs = 3
    installed_tension = "200 N"
    [[pulley]]
    name = "motor"
    center = [0, 0]
    diameter = "60 mm"
    speed = { kind = "position_table", file = "way.csv" }
    [[pulley]]
    name = "other"
    center = [0.3, 0]
    diameter = "60 mm"
    inertia = 1e-3
    [simulation]
    duration = 0.6
    """
    read = loads(text, tmp_path).pulleys[0].speed
    assert read is not None
    assert read.at(TIMES) == pytest.approx(table.at(TIMES))


def test_angles_give_speeds_alone() -> None:
    text = """
    [belt]
    profile = "PK"
    ribs = 3
    installed_tension = "200 N"
    [[pulley]]
    name = "motor"
    center = [0, 0]
    diameter = "60 mm"
    inertia = 1e-3
    torque = { kind = "trapezoid", times = [0], angles = [1], speed = 1, acceleration = 1 }
    [[pulley]]
    name = "other"
    center = [0.3, 0]
    diameter = "60 mm"
    inertia = 1e-3
    [simulation]
    duration = 0.6
    """
    with pytest.raises(ModelError, match="trapezoid"):
        loads(text)

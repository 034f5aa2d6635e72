"""A torque over angle and speed: its points, period, slopes and ends, and what is refused."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from beltdyn.errors import ModelError
from beltdyn.machines import AngleSpeedTable, AngleTable
from beltdyn.machines.loads.load import LoadTorque
from beltdyn.machines.loads.shaft import ShaftLoads, mean_loads, shaft_torque
from beltdyn.model import Pulley
from beltdyn.system.build_machines import machine_arrays

Torque = Callable[..., LoadTorque]
Kinks = Callable[..., list[float]]

ANGLES = np.linspace(0.0, 4 * np.pi, 24, endpoint=False)
WAVE = 3.0 * np.cos(ANGLES / 2) - np.cos(2 * ANGLES)
CRANK: dict[str, Any] = {
    "kind": "angle_table", "angles": ANGLES.tolist(), "torques": WAVE.tolist(), "cycle": "720 deg"
}  # fmt: skip
SPEEDS = [10.0, 20.0, 50.0]
GRID: dict[str, Any] = CRANK | {
    "kind": "angle_speed_table", "speeds": SPEEDS, "torques": np.outer(WAVE, [1.0, 1.5, 0.5]).tolist()
}  # fmt: skip
EPS = 1e-9


@pytest.mark.parametrize("turns", [0, -2, 6])
def test_it_goes_through_its_points_in_every_cycle(torque: Torque, turns: int) -> None:
    found = [torque(CRANK, 5.0, angle + 2 * np.pi * turns).torque for angle in ANGLES]
    assert found == pytest.approx(WAVE, abs=1e-12)


@pytest.mark.slow
def test_it_does_not_overshoot_a_narrow_pulse_and_has_its_area(torque: Torque) -> None:
    """A point of height 1 between zeros 0.05 rad away: two smooth steps, of the area of a triangle."""
    pulse = {"kind": "angle_table", "angles": [0.0, 1.0, 1.05, 1.1, 4.0], "torques": [0, 0, 1, 0, 0]}
    found = np.array([torque(pulse, 1.0, angle).torque for angle in np.linspace(0.0, 2 * np.pi, 2001)])
    assert found.min() == 0.0
    assert found.max() <= 1.0
    area = quad(lambda angle: torque(pulse, 1.0, angle).torque, 1.0, 1.1, points=[1.05])[0]
    assert area == pytest.approx(0.05, rel=1e-12)


def test_a_closed_table_and_an_open_one_are_the_same(torque: Torque) -> None:
    closed = CRANK | {"angles": [*ANGLES, 4 * np.pi], "torques": [*WAVE, WAVE[0]]}
    for angle in np.linspace(-3.0, 20.0, 41):
        assert torque(closed, 1.0, angle) == pytest.approx(torque(CRANK, 1.0, angle), abs=1e-12)


def test_a_smooth_curve_is_met_better_with_more_points(torque: Torque) -> None:
    """The error falls with the third power of their distance: slopes at points are exact to the second."""
    errors = []
    for count in (40, 80):
        angles = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
        table = {"kind": "angle_table", "angles": angles.tolist(), "torques": np.exp(np.sin(angles)).tolist()}
        near = np.linspace(-0.9, 0.9, 201)  # where the curve has no extremum, at which slopes are set to zero
        errors.append(max(abs(torque(table, 0.0, angle).torque - np.exp(np.sin(angle))) for angle in near))
    assert errors[0] / errors[1] > 2**2.7


def test_over_the_speed_it_goes_through_its_points_and_is_constant_outside(torque: Torque) -> None:
    for speed, factor in ((-5.0, 1.0), (10.0, 1.0), (20.0, 1.5), (50.0, 0.5), (90.0, 0.5)):
        assert torque(GRID, speed, ANGLES[3]).torque == pytest.approx(factor * WAVE[3], abs=1e-12)
    assert torque(GRID, 90.0, 1.0).by_speed == torque(GRID, -90.0, 1.0).by_speed == 0.0


def test_it_bends_at_the_ends_of_its_speeds_only(torque: Torque, kinks: Kinks) -> None:
    assert kinks(GRID, 0.0, 100.0) == pytest.approx([10.0, 50.0])
    assert kinks(GRID, 100.0, 0.0) == pytest.approx([50.0, 10.0])
    assert kinks(CRANK, -100.0, 100.0) == []
    for speed in (20.0, 30.0):
        before, after = (torque(GRID, speed + side * EPS, 1.0).by_speed for side in (-1, 1))
        assert before == pytest.approx(after, abs=1e-6)


def test_slopes_are_continuous_over_the_angle(torque: Torque) -> None:
    for angle in (0.0, ANGLES[5], 4 * np.pi):
        before, after = (torque(GRID, 13.0, angle + side * EPS).by_angle for side in (-1, 1))
        assert before == pytest.approx(after, abs=1e-6)


def test_orders_are_those_of_the_cycle_and_of_the_finest_points() -> None:
    assert AngleTable(**CRANK).orders == [0.5, 6.0]
    wave = {"order": 3, "amplitude": 0.1}
    assert AngleTable(**CRANK | {"harmonics": [wave]}).orders == [3.0, 0.5, 6.0]


def test_files(tmp_path: Path) -> None:
    (tmp_path / "crank.csv").write_text("deg,Nm\n0,1\n90,-2\n180,0\n360,1\n")
    context = {"base": tmp_path}
    given = {"kind": "angle_table", "file": "crank.csv", "units": ["deg", "N m"]}
    table = AngleTable.model_validate(given, context=context)
    assert table.angles == pytest.approx([0.0, np.pi / 2, np.pi, 2 * np.pi])
    assert table.torques == (1.0, -2.0, 0.0, 1.0)
    (tmp_path / "map.csv").write_text("deg/rpm,300,600\n0,1,2\n90,-2,-3\n180,0,0\n")
    grid = AngleSpeedTable.model_validate(
        {"kind": "angle_speed_table", "file": "map.csv", "units": ["deg", "rpm", "N m"]}, context=context
    )
    assert grid.speeds == pytest.approx([10 * np.pi, 20 * np.pi])
    assert grid.torques == ((1.0, 2.0), (-2.0, -3.0), (0.0, 0.0))


@pytest.mark.parametrize(
    ("kind", "given", "sentence"),
    [
        (AngleTable, CRANK | {"cycle": "360 deg"}, "angles span 12.0428 rad, more than cycle = 6.28319 rad"),
        (AngleTable, CRANK | {"torques": [1.0, 2.0, 3.0]}, "angles has 24 numbers but torques has 3"),
        (
            AngleTable,
            CRANK | {"angles": [0.0, 0.0, 1.0], "torques": [0, 0, 0]},
            "angles must increase, but 0 follows 0",
        ),
        (AngleTable, CRANK | {"angles": [0, 1, 4 * np.pi], "torques": [0, 0, 1]}, "one cycle apart with different"),
        (AngleSpeedTable, GRID | {"speeds": [1.0, 2.0]}, "speeds has 2 numbers but torques has 3"),
        (AngleSpeedTable, GRID | {"speeds": [1.0, 2.0, 2.0]}, "speeds must increase, but 2 follows 2"),
        (AngleSpeedTable, GRID | {"torques": [[1.0, 1.0, 1.0]] * 3}, "angles has 24 numbers but torques has 3"),
        (
            AngleTable,
            {"kind": "angle_table", "file": "x.csv", "angles": [0]},
            "file and angles and torques exclude each other",
        ),
    ],
)
def test_errors(kind: type[AngleTable], given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        kind(**given)
    assert sentence in str(caught.value)


@pytest.mark.parametrize("load", [CRANK, GRID])
@pytest.mark.parametrize("speed", [5.0, 13.0, 20.0, 41.0])
def test_its_mean_is_that_of_its_torque_and_slope(load: dict[str, Any], speed: float) -> None:
    """Over the angle, between speeds and outside of them; the mean has no slope over the angle."""
    load = load | {"torques": np.square(load["torques"]).tolist()}
    loads = machine_arrays([Pulley(name="one", center=(0, 0), radius=1, inertia=1, load=[load])])

    def torques(rows: ShaftLoads, angles: Iterable[float]) -> list[LoadTorque]:
        return [shaft_torque(loads.profiles, rows, 0, 0.0, angle, speed, np.zeros(1)) for angle in angles]

    found = torques(mean_loads(loads.shaft_loads), (0.3, 7.0))
    turned = torques(loads.shaft_loads, np.linspace(0.0, 4 * np.pi, 24 * 40, endpoint=False))
    assert found[0] == pytest.approx(found[1], abs=1e-12)
    assert found[0].torque == pytest.approx(np.mean([one.torque for one in turned]), abs=1e-5)
    assert found[0].by_speed == pytest.approx(np.mean([one.by_speed for one in turned]), abs=1e-5)
    assert found[0].by_angle == pytest.approx(0.0, abs=1e-12)

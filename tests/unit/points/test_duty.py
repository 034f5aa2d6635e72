"""Duty tables: what they hold, and means weighted by durations."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, load
from beltdyn.model.parameter_study import CalibrationStudy, OptimizationStudy
from beltdyn.points.duty import _means, at_row, duty, read_duty
from validation.published.cases import better, loaded_two_pulley

TABLE = "duration [min], driver speed [rpm], load, driven torque [N m]\n# comment\n2, 1000, 1, -20\n1, 600, 1, -40\n"


@pytest.fixture
def table(tmp_path: Path) -> Path:
    file = tmp_path / "duty.csv"
    file.write_text(TABLE, encoding="utf-8")
    return file


def test_columns_in_si_units(table: Path) -> None:
    columns = read_duty(table)
    assert [(one.what, one.pulley) for one in columns] == [
        ("duration", ""),
        ("speed", "driver"),
        ("load", ""),
        ("torque", "driven"),
    ]
    assert columns[0].values == [120.0, 60.0]
    np.testing.assert_allclose(columns[1].values, np.array([1000.0, 600.0]) * np.pi / 30.0)


def test_the_load_of_a_conveyor_is_its_goods(tmp_path: Path) -> None:
    (tmp_path / "duty.csv").write_text("share [%], load\n30, 0\n70, 0.5\n", encoding="utf-8")
    drive, columns = example("conveyor_1km"), read_duty(tmp_path / "duty.csv")
    assert at_row(drive, columns, 0).goods == ()
    (half,) = at_row(drive, columns, 1).goods
    assert half.mass_per_length == 0.5 * drive.goods[0].mass_per_length


def test_rollers_of_a_web_line_keep_their_draws(tmp_path: Path) -> None:
    (tmp_path / "duty.csv").write_text("share [%], speed [rad/s]\n100, 25\n", encoding="utf-8")
    line = load(Path(__file__).parents[3] / "docs" / "tasks" / "coater.toml")
    slower = at_row(line, read_duty(tmp_path / "duty.csv"), 0)
    speeds = [float(one.speed.at([0.0])[0]) for one in slower.pulleys if one.speed is not None]
    assert speeds == pytest.approx([-25.0, 25.005])


def test_means(table: Path) -> None:
    drive: Drive = better(loaded_two_pulley())
    found = duty(drive, table=table).dataset
    np.testing.assert_allclose(found.shaft_torque.sel(pulley="driven"), [-20.0, -40.0])
    np.testing.assert_allclose(found.pulley_speed.sel(pulley="driver"), np.array([1000.0, 600.0]) * np.pi / 30.0)
    np.testing.assert_allclose(found.duration, [120.0, 60.0])
    weights = np.array([2.0, 1.0]) / 3.0
    assert float(found.mean_power_in) == pytest.approx(weights @ found.power_in.values)
    assert float(found.mean_efficiency) == pytest.approx(
        (weights @ found.power_out.values) / (weights @ found.power_in.values)
    )
    np.testing.assert_allclose(found.mean_hub_load, weights @ found.hub_load.values)
    load, turns = found.hub_load.values[:, 0], weights * found.pulley_speed.values[:, 0]
    cubic = (turns @ load**3 / turns.sum()) ** (1.0 / 3.0)
    assert float(found.equivalent_hub_load[0]) == pytest.approx(cubic)


def test_powers_and_shares_of_a_file_and_of_the_drive_give_the_same(tmp_path: Path) -> None:
    """At the speeds without slip; shares are of an hour."""
    drive: Drive = better(loaded_two_pulley())
    file = tmp_path / "duty.csv"
    file.write_text("share [%], speed [rpm], driven power [kW]\n25, 1000, 2.0\n75, 600, 1.5\n", encoding="utf-8")
    points = [
        {"share": 0.25, "speed": "1000 rpm", "power": {"driven": "2 kW"}},
        {"share": 0.75, "speed": "600 rpm", "power": {"driven": "1.5 kW"}},
    ]
    one, other = duty(drive, table=file).dataset, duty(drive.replace(duty=points)).dataset
    np.testing.assert_allclose(one.duration, [900.0, 2700.0])
    ratio = float(drive.radii[0] / drive.radii[1])
    torques = np.array([-2000.0, -1500.0]) / (ratio * np.array([1000.0, 600.0]) * np.pi / 30.0)
    np.testing.assert_allclose(one.shaft_torque.sel(pulley="driven"), torques)
    for name in ("power_in", "span_tension", "duration", "mean_efficiency"):
        np.testing.assert_allclose(other[name], one[name])
    with pytest.raises(ModelError, match=r"the drive has no duty\. Give groups \[\[duty\]\]"):
        duty(drive)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("duration [s]\n", "has no rows"),
        ("load\n1\n", 'needs one column "duration'),
        ("duration [s]\n-1\n", 'needs one column "duration'),
        ("duration [s], wind\n1, 2\n", 'the heading "wind" must be'),
        ("duration [s], torque [N m]\n1, 2\n", 'the heading "torque" must be'),
        ("duration [s], share [%]\n1, 2\n", 'needs one column "duration'),
        ("duration [s], load\n1\n", "line 2: 1 cells but 2 headings"),
        ("duration [s], load\n1, many\n", 'line 2: "many"'),
        ("duration [s], driver speed [m]\n1, 2\n", "must be in units of rad/s"),
    ],
)
def test_what_is_no_duty_table(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / "duty.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=words):
        read_duty(file)


def test_a_heading_with_a_name_that_no_pulley_has(tmp_path: Path) -> None:
    file = tmp_path / "duty.csv"
    file.write_text("share [%], drivn power [kW]\n100, 1\n", encoding="utf-8")
    with pytest.raises(ModelError, match=r'duty.csv: the heading "drivn power" names no pulley.*mean "driven"'):
        duty(loaded_two_pulley(), table=file)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot be read"):
        read_duty(tmp_path / "none.csv")


SPEED = {"path": "pulley[1].speed.value", "least": "10 rad/s", "largest": "200 rad/s"}
WIDTH = {"path": "belt.width", "least": "1 mm", "largest": "1 m"}


def _studied(drive: Drive, table: Path, number: dict[str, str]) -> object:
    varied = {"path": number["path"], "values": [number["least"], number["largest"]]}
    return bd.study(bd.ParameterStudy(analysis="duty", options={"table": str(table)}, number=[varied]), drive, jobs=1)


def _optimized(drive: Drive, table: Path, number: dict[str, str]) -> object:
    study = OptimizationStudy(number=[number], goal={"result": "hub_load"}, points={"table": str(table)})
    return bd.optimize(drive, study=study)


def _calibrated(drive: Drive, table: Path, number: dict[str, str]) -> object:
    headings, *rows = table.read_text(encoding="utf-8").splitlines()
    measured = ["efficiency," + headings.partition(",")[2], *("0.9," + row.partition(",")[2] for row in rows)]
    table.write_text("\n".join(measured) + "\n", encoding="utf-8")
    return bd.calibrate(drive, study=CalibrationStudy(number=[number], measurement=[{"table": str(table)}]))


CONSUMERS: dict[str, Callable[[Drive, Path, dict[str, str]], object]] = {
    "duty": lambda drive, table, _: duty(drive, table=table),
    "sheet": lambda drive, table, _: bd.sheet(drive, table=table),
    "study": _studied,
    "optimize": _optimized,
    "calibrate": _calibrated,
}


TWICE = {
    "two speeds": (
        "speed [rpm], driver speed [rpm]",
        WIDTH,
        '"speed" and "driver speed" both give the same value. Remove one.',
    ),
    "torque and power": (
        "driven torque [N m], driven power [W]",
        WIDTH,
        '"driven torque" and "driven power" both give the torque.',
    ),
    "speed": (
        "load, speed [rpm]",
        SPEED,
        'the column "speed" gives the number "pulley[1].speed.value", which varies',
    ),
    "speed by name": (
        "driver speed [rpm], load",
        SPEED,
        'the column "driver speed" gives the number "pulley[1].speed.value"',
    ),
}
"""Columns of a table, a number that varies, and what is said."""
ASKED = {
    **dict.fromkeys(("duty", "sheet"), ("two speeds", "torque and power")),  # in which no number varies
    **dict.fromkeys(("study", "optimize"), tuple(TWICE)),
    "calibrate": ("speed by name",),  # measurements are at speeds of pulleys by their names
}


@pytest.mark.parametrize(
    ("consumer", "case"), [(consumer, case) for consumer, cases in ASKED.items() for case in cases]
)
def test_what_gives_one_value_twice_is_refused(consumer: str, case: str, tmp_path: Path) -> None:
    """By all that reads duty tables, before anything is computed."""
    columns, number, message = TWICE[case]
    table = tmp_path / "duty.csv"
    table.write_text(f"share [%], {columns}\n50, 100, 1\n50, 200, 1\n", encoding="utf-8")
    with pytest.raises(ModelError) as error:
        CONSUMERS[consumer](loaded_two_pulley(), table, number)
    assert message in str(error.value)


def test_means_weigh_with_time_and_hub_loads_with_turns() -> None:
    """Bearings live by the cube of the load over their turns (ISO 281); a pulley that stands still wears none."""
    arrays = {
        "power_in": np.array([100.0, np.nan, 300.0]),
        "power_out": np.array([80.0, np.nan, 270.0]),
        "pulley_speed": np.array([[10.0, 0.0], [20.0, 0.0], [-30.0, 0.0]]),
        "hub_load": np.array([[200.0, 50.0], [900.0, 90.0], [400.0, 60.0]]),
    }
    found = {name: np.asarray(values) for name, (_, values) in _means(arrays, np.array([3.0, 5.0, 1.0])).items()}
    assert float(found["mean_power_in"]) == pytest.approx((3.0 * 100.0 + 300.0) / 4.0)
    assert float(found["mean_efficiency"]) == pytest.approx((3.0 * 80.0 + 270.0) / (3.0 * 100.0 + 300.0))
    np.testing.assert_allclose(found["mean_hub_load"], [(3.0 * 200.0 + 400.0) / 4.0, (3.0 * 50.0 + 60.0) / 4.0])
    cubic = (30.0 * 200.0**3 + 30.0 * 400.0**3) / 60.0
    np.testing.assert_allclose(found["equivalent_hub_load"], [cubic ** (1.0 / 3.0), 0.0])
    assert _means(arrays, np.zeros(3)) == {}

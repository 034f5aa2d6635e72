"""Operating points over speed and load: as `steady_state` finds them, those that fail marked, and what is kept."""

import re
from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli import main
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, advise, install
from beltdyn.points.operating_points import operating_map
from beltdyn.results import Result, open_result, summarize, write_csv
from beltdyn.solvers.run_progress import Progress
from beltdyn.state.steady import steady_state
from validation.published import two_pulley
from validation.published.cases import better, loaded_two_pulley

LIMIT = 3.0
"""Factor on the load that is beyond what the belt transmits with a friction of 0.3."""


@pytest.fixture(scope="module")
def loaded() -> Drive:
    drive = better(loaded_two_pulley())
    return drive.replace(contact=drive.contact.replace(friction=0.3))


@pytest.fixture(scope="module")
def found(loaded: Drive) -> Result:
    return operating_map(loaded, speed="60, 120 rad/s", load=f"0.5, 1, {LIMIT}")


def test_points_are_those_of_steady_running(found: Result, loaded: Drive) -> None:
    alone, there = steady_state(loaded), found.dataset.sel(speed=120.0, load=1.0)
    summary = summarize(alone)
    np.testing.assert_allclose(there.span_tension, [one.tension for one in summary.spans], rtol=1e-4)
    np.testing.assert_allclose(there.pulley_slip, [one.slip for one in summary.pulleys], rtol=1e-4, atol=1e-12)
    np.testing.assert_allclose(there.hub_force, alone.dataset.hub_force[-1], rtol=1e-4, atol=0.1)
    np.testing.assert_allclose(np.linalg.norm(there.hub_force, axis=1), there.hub_load, rtol=1e-9)
    assert float(there.efficiency) == pytest.approx(summary.balance.efficiency, rel=1e-5)
    assert float(there.loss.sum()) == pytest.approx(summary.balance.lost, rel=1e-4)
    assert float(there.shaft_torque.sel(pulley="driven")) == pytest.approx(-45.0)


def test_a_point_that_fails_is_marked_and_others_stay(found: Result) -> None:
    beyond, others = found.dataset.sel(load=LIMIT), found.dataset.sel(load=[0.5, 1.0])
    assert all("the belt slips on `driven`" in reason for reason in beyond.failure.values)
    assert beyond.efficiency.isnull().all()
    assert set(others.failure.values.ravel()) == {""}
    assert others.efficiency.notnull().all()
    said = [warning for warning in found.warnings if "no operating point" in warning]
    assert len(said) == 1
    assert said[0].startswith("at speed 573 rpm, load 3:")
    assert said[0].endswith("The same applies at 1 more point, up to speed 1146 rpm, load 3.")


def test_the_worst_of_each_pulley(found: Result) -> None:
    dataset = found.dataset
    np.testing.assert_array_equal(dataset.largest_hub_load, dataset.hub_load.max(("speed", "load")))
    np.testing.assert_array_equal(dataset.smallest_safety, dataset.slip_safety.min(("speed", "load")))


def test_file_and_tables(found: Result, tmp_path: Path) -> None:
    saved = open_result(found.save(tmp_path / "map.nc"))
    assert (saved.kind, saved.status, saved.dataset.attrs["axes"]) == ("operating_map", "completed", "speed load")
    tables = write_csv(saved, tmp_path)
    assert [table.name for table in tables] == ["point.csv", "pulley.csv"]
    lines = tables[0].read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("point,speed [rad/s],load [1],belt_speed [m/s],")
    assert len(lines) == 7
    assert lines[1].startswith("1,60,0.5,")
    assert len(write_csv(saved, tmp_path)) == 2
    (tmp_path / "point.csv").write_text("mine,1\n", encoding="utf-8")
    with pytest.raises(ModelError, match="it would be lost"):
        write_csv(saved, tmp_path)


def test_an_interruption_keeps_what_was_found(loaded: Drive, tmp_path: Path) -> None:
    def stop(progress: Progress) -> None:
        if progress.time == 2.0:
            raise KeyboardInterrupt

    file = tmp_path / "map.nc"
    found = operating_map(loaded, load="0.2, 0.4, 0.6", output=file, progress=stop)
    assert found.status == "interrupted"
    saved = open_result(file)
    assert saved.status == "interrupted"
    assert saved.dataset.efficiency.notnull().values.tolist() == [True, True, False]


def test_no_point_at_all_is_an_error(loaded: Drive, tmp_path: Path) -> None:
    with pytest.raises(ConvergenceError, match="slips on `"):
        operating_map(loaded, load=f"{LIMIT}, 4", output=tmp_path / "map.nc")
    assert not list(tmp_path.iterdir())


def test_a_belt_lifts_off_at_the_speed_that_check_names() -> None:
    """Pulleys are pressed by T - m v^2: three quarters at half of that speed, next to nothing at that speed."""
    drive = better(two_pulley())
    fast = drive.with_({"pulley[driver].speed.value": 4000.0})
    (warning,) = (text for text in advise(fast, install(fast)) if "lifts off" in text)
    limit = re.search(r"(?i)from .* m/s on \((\S+) rpm of driver\)", warning)
    assert limit is not None
    rpm = float(limit[1])
    assert not any("lifts off" in text for text in advise(drive, install(drive)))
    found = operating_map(
        drive, speed=f"{0.01 * rpm}, {0.5 * rpm}, {1.05 * rpm}, {1.5 * rpm} rpm", force_tolerance=0.05
    )
    loads = found.dataset.hub_load.sel(pulley="driven").values
    assert loads[1] / loads[0] == pytest.approx(0.75, abs=0.01)
    assert loads[2] / loads[0] < 0.1  # what bends the belt around a pulley presses on its middle
    assert any("lifts the belt off" in text for text in found.warnings)


def test_bad_input(loaded: Drive) -> None:
    with pytest.raises(ModelError, match=r"a map needs speed, load or both\."):
        operating_map(loaded)
    with pytest.raises(ModelError, match=r"load = '-1..1' contains a negative factor"):
        operating_map(loaded, load="-1..1")
    with pytest.raises(ModelError, match="pulley = 'fan' is not in this drive"):
        operating_map(loaded, speed="1..2 rpm", pulley="fan")


def test_the_command(drive_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["operating-map", str(drive_file), "--speed", "60..120rpm", "--points", "2", "--csv"])
    said = capsys.readouterr().out
    assert ended.value.code == 0
    assert all(words in said for words in ("Speed of driver", "120.0", "Largest hub load", "point.csv"))
    assert bd.open_result(drive_file.with_name("drive-operating-map.nc")).dataset.sizes["speed"] == 2


def test_a_torque_over_the_angle_counts_with_its_mean_and_the_map_says_so(loaded: Drive) -> None:
    driver, driven = loaded.pulleys
    table = {"kind": "angle_table", "angles": [0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi], "torques": [0, -10, -20, -10]}
    uneven, even = (
        operating_map(loaded.replace(pulley=[driver, driven.replace(torque=torque, load=load)]), speed="60, 120 rad/s")
        for torque, load in ((None, [table]), ({"kind": "constant", "value": -10.0}, ()))
    )
    np.testing.assert_allclose(uneven.dataset.span_tension, even.dataset.span_tension, rtol=1e-9)
    said = [warning for warning in uneven.warnings if "steady running uses its mean over a cycle" in warning]
    assert len(said) == 1
    assert said[0].startswith("at speed 573 rpm: the load of driven")
    assert said[0].endswith("The same applies at 1 more point, up to speed 1146 rpm.")

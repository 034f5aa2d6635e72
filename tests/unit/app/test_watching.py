"""A run as it stands while it is computed."""

from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.app.watching import Watcher
from beltdyn.parts.quantity import RPM


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory, drive_text: str) -> Path:
    drive = bd.loads(drive_text)
    settings = drive.simulation.replace(duration=0.1, output_interval=0.01)
    path = tmp_path_factory.mktemp("watched") / "drive.nc"
    bd.simulate(drive.replace(simulation=settings), path)
    return path


def test_the_latest_instant_is_seen_once(result: Path) -> None:
    watcher, run = Watcher(result), bd.results.open_run(result)
    seen = watcher.look()
    assert seen is not None
    instant = run.fields_at()
    assert seen.time == instant["time"] == pytest.approx(0.1)
    low, high = seen.tension
    assert 0.0 <= low < high
    assert [row[0] for row in seen.pulleys.rows] == ["driver", "driven"]
    assert [float(row[1]) for row in seen.pulleys.rows] == pytest.approx(RPM * instant["pulley_speed"].values, abs=0.05)
    watcher._next = 0.0
    assert watcher.look() is None  # nothing is new


def test_what_is_drawn_lies_around_the_pulleys(result: Path) -> None:
    seen = Watcher(result).look()
    assert seen is not None
    points = np.array(
        [[float(one) for one in pair.split()] for piece in seen.drawn["belt"] for pair in piece["d"][1:].split("L")]
    )
    assert points[:, 1].max() == pytest.approx(81.25, abs=1.0)  # radius, mm: this belt touches with its centerline
    assert points[0] == pytest.approx(points[-1], abs=0.01)  # closed
    assert [one["r"] for one in seen.drawn["pulleys"]] == [81.25, 81.25]
    turned = bd.results.open_run(result).fields_at()["pulley_angle"].values
    assert [one["angle"] for one in seen.drawn["pulleys"]] == pytest.approx(-np.degrees(turned))


def test_it_looks_now_and_then_and_not_before_there_is_a_file(result: Path, tmp_path: Path) -> None:
    assert Watcher(tmp_path / "none.nc").look() is None
    watcher = Watcher(result)
    assert watcher.look() is not None
    watcher._seen = 0.0
    assert watcher.look() is None  # too early

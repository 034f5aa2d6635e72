"""Pictures of the moving drive against the run that they come from."""

import base64

import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.show.report.replay import motion


def unpacked(text: str, kind: type, shape: tuple[int, ...]) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), kind).reshape(shape)


def test_the_belt_is_where_the_run_has_it(run: Run) -> None:
    """To the step of 16-bit numbers over the size of the drive, and the sagitta between points."""
    found = motion(run)
    instants, points = len(found["time"]), found["points"]
    low, high = np.array(found["extent"])
    place = low + unpacked(found["place"], np.uint16, (instants, points, 2)) / 65535 * np.max(high - low)
    nodes = run.fields_at(found["time"][-1])["node_position"].values
    distance = np.linalg.norm(place[-1][None] - nodes[:, None], axis=2).min(axis=1)
    spacing = np.linalg.norm(np.diff(place[-1], axis=0), axis=1)
    assert distance.max() < 0.51 * spacing.max()
    assert np.ptp(spacing) < 0.05 * spacing.mean()


def test_points_stay_in_place_while_the_belt_passes(run: Run) -> None:
    found = motion(run)
    place = unpacked(found["place"], np.uint16, (len(found["time"]), found["points"], 2)).astype(float)
    travelled = found["travel"][-1] - found["travel"][0]
    moved = np.linalg.norm(np.diff(place, axis=0), axis=2).max() / 65535 * np.ptp(found["extent"], axis=0).max()
    assert travelled > 0.1
    assert moved < 0.05


def test_the_travel_is_the_integral_of_the_belts_speed(run: Run) -> None:
    found = motion(run)
    speed = run.dataset["belt_speed"][:, 0]
    assert found["travel"][-1] == pytest.approx(float(speed.integrate("time")), rel=1e-3)
    assert found["angle"][-1] == pytest.approx(run.dataset["pulley_angle"][-1].values, abs=1e-4)


def test_many_runs_have_fewer_pictures_each(run: Run) -> None:
    assert len(motion(run, 3)["time"]) < len(motion(run)["time"])

"""The life of a belt over a duty table and in runs."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps
from beltdyn.points import life as module
from beltdyn.points.duty import Column
from beltdyn.points.life import _extremes, _Sums, life
from beltdyn.points.operating_points import operating_map
from beltdyn.results import Result, Run, open_result
from beltdyn.results.belt_history import BeltHistory
from beltdyn.results.damage import Damage
from beltdyn.state.steady import steady_state
from tests.unit.model.test_web import line

TABLE = "duration [h], large torque [N m], temperature [°C]\n3, -12, 80\n1, -15, 103\n"


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("life") / "duty.csv"
    file.write_text(TABLE, encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def found(fatigue_drive: Drive, table: Path) -> Result:
    return life(fatigue_drive, table=table)


def test_damage_of_the_duty_is_the_mean_of_its_rows(found: Result) -> None:
    dataset, weights = found.dataset, np.array([0.75, 0.25])
    for what in ("cord", "rib"):
        rate = weights @ dataset[f"{what}_damage_rate"].values
        assert float(dataset[f"mean_{what}_damage_rate"]) == pytest.approx(rate)
        np.testing.assert_allclose(dataset[f"{what}_share"], weights @ dataset[f"{what}_damage"].values / rate)
        assert float(dataset[f"{what}_share"].sum()) == pytest.approx(1.0)
    assert float(dataset.cord_life) == pytest.approx(1.0 / float(dataset.mean_cord_damage_rate))
    assert float(dataset.rib_life) == pytest.approx(1e9 / float(dataset.mean_rib_damage_rate))
    assert dataset.cord_life.attrs == {"units": "h", "long_name": "B10 life of the cords"}
    assert dataset.rib_life.attrs["long_name"] == "Life of the ribs"


def test_rows_have_their_temperature_and_torque(found: Result) -> None:
    """23 K halve the life of ribs, and they fail with the tension to the power 1.13."""
    dataset = found.dataset
    tight = dataset.span_tension.max("span").values
    speed = dataset.belt_speed.values
    expected = 2.0 * (tight[1] / tight[0]) ** 1.13 * speed[1] / speed[0]
    assert float(dataset.rib_damage_rate[1] / dataset.rib_damage_rate[0]) == pytest.approx(expected, rel=1e-3)
    assert not any("temperature" in text for text in found.warnings)


def test_history_over_a_turn(found: Result, fatigue_drive: Drive) -> None:
    dataset = found.dataset
    tight, slack = dataset.span_tension.max("span"), dataset.span_tension.min("span")
    np.testing.assert_allclose(dataset.tension.max("place"), tight, rtol=1e-3)
    np.testing.assert_allclose(dataset.tension.min("place"), slack, rtol=0.01)
    strain = 0.004 / fatigue_drive.radii
    np.testing.assert_allclose(-dataset.bending_strain.min("place"), strain.max(), rtol=0.02)
    assert dataset.place.attrs["units"] == "1"
    middle = dataset.arc_place.values[0]
    assert np.all((middle >= 0.0) & (middle < 1.0))
    assert abs(middle[0] - middle[1]) == pytest.approx(0.5, abs=0.02)  # from half an arc over a span to half an arc
    turns = np.exp(2j * np.pi * dataset.place.values)
    for number, bend in enumerate(strain):  # each where the belt bends as much as on that pulley
        on_arc = np.abs(-dataset.bending_strain.values[0] / bend - 1.0) < 0.05
        assert np.angle(turns[on_arc].mean() / np.exp(2j * np.pi * middle[number])) == pytest.approx(0.0, abs=0.3)


def test_relative_to_a_reference(fatigue_drive: Drive, table: Path, found: Result, tmp_path: Path) -> None:
    """A larger pulley: twice the diameter, 2^5.6 times the life of ribs on it."""
    small, large = fatigue_drive.pulleys
    other = fatigue_drive.replace(pulley=[small, large.replace(torque={"kind": "constant", "value": -9.0})])
    own = life(fatigue_drive)
    file, results = tmp_path / "reference.toml", own.save(tmp_path / "own.nc")
    file.write_text(dumps(fatigue_drive), encoding="utf-8")
    for reference in (fatigue_drive, file, own, results):
        relative = life(other, reference=reference).dataset
        for what in ("cord", "rib"):
            rates = [float(one[f"mean_{what}_damage_rate"]) for one in (own.dataset, relative)]
            assert float(relative[f"relative_{what}_life"]) == pytest.approx(rates[0] / rates[1])
            assert float(relative[f"relative_{what}_life"]) > 1.0


def test_a_run_is_added(fatigue_drive: Drive) -> None:
    """Steady running as a run: added as often as it fills the time, it halves the life."""
    run, alone = steady_state(fatigue_drive), life(fatigue_drive)
    once = float(np.ptp(run.dataset.time.values))
    both = life(fatigue_drive, run=run, repeats=3600.0 / once).dataset
    assert float(both.cord_share_of_run) == pytest.approx(0.5, rel=0.01)
    assert float(both.cord_life / alone.dataset.cord_life) == pytest.approx(0.5, rel=0.01)
    assert float(both.rib_life / alone.dataset.rib_life) == pytest.approx(0.5, rel=0.01)


def test_warnings_about_the_line(fatigue_drive: Drive) -> None:
    def with_forces(*forces: float) -> Drive:
        assert fatigue_drive.belt.cord_fatigue is not None
        line = fatigue_drive.belt.cord_fatigue.replace(forces=forces)
        return fatigue_drive.replace(belt=fatigue_drive.belt.replace(cord_fatigue=line))

    weak, strong = life(with_forces(500.0, 400.0)), life(with_forces(2000.0, 1500.0))
    assert any("above the first point of the S-N line, 500 N" in text for text in weak.warnings)
    assert any("below the last point of the S-N line, 1500 N" in text for text in strong.warnings)
    assert strong.dataset.cord_life.attrs["long_name"] == "B10 life of the cords, at least"
    dataset, belt = strong.dataset, fatigue_drive.belt
    stretch = 1.0 + float(dataset.span_tension.mean()) / belt.axial_stiffness
    turns = 3600.0 * float(dataset.belt_speed[0]) / (stretch * strong.drive.belt_length)
    assert float(dataset.cord_life) == pytest.approx(1e9 / turns, rel=1e-4)
    assert any("no temperature of the belt is given, so ribs are at 80 °C" in text for text in weak.warnings)


def test_a_belt_with_ribs_alone_has_their_life(fatigue_drive: Drive) -> None:
    dataset = life(fatigue_drive.replace(belt=fatigue_drive.belt.replace(cord_fatigue=None))).dataset
    assert not [name for name in dataset.data_vars if str(name).startswith(("cord", "mean_cord"))]
    assert float(dataset.rib_life) == pytest.approx(1e9 / float(dataset.mean_rib_damage_rate))
    assert float(dataset.rib_share.sum()) == pytest.approx(1.0)


def turn_of(drive: Drive, curvature: FloatArray, pulley: ArrayLike) -> BeltHistory:
    """A turn at constant tension over equally spaced places."""
    passed = (np.arange(curvature.size) + 0.5) / curvature.size * drive.belt_length
    columns = (np.full(curvature.size, 100.0), curvature, np.asarray(pulley, dtype=int))
    return BeltHistory(passed, passed / 20.0, *(one[:, None] for one in columns))  # type: ignore[arg-type]


def test_the_middle_of_an_arc_is_that_of_its_bends(fatigue_drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of pulleys of any size, and across the end of the turn."""
    places = (np.arange(2000) + 0.5) / 2000
    arcs = ((places > 0.9) | (places < 0.2), (places > 0.5) & (places < 0.6))
    for curvatures in ((50.0, 20.0), (0.5, 0.2)):
        curvature = sum(bend * arc for bend, arc in zip(curvatures, arcs, strict=True))
        history = turn_of(fatigue_drive, np.asarray(curvature), (places > 0.35) & (places < 0.75))
        monkeypatch.setattr(module, "turn_history", lambda _run, history=history: history)
        sums = _Sums(fatigue_drive, [Column("duration", "", [1.0])], None, None)
        sums.take((0,), SimpleNamespace(drive=fatigue_drive))  # type: ignore[arg-type]
        middle = np.asarray(sums.derive({})["arc_place"][1])
        np.testing.assert_allclose(middle, [[0.05, 0.55]], atol=1e-3)


def test_of_several_extremes_in_a_cell_the_outer_ones_stay(fatigue_drive: Drive) -> None:
    """A peak of the curvature near the middle of its range, and a valley at its end; and the other way round."""
    drive = fatigue_drive.replace(belt=fatigue_drive.belt.replace(cord_fatigue=None))
    for outer, inner in ((0.5, 6.0), (9.5, 4.0)):
        curvature = np.full(4000, 5.0)
        curvature[2000:2010] = [5.0, 5.0, inner, 5.0, outer, 5.0, inner, 5.0, 5.0, 5.0]
        curvature[[100, 3000]] = 0.0, 10.0
        history = turn_of(drive, curvature, np.zeros(4000))
        kept = history.curvature[_extremes(drive, history), 0]
        assert kept[200] == outer
        assert (kept.min(), kept.max()) == (0.0, 10.0)


def test_a_belt_without_data(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"the belt has no fatigue data\. Give \[belt\.cord_fatigue\]"):
        life(drive)


def test_a_web_has_no_fatigue_life() -> None:
    with pytest.raises(ModelError, match="the fatigue life needs a closed belt, and this is a web line"):
        life(line())


def test_runs_that_do_not_fit(fatigue_drive: Drive, run: Run, tmp_path: Path, found: Result) -> None:
    with pytest.raises(ModelError, match="the run has the pulleys driver, driven, the drive small, large"):
        life(fatigue_drive, run=run)
    with pytest.raises(ModelError, match="holds results of life"):
        life(fatigue_drive, run=found.save(tmp_path / "life.nc"))
    with pytest.raises(ModelError, match="run holds results of life, not of a run"):
        life(fatigue_drive, run=found)  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="reference holds results of run"):
        life(fatigue_drive, reference=steady_state(fatigue_drive))
    with pytest.raises(ModelError, match=r"repeats = 200 needs a run"):
        life(fatigue_drive, repeats=200.0)
    with pytest.raises(ModelError, match=r"repeats = -1.0 must be at least 0"):
        life(fatigue_drive, run=steady_state(fatigue_drive), repeats=-1.0)


def test_results_are_kept(fatigue_drive: Drive, tmp_path: Path) -> None:
    life(fatigue_drive, output=tmp_path / "life.nc")
    kept = open_result(tmp_path / "life.nc")
    assert (kept.kind, kept.status) == ("life", "completed")
    assert any("temperature" in text for text in kept.warnings)


def test_maps_have_no_columns_of_fatigue(fatigue_drive: Drive) -> None:
    dataset: Any = operating_map(fatigue_drive, load="1, 1.1", force_tolerance=0.05).dataset
    assert not [name for name in dataset.data_vars if "damage" in str(name)]


def test_damage_adds_up() -> None:
    one = Damage(np.array([1.0, 2.0]), np.array([3.0, 4.0]), 10.0, 100.0)
    both = one.times(2.0).plus(one)
    np.testing.assert_array_equal(both.cord, [3.0, 6.0])
    np.testing.assert_array_equal(both.rib, [9.0, 12.0])
    assert (both.turns, both.force) == (30.0, 100.0)

"""Traction curves: where they begin and end, and what they are of."""

from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

import beltdyn.points.traction as curves
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, example, load
from beltdyn.points.traction import traction
from beltdyn.results import open_result
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Table
from beltdyn.state.steady import steady_state
from beltdyn.system.meshing import TOOTH_PHASES
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def loaded() -> Drive:
    drive = better(loaded_two_pulley())
    return drive.replace(contact=drive.contact.replace(friction=0.3))


@pytest.mark.slow
def test_from_nothing_past_gross_slip(loaded: Drive, tmp_path: Path) -> None:
    file = tmp_path / "traction.nc"
    found = traction(loaded, points=8, output=file).dataset
    xr.testing.assert_allclose(open_result(file).dataset[["torque", "elastic"]], found[["torque", "elastic"]])
    assert found.attrs["pulley"] == "driven"
    assert np.all(np.diff(found.torque) > -1e-6 * float(found.limit_torque))
    assert abs(float(found.torque[0])) < 0.1
    assert found.sliding_share[-1] > 0.99
    assert float(found.slip[-1]) == pytest.approx(1.2 * 0.164, rel=0.03)
    assert found.sliding_share[0] < 0.05
    assert float(found.limit_torque) == pytest.approx(float(found.torque[-1]), rel=1e-6)
    np.testing.assert_allclose(found.elastic + found.added + found.slid, found.slip, atol=1e-9)
    np.testing.assert_allclose(found.pulley_slip.sel(pulley="driven"), found.slip, atol=1e-9)


@pytest.mark.slow
def test_where_steps_of_the_slip_are_too_long_shorter_ones_are_taken() -> None:
    """The arc of the alternator slides on nine tenths, and that of the crank on seven: a step of 0.1 % is too long."""
    found = traction(
        load(str(files("beltdyn") / "examples" / "alternator_drive.toml")), slip="2.0..2.6 %", points=6
    ).dataset
    assert np.all(found.failure == "")
    assert np.all(np.diff(found.torque) > 0.0)
    assert found.sliding_share[-1] > 0.9


def test_torques_go_from_zero_to_the_jump(monkeypatch: pytest.MonkeyPatch) -> None:
    drive = example("timing_drive")
    monkeypatch.setattr(curves, "_jump_torque", lambda *_: 10.0)
    curve = curves._of_teeth(drive, 1, 100.0, None, 5, None)
    np.testing.assert_allclose(curve.values, [0.0, 2.5, 5.0, 7.5, 10.0])
    assert curve.label.units == "N m"


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_pulleys_with_teeth_take_torques_against_their_motion(sense: float) -> None:
    """And lag behind the driver by their wind-up, by the phases of the teeth of both."""
    drive, number = example("timing_drive"), 2
    curve = curves._of_teeth(drive, number, 100.0 * sense, "0..40 N m", 5, None)
    for torque in curve.values.tolist():
        assert curve.drive_at(torque, None).pulleys[number].torque.at([0.0])[0] == -sense * torque  # type: ignore[union-attr]
    ratio = drive.pulleys[0].teeth / drive.pulleys[number].teeth  # type: ignore[operator]
    assert ratio != 1.0
    assert curve.then is not None
    for place, angle in enumerate((3.0, 7.0, 4.0)):
        phases = np.full(len(drive.pulleys), np.nan)
        phases[[0, number]] = angle, angle * ratio - sense * 0.01 * place
        dataset = SimpleNamespace(attrs={TOOTH_PHASES: phases})
        curve.then((place,), SimpleNamespace(dataset=dataset, prepared=drive))  # type: ignore[arg-type]
    curve.then((3,), None)
    found = curve.derive({"belt_speed": np.array([1.0, 1.0, 1.0, np.nan, np.nan])})
    np.testing.assert_allclose(np.asarray(found["wind_up"][1]), [0.0, 0.01, 0.02, np.nan, np.nan], atol=1e-12)


@pytest.mark.parametrize(("first", "other"), [(0.8, 0.9), (0.6, 0.9), (0.9, 0.6)])
def test_the_driver_is_firmer_where_both_arcs_are_about_to_slide(
    monkeypatch: pytest.MonkeyPatch, loaded: Drive, first: float, other: float
) -> None:
    monkeypatch.setattr(curves, "_sliding", lambda _run, _number: (first, other))
    curve = curves._of_slip(loaded, 1, -50.0, "0.1, 0.2", 3)
    alone, near = (curve.drive_at(0.1, run) for run in (None, SimpleNamespace()))  # type: ignore[arg-type]
    assert alone.pulleys[1].speed is not None
    assert alone.pulleys[1].speed.at([0.0])[0] == -45.0
    assert alone.pulleys[0] == loaded.pulleys[0]
    firmer = 1.002 if min(first, other) > 0.7 else 1.0
    assert near.frictions == pytest.approx(alone.frictions * [firmer, 1.0], rel=1e-12)
    assert near.pulleys[1] == alone.pulleys[1]
    assert near.pulleys[0].name == alone.pulleys[0].name


def test_parts_of_the_slip_add_up(loaded: Drive) -> None:
    """And the drive of the curve is that without slip."""
    result = traction(loaded, slip="1, 2 %", force_tolerance=0.05)
    found, (driver, driven) = result.dataset, result.drive.pulleys
    np.testing.assert_allclose(found.elastic + found.added + found.slid, found.slip, atol=1e-9)
    assert np.all(found.added > 0.0)
    rims = [one.driven_speed() * radius for one, radius in zip((driver, driven), loaded.rolling_radii, strict=True)]
    assert rims[0] == pytest.approx(rims[1], rel=1e-12)


def test_files_of_others_stay(loaded: Drive, tmp_path: Path) -> None:
    file = tmp_path / "notes.txt"
    file.write_text("of others", encoding="utf-8")
    with pytest.raises(ModelError, match="overwrite"):
        traction(loaded, slip="0.01, 0.02 %", output=file)
    assert file.read_text(encoding="utf-8") == "of others"


def test_which_pulley(loaded: Drive) -> None:
    with pytest.raises(ModelError, match="pulley = 'driver' is the driver"):
        traction(loaded, pulley="driver")
    with pytest.raises(ModelError, match="points = 2 must be at least 3"):
        traction(loaded, points=2)


@pytest.mark.parametrize("breaks", [False, True])
@pytest.mark.parametrize("gross", [3e-4, 4e-3, 0.05, 0.3, 7.0])
def test_gross_slip_is_enclosed_within_two_percent(monkeypatch: pytest.MonkeyPatch, gross: float, breaks: bool) -> None:
    """Of an arc that slides in proportion to its slip, up to 60 %; beyond, steady running may not be found."""
    tried = list[float]()

    def running(slip: float, **_: Any) -> float:
        tried.append(slip)
        if breaks and slip > gross:
            raise ConvergenceError("no steady running")
        return slip

    monkeypatch.setattr(curves, "steady_state", running)
    monkeypatch.setattr(curves, "_sliding", lambda slip, _number: (0.5, min(slip / gross, 1.0)))
    slips = curves._past_gross_slip(lambda part, _firmer: part, 1, 7)  # type: ignore[arg-type, return-value]
    np.testing.assert_allclose(slips, np.linspace(0.0, slips[-1], 7))
    assert 0.99 * min(gross, 0.6) <= slips[-1] / 1.2 <= min(gross / 0.98, 0.6)
    assert len(tried) < 20


def test_where_no_slip_has_steady_running_the_cause_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object, **__: object) -> None:
        raise ConvergenceError("the cause")

    monkeypatch.setattr(curves, "steady_state", never)
    with pytest.raises(ConvergenceError, match="no steady running found at any slip: the cause"):
        curves._past_gross_slip(lambda part, _firmer: part, 1, 7)  # type: ignore[arg-type, return-value]


@pytest.mark.parametrize("limit", [0.3, 2.0, 57.0, 900.0])
def test_the_torque_of_the_jump_is_enclosed_within_two_percent(monkeypatch: pytest.MonkeyPatch, limit: float) -> None:
    """Of a belt that holds any smaller torque; without any, the cause is told."""
    radius, stiffness, tension = 0.05, 1e5, xr.DataArray([[400.0, 200.0]])
    prepared = SimpleNamespace(radii=[0.1, radius], belt=SimpleNamespace(axial_stiffness=stiffness))
    holds, tried = [limit], list[float]()

    def running(torque: float, **_: Any) -> Any:
        tried.append(torque)
        if torque > holds[0]:
            raise ConvergenceError("the cause")
        return SimpleNamespace(prepared=prepared, dataset={"span_tension": tension})

    monkeypatch.setattr(curves, "steady_state", running)
    found = curves._jump_torque(lambda torque: torque, 1, None)  # type: ignore[arg-type, return-value]
    assert 0.98 * limit <= found <= limit
    assert len(tried) <= 9 + abs(np.log2(limit / (400.0 * radius)))  # the first is that of the tight span alone
    holds[0] = 0.0
    with pytest.raises(ConvergenceError, match="no steady running found under any torque: the cause"):
        curves._jump_torque(lambda torque: torque, 1, None)  # type: ignore[arg-type, return-value]


def test_wind_up_counts_from_the_first_point_that_is_found() -> None:
    torques, wind_up = np.array([0.0, 2.0, 4.0, 6.0]), np.array([np.nan, 0.3, 0.5, np.nan])
    for speeds, ahead, limit in (
        ([np.nan, 1.0, 1.0, np.nan], [np.nan, 0.0, 0.2, np.nan], 4.0),
        ([np.nan] * 4, wind_up, -np.inf),
    ):
        found = curves._over_torque({"belt_speed": np.array(speeds)}, torques, wind_up)
        np.testing.assert_allclose(np.asarray(found["wind_up"][1]), ahead, atol=1e-15)
        assert float(np.asarray(found["limit_torque"][1])) == limit


@pytest.mark.slow
def test_guides_that_stand_still_are_no_choice_and_have_no_slip() -> None:
    """The belt slides over them by nature, which is no slip to be judged."""
    drive = load(Path(__file__).parents[3] / "docs" / "tasks" / "handrail.toml")
    found = traction(drive, slip="0.02, 0.04 %").dataset
    assert found.attrs["pulley"] == "roller"
    assert found.largest_slip.isnull().values.tolist() == [False, False, True, True]
    rows = next(one for one in sheet(steady_state(drive)).parts if one.title.startswith("Pulleys"))
    assert isinstance(rows, Table)
    assert [row[5] for row in rows.rows[2:]] == ["–", "–"]

"""Campbell diagram of the paper's loaded drive: modes as `modes` finds them, critical speeds, and failed speeds."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli import main
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.vibration.campbell import campbell
from beltdyn.vibration.modes import modes
from validation.published.cases import better, loaded_two_pulley

SPEEDS = np.array([60.0, 90.0, 120.0])
ORDERS = (1.5, 11.0)


@pytest.fixture(scope="module")
def loaded() -> Drive:
    return better(loaded_two_pulley())


@pytest.fixture(scope="module")
def found(loaded: Drive) -> bd.Result:
    return campbell(loaded, speed="60, 90, 120 rad/s", count=3, orders="1.5, 11")


def test_modes_are_those_of_each_speed(found: bd.Result, loaded: Drive) -> None:
    """Within the error of their meshes, which are others: up to 1 % of contact forces."""
    for speed in (60.0, 120.0):
        alone = modes(loaded, speed=f"{speed} rad/s", count=3).dataset.sel(mode=[1, 2, 3])
        there = found.dataset.sel(speed=speed)
        known = np.argsort(there.frequency.values)[:3]
        np.testing.assert_allclose(there.frequency.values[known], alone.frequency, rtol=5e-3)
        np.testing.assert_allclose(there.damping_ratio.values[known], alone.damping_ratio, rtol=0.03)
        assert [found.dataset.kind.values[one] for one in known] == alone.kind.values.tolist()


def test_modes_are_followed(found: bd.Result) -> None:
    """Spans as moving strings go slower with the speed; the driven pulley swings on them as before."""
    dataset = found.dataset
    assert dataset.sizes["mode"] >= 3
    assert dataset.assurance.values[1:, :3].min() > 0.9
    for mode in np.flatnonzero(dataset.kind.values == "span")[:2]:
        assert np.all(np.diff(dataset.frequency.values[:, mode]) < 0.0)
    total = dataset.span_share.sum("span") + dataset.pulley_share.sum("pulley") + dataset.belt_share
    np.testing.assert_allclose(total.values[np.isfinite(dataset.frequency.values)], 1.0)
    assert float(dataset.growth.max()) < 0.0
    assert not [one for one in found.warnings if "grows" in one or "doubtful" in one]


def test_critical_speeds_lie_on_both_lines(found: bd.Result, loaded: Drive) -> None:
    dataset = found.dataset
    assert dataset.sizes["critical"] >= 2
    for number in range(dataset.sizes["critical"]):
        one = dataset.isel(critical=number)
        mode = int(one.critical_mode) - 1
        order = float(str(one.critical_excitation.values).split()[1])
        assert order in ORDERS
        assert float(one.critical_frequency) == pytest.approx(order * float(one.critical_speed) / (2.0 * np.pi))
        line = np.interp(float(one.critical_speed), SPEEDS, dataset.frequency.values[:, mode])
        assert float(one.critical_frequency) == pytest.approx(line)
        assert float(one.critical_damping_ratio) < 0.71
        nearest = dataset.isel(speed=int(np.argmin(np.abs(SPEEDS - float(one.critical_speed)))), mode=mode)
        parts = {"-".join(span): share for span, share in zip(loaded.spans, nearest.span_share.values, strict=True)}
        parts |= dict(zip(nearest.pulley.values.tolist(), nearest.pulley_share.values, strict=True))
        assert str(one.critical_parts.values).split(", ")[0] == max(parts, key=lambda part: parts[part])


def test_flutter_is_not_found_where_nothing_grows(found: bd.Result) -> None:
    """An arc that slid as a whole could flutter; the driven arcs slide in part."""
    assert float(found.dataset.flutter_rate.max()) < 0.0
    assert float(found.dataset.flutter_bound.min()) > 0.0


@pytest.mark.slow
def test_file_tables_and_screen(
    found: bd.Result, loaded: Drive, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    saved = bd.open_result(found.save(tmp_path / "campbell.nc"))
    assert (saved.kind, saved.dataset.attrs["pulley"]) == ("campbell", "driver")
    tables = {path.name: path.read_text(encoding="utf-8") for path in bd.write_csv(saved, tmp_path / "tables")}
    assert tables["point.csv"].splitlines()[0].startswith("point,speed [rad/s],belt_speed [m/s]")
    assert "frequency 1 [Hz]" in tables["point.csv"]
    assert tables["critical.csv"].startswith("critical,critical_speed [rad/s],critical_excitation,critical_mode [1]")
    file = tmp_path / "drive.toml"
    file.write_text(bd.dumps(loaded), encoding="utf-8")
    with pytest.raises(SystemExit) as end:
        main(["campbell", str(file), "--speed", "60,120rad/s", "--count", "1", "--orders", "1.5"])
    assert end.value.code == 0
    shown = capsys.readouterr().out
    assert "Campbell diagram of" in shown
    assert "order 1.5 of driver" in shown


def test_a_speed_that_fails_is_marked_and_others_stay(loaded: Drive) -> None:
    """With a load that grows with the square of the speed, and a belt that its inertia lifts off.

    The driven pulley on the creep of the belt, the last mode, is damped by 0.897 at 60 rad/s, by more than 0.9 beyond.
    """
    driver, driven = loaded.pulleys
    heavy = driven.replace(torque=None, load=[{"kind": "resistance", "quadratic": 45.0 / 100.0**2}])
    weak = loaded.replace(pulley=[driver, heavy], contact=loaded.contact.replace(friction=0.3))
    found = campbell(weak, speed="60, 90, 2500 rad/s", count=2)
    assert found.dataset.failure.values[:2].tolist() == ["", ""]
    assert "no steady running found" in str(found.dataset.failure.values[2])
    assert np.isfinite(found.dataset.frequency.values[:2]).tolist() == [[True, True, True], [True, True, False]]
    assert np.isnan(found.dataset.frequency.values[2]).all()
    assert any(one.startswith(f"at speed {2500.0 * RPM:.4g} rpm: no operating point") for one in found.warnings)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"count": 0}, "count = 0 must be at least 1"),
        ({"dry_tensioners": "dry"}, "dry_tensioners = 'dry' must be"),
        ({"orders": "first"}, "orders = 'first' must be"),
        ({"speed": "-1..100 rpm"}, "must not be negative"),
        ({"speed": "fast"}, "speed = 'fast' must be a range"),
        ({"pulley": "dirver"}, "driver"),
    ],
)
def test_options_that_make_no_sense(loaded: Drive, options: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        campbell(loaded, **({"speed": "60, 120 rad/s"} | options))


@pytest.mark.slow
def test_near_standstill_lightly_damped_modes_come_first_and_responses_are_finite() -> None:
    """Friction of a belt that hardly moves damps most modes; the start of a run-up is there at all."""
    drive = bd.example("flat_belt_idler").with_(
        {"pulley[motor].speed.start": 0.005, "pulley[motor].harmonics": [{"order": 2.0, "amplitude": 0.02}]}
    )
    found = bd.campbell(drive, speed="0.5, 5 rpm", count=4).dataset
    ratios = found.damping_ratio.values[:, :4]
    assert np.all((ratios < 0.5) | np.isnan(ratios))
    assert np.isfinite(found.frequency.values[:, 0]).all()
    answers = bd.response(drive, speed="0.5, 5 rpm").dataset
    assert answers.failure.values.tolist() == ["", ""]
    assert np.isfinite(answers.span_tension_amplitude.values).all()

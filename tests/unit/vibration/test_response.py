"""Linear response over speed: results of their own, what stands beside, and what excites nothing."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.sparse import linalg

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.state.steady import steady_state
from beltdyn.vibration.response import response
from validation.published.cases import better, loaded_two_pulley

LOAD = {"kind": "resistance", "constant": 45.0, "harmonics": [{"order": 3, "amplitude": 0.02, "phase": 1.0}]}
SPAN = "driver-driven"


@pytest.fixture(scope="module")
def shaken() -> Drive:
    """The paper's loaded drive with a wave in its speed, and one in its load."""
    drive = better(loaded_two_pulley())
    driver, driven = drive.pulleys
    waves = [{"order": 2, "amplitude": 0.002}]
    return drive.replace(pulley=[driver.replace(harmonics=waves), driven.replace(torque=None, load=[LOAD])])


@pytest.fixture(scope="module")
def found(shaken: Drive) -> bd.Result:
    return response(shaken, speed="60, 120 rad/s")


def test_amplitudes_of_each_excitation(found: bd.Result) -> None:
    dataset = found.dataset
    assert dataset.excitation.values.tolist() == ["speed of driver, order 2", "load of driven, order 3"]
    own = dataset.pulley_speed_amplitude.sel(pulley="driver")
    np.testing.assert_allclose(own[:, 0], 0.002 * dataset.speed, rtol=1e-9)
    np.testing.assert_allclose(own[:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(dataset.pulley_speed_phase.sel(pulley="driver")[:, 0], 0.0, atol=1e-9)
    np.testing.assert_allclose(dataset.shaft_torque_amplitude.sel(pulley="driven")[:, 1], 0.02 * 45.0, rtol=1e-6)
    resisting = -np.exp(1j * 1.0)  # -45 N m (1 + 0.02 cos(3 theta + 1))
    np.testing.assert_allclose(np.exp(1j * dataset.shaft_torque_phase.sel(pulley="driven")[:, 1]), resisting, rtol=1e-6)
    total = dataset.span_tension_amplitude.sum("excitation").max("speed")
    np.testing.assert_allclose(dataset.largest_span_tension_amplitude, total)


def test_turning_the_other_way_round(shaken: Drive, found: bd.Result) -> None:
    """Mirrored at the line of the centers, amplitudes are the same, and phases over the angle have the other sign."""
    driver, driven = shaken.pulleys
    back = {"kind": "constant", "value": -120.0}
    turned = shaken.replace(pulley=[driver.replace(speed=back), driven])
    other = response(turned, speed="120 rad/s").dataset.isel(speed=0)
    there = found.dataset.sel(speed=120.0)
    np.testing.assert_allclose(other.span_tension_amplitude[:, ::-1], there.span_tension_amplitude, rtol=5e-3)
    np.testing.assert_allclose(other.pulley_speed_amplitude, there.pulley_speed_amplitude, rtol=5e-3, atol=1e-9)
    shift = other.span_tension_phase.values[0, ::-1] + there.span_tension_phase.values[0]
    np.testing.assert_allclose(np.exp(1j * shift), 1.0, atol=0.01)


def test_beyond_its_range_it_says_why_and_by_how_much(shaken: Drive) -> None:
    driver, driven = shaken.pulleys
    waves = [{"order": 2, "amplitude": 0.4}]
    found = response(shaken.replace(pulley=[driver.replace(harmonics=waves), driven]), speed="60, 120 rad/s")
    (said,) = [one for one in found.warnings if "beyond its range" in one]
    assert said.startswith(
        "the linear response is beyond its range at 2 of 2 speeds, between 573 and 1146 rpm. Worst at"
    )
    error = float(found.dataset.amplitude_error.max())
    size = f"by about {100.0 * error:.2g}%" if error < 1.0 else "by more than their own size"
    assert f"amplitudes may err {size}" in said
    assert "reaches a stop" not in said
    assert "so that the span goes slack" in said
    assert "slides during part of each period" in said
    assert "beltdyn sweep" in said
    assert (found.dataset.amplitude_error.values > 0.05).all()


def test_range_of_small_vibrations(found: bd.Result) -> None:
    dataset = found.dataset
    assert not [one for one in found.warnings if "beyond its range" in one]
    ripple = dataset.span_tension_amplitude.sum("excitation") / dataset.span_tension
    np.testing.assert_allclose(dataset.tension_ripple, ripple, rtol=1e-3)
    assert (dataset.amplitude_error.values < float(dataset.attrs["linear_range"])).all()
    assert (dataset.largest_friction_used.values < 1.0).all()


def test_a_torque_over_the_angle_excites(shaken: Drive) -> None:
    """As much as a wave of the same size: a table of a cosine about the same mean."""
    driver, driven = shaken.pulleys
    angles = np.linspace(0.0, 2.0 * np.pi, 240, endpoint=False)
    torques = -45.0 * (1.0 + 0.02 * np.cos(3.0 * angles + 1.0))
    table = {"kind": "angle_table", "angles": angles.tolist(), "torques": torques.tolist()}
    plain = shaken.replace(pulley=[driver.replace(harmonics=()), driven.replace(load=[LOAD])])
    other = shaken.replace(pulley=[driver.replace(harmonics=()), driven.replace(load=[table])])
    one, two = (response(drive, speed="120 rad/s").dataset for drive in (plain, other))
    assert two.excitation.values.tolist() == ["load of driven, order 3"]
    np.testing.assert_allclose(two.span_tension_amplitude, one.span_tension_amplitude, rtol=0.02)
    np.testing.assert_allclose(two.span_tension_phase, one.span_tension_phase, atol=0.02)


def test_file_and_tables(found: bd.Result, tmp_path: Path) -> None:
    saved = bd.open_result(found.save(tmp_path / "response.nc"))
    assert saved.kind == "response"
    tables = [path.name for path in bd.write_csv(saved, tmp_path / "tables")]
    assert {"point.csv", "span.csv", "pulley.csv", "excitation.csv"} <= set(tables)
    head = (tmp_path / "tables" / "point.csv").read_text(encoding="utf-8").splitlines()[0]
    assert f"span_tension_amplitude speed of driver, order 2 {SPAN} [N]" in head


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"dry_tensioners": "dry"}, "dry_tensioners = 'dry' must be"),
        ({"speed": "-1, 100 rpm"}, "must not be negative"),
        ({"pulley": "dirver"}, "driver"),
        ({"measured": "nowhere.csv"}, "nowhere.csv"),
        ({"compare": "nowhere.nc"}, "nowhere.nc"),
    ],
)
def test_options_that_make_no_sense(shaken: Drive, options: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        response(shaken, **({"speed": "60, 120 rad/s"} | options))


def test_nothing_excites() -> None:
    with pytest.raises(ModelError, match="the drive has no excitation"):
        response(better(loaded_two_pulley()), speed="60, 120 rad/s")


def test_steady_running_is_that_of_the_mean(shaken: Drive, found: bd.Result) -> None:
    run = steady_state(shaken, at=1.0)
    np.testing.assert_allclose(found.dataset.span_tension.sel(speed=120.0), run.dataset.span_tension[-1], rtol=1e-3)


def test_a_motion_that_nothing_holds_has_no_response(shaken: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    """At a point where SuperLU finds the dynamic stiffness singular; the other point is there."""
    factorized, singular = linalg.splu, iter([True])

    def splu(matrix: Any, **options: Any) -> Any:
        if matrix.dtype.kind == "c" and next(singular, False):
            raise RuntimeError("Factor is exactly singular")
        return factorized(matrix, **options)

    monkeypatch.setattr(linalg, "splu", splu)
    found = response(shaken, speed="60, 120 rad/s").dataset
    failures = found["failure"].values.tolist()
    assert "the drive has no response at" in failures[0]
    assert failures[1] == ""
    assert np.isfinite(found["span_tension_amplitude"].sel(speed=120.0)).all()

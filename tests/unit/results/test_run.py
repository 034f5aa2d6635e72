import math
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import FileRecorder, Layout, Run, open_run, summarize
from beltdyn.results.checks import Evidence
from beltdyn.results.checks.ending import NOTHING_RECORDED
from beltdyn.results.checks.machines import stopped_tensioners
from beltdyn.results.energy_balance import energy_put_in
from beltdyn.results.means import pulley_means

MakeRun = Callable[..., Run]


def test_run_from_its_file_knows_its_drive(
    tmp_path: Path, drive: Drive, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], statistics: Any
) -> None:
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(np.array([0.0])))
    recorder.close("completed", statistics)
    run = open_run(str(recorder.path))
    with run.dataset as dataset:
        assert run.drive == drive
        assert run.path == recorder.path
        assert run.status == "completed"
        assert dataset.attrs["steps"] == 1200
        assert {"title", "beltdyn_version", "numba_version", "python_version", "created"} <= dataset.attrs.keys()


def test_a_run_of_a_file_reads_it_when_it_is_asked_for(
    tmp_path: Path, drive: Drive, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], statistics: Any
) -> None:
    """Plain reading and the dataset say the same; another file of the same name is not this run's."""

    def record(instants: int) -> Run:
        recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
        recorder.append(make_chunk(np.linspace(0.0, 1.0, instants)))
        recorder.close("completed", statistics)
        return Run(None, drive, recorder.path)

    run = record(11)
    opened = open_run(tmp_path / "result.nc")
    with opened.dataset:
        assert (run.status, run.outputs) == (opened.status, opened.outputs) == ("completed", 11)
        assert run.warnings == opened.warnings
        assert run.resolution == opened.resolution
        assert repr(summarize(run).pulleys) == repr(summarize(opened).pulleys)  # in which NaN is as NaN
    with run.dataset as dataset:
        assert dataset.sizes["time"] == 11
    replaced = record(11)
    record(12)
    with pytest.raises(ModelError, match="changed, replaced or removed after"):
        _ = replaced.dataset


def test_file_that_is_missing_is_a_model_error(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"missing\.nc does not exist"):
        open_run(tmp_path / "missing.nc")


@pytest.mark.parametrize("content", [b"", b"not a result", b"\x89HDF\r\n\x1a\n" + bytes(100)])
def test_file_that_is_no_netcdf_is_a_model_error(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "result.nc"
    path.write_bytes(content)
    with pytest.raises(ModelError, match="cannot be read"):
        open_run(path)


def test_other_netcdf_is_a_model_error(tmp_path: Path) -> None:
    path = tmp_path / "other.nc"
    xr.Dataset({"a": ("b", [1.0])}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(ModelError, match="not a beltdyn result"):
        open_run(path)


def test_energy_account_that_does_not_close_is_said(make_run: MakeRun) -> None:
    """At its worst instant, wherever in the run that is."""
    errors = np.zeros(11)
    errors[3:5] = 0.004, -0.023
    (warning,) = (text for text in make_run(outputs=11, energy_closure=errors).warnings if "energy balance" in text)
    assert warning.startswith(
        "the energy balance does not close: at t = 0.4 s -2.30% of the energy input is unaccounted for"
    )


def test_energy_that_the_integrator_takes_is_said(make_run: MakeRun, run: Run) -> None:
    """As a part of what was stored at first and put in by then."""
    put_in = energy_put_in(run.dataset)
    taken = np.where(np.arange(len(put_in)) == 3, 0.02, 0.002) * put_in
    (warning,) = (text for text in make_run(numerical_loss=taken).warnings if "time steps" in text)
    time = float(run.dataset["time"][3])
    assert f"has dissipated 2.00% of the energy input by t = {time:.4g} s" in warning
    assert "Reduce simulation.rtol from 0.0001 to 1e-05" in warning


def test_energy_account_without_a_number_is_said(make_run: MakeRun) -> None:
    errors = np.zeros(11)
    errors[2] = np.nan
    assert any(
        text.startswith("the energy balance does not close: at t = 0.2 s nan%")
        for text in make_run(outputs=11, energy_closure=errors).warnings
    )


def test_slack_span_is_said(make_run: MakeRun) -> None:
    tension = np.full((11, 2), 30.0)
    tension[4, 1] = -1.5
    (warning,) = (warning for warning in make_run(outputs=11, span_tension=tension).warnings if "slack" in warning)
    assert "(tension zero or negative): driven-driver to -1.5 N at t = 0.4 s." in warning
    assert "are wrong in 9% of the run. Raise the installed tension by more than 1.5 N" in warning


def test_what_the_mesh_does_not_resolve_is_said(run: Run) -> None:
    (warning,) = Run(run.dataset, run.drive).warnings
    assert warning.startswith("the belt has too few elements for peak pressure")
    assert "(over 100%)" in warning
    assert "speeds and torques need fewer elements. Set belt.elements = " in warning


def test_resolved_run_says_nothing(run: Run, fine_drive: Drive) -> None:
    assert Run(run.dataset, fine_drive).warnings == []


def test_interrupted_run_is_said(make_run: MakeRun) -> None:
    (finding,) = (one for one in make_run(status="interrupted").findings if "interrupted" in one.fault)
    assert finding.fault == "the run was interrupted: results end at t = 1 s of 1 s."


def test_run_without_outputs_is_said(run: Run) -> None:
    empty = Run(run.dataset.isel(time=slice(0)), run.drive)
    assert empty.findings == [NOTHING_RECORDED]


def test_belt_that_leaves_a_pulley_is_said(make_run: MakeRun) -> None:
    wrap = np.full((11, 2), np.pi)
    wrap[3:5, 1] = 0.0
    (warning,) = (text for text in make_run(outputs=11, wrap_angle=wrap).warnings if "lifts off" in text)
    assert warning.startswith("the belt lifts off driven at t = 0.3 s. ")
    assert "values are missing in 18% of the run." in warning


def test_pulley_near_gross_slip_is_said(make_run: MakeRun) -> None:
    """Of 10 and 100 N; the friction needed is ln(99.9 / 9.9) / 1.2 pi of the drive's, 61 %."""
    torque = np.tile([-90.0, 90.0], (101, 1)) * 0.08125
    run = make_run(span_tension=np.tile([10.0, 100.0], (101, 1)), pulley_torque=torque)
    (warning,) = (text for text in run.warnings if "near gross slip" in text)
    safety = min(one.slip_safety for one in summarize(run).pulleys)
    assert 1.2 < safety < 1.4
    assert warning.startswith("driver and driven are near gross slip: the slip safety is 1.")
    assert "drops by more than 39%" in warning
    lifted = 0.1036 * 0.975**2 / 55.0
    raised, lowered = (1.5 / safety - 1.0) * (1.0 - lifted), 1.0 - safety / 1.5
    assert f"the belt by about {math.ceil(100 * raised)}%, reduce the loads by {math.ceil(100 * lowered)}%" in warning


@pytest.mark.parametrize("tight", np.linspace(70.0, 80.0, 41).tolist())
def test_a_remedy_never_asks_for_nothing(make_run: MakeRun, tight: float) -> None:
    """Also where the slip safety is a hair below its limit, which then is not said to be below itself."""
    for warning in make_run(span_tension=np.tile([10.0, tight], (101, 1))).warnings:
        assert " 0%" not in warning.split("Raise the tension")[-1]
        assert "is 1.50" not in warning


def test_pulley_that_slides_through_is_said(make_run: MakeRun, run: Run) -> None:
    touched = run.dataset["contact_pulley"].values
    found = make_run(slip_velocity=np.where(touched == 1, 0.4, 0.0)).warnings
    assert any(text.startswith("gross slip: the belt slides on the whole arc of driven, at 0.39") for text in found)
    assert not any(text.startswith("driver") for text in found)


def test_flutter_is_said(run: Run, fine_drive: Drive) -> None:
    """Twice the root of 1e7 N/m^2 and 0.1036 kg/m is 2.0e3 N s/m^2."""

    def warnings(growth: float) -> list[str]:
        found = {"growth": growth, "rate": 700.0, "frequency": 1498.4, "start": 0.082, "end": 0.12}
        attributes = {f"flutter_{name}": value for name, value in found.items()}
        return Run(run.dataset.assign_attrs(attributes), fine_drive).warnings

    assert warnings(4.6) == []
    assert warnings(18.6) == [
        "the belt may flutter where it slides: between t = 0.082 s and 0.12 s, vibrations of 1498 Hz could grow by a "
        "factor of 1e+08. Contact forces are then uncertain; a run with simulation.rtol = 1e-05 shows by how much "
        "speeds and slip are. Real belts rarely flutter like this. Increase contact.damping from 10 to 1e+03 N s/m^2, "
        "half of critical."
    ]
    assert "could grow by a factor of 1e+304." in warnings(1e4)[0]


def test_gross_slip_that_has_passed_is_said(make_run: MakeRun) -> None:
    """The whole arc of the driver slides from 0.2 to 0.3 s: two outputs of 0.1 s each."""
    sliding = np.zeros((11, 2))
    sliding[2:4, 0] = 0.1
    found = make_run(outputs=11, sliding_speed=sliding).warnings
    torque = float(make_run(outputs=11).dataset["pulley_torque"][2, 0])
    (warning,) = (text for text in found if "in gross slip" in text)
    said = f"the belt was in gross slip on driver from t = 0.2 to 0.3 s, starting at {abs(torque):.4g} N m"
    assert warning.startswith(said)
    assert "for 0.2 s in total" in warning


@pytest.mark.parametrize(
    ("position", "said"),
    [
        (np.linspace(0.0, 1.0, 11), ["upper stop since t = 0.5 s"]),
        (np.full(11, -0.7), ["lower stop since t = 0 s"]),
        (np.linspace(-0.4, 0.4, 11), []),
        (np.linspace(1.0, 0.0, 11), ["upper stop between t = 0 s and 0.5 s"]),
        (np.linspace(-1.0, 1.0, 11), ["lower stop between t = 0 s and 0.2 s", "upper stop since t = 0.8 s"]),
        (np.tile([0.0, 0.6], 6)[:11], ["upper stop between t = 0.1 s and 0.9 s, 5 times"]),
        (np.tile([0.6, 0.0], 6)[:11], ["upper stop since t = 1 s, and first reached it at t = 0 s"]),
    ],
)
def test_tensioner_on_its_stop_is_said(run: Run, position: np.ndarray, said: list[str]) -> None:
    """The drive is as much of one as the check asks for."""
    tensioners = [
        SimpleNamespace(pulley="driven", stops=(-0.5, 0.5)),
        SimpleNamespace(pulley="idler", stops=None),
    ]
    places, tensions = np.stack([position, 9.0 + position], axis=1), np.full((11, 2), 25.0)
    dataset = {"time": np.linspace(0.0, 1.0, 11), "tensioner_position": places, "span_tension": tensions}
    evidence = Evidence(dataset, SimpleNamespace(moving_tensioners=tensioners), None, tuple)  # type: ignore[arg-type]
    found = list(stopped_tensioners(evidence))
    assert [finding.fault.removesuffix(".").split(" on its ")[1] for finding in found] == said
    assert all("(25 N on average)" in finding.spoils for finding in found)
    lengths = ["Shorten" if "upper" in text else "Lengthen" for text in said]
    assert [finding.remedy.split(" the belt")[0] for finding in found] == lengths


def test_summary_and_findings_share_the_means_of_pulleys(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Slip safety takes most of the time of both."""
    counted = list[str]()

    def counting(recorded: Any, prepared: Any) -> Any:
        counted.append("once")
        return pulley_means(recorded, prepared)

    known = run.warnings
    monkeypatch.setattr("beltdyn.results.run.pulley_means", counting)
    again = Run(run.dataset, run.drive)
    assert summarize(again).pulleys is again.pulley_means
    assert again.warnings == known
    assert len(counted) == 1

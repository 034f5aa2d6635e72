from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import FileRecorder, Layout, Run, open_run, summarize

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
        assert summarize(run).pulleys == summarize(opened).pulleys
    with run.dataset as dataset:
        assert dataset.sizes["time"] == 11
    replaced = record(11)
    record(12)
    with pytest.raises(ModelError, match="changed, replaced or removed since"):
        _ = replaced.dataset


def test_file_that_is_missing_is_a_model_error(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot be read"):
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
    with pytest.raises(ModelError, match="not a result of beltdyn"):
        open_run(path)


def test_energy_account_that_does_not_close_is_said(make_run: MakeRun) -> None:
    run = make_run(outputs=11, energy_closure=np.linspace(0.0, -0.023, 11))
    assert any(warning.startswith("the energy account is open by -2.30%") for warning in run.warnings)


def test_slack_span_is_said(make_run: MakeRun) -> None:
    tension = np.full((11, 2), 30.0)
    tension[4, 1] = -1.5
    (warning,) = (warning for warning in make_run(outputs=11, span_tension=tension).warnings if "slack" in warning)
    assert warning.startswith("the span driven-driver is slack: its tension falls to -1.5 N at t = 0.4 s.")


def test_unresolved_forces_and_tensions_are_said(make_run: MakeRun, run: Run) -> None:
    force, variation = run.dataset["normal_force"].values, run.dataset["tension_variation"].values
    checkered = force * np.where(np.arange(force.shape[1]) % 2, 1.3, 0.7)
    (warning,) = make_run(normal_force=checkered, tension_variation=4.0 * variation).warnings
    assert warning == (
        "the mesh does not resolve the contact forces along driver and driven (they ripple by 29% of their mean), and "
        "the tension (up to 9% too high). Speeds converge earlier. Set belt.elements = 35 or more, in place of 20."
    )


def test_resolved_run_says_nothing(run: Run) -> None:
    assert run.warnings == []


def test_interrupted_run_is_said(make_run: MakeRun) -> None:
    assert "the run was interrupted: results end at t = 1 s of 1 s." in make_run(status="interrupted").warnings


def test_run_without_outputs_is_said(run: Run) -> None:
    empty = Run(run.dataset.isel(time=slice(0)), run.drive)
    assert empty.warnings == ["nothing was recorded: the run ended before its first output."]

"""What a run takes of a disk or of memory is known before, and refused where there is no room; fields are seldom."""

import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import psutil
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.observation.recording import result_layout
from beltdyn.results import expected_bytes, open_run
from beltdyn.system.build import drive_system

Change = Callable[..., Drive]
KINDS: dict[str, Any] = {
    "ancf": {},
    "multipliers": {"simulation": {"joint": "multipliers"}},
    "nodal": {"contact": {"sampling": "nodal"}},
    "truss": {"belt": {"elements": 30, "discretization": "truss"}},
    "three-node-beam": {"belt": {"elements": 30, "discretization": "three-node-beam"}},
}


@pytest.mark.parametrize("kind", KINDS)
def test_every_array_is_counted(change: Change, kind: str) -> None:
    """The bytes of a run without gaps between chunks are those of its arrays."""
    drive = change(**KINDS[kind])
    layout, instants = result_layout(prepare(drive), drive_system(prepare(drive))), drive.simulation.instants
    counts = {"time": instants.count, "field_time": instants.fields, "filtered_time": instants.count}
    arrays = sum(
        int(np.prod(layout.shape(variable, counts[variable.dims[0]]))) * np.dtype(variable.dtype).itemsize
        for variable in layout.recorded.values()
    )
    pieces = 40_000 * len(layout.recorded) + 64_000
    assert arrays < expected_bytes(prepare(drive)) < arrays + pieces


def test_a_file_is_as_large_as_was_said(change: Change, tmp_path: Path) -> None:
    drive = change(simulation={"duration": 5e-3, "output_interval": 1e-6, "field_interval": 1e-5})
    simulate(drive, tmp_path / "run.nc")
    assert (tmp_path / "run.nc").stat().st_size == pytest.approx(expected_bytes(prepare(drive)), rel=0.1)


def test_no_room_is_said_before(change: Change, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=10_000))
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=10_000))
    with pytest.raises(ModelError, match=r"need .*MB of the disk of .*only 10 kB are free.*output_interval"):
        simulate(change(), tmp_path / "run.nc")
    assert not list(tmp_path.iterdir())
    with pytest.raises(ModelError, match=r"of memory, but only 10 kB are free.*Write them to a file"):
        simulate(change())


OFTEN = {"duration": 2.5e-3, "output_interval": 1e-5, "rtol": 1e-3}


@pytest.fixture(scope="module")
def always(change: Change) -> xr.Dataset:
    """A run that records its fields at each output."""
    return simulate(change(simulation=OFTEN | {"field_interval": 1e-5})).dataset


@pytest.mark.parametrize("interval", [None, 3e-4, 1e-3])
def test_fields_are_recorded_as_often_as_asked_for_and_at_the_end(
    change: Change, always: xr.Dataset, tmp_path: Path, interval: float | None
) -> None:
    """And are those of the outputs at the same instants of a run that records them always."""
    seldom = {} if interval is None else {"field_interval": interval}
    run = simulate(change(simulation=OFTEN | seldom), tmp_path / "run.nc")
    expected = np.append(np.arange(0.0, 2.5e-3 - 1e-9, interval or 2e-5), 2.5e-3)
    np.testing.assert_allclose(run.dataset["field_time"], expected, rtol=1e-9)
    same = always.sel(field_time=run.dataset["field_time"].values)
    for name in ("nodal_coordinates", "normal_force", "contact_pulley", "node_position"):
        np.testing.assert_array_equal(run.dataset[name], same[name])
    for name in ("span_tension", "sliding_speed", "mid_span_displacement", "energy_closure"):
        np.testing.assert_array_equal(run.dataset[name], always[name])
    assert run.fields.sizes["time"] == len(expected)
    np.testing.assert_array_equal(run.fields["span_tension"][-1], always["span_tension"][-1])
    for name in ("friction_work_on_arc", "friction_work_on_belt"):
        total = always[name].values.sum(axis=0, dtype=float)
        np.testing.assert_allclose(run.dataset[name].sum("field_time"), total, rtol=1e-5, atol=1e-5 * total.max())
    assert open_run(tmp_path / "run.nc").fields_at(1.2e-3)["normal_force"].dims == ("contact_point",)


def test_friction_work_is_what_is_lost(change: Change) -> None:
    """With friction about the rim, the work of |f_t v_t| over all places is the energy account's loss in friction.

    Both are integrals over the same steps and points by the same rule; the account takes forces before the last change
    of Newton's method.
    """
    drive = change(
        contact={"moment_arm": "rim", "integration": "fixed"},
        simulation={"duration": 5e-3, "output_interval": 1e-5, "start": "laid"},
    )
    dataset = simulate(drive).dataset
    lost = float(dataset["friction_loss"][-1])
    assert lost > 0.0
    for name in ("friction_work_on_arc", "friction_work_on_belt"):
        assert float(dataset[name].sum()) == pytest.approx(lost, rel=1e-3)

"""What VTK reads of a file is what was recorded."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.atomic import MARK
from beltdyn.results.export import SECTORS, Ribbon, write_vtkhdf

BELT, PULLEYS = 0, 1
SINGLE = 2e-7
"""Relative error of numbers in single precision, with some margin."""


class Read:
    """A file as VTK reads it."""

    def __init__(self, path: Path) -> None:
        self._reader = vtkHDFReader()
        self._reader.SetFileName(str(path))
        self._reader.UpdateInformation()
        self.times = self._reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())

    def at(self, time: float) -> Any:
        self._reader.UpdateTimeStep(time)
        return self._reader.GetOutput()


def values(part: Any, name: str, on: str = "Cell") -> Any:
    return vtk_to_numpy(getattr(part, f"Get{on}Data")().GetArray(name))


@pytest.fixture(scope="module")
def written(run: Run, tmp_path_factory: pytest.TempPathFactory) -> list[Read]:
    return [Read(path) for path in write_vtkhdf(run, tmp_path_factory.mktemp("vtk") / "drive.nc")]


def test_steps_are_the_instants_of_fields(written: list[Read], run: Run) -> None:
    for read in written:
        np.testing.assert_array_equal(read.times, run.dataset["field_time"].values)


@pytest.mark.parametrize("number", [0, 40, 100])
def test_the_belt_at_an_instant(written: list[Read], run: Run, number: int) -> None:
    """Nodes, width, tension by element, and contact where it is recorded; beyond the first batch too."""
    time = float(run.dataset["field_time"][number])
    belt, fields, ribbon = written[BELT].at(time), run.fields_at(time), Ribbon(run)
    places = vtk_to_numpy(belt.GetPoints().GetData())
    nodes = 2 * np.searchsorted(ribbon.coordinate, run.dataset["node_coordinate"].values - 1e-12)
    np.testing.assert_allclose(places[nodes, :2], fields["node_position"], rtol=SINGLE, atol=1e-8)
    np.testing.assert_allclose(places[nodes + 1, 2] - places[nodes, 2], run.drive.belt.width, rtol=SINGLE)
    assert belt.GetNumberOfCells() == len(ribbon.surface.corners) == belt.GetNumberOfPolys()
    np.testing.assert_allclose(values(belt, "belt_tension")[nodes // 2], fields["belt_tension"], rtol=SINGLE)
    points = 2 * np.searchsorted(ribbon.coordinate, run.dataset["belt_coordinate"].values - 1e-9)
    for name in ("normal_force", "slip_velocity"):
        np.testing.assert_allclose(values(belt, name, "Point")[points], fields[name], rtol=1e-6, atol=1e-9)
    pressure = fields["normal_force"] / run.drive.belt.width
    np.testing.assert_allclose(values(belt, "contact_pressure", "Point")[points], pressure, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("number", [0, 40, 100])
def test_the_pulleys_at_an_instant(written: list[Read], run: Run, number: int) -> None:
    time = float(run.dataset["field_time"][number])
    pulleys, fields = written[PULLEYS].at(time), run.fields_at(time)
    places = vtk_to_numpy(pulleys.GetPoints().GetData()).reshape(2, 2, SECTORS + 1, 3)
    for pulley, (center, angle) in enumerate(zip(fields["pulley_center"].values, fields["pulley_angle"], strict=True)):
        direction = np.array([np.cos(angle), np.sin(angle)])
        rim = center + (run.drive.pulleys[pulley].radius - 0.5 * run.drive.belt.thickness) * direction
        np.testing.assert_allclose(places[pulley, :, 1, :2], [rim, rim], rtol=SINGLE, atol=1e-8)
        one = values(pulleys, "pulley") == pulley
        np.testing.assert_allclose(values(pulleys, "pulley_angle")[one], angle, rtol=SINGLE)
        np.testing.assert_allclose(values(pulleys, "pulley_torque")[one], fields["pulley_torque"][pulley], rtol=SINGLE)


def test_files_of_ours_are_replaced_and_others_are_not(make_run: Callable[..., Run], tmp_path: Path) -> None:
    run = make_run(3)
    for _ in range(2):
        belt, pulleys = write_vtkhdf(run, tmp_path / "drive.nc")
    assert [belt.name, pulleys.name] == ["drive-belt.vtkhdf", "drive-pulleys.vtkhdf"]
    with h5py.File(pulleys, "w") as file:
        file.create_group("VTKHDF")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(ModelError, match=r"pulleys\.vtkhdf already exists"):
        write_vtkhdf(run, tmp_path / "drive.nc")
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
    write_vtkhdf(run, tmp_path / "drive.nc", overwrite=True)
    assert set(tmp_path.iterdir()) == {belt, pulleys}
    with h5py.File(pulleys) as file:
        assert file.attrs["creator"] == MARK

"""Results of analyses that have dimensions of their own."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Result, Run, Variable, build_result, open_result, open_run
from beltdyn.show import plot
from beltdyn.show.plot.figures import always, figure
from beltdyn.show.plot.style import axes_or_new

LOADS = np.array([1.0, 2.0, 4.0])


@pytest.fixture
def grip(drive: Drive) -> Result:
    """Slip over torque."""
    return build_result(
        "grip",
        drive,
        {"slip": (Variable(("torque",), "1", "Slip"), 1e-3 * LOADS)},
        {"torque": (Variable(("torque",), "N m", "Torque"), LOADS)},
        ["gross slip beyond 4 N m", "the mesh is coarse"],
    )


def test_a_result_says_what_it_is(grip: Result) -> None:
    assert grip.kind == "grip"
    assert grip.warnings == ["gross slip beyond 4 N m", "the mesh is coarse"]
    assert grip.dataset["slip"].sel(torque=2.0) == 2e-3
    assert grip.dataset["torque"].attrs == {"units": "N m", "long_name": "Torque"}
    assert "grip" in repr(grip)
    assert "Torque" in grip._repr_html_()


def test_its_file_holds_the_same(grip: Result, drive: Drive, tmp_path: Path) -> None:
    opened = open_result(grip.save(tmp_path / "grip.nc"))
    xr.testing.assert_identical(opened.dataset.load(), grip.dataset)
    assert (opened.kind, opened.drive, opened.warnings) == ("grip", drive, grip.warnings)
    assert not isinstance(opened, Run)


def test_a_file_is_replaced_only_if_it_is_a_result(grip: Result, tmp_path: Path) -> None:
    path = grip.save(grip.save(tmp_path / "grip.nc"))
    path.write_text("mine", encoding="utf-8")
    with pytest.raises(ModelError, match=r"grip\.nc"):
        grip.save(path)
    assert grip.save(path, overwrite=True) == path


def test_it_is_no_run(grip: Result, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"is the result of another analysis \(grip\)"):
        open_run(grip.save(tmp_path / "grip.nc"))


def test_a_run_is_opened_as_such(run: Run, tmp_path: Path) -> None:
    opened = open_result(run.save(tmp_path / "run.nc"))
    assert isinstance(opened, Run)
    assert opened.kind == "run"
    xr.testing.assert_identical(opened.dataset.load(), run.dataset)


def test_a_file_whose_drive_is_none_is_refused(grip: Result, tmp_path: Path) -> None:
    grip.dataset.attrs["drive"] = "[belt]\nlength = -1"
    with pytest.raises(ModelError, match="cannot be read as a result file"):
        open_result(grip.save(tmp_path / "grip.nc"))


def test_a_file_that_does_not_exist_is_not_called_damaged(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"none\.nc does not exist\. Give"):
        open_result(tmp_path / "none.nc")


def test_its_figures_are_those_of_its_kind(grip: Result, run: Run, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="there is no figure for grip"):
        plot.save_all(grip, tmp_path)

    @figure(always, of=("grip",))
    def curve_of_grip(result: Result, ax: Axes | None = None) -> Axes:
        ax = axes_or_new(ax)
        ax.plot(result.dataset["torque"], result.dataset["slip"])
        return ax

    assert [path.name for path in plot.save_all(grip, tmp_path)] == ["curve_of_grip.png"]
    with pytest.raises(
        ModelError,
        match=r"of run; these are of grip\. Available figures: curve_of_grip\.",
    ):
        plot.save_all(grip, tmp_path, ["speeds"])
    with pytest.raises(ModelError, match="'curve_of_grip' shows results of grip; these are of run"):
        plot.save_all(run, tmp_path, ["curve_of_grip"])

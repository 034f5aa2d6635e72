"""Results of analyses that have dimensions of their own."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from beltdyn import plot
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.plot.registry import FIGURES, always, figure
from beltdyn.plot.style import axes_or_new
from beltdyn.results import Result, Run, Variable, build_result, open_result, open_run

LOADS = np.array([1.0, 2.0, 4.0])


@pytest.fixture
def traction(drive: Drive) -> Result:
    """Slip over torque."""
    return build_result(
        "traction",
        drive,
        {"slip": (Variable(("torque",), "1", "Slip"), 1e-3 * LOADS)},
        {"torque": (Variable(("torque",), "N m", "Torque"), LOADS)},
        ["gross slip beyond 4 N m", "the mesh is coarse"],
    )


def test_a_result_says_what_it_is(traction: Result) -> None:
    assert traction.kind == "traction"
    assert traction.warnings == ["gross slip beyond 4 N m", "the mesh is coarse"]
    assert traction.dataset["slip"].sel(torque=2.0) == 2e-3
    assert traction.dataset["torque"].attrs == {"units": "N m", "long_name": "Torque"}
    assert "traction" in repr(traction)
    assert "torque" in traction._repr_html_()


def test_its_file_holds_the_same(traction: Result, drive: Drive, tmp_path: Path) -> None:
    opened = open_result(traction.save(tmp_path / "traction.nc"))
    xr.testing.assert_identical(opened.dataset.load(), traction.dataset)
    assert (opened.kind, opened.drive, opened.warnings) == ("traction", drive, traction.warnings)
    assert not isinstance(opened, Run)


def test_a_file_is_replaced_only_if_it_is_a_result(traction: Result, tmp_path: Path) -> None:
    path = traction.save(traction.save(tmp_path / "traction.nc"))
    path.write_text("mine", encoding="utf-8")
    with pytest.raises(ModelError, match=r"traction\.nc"):
        traction.save(path)
    assert traction.save(path, overwrite=True) == path


def test_it_is_no_run(traction: Result, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"is the result of another analysis, traction"):
        open_run(traction.save(tmp_path / "traction.nc"))


def test_a_run_is_opened_as_such(run: Run, tmp_path: Path) -> None:
    opened = open_result(run.save(tmp_path / "run.nc"))
    assert isinstance(opened, Run)
    assert opened.kind == "run"
    xr.testing.assert_identical(opened.dataset.load(), run.dataset)


def test_a_file_whose_drive_is_none_is_refused(traction: Result, tmp_path: Path) -> None:
    traction.dataset.attrs["drive"] = "[belt]\nlength = -1"
    with pytest.raises(ModelError, match="cannot be read as a result file"):
        open_result(traction.save(tmp_path / "traction.nc"))


def test_its_figures_are_those_of_its_kind(traction: Result, run: Run, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="there is no figure of traction"):
        plot.save_all(traction, tmp_path)
    before = dict(FIGURES)

    @figure(always, of=("traction",))
    def traction_curve(result: Result, ax: Axes | None = None) -> Axes:
        ax = axes_or_new(ax)
        ax.plot(result.dataset["torque"], result.dataset["slip"])
        return ax

    try:
        assert [path.name for path in plot.save_all(traction, tmp_path)] == ["traction_curve.png"]
        with pytest.raises(
            ModelError,
            match=r"of run, and these are of traction\. .* there are: traction_curve\.",
        ):
            plot.save_all(traction, tmp_path, ["speeds"])
        with pytest.raises(ModelError, match="'traction_curve' shows results of traction, and these are of run"):
            plot.save_all(run, tmp_path, ["traction_curve"])
    finally:
        FIGURES.clear()
        FIGURES.update(before)

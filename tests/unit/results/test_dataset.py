"""Files of other versions: earlier ones open, and later ones that this version would misread are refused."""

import gzip
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import matplotlib.pyplot as plt
import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import COORDINATES, VARIABLES, open_run, summarize, write_csv
from beltdyn.results.schema import FORMAT
from beltdyn.show import plot

KEPT = Path(__file__).parent / "kept" / "format_1_0.nc.gz"
"""The paper's drive with 16 elements, 81 outputs in 0.12 s, written by the first version with a format."""

EXTRA = [name for name, variable in (VARIABLES | COORDINATES).items() if not variable.core]


def slow(*names: str) -> list[Any]:
    """Further names, of which the same is told; with these files alone readers look for lengths in all variables."""
    return [pytest.param(name, marks=pytest.mark.slow) for name in names]


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    path = tmp_path / "kept.nc"
    path.write_bytes(gzip.decompress(KEPT.read_bytes()))
    return path


@pytest.fixture
def change(tmp_path: Path) -> Callable[[Callable[[h5py.File], None]], Path]:
    """Change a copy of the kept file."""

    def make(changed: Callable[[h5py.File], None]) -> Path:
        path = tmp_path / "changed.nc"
        path.write_bytes(gzip.decompress(KEPT.read_bytes()))
        with h5py.File(path, "r+") as file:
            changed(file)
        return path

    return make


def take(file: h5py.File, *names: str) -> None:
    """Take variables away."""
    for name in names:
        for axis in file[name].dims:
            for scale in axis.values():
                axis.detach_scale(scale)
        del file[name]


def take_extras(file: h5py.File) -> None:
    """Leave the core alone."""
    take(file, *(file.keys() & set(EXTRA)))


@pytest.mark.slow
def test_the_kept_file_is_drawn(kept: Path, tmp_path: Path) -> None:
    """All but what the drive has not, tensioners, teeth, nips and carriage, and what needs more turns of the belt."""
    teeth = ("load_sharing", "transmission_error", "transmission_orders")
    left = ("tensioners", "carriage_error", "nip_pressure", *teeth, "waterfall", "orders")
    chosen = [name for name, figure in plot.FIGURES.items() if "run" in figure.of and name not in left]
    assert len(plot.save_all(open_run(kept), tmp_path, chosen)) == len(chosen)
    plt.close("all")


def test_the_kept_file_says_what_it_said(kept: Path) -> None:
    assert KEPT.stat().st_size < 100_000
    run = open_run(kept)
    summary = summarize(run)
    assert (summary.status, summary.outputs, summary.integrator) == ("completed", 81, "generalized_alpha")
    assert [pulley.speed for pulley in summary.pulleys] == pytest.approx([1.3963636, 1.344366], rel=1e-6)
    assert [span.tension for span in summary.spans] == pytest.approx([7.8778129, 53.411369], rel=1e-6)
    assert any("too few elements for peak pressure" in warning for warning in run.warnings)
    assert not any("nan" in warning for warning in run.warnings)
    run.dataset.close()


@pytest.mark.slow
def test_a_file_with_the_core_alone_is_summed_up_drawn_and_tabled(kept: Path, change: Callable[..., Path]) -> None:
    run = open_run(change(take_extras))
    whole = open_run(kept)
    assert len(run.dataset.data_vars) < len(whole.dataset.data_vars) - 10
    assert repr(summarize(run)) == repr(summarize(whole))  # in which NaN is as NaN
    by_default = [name for name, figure in plot.FIGURES.items() if "run" in figure.of and figure.by_default(run)]
    assert sorted(path.stem for path in plot.save_all(run, kept.parent / "figures")) == sorted(by_default)
    assert {"pulleys.csv", "energy.csv"} < {path.name for path in write_csv(run, kept.parent / "tables")}
    plt.close("all")


@pytest.mark.parametrize("figure", ["wear_by_arc", *slow("wear_by_belt", "mid_spans", "tension_spectrum")])
def test_what_a_file_does_not_hold_is_named(change: Callable[..., Path], tmp_path: Path, figure: str) -> None:
    run = open_run(change(take_extras))
    with pytest.raises(ModelError, match=r"has no `\w+`: .* Run the drive again"):
        plot.save_all(run, tmp_path, [figure])


def test_more_than_is_known_is_kept(change: Callable[..., Path]) -> None:
    def add(file: h5py.File) -> None:
        added = file.create_dataset("pulley_temperature", data=np.full((81, 2), 20.0))
        for axis, dim in enumerate(("time", "pulley")):
            added.dims[axis].attach_scale(file[dim])

    run = open_run(change(add))
    assert run.dataset["pulley_temperature"].dims == ("time", "pulley")
    assert summarize(run).outputs == 81


@pytest.mark.parametrize("name", ["span_tension", *slow("node_coordinate", "kinetic_energy")])
def test_a_file_without_a_part_of_the_core_is_refused(change: Callable[..., Path], name: str) -> None:
    with pytest.raises(ModelError, match=rf"is incomplete: it has no `{name}`\. Run the drive again"):
        open_run(change(lambda file: take(file, name)))


def test_a_later_format_is_refused(change: Callable[..., Path]) -> None:
    with pytest.raises(ModelError, match=r"has format 2\.3, written by beltdyn 9\.1; .* Install a newer beltdyn\."):
        open_run(change(lambda file: file.attrs.update(format="2.3", beltdyn_version="9.1")))


def test_a_later_minor_format_opens(change: Callable[..., Path]) -> None:
    assert open_run(change(lambda file: file.attrs.update(format=f"{FORMAT[0]}.99"))).outputs == 81


def test_the_first_files_which_say_no_format_open(change: Callable[..., Path]) -> None:
    assert open_run(change(lambda file: file.attrs.pop("format"))).outputs == 81


def test_a_format_that_is_no_version_is_damage(change: Callable[..., Path]) -> None:
    with pytest.raises(ModelError, match="cannot be read as a result file"):
        open_run(change(lambda file: file.attrs.update(format="new")))


@pytest.mark.parametrize("name", ["field_time", *slow("time", "filtered_time")])
def test_instants_that_do_not_grow_are_damage(change: Callable[..., Path], name: str) -> None:
    def repeat(file: h5py.File) -> None:
        file[name][3] = file[name][2]

    with pytest.raises(ModelError, match=f"the instants of `{name}` do not increase"):
        open_run(change(repeat))

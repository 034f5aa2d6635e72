"""A drive at rest as a result: dimensions without a time, its file, its figures, and what it lacks."""

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, load
from beltdyn.results import StaticResult, derived, open_result, open_run, steady_comparison, summarize
from beltdyn.results.derived import contact_arc
from beltdyn.show import plot
from beltdyn.state.equilibrium import equilibrium
from beltdyn.state.installation import bring_to_rest

RunMain = Callable[[list[str]], tuple[int, str, str]]


OF_RUNS = (
    *(summarize, steady_comparison, derived.balance, derived.slips, derived.hub_loads, derived.mid_span_displacements),
    *(derived.wear_by_belt, derived.slip_safety, lambda rest: plot.animate(rest, "none.gif")),
)
"""What needs results over time."""


@pytest.fixture(scope="module")
def rest(drive: Drive) -> StaticResult:
    return equilibrium(drive)


def test_it_has_no_time(rest: StaticResult, drive: Drive) -> None:
    along = {"node": drive.elements, "element": drive.elements}
    sizes = along | {"contact_point": drive.elements * drive.contact.quadrature_points}
    sizes |= {"pulley": 2, "span": 2, "axis": 2, "coordinate": 6}
    assert dict(rest.dataset.sizes) == sizes
    assert (rest.kind, rest.status) == ("equilibrium", "completed")
    assert "energy_closure" not in rest.dataset


def test_hubs_carry_what_spans_pull(rest: StaticResult) -> None:
    """At rest each of two equal pulleys carries both spans, which are parallel, but for the belt's shear in bending."""
    found = rest.dataset
    np.testing.assert_allclose(found.hub_load, found.span_tension.sum(), rtol=0.02)
    np.testing.assert_allclose(found.hub_force.sum("pulley"), 0.0, atol=1e-6)  # of 50 N; Newton's tolerance
    assert float(found.tension) == pytest.approx(float(found.span_tension.mean()))
    assert float(found.normal_force.where(found.contact_pulley < 0).sum()) == 0.0
    assert float(found.normal_force.min()) >= 0.0


def test_it_has_the_length_that_gives_the_tension(drive: Drive) -> None:
    wanted = drive.replace(belt=drive.belt.replace(installed_tension=100.0))
    found = equilibrium(wanted)
    assert float(found.dataset.tension) == pytest.approx(100.0, rel=1e-5)
    assert float(found.dataset.belt_length) == found.drive.belt_length == bring_to_rest(wanted).drive.belt_length
    assert found.dataset.attrs["drive_as_given"] == wanted.text


def test_its_file_holds_the_same(rest: StaticResult, tmp_path: Path) -> None:
    opened = open_result(rest.save(tmp_path / "rest.nc"))
    assert isinstance(opened, StaticResult)
    xr.testing.assert_identical(opened.dataset.load(), rest.dataset)
    assert opened.warnings == rest.warnings
    assert opened.resolution == rest.resolution


def test_figures_of_one_instant_show_it(rest: StaticResult, tmp_path: Path) -> None:
    drawn = [path.stem for path in plot.save_all(rest, tmp_path)]
    assert drawn == ["configuration", "contact_pressure"]
    arc = contact_arc(rest, "driven")
    on = rest.dataset.contact_pulley.values == 1
    assert float(arc.normal_force.sum()) == pytest.approx(float(rest.dataset.normal_force.values[on].sum()), rel=1e-5)


@pytest.mark.parametrize(
    ("use", "message"),
    [
        *((use, "needs results over time, of a run; these are of equilibrium") for use in OF_RUNS),
        (plot.speeds, "the figure 'speeds' shows results of run; these are of equilibrium. Available figures: conf"),
    ],
)
def test_what_it_lacks_is_said(rest: StaticResult, use: Callable[[Any], object], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        use(rest)


def test_it_is_no_run(rest: StaticResult, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"is the result of another analysis \(equilibrium\)"):
        open_run(rest.save(tmp_path / "rest.nc"))


def peaks(found: StaticResult) -> Any:
    """Largest normal force of each pulley, N/m."""
    forces = found.dataset.normal_force
    return [float(forces.where(found.dataset.contact_pulley == number).max()) for number in range(2)]


def test_contact_forces_keep_to_a_tolerance(drive: Drive) -> None:
    """The largest forces, at the ends of arcs, against those of a mesh that is ten times more exact."""
    wanted = drive.replace(belt=drive.belt.replace(installed_tension=100.0))
    coarse, fine = (equilibrium(wanted, force_tolerance=tolerance) for tolerance in (0.01, 0.001))
    np.testing.assert_allclose(peaks(coarse), peaks(fine), rtol=0.01)
    assert coarse.resolution.errors["peak pressure"] <= 0.01
    assert fine.resolution.errors["peak pressure"] <= 0.001
    assert fine.dataset.sizes["element"] > coarse.dataset.sizes["element"]
    np.testing.assert_allclose(coarse.dataset.span_tension, 100.0, rtol=0.003)
    assert coarse.dataset.attrs["drive_as_given"] == wanted.text


def test_the_tolerance_may_be_that_of_the_drive(drive: Drive) -> None:
    settings = drive.simulation.replace(frame="staying", force_tolerance=0.02, start="equilibrium")
    given = drive.replace(simulation=settings)
    assert 0.0 < equilibrium(given).resolution.errors["peak pressure"] <= 0.02


@pytest.mark.parametrize(
    ("example", "tolerance", "message"),
    [
        ("band_brake", 0.01, "force_tolerance does not apply to an open belt"),
        ("alternator_drive", 0.0, "force_tolerance = 0.0 must be greater than 0"),
    ],
)
def test_a_tolerance_that_makes_no_sense(example: str, tolerance: float, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        equilibrium(load(str(files("beltdyn") / "examples" / f"{example}.toml")), force_tolerance=tolerance)


@pytest.mark.slow
def test_an_axis_at_rest_is_that_in_which_its_runs_begin() -> None:
    """Runs have other elements; both find the tension asked for to the error of a mesh."""
    axis = bd.example("printer_axis")
    begun = bd.simulate(axis.with_({"simulation.duration": 1e-3})).dataset.span_tension.values[0]
    np.testing.assert_allclose(bd.equilibrium(axis).dataset.span_tension.values, begun, rtol=2e-4)

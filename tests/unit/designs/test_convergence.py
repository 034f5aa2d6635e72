"""Convergence of an analysis whose values are formulas of mesh and tolerance."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import beltdyn as bd
from beltdyn.analyses import Analysis
from beltdyn.designs import convergence as subject
from beltdyn.errors import ModelError, SimulationError
from beltdyn.kinds import register
from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result
from beltdyn.show.plot import mesh_convergence, tolerance_convergence
from beltdyn.show.sheet import sheet_without_limits
from beltdyn.solvers.run_progress import Progress

ORDER, TOLERANCE_ORDER, LIMIT = 2.5, 0.8, 40.0


def powers(drive: Drive) -> Result:
    """Give a value that converges with known orders, one that does not, and one that fails to exist on a mesh."""
    assert drive.belt.elements is not None
    size, tolerance = 1.0 / drive.belt.elements, drive.simulation.rtol
    values = {
        "force": LIMIT + 900.0 * size**ORDER - 30.0 * tolerance**TOLERANCE_ORDER,
        "swing": LIMIT + (-1.0) ** (drive.belt.elements // 10),
        "speed": np.nan if drive.belt.elements == 10 else 3.0 + size,
    }
    if drive.belt.elements == 13:
        raise ModelError("the belt slips. Give more tension.")
    return build_result("powers", drive, {name: (Variable((), "N", name), one) for name, one in values.items()}, {})


@pytest.fixture(autouse=True)
def _powers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subject, "_TOLERANCE_KEYS", {"powers": "simulation.rtol"})
    register(Analysis(f"{__name__}:powers", "Give powers."))


@pytest.fixture
def fine(drive: Drive) -> Drive:
    return drive.with_({"belt.elements": 20, "simulation.rtol": 1e-12})


def test_orders_limits_and_what_is_left(fine: Drive) -> None:
    found = bd.convergence(fine, of="all", meshes="10, 20, 30, 50", tolerances=[1e-4, 1e-2, 1e-3], repeated="powers")
    data = found.dataset
    assert data.tolerance.values.tolist() == [1e-2, 1e-3, 1e-4]  # the finest last
    force = data.sel(result="force")
    assert force.mesh_order.values[2:] == pytest.approx([ORDER, ORDER], rel=1e-6)
    assert np.isnan(force.mesh_order.values[:2]).all()
    assert float(force.mesh_limit) == pytest.approx(LIMIT, rel=1e-8)
    assert float(force.mesh_left) == pytest.approx(900.0 * 50.0**-ORDER / LIMIT, rel=1e-4)
    expected = np.abs(force.mesh_value.values / force.mesh_value.values[-1] - 1.0)
    assert force.mesh_error.values == pytest.approx(expected, abs=1e-15)
    assert force.tolerance_order.values[2] == pytest.approx(TOLERANCE_ORDER, rel=1e-6)
    assert float(force.tolerance_limit) == pytest.approx(LIMIT + 900.0 * 20.0**-ORDER, rel=1e-9)
    assert np.isnan(data.sel(result="swing").mesh_order.values).all()
    speed = data.sel(result="speed")
    assert np.isnan(speed.mesh_order.values[2])
    assert speed.mesh_order.values[3] == pytest.approx(1.0, rel=1e-6)
    assert data.unit.values.tolist() == ["N"] * 3


def test_a_level_that_fails_leaves_the_others(fine: Drive) -> None:
    found = bd.convergence(fine, of="force", meshes=[13, 20, 30, 50], repeated="powers")
    assert np.isnan(found.dataset.mesh_value.values[0, 0])
    assert found.dataset.mesh_order.values[0, -1] == pytest.approx(ORDER, rel=1e-6)
    assert "elements: failed at" in found.warnings[1]
    assert "the belt slips" in found.warnings[1]
    with pytest.raises(SimulationError, match="the belt slips"):
        bd.convergence(fine.with_({"belt.elements": 13}), of="force", tolerances=[1e-3, 1e-4, 1e-5], repeated="powers")


def test_an_interrupted_series_keeps_what_is_computed(fine: Drive) -> None:
    def interrupt(progress: Progress) -> None:
        if progress.time >= 2.0:
            raise KeyboardInterrupt

    options = {"of": "force", "meshes": [20, 30, 50], "tolerances": [1e-2, 1e-3, 1e-4], "repeated": "powers"}
    found = bd.convergence(fine, progress=interrupt, **options)  # type: ignore[arg-type]
    assert found.status == "interrupted"
    assert np.isfinite(found.dataset.mesh_value.values[0]).sum() >= 1
    assert "tolerance" not in found.dataset.dims


def test_tables_and_figures(fine: Drive) -> None:
    found = bd.convergence(
        fine, of="force, swing", meshes="10, 20, 30, 50", tolerances="1e-2, 1e-3, 1e-4", repeated="powers"
    )
    titles = [table.title for table in sheet_without_limits(found).parts]
    assert titles[1:4] == ["Value", "Difference from the finest mesh", "Observed order"]
    assert titles[4:] == ["Value", "Difference from the smallest tolerance", "Observed order"]
    ax = mesh_convergence(found)
    assert [line.get_label() for line in ax.lines] == ["force, order 2.5", "swing"]
    assert ax.lines[0].get_ydata() == pytest.approx(found.dataset.mesh_error.values[0, :-1])
    ax = tolerance_convergence(found, of="force")
    assert [line.get_label() for line in ax.lines] == ["force, order 0.8"]
    with pytest.raises(ModelError, match=r"is not a result\. Choose one of force, swing"):
        mesh_convergence(found, of="speed")
    plt.close("all")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "no levels are given. Give meshes"),
        ({"meshes": [20, 40]}, "meshes has 2 levels; an order needs at least 3"),
        ({"meshes": [20.5, 30, 40]}, "must be whole numbers"),
        ({"meshes": "20, 20, 30"}, "contains the same number twice"),
        ({"tolerances": [1e-3, 1e-4]}, "tolerances has 2 levels"),
        ({"tolerances": [1e-3, 1e-4, 1e-5], "repeated": "modes"}, '"modes" has no tolerance. Give meshes'),
        ({"meshes": [20, 30, 40], "repeated": "stress"}, 'repeated = "stress" is no analysis'),
        ({"meshes": [20, 30, 40], "of": "forces", "repeated": "powers"}, "'forces' is not a numerical result"),
    ],
)
def test_what_cannot_be_compared(fine: Drive, options: dict[str, object], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        bd.convergence(fine, **options)  # type: ignore[arg-type]

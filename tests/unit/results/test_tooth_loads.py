"""Loads of teeth on pulleys: balance with torques, teeth in mesh, margin to a jump."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.results import Run, tooth_loads


@pytest.fixture(scope="module")
def run() -> Run:
    driver = {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "speed": "1500 rpm"}
    driven = {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "inertia": 1e-3, "torque": -5.0}
    drive = bd.Drive(
        belt={"profile": "HTD 8M", "width": "20 mm", "teeth": 100, "installed_tension": "300 N"},
        pulley=[driver, driven],
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation={"duration": 1.0},
    )
    return bd.steady_state(drive)


def test_tooth_loads_make_the_torques(run: Run) -> None:
    loads = {one.name: one for one in tooth_loads(run)}
    assert list(loads) == ["driver", "driven"]
    torque = run.dataset.pulley_torque.isel(time=-1).values
    for number, (one, sense) in enumerate(zip(loads.values(), (1.0, -1.0), strict=True)):
        assert one.places.size == one.loads.size == round(one.in_mesh)
        # sampled at the middles of teeth
        pull = abs(float(torque[number])) / run.prepared.radii[number]
        assert sense * float(one.loads.sum()) == pytest.approx(pull, rel=0.03)
        assert one.largest >= np.abs(one.loads).max()


def test_teeth_in_mesh(run: Run) -> None:
    wraps = run.dataset.wrap_angle.isel(time=-1).values
    for one, wrap, teeth in zip(tooth_loads(run), wraps, (24, 36), strict=True):
        assert one.in_mesh == pytest.approx(teeth * wrap / (2.0 * np.pi), rel=5e-3)


def test_the_margin_falls_with_the_flank_angle(run: Run) -> None:
    assert all(np.isfinite(one.jump_margin) and one.jump_margin > 1.0 for one in tooth_loads(run))
    toothing = run.drive.belt.toothing
    assert toothing is not None
    steeper = bd.steady_state(run.drive.with_({"belt.toothing": toothing.replace(flank_angle=0.35)}))
    for one, other in zip(tooth_loads(run), tooth_loads(steeper), strict=True):
        ratio = np.tan(toothing.flank_angle) / np.tan(0.35)
        assert other.jump_margin == pytest.approx(ratio * one.jump_margin, rel=1e-3)
        assert other.allowed == toothing.largest_tooth_load


def test_toothed_pulleys_do_not_slip(run: Run) -> None:
    pulleys = bd.summarize(run).pulleys
    assert all(np.isnan(one.slip_safety) for one in pulleys)
    assert [one.sliding_speed for one in pulleys] == [0.0, 0.0]
    with pytest.raises(ModelError, match="driven holds the belt by its teeth, so that it does not slip"):
        bd.traction(run.drive, pulley="driven")


def test_rest_has_no_tooth_loads(run: Run) -> None:
    with pytest.raises(ModelError, match="loads of teeth need results over time"):
        tooth_loads(bd.equilibrium(run.drive))  # type: ignore[arg-type]

"""Loads of teeth on pulleys: balance with torques, teeth in mesh, margin to a jump."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.results import Run, tooth_loads
from beltdyn.results.checks import Evidence
from beltdyn.results.checks.machines import lifted_teeth
from beltdyn.results.tooth_loads import _Arc, _spread


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
        seated = (one.places > 0.0) & (one.places < one.in_mesh)
        assert abs(int(seated.sum()) - one.in_mesh) < 1.0  # others enter or leave
        # sampled at contact points, across the ends of the arc too
        pull = abs(float(torque[number])) / run.prepared.radii[number]
        assert sense * float(one.loads.sum()) == pytest.approx(pull, rel=0.01)
        assert one.largest >= np.abs(one.loads).max()


def test_no_tooth_of_steady_running_carries_more_than_the_largest(run: Run) -> None:
    """The last one is a part of a pitch, and carries a part."""
    for pitches in np.linspace(6.0, 13.9, 17).tolist():
        count = 400
        place = np.linspace(0.0, 8e-3 * pitches, count)
        share = np.full(count, 8e-3 * pitches / count)
        traction = 1e4 * np.cosh(place / 0.03)
        arc = _Arc(place, share, np.full(count, 1e4), traction)
        found = _spread(arc, arc, 8e-3, 0.1)
        assert found.loads.sum() == pytest.approx(float(share @ traction), rel=1e-9)
        assert np.abs(found.loads).max() <= found.largest
        assert found.loads.size == np.ceil(pitches - 1e-6)
        assert np.all(np.diff(found.loads[:-1]) > 0.0)


def test_teeth_in_mesh(run: Run) -> None:
    wraps = run.dataset.wrap_angle.isel(time=-1).values
    for one, wrap, count in zip(tooth_loads(run), wraps, (24, 36), strict=True):
        assert one.in_mesh == pytest.approx(count * wrap / (2.0 * np.pi), rel=5e-3)


def test_the_margin_falls_with_the_flank_angle(run: Run) -> None:
    assert all(np.isfinite(one.jump_margin) and one.jump_margin > 1.0 for one in tooth_loads(run))
    toothing = run.drive.belt.toothing
    assert toothing is not None
    steeper = bd.steady_state(run.drive.with_({"belt.toothing": toothing.replace(flank_angle=0.35)}))
    for one, other in zip(tooth_loads(run), tooth_loads(steeper), strict=True):
        ratio = np.tan(toothing.flank_angle) / np.tan(0.35)
        # flanks give lifted teeth play, and teeth on the arc some of their load: the largest rises by 0.7 %
        assert other.jump_margin == pytest.approx(ratio * one.jump_margin, rel=0.01)
        assert other.allowed == toothing.largest_tooth_load


def test_toothed_pulleys_do_not_slip(run: Run) -> None:
    pulleys = bd.summarize(run).pulleys
    assert all(np.isnan(one.slip_safety) for one in pulleys)
    assert [one.sliding_speed for one in pulleys] == [0.0, 0.0]
    with pytest.raises(ModelError, match="driven holds the belt by its teeth, so that it does not slip"):
        bd.traction(run.drive, pulley="driven", slip="0..1 %")


def test_points_hold_the_loads_of_teeth(run: Run) -> None:
    limited = run.drive.with_({"limits.largest_tooth_load": 5.0})
    found = bd.operating_map(limited, load="1, 1.5")
    loads = tooth_loads(run)
    at_load = found.dataset.isel(load=0)
    for name, expected in (("tooth_load", "largest"), ("jump_margin", "jump_margin"), ("teeth_in_mesh", "in_mesh")):
        # the mesh of a map is refined to 1 %
        np.testing.assert_allclose(at_load[name], [getattr(one, expected) for one in loads], rtol=0.01)
    key = {one.key: one for one in bd.results.key_numbers(found)}["largest_tooth_load"]
    assert key.value == float(found.dataset.tooth_load.max())
    assert key.passes is False


def test_rest_has_no_tooth_loads(run: Run) -> None:
    with pytest.raises(ModelError, match="loads of teeth need results over time"):
        tooth_loads(bd.equilibrium(run.drive))


def test_overloaded_teeth_are_told(run: Run) -> None:
    assert not any("tooth" in warning for warning in run.warnings)
    toothing = run.drive.belt.toothing
    assert toothing is not None
    weak = toothing.replace(largest_tooth_load=5.0)
    (told,) = bd.steady_state(run.drive.with_({"belt.toothing": weak})).warnings
    assert told.split()[:3] == ["a", "tooth", "carries"]
    assert "the belt allows 5 N" in told


def test_teeth_whose_lands_carry_nothing_lift(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    loads = tooth_loads(run)
    lifted = replace(loads[0], jump_margin=1.0), *loads[1:]
    module = import_module("beltdyn.results.tooth_loads")
    monkeypatch.setattr(module, "loads_over_time", lambda *_: iter([(0.0, loads), (0.1, lifted)]))
    evidence = Evidence(run.dataset, run.prepared, run.resolution, tuple)
    assert [str(one) for one in lifted_teeth(evidence)] == [
        "teeth lift off driver at 100% of the load. The belt rides up there, and jumps under a little more load. "
        "Raise the tension, reduce the load, or increase the wrap angle."
    ]


def test_a_belt_that_flanks_push_off_does_not_run(run: Run) -> None:
    toothing = run.drive.belt.toothing
    assert toothing is not None
    steep = run.drive.with_({"belt.toothing": toothing.replace(flank_angle=1.3), "pulley[driven].torque": -20.0})
    assert tooth_loads(bd.steady_state(steep))[0].jump_margin == 1.0  # all teeth of the driver have lifted, and hold
    steep = steep.with_({"pulley[driven].torque": -60.0})
    with pytest.raises(ConvergenceError, match="The belt jumps beyond that"):
        bd.steady_state(steep)


def test_a_motor_drives_teeth_at_the_speed_of_its_torque(run: Run) -> None:
    motor = {"kind": "motor", "breakdown_torque": 20.0, "breakdown_slip": 0.2, "synchronous_speed": "1500 rpm"}
    driven = {"speed": None, "inertia": 1e-3, "load": [motor]}
    drive = run.drive.with_({f"pulley[driver].{key}": value for key, value in driven.items()})
    end = bd.steady_state(drive).dataset.isel(time=-1)
    assert end.pulley_speed.values[0] / end.pulley_speed.values[1] == pytest.approx(1.5, rel=1e-12)
    assert 150.0 < float(end.pulley_speed[0]) < 157.0  # little below its synchronous speed
    assert float(end.shaft_torque[0]) == pytest.approx(-float(end.pulley_torque[0]), rel=1e-6)


def test_limits_of_teeth(run: Run) -> None:
    limited = bd.steady_state(run.drive.with_({"limits.largest_tooth_load": 5.0, "limits.least_jump_margin": 1.5}))
    found = {one.key: one for one in bd.results.key_numbers(limited)}
    loads = tooth_loads(limited)
    assert found["largest_tooth_load"].value == pytest.approx(max(one.largest for one in loads))
    assert found["least_jump_margin"].value == pytest.approx(min(one.jump_margin for one in loads))
    assert (found["largest_tooth_load"].passes, found["least_jump_margin"].passes) == (False, True)
    assert found["largest_tooth_load"].where in ("driver", "driven")

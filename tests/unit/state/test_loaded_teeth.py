"""Toothed drives that start in equilibrium, held by the teeth of their driver under the loads of the first instant."""

from math import pi
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import prepare
from beltdyn.state.loaded_teeth import _balanced_torques, _pull_of_carriage
from beltdyn.system.build import axis_system, drive_system

RADIUS = 36 * 8e-3 / (2 * pi)


def drive(frame: str, torque: float = -5.0, **driven: Any) -> bd.Drive:
    ramp = {"kind": "cosine_ramp", "start": 4e-3, "end": 0.1, "value": 20.0}
    return bd.Drive(
        belt={"profile": "HTD 8M", "width": "20 mm", "teeth": 100, "installed_tension": 400.0},
        pulley=[
            {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "speed": ramp},
            {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "inertia": 1e-3, "torque": torque} | driven,
        ],
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation={"duration": 4e-3, "output_interval": 1e-4, "frame": frame, "start": "equilibrium"},
    )


@pytest.mark.parametrize("frame", ["staying", "travelling"])
def test_a_constant_torque_is_no_shock(frame: str) -> None:
    tension = bd.simulate(drive(frame)).dataset.span_tension.values
    assert np.abs(np.diff(tension[0])).item() == pytest.approx(5.0 / RADIUS, rel=5e-3)
    assert np.ptp(tension, axis=0).max() < 1e-3 * 5.0 / RADIUS


def test_torques_through_springs_of_a_hub() -> None:
    hub = [{"kind": "isolator", "stiffness": 2000.0, "damping": 0.5, "inertia": 2e-4}]
    run = bd.simulate(drive("staying", hub=hub, inertia=1e-4)).dataset
    tension = run.span_tension.values
    assert np.abs(np.diff(tension[0])).item() == pytest.approx(5.0 / RADIUS, rel=5e-3)
    assert np.ptp(tension, axis=0).max() < 1e-3 * 5.0 / RADIUS


def test_a_torque_that_teeth_do_not_hold_starts_unloaded() -> None:
    """No equilibrium holds 3 kN m; the run starts as without it, and the belt jumps."""
    tension = bd.simulate(drive("staying", torque=-3000.0).with_({"simulation.duration": 2e-4})).dataset.span_tension
    assert np.ptp(tension.values[0]) < 1.0


@pytest.mark.parametrize("frame", ["staying", "travelling"])
def test_a_force_on_a_carriage_is_no_shock(frame: str) -> None:
    axis = bd.example("printer_axis")
    pushed = axis.replace(
        carriage=axis.data["carriage"] | {"force": -8.0, "friction": 0.0},
        simulation={"duration": 5e-3, "output_interval": 1e-4, "frame": frame},
    )
    run = bd.simulate(pushed).dataset
    tension = run.span_tension.values
    assert abs(tension[0, -1] - tension[0, 0]) == pytest.approx(8.0, rel=0.01)
    assert np.ptp(tension, axis=0).max() < 0.01 * 8.0


@pytest.mark.parametrize(
    ("load", "torque"),
    [
        ({"kind": "resistance", "constant": 3.0}, 0.0),
        ({"kind": "resistance", "linear": 2.0}, 0.0),
        ({"kind": "angle_table", "angles": [0.0, 2.0, 4.0], "torques": [-3.0, -3.0, -3.0]}, -3.0),
        ({"kind": "motor", "breakdown_torque": 20.0, "breakdown_slip": 0.5, "synchronous_speed": 20.0}, 16.0),
    ],
    ids=["dry", "viscous", "of the angle", "motor at standstill"],
)
def test_loads_on_teeth_are_those_at_rest(load: dict[str, Any], torque: float) -> None:
    """What resists motion alone is none; the driver balances the others in proportion to its teeth."""
    prepared = prepare(drive("staying", load=[load]))
    torques = _balanced_torques(prepared, drive_system(prepared))
    assert torques[1] == pytest.approx(torque - 5.0)
    assert torques[0] == pytest.approx(-torques[1] * 24.0 / 36.0)


def test_without_a_driver_with_teeth_nothing_holds_loads() -> None:
    driver, driven = drive("staying").pulleys
    free = prepare(drive("staying").replace(pulley=[driver.replace(speed=None, inertia=1e-3, torque=2.0), driven]))
    assert not _balanced_torques(free, drive_system(free)).any()


@pytest.mark.parametrize("force", [-8.0, 3.0])
def test_a_carriage_pulls_with_its_force_where_its_belt_runs(force: float) -> None:
    """In the direction in which it moves, to which its strand runs; a closed belt has none."""
    axis = bd.example("printer_axis")
    prepared = prepare(axis.replace(carriage=axis.data["carriage"] | {"force": force, "friction": 0.0}))
    system = axis_system(prepared, prepared.equal_lengths(prepared.elements))
    assert abs(_pull_of_carriage(prepared, system)) == pytest.approx(abs(force))
    closed = prepare(drive("staying"))
    assert _pull_of_carriage(closed, drive_system(closed)) == 0.0

"""All integrators give the same motion of a drive with a tensioner and a hub chain."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.model import Drive

Make = Callable[..., Drive]
Measured = Callable[..., None]
SPEED, RADIUS = 12.0, 0.08
TOLERANCES = {"generalized_alpha": 1e-5, "cvode": 1e-6, "ida": 1e-6, "bdf": 1e-5, "radau": 1e-4}
"""At which each of them is about as good as 1e-4 of the driver's speed; multi-step methods count errors by the step."""


@pytest.fixture(scope="module")
def solve(make: Make) -> Callable[..., xr.Dataset]:
    """Brought to 12 rad/s within 20 ms, with a load step at 10 ms."""
    chain = [
        {"kind": "isolator", "stiffness": 60.0, "damping": 0.05, "inertia": 5e-4},
        {"kind": "one_way_clutch", "locking_damping": 5.0, "drag_torque": 0.2, "inertia": 2e-3},
    ]
    crank = {"name": "crank", "center": (0.0, 0.0), "radius": RADIUS}
    crank |= {"speed": {"kind": "cosine_ramp", "start": 0.0, "end": 0.02, "value": SPEED}}
    idler = {"name": "idler", "center": (0.15, -0.12), "radius": 0.04, "inertia": 1e-4, "mass": 0.5}
    driven = {"name": "driven", "center": (0.3, 0.02), "radius": 0.06, "inertia": 1e-3, "hub": chain}
    driven |= {
        "torque": {"kind": "step", "time": 0.01, "value": -1.5},
        "load": [{"kind": "resistance", "linear": 0.02}],
    }
    arm = {"kind": "rotary", "pulley": "idler", "pivot": (0.24, -0.15), "inertia": 1e-3, "preload": 30.0, "rate": 50.0}
    arm |= {"damping": 0.2, "tensioning_friction": 0.5, "yielding_friction": 1.5, "creep_speed": 0.1}

    def run(integrator: str, rtol: float) -> xr.Dataset:
        drive = make(
            [crank, idler, driven],
            tensioner=[arm],
            belt={"length": 1.098, "elements": 16},
            contact={"stiffness": 3e6, "creep_rate_factor": 1e4},
            simulation={"duration": 0.02, "integrator": integrator, "rtol": rtol},
        )
        return simulate(drive).dataset

    return run


@pytest.fixture(scope="module")
def reference(solve: Callable[..., xr.Dataset]) -> xr.Dataset:
    return solve("generalized_alpha", 1e-6)


@pytest.mark.parametrize(
    "integrator",
    [
        pytest.param(name, marks=[pytest.mark.slow] if name in ("cvode", "radau", "bdf", "ida") else [])
        for name in TOLERANCES
    ],
)
def test_agree(solve: Callable[..., xr.Dataset], reference: xr.Dataset, measured: Measured, integrator: str) -> None:
    run = solve(integrator, TOLERANCES[integrator])
    scales = {
        "pulley_speed": SPEED, "shaft_speed": SPEED, "tensioner_speed": SPEED, "tensioner_position": 0.02 * SPEED,
        "node_position": 0.02 * SPEED * RADIUS, "span_tension": 200.0, "hub_force": 200.0,
    }  # fmt: skip
    found = {name: float(np.abs(run[name] - reference[name]).max()) / scale for name, scale in scales.items()}
    measured(steps=run.attrs["steps"], **found)
    assert float(np.ptp(reference.tensioner_position.values)) > 5e-3
    assert float(reference.coupling_loss[-1]) > 0.0
    assert max(found.values()) < 2e-4, found


@pytest.mark.parametrize("integrator", ["cvode", "bdf"])
def test_prescribed_motion_is_recorded_as_it_was_prescribed(solve: Callable[..., xr.Dataset], integrator: str) -> None:
    """And not as the solver integrates it with a coarse tolerance."""
    run = solve(integrator, 1e-3)
    time = run.time.values
    speed = 0.5 * SPEED * (1 - np.cos(np.pi * time / 0.02))
    np.testing.assert_allclose(run.pulley_speed[:, 0], speed, atol=1e-12)
    angle = 0.5 * SPEED * (time - 0.02 / np.pi * np.sin(np.pi * time / 0.02))
    np.testing.assert_allclose(run.pulley_angle[:, 0], angle, atol=1e-12)

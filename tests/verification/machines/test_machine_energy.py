"""The energy account closes with every machine at work, and powers that are recorded add up to the losses.

Drives of three pulleys, a tenth of a second long, with equal outputs every 0.1 ms for the trapezoidal rule.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn import simulate
from beltdyn.model import Drive

Make = Callable[..., Drive]
Measured = Callable[..., None]
LOSSES = ("friction_loss", "damping_loss", "material_loss", "tensioner_loss", "coupling_loss")

CRANK: dict[str, Any] = {
    "name": "crank", "center": (0.0, 0.0), "radius": 0.08,
    "speed": {"kind": "cosine_ramp", "start": 0.0, "end": 0.05, "value": 40.0},
}  # fmt: skip
DRIVEN: dict[str, Any] = {"name": "driven", "center": (0.3, 0.02), "radius": 0.06, "inertia": 2e-3}
IDLER: dict[str, Any] = {"name": "idler", "center": (0.15, -0.12), "radius": 0.04, "inertia": 1e-4, "mass": 0.5}
BACK = IDLER | {"center": (0.15, 0.05), "side": "outside"}
LOAD = {"kind": "resistance", "constant": 2.0, "creep_speed": 1.0, "linear": 0.02, "quadratic": 5e-4}
SLIDE = {"kind": "sliding", "pulley": "idler", "direction": (0.2, -1.0), "mass": 0.5, "preload": 600.0}
ARM = {"kind": "rotary", "pulley": "idler", "pivot": (0.24, -0.15), "inertia": 1e-3, "preload": 55.0, "rate": 100.0}
INSIDE, OUTSIDE = {"length": 1.0945}, {"installed_tension": 400.0}


def step(value: float) -> dict[str, Any]:
    return {"kind": "step", "time": 0.03, "value": value}


def loaded(**keys: Any) -> dict[str, Any]:
    return DRIVEN | {"load": [LOAD]} | keys


FALLING = "weight"
"""Laid around its pulleys, with 30 N if it had no weight, the belt falls on them, with blows that outputs do not
resolve; the account is open by nine times the tolerance when it has hardly begun, so that the tolerance is half."""
CASES: dict[str, tuple[list[dict[str, Any]], dict[str, Any], set[str]]] = {
    # pulleys, what else differs, losses beside friction and contact damping
    "sliding tensioner against a stop": (
        [CRANK, IDLER, loaded(torque=step(-15.0))],
        {
            "belt": INSIDE,
            "tensioner": [
                SLIDE | {"damping": 20.0, "tensioning_friction": 30.0, "yielding_friction": 60.0, "rate": 1e4}
                | {"stops": (-0.02, 3e-3), "stop_stiffness": 1e6, "stop_damping": 200.0}
            ],
        },
        {"tensioner_loss"},
    ),
    "rotary tensioner": (
        [CRANK, IDLER, loaded(torque=step(-15.0))],
        {"belt": INSIDE, "tensioner": [ARM | {"damping": 0.5, "tensioning_friction": 1.0, "yielding_friction": 4.0}]},
        {"tensioner_loss"},
    ),
    "isolator": (
        [CRANK, IDLER, loaded(hub=[{"kind": "isolator", "stiffness": 300.0, "damping": 0.3, "inertia": 4e-3}])],
        {"belt": OUTSIDE},
        {"coupling_loss"},
    ),
    "one-way clutch": (
        [
            CRANK | {"speed": {"kind": "table", "times": [0.0, 0.03, 0.06, 0.09], "values": [0.0, 40.0, 15.0, 40.0]}},
            IDLER,
            loaded(hub=[{"kind": "one_way_clutch", "locking_damping": 20.0, "drag_torque": 0.3, "inertia": 4e-3}]),
        ],
        {"belt": OUTSIDE},
        {"coupling_loss"},
    ),
    "friction clutch": (
        [
            CRANK,
            IDLER,
            loaded(hub=[
                {"kind": "friction_clutch", "capacity": 8.0, "locking_damping": 20.0, "inertia": 3e-3,
                 "schedule": {"kind": "ramp", "start": 0.04, "end": 0.06, "value": 1.0}},
            ]),
        ],
        {"belt": OUTSIDE},
        {"coupling_loss"},
    ),
    "motor": (
        [
            {"name": "motor", "center": (0.0, 0.0), "radius": 0.08, "inertia": 0.01,
             "load": [{"kind": "motor", "breakdown_torque": 25.0, "breakdown_slip": 0.2, "synchronous_speed": 50.0}]},
            IDLER,
            loaded(),
        ],
        {"belt": OUTSIDE},
        set(),
    ),
    "resistance with harmonics": (
        [CRANK | {"harmonics": [{"order": 2, "amplitude": 0.05}]}, IDLER,
         DRIVEN | {"load": [LOAD | {"harmonics": [{"order": 3, "amplitude": 0.4, "phase": 0.5}]}]}],
        {"belt": OUTSIDE},
        set(),
    ),
    FALLING: (
        [CRANK, IDLER, loaded()],
        {"belt": {"length": 1.099814}, "gravity": (0.0, -300.0),
         "simulation": {"start": "laid", "rtol": 5e-5, "output_interval": 2.5e-5}},
        set(),
    ),
    "material damping": (
        [CRANK, IDLER, loaded()],
        {"belt": OUTSIDE | {"stretch_damping_time": 2e-5, "bending_damping_time": 2e-4}},
        {"material_loss"},
    ),
    "crossed belt": (
        [CRANK, DRIVEN | {"side": "outside", "center": (0.4, 0.0), "load": [LOAD]}],
        {"belt": OUTSIDE | {"crossed": True, "pitch_offset": 0.002, "back_offset": 0.002}},
        set(),
    ),
    "idler on the back": (
        [CRANK, loaded(), BACK],
        {"belt": OUTSIDE | {"pitch_offset": 0.0015, "back_offset": 0.0025, "wedge_angle": 0.7}},
        set(),
    ),
}  # fmt: skip
COSTLY = ("weight", "one-way clutch", "friction clutch", "isolator")


@pytest.mark.parametrize("case", [pytest.param(one, marks=pytest.mark.slow) if one in COSTLY else one for one in CASES])
def test_closes(make: Make, measured: Measured, case: str) -> None:
    """Within five times the tolerance; what is not there loses nothing, and no loss is given back."""
    pulleys, others, lost = CASES[case]
    simulation = {"duration": 0.1, "output_interval": 1e-4, "rtol": 1e-4} | others.get("simulation", {})
    run = simulate(make(pulleys, **others | {"simulation": simulation})).dataset
    closure = float(np.abs(run.energy_closure).max())
    powers = {"friction_loss": run.friction_power, "damping_loss": run.contact_damping_power}
    sums = {name: float(np.trapezoid(power.sum("pulley"), run.time)) for name, power in powers.items()}
    errors = {name: value / float(run[name][-1]) - 1 for name, value in sums.items()}
    parts = {name: float(run[name][-1]) for name in LOSSES if name in lost}
    measured(closure=closure, friction_power=errors["friction_loss"], damping_power=errors["damping_loss"], **parts)
    assert closure < 5e-4
    assert max(map(abs, errors.values())) < (1e-3 if case == FALLING else 1e-4)
    for name in LOSSES:
        loss = run[name].values
        assert np.all(np.diff(loss) >= -1e-12 * loss[-1])
        assert (loss[-1] > 1e-4) == (name in lost | {"friction_loss", "damping_loss"})


@pytest.mark.slow
def test_a_tensioner_does_meet_its_stop(make: Make) -> None:
    pulleys, others, _ = CASES["sliding tensioner against a stop"]
    run = simulate(make(pulleys, **others, simulation={"duration": 0.1})).dataset
    upper = others["tensioner"][0]["stops"][1]
    q = run.tensioner_position.values[:, 0]
    assert q[0] < upper < q.max(), (q[0], q.max(), q.min())


FREE = {"friction": 0.0, "creep_rate_factor": 1e3}
"""Without friction the belt leaves pulleys alone."""


def test_a_friction_clutch_loses_what_it_must(make: Make, measured: Measured) -> None:
    """Two inertias of different speed become one: I1 I2 / (I1 + I2) w^2 / 2 is lost, whatever the capacity does.

    The hub has its speed from a torque of 10 N m over 20 ms, while the clutch lets go; what is left is a slip of
    2 exp(-c (1 / I1 + 1 / I2) t), nothing by the end.
    """
    clutch = {
        "kind": "friction_clutch", "capacity": 8.0, "locking_damping": 2.0, "inertia": 5e-3,
        "schedule": {"kind": "ramp", "start": 0.03, "end": 0.05, "value": 1.0},
    }  # fmt: skip
    torque = {"kind": "step", "time": 0.02, "before": 10.0, "value": 0.0}
    driven = DRIVEN | {"hub": [clutch], "torque": torque}
    drive = make(
        [CRANK, IDLER, driven],
        belt=OUTSIDE | {"elements": 30},
        contact=FREE,
        simulation={"duration": 0.12, "max_step": 1e-4},
    )
    run = simulate(drive).dataset
    speed = 10.0 * 0.02 / 5e-3
    hand = 0.5 * (2e-3 * 5e-3 / 7e-3) * speed**2
    loss, common = float(run.coupling_loss[-1]), 5e-3 * speed / 7e-3
    measured(loss=loss, error=loss / hand - 1, speed=float(run.pulley_speed[-1, 2]) / common - 1)
    assert loss == pytest.approx(hand, rel=1e-4)
    np.testing.assert_allclose([run.pulley_speed[-1, 2], run.shaft_speed[-1, 2]], common, rtol=1e-6)


def test_a_motor_runs_up_as_kloss_says(make: Make, measured: Measured) -> None:
    """From rest to the slip s in t = I w_s / (2 M_b) ((1 - s^2) / (2 s_b) - s_b ln s); its work is I w^2 / 2."""
    load = {"kind": "motor", "breakdown_torque": 25.0, "breakdown_slip": 0.2, "synchronous_speed": 50.0}
    motor = {"name": "motor", "center": (0.0, 0.0), "radius": 0.08, "inertia": 0.05, "load": [load]}
    slip, pace = 0.05, 0.05 * 50.0 / 50.0
    time = pace * ((1 - slip**2) / 0.4 - 0.2 * np.log(slip))
    drive = make(
        [motor, IDLER, DRIVEN],
        belt=OUTSIDE | {"elements": 30},
        contact=FREE,
        simulation={"duration": time, "output_interval": time / 10, "max_step": time / 1000},
    )
    run = simulate(drive).dataset.isel(time=-1)
    speed = float(run.pulley_speed[0])
    measured(time=time, speed=speed / (50.0 * (1 - slip)) - 1, work=float(run.torque_work) / (0.025 * speed**2) - 1)
    assert speed == pytest.approx(50.0 * (1 - slip), rel=1e-5)
    assert float(run.torque_work) == pytest.approx(0.025 * speed**2, rel=1e-5)

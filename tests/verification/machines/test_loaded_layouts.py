"""Loaded drives with a pulley on the back, grooves and offsets: capstan, hub loads and elastic creep.

Friction is that of Coulomb, nearly: fully used from a creep velocity on that is small beside the creep.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.model import Drive
from beltdyn.theory.creep import sliding_angle, speed_loss, tight_tension

Make = Callable[..., Drive]
Measured = Callable[..., None]
Pulleys = list[dict[str, Any]]

PITCH, BACK, WEDGE = 0.0015, 0.0025, 0.7
BELT = {
    "installed_tension": 300.0, "bending_factor": 1e-3, "pitch_offset": PITCH, "back_offset": BACK,
    "stretch_damping_time": 2e-5, "bending_damping_time": 1e-3,
}  # fmt: skip
COULOMB = {"friction_law": "coefficient_slope", "creep_rate_factor": None, "stiffness": 3e7}


def three(driver: dict[str, Any], back: dict[str, Any], inside: dict[str, Any]) -> Pulleys:
    """A pulley on the back between two on the inside."""
    return [
        {"name": "driver", "center": (0.0, 0.0), "radius": 0.06} | driver,
        {"name": "inside", "center": (0.4, 0.0), "radius": 0.06} | inside,
        {"name": "back", "center": (0.2, 0.005), "radius": 0.05, "side": "outside"} | back,
    ]


HELD = {"speed": {"kind": "constant", "value": 0.0}}
FREE = {"inertia": 1e-4}
TURNS = {"speed": {"kind": "cosine_ramp", "start": 0.0, "end": 0.05, "value": 10.0}}


@pytest.mark.slow
@pytest.mark.parametrize(("held", "friction"), [("back", 0.3), ("inside", 0.1)], ids=["flat back", "groove"])
def test_a_held_pulley_is_a_capstan(
    make: Make, measured: Measured, span_lines: Callable[..., Any], held: str, friction: float
) -> None:
    """T - rho A v^2 grows by e^(mu theta), with mu / sin(beta / 2) in the groove; hub loads follow from both tensions.

    The mean of 50 ms, during which arcs on the driver still fill with belt of the higher tension.
    """
    free = {"friction": 0.0} | FREE
    pulleys = three(TURNS | {"friction": 3.0}, HELD if held == "back" else free, HELD if held == "inside" else free)
    drive = make(
        pulleys,
        belt=BELT | {"wedge_angle": WEDGE, "elements": 120},
        contact=COULOMB | {"friction": friction, "creep_velocity": 1e-3},
        simulation={"duration": 0.2, "output_interval": 1e-3, "field_interval": 1e-3, "rtol": 1e-3},
    )
    last = simulate(drive).fields.isel(time=slice(-50, None))
    k = [pulley["name"] for pulley in pulleys].index(held)
    mean = last.mean("time")
    slack, tight = (float(mean.span_tension[j]) for j in (k - 1, k))
    lines = np.mean([span_lines(last.isel(time=j)) for j in range(0, 50, 5)], axis=0)
    cosine = float(lines[k - 1] @ lines[k])
    theta = np.arccos(cosine) if drive.path.wrap_angles[k] < np.pi else 2 * np.pi - np.arccos(cosine)
    effective = friction if held == "back" else friction / np.sin(WEDGE / 2)
    moving = {"mass_per_length": drive.belt.mass_per_length, "speed": float(mean.belt_speed[k])}
    capstan = tight_tension(slack, effective, theta, **moving)
    t1, t2 = (tension - moving["mass_per_length"] * moving["speed"] ** 2 for tension in (tight, slack))
    hub = np.sqrt(t1**2 + t2**2 - 2 * t1 * t2 * cosine)
    found = float(np.linalg.norm(mean.hub_force.values[k]))
    measured(slack=slack, tight=tight, theta=theta, capstan=tight / capstan - 1, hub=found / hub - 1)
    assert tight / slack > 1.3
    assert tight == pytest.approx(capstan, rel=2e-3)
    assert found == pytest.approx(hub, rel=5e-4)


SLIDES = 0.99
"""Friction above this part of mu f_n is taken for sliding."""


def sliding(run: xr.Dataset, pulley: int, friction: float) -> float:
    """Arc of sliding, rad, mean of every tenth of the last 100 outputs."""
    shares = []
    for k in range(-100, 0, 10):
        output = run.isel(time=k)
        touching = output.contact_pulley.values == pulley
        full = np.abs(output.friction_force.values) > SLIDES * friction * output.normal_force.values
        shares.append(np.mean(full[touching]) * float(output.wrap_angle[pulley]))
    return float(np.mean(shares))


@pytest.mark.slow
@pytest.mark.parametrize(("driven", "load"), [("back", 5.0), ("inside", -10.0)])
def test_elastic_creep(make: Make, measured: Measured, driven: str, load: float) -> None:
    """Rims at their effective radii differ by 1 - g(T2) / g(T1), and the belt slides over ln(T1 / T2) / mu on both.

    The layer of creep before the sliding arc is 3 degrees long, contact points are 3 degrees apart, and the arc of the
    driver has another friction than the back of the belt.  Without its offset a rim would seem 3 or 5 % slower.  The
    load is (T1 - T2) R, where spans lie on lines at R - T / (2 k_p R) from the center.
    """
    loaded = {"inertia": 1e-3, "torque": {"kind": "cosine_ramp", "start": 0.05, "end": 0.2, "value": load}}
    turns = {"speed": {"kind": "cosine_ramp", "start": 0.0, "end": 0.1, "value": 20.0}}
    drive = make(
        three(turns, *((loaded, FREE) if driven == "back" else (FREE, loaded))),
        belt=BELT | {"elements": 80, "youngs_modulus": 1.25e8, "wedge_angle": 2.0},
        contact=COULOMB | {"friction": 0.5, "creep_velocity": 1e-3},
        simulation={"duration": 0.8, "output_interval": 2e-3, "field_interval": 2e-3, "rtol": 1e-3},
    )
    run = simulate(drive).fields
    mean = run.isel(time=slice(-100, None)).mean("time")
    rims, tensions = np.abs(mean.pulley_speed.values) * drive.radii, mean.span_tension.values
    k = list(run.pulley.values).index(driven)
    tight, slack = float(tensions.max()), float(tensions.min())
    loss, theory = 1 - rims[k] / rims[0], speed_loss(tight, slack, drive.belt.stretch_parameters)
    moving = {"mass_per_length": drive.belt.mass_per_length, "speed": float(rims[0])}
    for pulley in (0, k):
        found = np.degrees(sliding(run, pulley, drive.frictions[pulley]))
        arc = np.degrees(sliding_angle(tight, slack, drive.frictions[pulley], **moving))
        measured(pulley=pulley, found=found, arc=arc)
        assert found == pytest.approx(arc, abs=4.0)
    sunk = (tight + slack) / (2 * drive.contact_stiffness * drive.radii[k] ** 2)
    torque = abs(load) / (drive.radii[k] * (tight - slack) * (1 - sunk))
    measured(tight=tight, slack=slack, loss=loss, error=loss / theory - 1, torque=torque - 1, sunk=sunk)
    assert loss == pytest.approx(theory, rel=0.02)
    assert torque == pytest.approx(1.0, rel=1e-3)

"""Verified: hysteresis of a belt that runs round two pulleys.

Against: pi/4 eta EI / R^2 a meter of belt and pulley, and pi/4 eta (T1 - T2)^2 / EA a meter, at speeds of 1 to 100, on
meshes of 1 to 2, and over the radius; and what is published of V-belts: torque losses in proportion to 1/R (Childs and
Cowburn 1987) and efficiencies of 95 to 98 % (Gates, "Belt Drive Efficiencies").
"""

from collections.abc import Callable

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.results.derived.pulley_means import balance as power_balance
from beltdyn.results.energy_balance import Balance
from beltdyn.theory.nip import bending_loss, stretch_loss

BENDING, STRETCH = 0.15, 0.05
"""Loss factors."""
SECTION = "axial_stiffness = 60e3\nbending_stiffness = 0.05\nmass_per_length = 0.08\nwidth = 0.01\nthickness = 0.008"
"""Of a V-belt."""

pytestmark = pytest.mark.slow


def make_drive(
    speed: float, radius: float = 0.05, elements: int = 40, pull: float = 0.0, belt: str = SECTION
) -> bd.Drive:
    """Two equal pulleys that start together, and a load that pulls at the belt with a force (N), for 1.8 turns."""
    centers = 0.4
    turn = (2.0 * centers + 2.0 * np.pi * radius) / speed
    return bd.loads(f"""
[belt]
{belt}
installed_tension = 200.0
wedge_angle = "40 deg"
elements = {elements}
bending_loss_factor = {BENDING}
stretch_loss_factor = {STRETCH}

[[pulley]]
name = "driver"
center = [0.0, 0.0]
radius = {radius}
speed = {{kind = "cosine_ramp", start = 0.0, end = {0.3 * turn}, value = {speed / radius}}}

[[pulley]]
name = "driven"
center = [{centers}, 0.0]
radius = {radius}
inertia = {1e-4 * (radius / 0.05) ** 2 * min(1.0, (3.0 / speed) ** 2)}
torque = {{kind = "cosine_ramp", start = {0.06 * turn}, end = {0.45 * turn}, value = {-pull * radius}}}

[contact]
friction = 0.35
stiffness = 2e7
damping = 200.0
friction_law = "coefficient_slope"
creep_velocity = {0.002 * speed}
moment_arm = "rim"

[simulation]
duration = {1.8 * turn}
output_interval = {turn / 200.0}
frame = "travelling"
rtol = 1e-3
""")


def run_drive(drive: bd.Drive) -> tuple[Balance, float, FloatArray, float]:
    """Powers, speed of the belt, its span tensions in the last 1.1 turns, and the closure of the energy account."""
    run = bd.simulate(drive)
    start = 0.4 * float(run.dataset["time"][-1])
    last = run.dataset.sel(time=slice(start, None))
    speed, tensions = float(last["belt_speed"].mean()), last["span_tension"].values.mean(axis=0)
    return power_balance(run, start), speed, tensions, float(abs(run.dataset["energy_closure"]).max())


@pytest.mark.parametrize("speed", [0.3, 3.0, 30.0])
def test_losses_do_not_depend_on_the_speed(speed: float, measured: Callable[..., None]) -> None:
    """Bending within 6 %: 2 % by smoothing, the rest waves of a mesh as coarse as the layer.

    Stretch within 1e-4 of the pull: waves of the tension on such a mesh lose about as much as the pass itself.
    """
    drive = make_drive(speed, pull=150.0)
    balance, belt_speed, tensions, closure = run_drive(drive)
    stiffness = drive.belt
    bending = balance.losses["belt bending"] / belt_speed
    stretch = balance.losses["belt stretch"] / belt_speed
    expected = float(bending_loss(stiffness.bending_stiffness, BENDING, drive.radii).sum())
    cycle = stretch_loss(stiffness.axial_stiffness, STRETCH, float(tensions.max()), float(tensions.min()))
    measured(bending=bending / expected, stretch=stretch / cycle, closure=closure, efficiency=balance.efficiency)
    assert bending == pytest.approx(expected, rel=0.06)
    assert stretch == pytest.approx(cycle, abs=1e-4 * 150.0)
    assert stretch > 0.85 * cycle
    assert closure < 2e-3


@pytest.mark.parametrize("elements", [30, 50])
def test_losses_do_not_depend_on_the_mesh(elements: int, measured: Callable[..., None]) -> None:
    """Elements of 1.4 to 2.4 times the layer sqrt(EI / T) in which the belt bends: bending within 6 %."""
    drive = make_drive(3.0, elements=elements)
    balance, belt_speed, _, _ = run_drive(drive)
    expected = float(bending_loss(drive.belt.bending_stiffness, BENDING, drive.radii).sum())
    found = balance.losses["belt bending"] / belt_speed
    measured(bending=found / expected)
    assert found == pytest.approx(expected, rel=0.06)


@pytest.mark.parametrize(
    ("speed", "radius", "stiffness"),
    [(0.3, 0.05, 2e7), (3.0, 0.05, 2e7), (30.0, 0.05, 2e7), (3.0, 0.03, 2e7), (3.0, 0.05, 2e6), (3.0, 0.05, 2e9)],
)
def test_bending_in_steady_running(
    speed: float, radius: float, stiffness: float, measured: Callable[..., None]
) -> None:
    """On a mesh that stays, on soft and stiff pulleys: within 3 %, the part of it above 1 for the overshoot."""
    given = make_drive(speed, radius)
    drive = given.replace(contact=given.contact.replace(stiffness=stiffness))
    run = bd.steady_state(drive)
    found = power_balance(run, 0.0).losses["belt bending"] / float(run.dataset["belt_speed"].mean())
    expected = float(bending_loss(drive.belt.bending_stiffness, BENDING, drive.radii).sum())
    measured(bending=found / expected)
    assert found == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize(("speed", "pull"), [(0.3, 75.0), (3.0, 75.0), (3.0, 150.0), (30.0, 150.0)])
def test_stretch_in_steady_running(speed: float, pull: float, measured: Callable[..., None]) -> None:
    """Within a quarter, by the reference at rest and slow arcs; without waves the mesh has no part in it.

    But for the 33 elements that contact forces to 1 % need: means over elements, of which arcs have few, lose up to 6 %
    less where little is lost.
    """
    drive = make_drive(speed, pull=pull)
    found = []
    for tolerance in (0.01, 0.002, 5e-4):
        run = bd.steady_state(drive, force_tolerance=tolerance)
        tensions = run.dataset["span_tension"].values[-1]
        cycle = stretch_loss(drive.belt.axial_stiffness, STRETCH, float(tensions.max()), float(tensions.min()))
        lost = power_balance(run, 0.0).losses["belt stretch"] / float(run.dataset["belt_speed"].mean())
        found.append(lost / cycle)
    measured(coarse=found[0], fine=found[1], finest=found[2])
    assert found[0] == pytest.approx(found[2], rel=0.06)
    assert found[1] == pytest.approx(found[2], rel=0.02)
    assert 0.8 < found[2] < 1.25


def test_the_torque_that_bending_takes_goes_by_the_inverse_radius(
    measured: Callable[..., None], curve: Callable[..., None]
) -> None:
    """Torque over a factor of 2.7 in the radius: an exponent of -1 within 0.05."""
    radii, torques = np.array([0.03, 0.05, 0.08]), []
    for radius in radii:
        balance, belt_speed, _, _ = run_drive(make_drive(3.0, float(radius)))
        torques.append(radius * balance.losses["belt bending"] / belt_speed)
    fine = np.linspace(radii[0], radii[-1])
    exponent = np.polyfit(np.log(radii), np.log(torques), 1)[0]
    measured(exponent=exponent, **{f"torque_{1e3 * r:g}_mm": t for r, t in zip(radii, torques, strict=True)})
    curve("hysteresis/torque", 1e3 * fine, 2.0 * fine * bending_loss(0.05, BENDING, fine), "π/2 η EI / R", "k-")
    curve("hysteresis/torque", 1e3 * radii, torques, "simulation", "o")
    assert exponent == pytest.approx(-1.0, abs=0.05)


def test_efficiency_of_a_classical_v_belt(measured: Callable[..., None], curve: Callable[..., None]) -> None:
    """Profile A on its smallest pulleys: 93 to 98 % under its load, where measurements lie; less under parts of it."""
    pulls, found = np.array([50.0, 100.0, 200.0]), []
    for pull in pulls:
        belt = 'profile = "A"\nribs = 1'
        balance, _, _, _ = run_drive(make_drive(10.0, 0.0355, 40, float(pull), belt))
        found.append(balance.efficiency)
    measured(**{f"efficiency_{pull:g}_N": value for pull, value in zip(pulls, found, strict=True)})
    curve("hysteresis/efficiency", pulls, 100.0 * np.array(found), "simulation", "o-")
    assert 0.93 < found[-1] < 0.98
    assert found == sorted(found)

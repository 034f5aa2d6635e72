"""Verified: web lines in steady running, against draws, moments of rollers, and the first law.

The same unstretched length c passes every place in a unit of time.  A roller that grips the web where it arrives moves
it at its own speed, v = c g with the stretch g of the span before it, so that T = N(g_0 v / v_0).
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results.energy_balance import largest_closure

RADIUS, SPEED, ENTERS, LEAVES = 0.05, 2.0, 100.0, 150.0


def line(idler: dict[str, Any], last: dict[str, Any], winder: float = LEAVES, friction: float = 0.8) -> Drive:
    """A roller at the speed of the web, an idle one on its other side, and another one."""
    first = {"name": "first", "center": [0.5, 0.0], "radius": RADIUS, "speed": SPEED / RADIUS}
    middle = {"name": "idler", "center": [1.0, 0.3], "radius": RADIUS, "side": "outside", "inertia": 1e-3}
    return Drive(
        belt={
            "axial_stiffness": 2e4,
            "bending_stiffness": 1e-4,
            "mass_per_length": 0.05,
            "thickness": 1e-4,
            "width": 0.2,
        },
        unwinder={"point": [0.0, 0.3], "tension": ENTERS},
        pulley=[first, middle | idler, {"name": "last", "center": [1.5, 0.0], "radius": RADIUS} | last],
        winder={"point": [2.0, 0.3], "tension": winder},
        contact={"friction": friction},
        simulation={"duration": 1.0},
    )


@pytest.mark.parametrize("draw", [1.002, 1.005, 0.999])
def test_a_draw_sets_the_tension_between_driven_rollers(draw: float) -> None:
    """To 0.1 %; the account of energy closes with the power that comes in and goes out."""
    run = bd.steady_state(line({}, {"speed": draw * SPEED / RADIUS}))
    law = run.prepared.belt.stretch_parameters
    enters = float(law.stretch(ENTERS))
    between = float(law.tension(draw * enters))
    found = run.dataset.span_tension.values[-1]
    assert found == pytest.approx([between, between, LEAVES, ENTERS], rel=1e-3)
    assert run.dataset.attrs["belt_parameter"] == pytest.approx(SPEED / enters, rel=1e-5)
    assert abs(largest_closure(run.dataset).error) < 1e-7


@pytest.mark.parametrize("torque", [0.0, 1.0])
def test_rollers_change_the_tension_by_their_moments(torque: float) -> None:
    """To 0.1 %: an idle roller with friction in its bearings, and one that is driven with a torque.

    Both run as fast as the web that arrives.
    """
    bearing = 0.1
    given = {"inertia": 1e-3, "torque": torque}
    run = bd.steady_state(line({"load": [{"kind": "resistance", "constant": bearing}]}, given, winder=120.0))
    law = run.prepared.belt.stretch_parameters
    before = 120.0 + torque / RADIUS
    arrives = np.array([before - bearing / RADIUS, before])
    found = run.dataset.isel(time=-1)
    assert found.span_tension.values[:2] == pytest.approx(arrives, rel=1e-3)
    rims = np.abs(found.pulley_speed.values[1:]) * RADIUS
    assert rims == pytest.approx(SPEED / law.stretch(ENTERS) * law.stretch(arrives), rel=1e-5)


def test_torques_of_rolls_set_the_tensions_of_the_ends() -> None:
    """M/R, to 0.1 %, at the instant asked for."""
    roll = {"core_radius": 0.05, "radius": 0.1}
    rising = {"kind": "step", "time": 0.5, "before": 10.0, "value": 12.0}
    drive = line({}, {"speed": 1.002 * SPEED / RADIUS}).replace(
        unwinder={"point": [0.0, 0.3], "torque": rising, "roll": roll},
        winder={"point": [2.0, 0.3], "torque": 15.0, "roll": roll},
    )
    for instant, enters in ((0.0, 100.0), (1.0, 120.0)):
        found = bd.steady_state(drive, at=instant).dataset
        assert found.span_tension.values[-1, 2:] == pytest.approx([LEAVES, enters], rel=1e-3)
        assert found.roll_torque.values[-1] == pytest.approx([0.1 * enters, 15.0], rel=1e-3)


def test_a_roller_that_cannot_hold_the_draw_slips() -> None:
    """To 0.1 %: the tensions before and behind it have the ratio of Euler and Eytelwein."""
    run = bd.steady_state(line({}, {"speed": 0.998 * SPEED / RADIUS}, friction=0.4))
    centrifugal = 0.05 * SPEED**2
    expected = (LEAVES - centrifugal) * np.exp(-0.4 * run.prepared.path.wrap_angles[2]) + centrifugal
    assert run.dataset.span_tension.values[-1, :2] == pytest.approx([expected, expected], rel=1e-3)


def test_steady_running_of_a_neighbour_is_found_on_its_mesh() -> None:
    """Other loads give the tensions that they give from rest, to the tolerance of the mesh."""
    first, second = (line({}, {"inertia": 1e-3, "torque": 1.0}, winder=tension) for tension in (120.0, 125.0))
    other, alone = bd.steady_state(second, start=bd.steady_state(first)), bd.steady_state(second)
    assert other.dataset.span_tension.values[-1] == pytest.approx(alone.dataset.span_tension.values[-1], rel=1e-5)
    assert other.drive.belt_length == pytest.approx(alone.drive.belt_length, rel=1e-6)


def test_powers_of_shafts_and_web_balance() -> None:
    """What rollers put in, the web brings and losses take is nothing in all, to the closure of the account."""
    balance = bd.summarize(bd.steady_state(line({}, {"speed": 1.002 * SPEED / RADIUS}))).balance
    stretches = 1.0 + np.array([LEAVES, ENTERS]) / 2e4
    passes = SPEED / stretches[1]
    tension = passes * (LEAVES * stretches[0] - ENTERS * stretches[1])
    strain = passes * 2e4 * ((stretches[0] - 1.0) ** 2 - (stretches[1] - 1.0) ** 2) / 2.0
    assert balance.web == pytest.approx(tension - strain, rel=1e-3)
    assert balance.power_in == pytest.approx(balance.power_out + balance.lost, abs=1e-6 * ENTERS * SPEED)


@pytest.mark.parametrize(
    ("analysis", "told"),
    [
        (partial(bd.modes, about="rest"), "a web line has modes about steady running alone"),
        (
            partial(bd.sweep, pulley="first", from_="10 rad/s", to="40 rad/s", duration=1.0),
            "a run-up needs a closed belt",
        ),
        (partial(bd.traction, pulley="idler"), "a traction curve needs a closed belt, and this is a web line"),
        (bd.tensioner_sheet, "a tensioner sheet needs a closed belt, and this is a web line"),
        (bd.life, "the fatigue life needs a closed belt, and this is a web line"),
        (bd.stroke, "a stroke needs a carriage"),
    ],
)
def test_what_a_web_line_has_not_is_told(analysis: Callable[[Drive], Any], told: str) -> None:
    with pytest.raises(ModelError, match=told):
        analysis(line({}, {"speed": SPEED / RADIUS}))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "tension"), [("coater", 120.0), ("calender", 400.0)])
def test_a_web_line_rests_at_the_tension_of_its_unwinder(name: str, tension: float) -> None:
    """To 0.1 %, with rolls and with nips."""
    found = bd.equilibrium(bd.load(Path(__file__).parents[3] / "docs" / "tasks" / f"{name}.toml"))
    assert found.dataset.span_tension.values == pytest.approx(tension, rel=1e-3)

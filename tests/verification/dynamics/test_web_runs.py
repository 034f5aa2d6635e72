"""Verified: web lines over time and their vibrations, against transport of strain, stretch waves, and a dancer.

The web between two rollers that grip it has the content L/g.  What enters has the stretch g_0 of the span before, so
that d(L/g)/dt = v_1/g_0 - v_2/g: 1/g goes to its steady value with the rate v_2/L.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.balance import largest_closure

pytestmark = pytest.mark.slow

RADIUS, SPEED, STIFFNESS, TENSION = 0.05, 2.0, 2e4, 100.0
FRICTION, MASS = 0.8, 0.05
RISE, DRAW = (0.05, 0.10), 5e-4


def line(rollers: list[dict[str, Any]], end: float, mass: float = MASS, **more: Any) -> Drive:
    """Rollers between an unwinder and a winder with the same tension."""
    return Drive(
        belt={
            "axial_stiffness": STIFFNESS,
            "bending_stiffness": 1e-4,
            "mass_per_length": mass,
            "thickness": 1e-4,
            "width": 0.2,
        },
        unwinder={"point": [0.0, 0.3], "tension": TENSION},
        pulley=[{"radius": RADIUS} | one for one in rollers],
        winder={"point": [end, 0.3], "tension": TENSION},
        contact={"friction": FRICTION, "creep_ratio": 3e-5},  # a fifth of the default: near Coulomb's law
        **more,
    )


@pytest.fixture(scope="module")
def stepped() -> Run:
    """A line of two driven rollers, of which the second gets faster by a draw."""
    faster = SPEED / RADIUS * np.array([1.0, 1.0, 1.0 + DRAW, 1.0 + DRAW])
    rising = {"kind": "table", "times": [0.0, *RISE, 10.0], "values": faster.tolist()}
    drive = line(
        [
            {"name": "first", "center": [0.5, 0.0], "speed": SPEED / RADIUS},
            {"name": "last", "center": [1.5, 0.0], "speed": rising},
        ],
        2.0,
        simulation={"duration": 1.1, "start": "steady", "output_interval": 5e-3, "rtol": 1e-4},
    )
    return bd.simulate(drive)


def test_a_draw_is_transported(stepped: Run, curve: Callable[..., None]) -> None:
    """The tension follows the content of the span and of the arc that slides on the first roller.

    To 0.1 % of the change of the draw.
    """
    law, time = stepped.prepared.belt.stretch_parameters, stepped.dataset.time.values
    length = float(stepped.prepared.path.span_lengths[0])
    tension = np.linspace(TENSION, TENSION + 1.2 * STIFFNESS * DRAW, 2001)
    thin = 1.0 / law.stretch(tension)
    slides = RADIUS / FRICTION * (thin - thin[0]) / (tension - MASS * SPEED**2)
    content = length * thin + cumulative_trapezoid(slides, tension, initial=0)

    def flow(at: float, held: FloatArray) -> FloatArray:
        part = np.clip((at - RISE[0]) / (RISE[1] - RISE[0]), 0.0, 1.0)
        return np.asarray(SPEED * (thin[0] - (1.0 + DRAW * part) * np.interp(held, content[::-1], thin[::-1])))

    found = solve_ivp(flow, (0.0, time[-1]), [content[0]], t_eval=time, rtol=1e-10, atol=1e-13, max_step=0.01)
    expected = np.interp(found.y[0], content[::-1], tension[::-1])
    assert expected[-1] - TENSION == pytest.approx(STIFFNESS * DRAW * (1.0 - np.exp(-2.0)), rel=0.02)
    tensions = stepped.dataset.span_tension.values[:, 0]
    curve("web_draw", time, tensions, "found", "-")
    curve("web_draw", time[::10], expected[::10], "closed form", ".")
    later = time > 0.2
    assert np.abs(tensions - expected)[later].max() < 1e-3 * STIFFNESS * DRAW


def test_the_account_of_energy_closes_with_the_flow_through_the_ends(stepped: Run) -> None:
    """To the tolerance of the steps."""
    assert abs(largest_closure(stepped.dataset).error) < 1e-4
    assert abs(stepped.dataset.numerical_loss.values[-1]) < 1e-4 * stepped.dataset.torque_work.values[-1]


def test_steady_running_stays(stepped: Run) -> None:
    """Before the draw changes, tensions stay as they begin to a millionth."""
    before = stepped.dataset.span_tension.values[stepped.dataset.time.values < RISE[0]]
    assert np.abs(before - before[0]).max() < 1e-6 * TENSION


def test_stretch_waves(stepped: Run) -> None:
    """To 0.5 %: half a wave between gripping rollers, a quarter between one and a held tension."""
    drive = stepped.drive.replace(pulley=[one.replace(speed=SPEED / RADIUS) for one in stepped.drive.pulleys])
    found = bd.modes(drive, count=60).dataset
    free = np.array(drive.path.span_lengths)
    stretch = 1.0 + TENSION / STIFFNESS
    speed = np.sqrt(STIFFNESS / MASS) * stretch
    longitudinal = found.frequency.values[found.belt_share.values.ravel() > 0.9]
    assert longitudinal[:3] == pytest.approx(np.sort(speed / free / np.array([2.0, 4.0, 4.0])), rel=5e-3)


def test_a_dancer() -> None:
    """To 0.5 %: frequency and damping by the equations of transport, with the inertia of the roller."""
    mass, rate, damping, inertia, span = 8.0, 500.0, 60.0, 1e-3, 2.0
    apart = np.hypot(span, 0.3)
    length = np.sqrt(apart**2 - (2.0 * RADIUS) ** 2)
    rise = np.sin(np.arctan2(0.3, span) + np.arcsin(2.0 * RADIUS / apart))
    dancer = {"name": "dancer", "center": [2.0 * span, 0.3], "side": "outside", "inertia": inertia, "mass": mass}
    driven = ({"name": name, "center": [x, 0.0], "speed": SPEED / RADIUS} for name, x in (("a", span), ("b", 3 * span)))
    first, last = driven
    slide = {"kind": "sliding", "pulley": "dancer", "direction": [0, 1], "rate": rate, "damping": damping}
    slide["preload"] = 2.0 * TENSION * rise
    drive = line(
        [first, dancer, last], 4.0 * span, mass=1e-3, tensioner=[slide], simulation={"duration": 1.0, "start": "steady"}
    )
    along, flow = STIFFNESS / length, SPEED / length
    sideways = 2.0 * TENSION * (1.0 - rise**2) / length
    turning = RADIUS**2 / inertia
    motion = np.array(
        [
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [-(rate + sideways) / mass, -damping / mass, 0.0, -rise / mass, -rise / mass],
            [0.0, 0.0, 0.0, -turning, turning],
            [0.0, along * rise, along, -flow, 0.0],
            [0.0, along * rise, -along, flow, -flow],
        ]
    )
    values = np.linalg.eigvals(motion)
    slow = values[np.argmin(np.abs(values.imag - 2.0 * np.pi * 2.0))]
    found = bd.modes(drive, count=3).dataset
    assert found.kind.values[0] == "tensioner"
    assert 2.0 * np.pi * found.frequency.values[0] == pytest.approx(slow.imag, rel=5e-3)
    assert found.growth_rate.values[0] == pytest.approx(slow.real, rel=5e-3)

"""Verified: tensions of a web that slides on a roller with an air film, against the capstan equation.

On the sliding arc N = T - m v^2 grows by dN/dphi = mu s(h) N with h = 0.643 R (6 eta V b / N)^(2/3), V the speed of
the web: the film is thinner where the web is tighter, and the ratio of the tensions falls with V.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive

RADIUS, HALF, WIDTH, MASS, FRICTION, VISCOSITY = 0.05, 0.00125, 0.02, 0.0574, 0.3, 1.81e-5
PITCH = RADIUS + HALF
ROUGHNESS = 2e-7
SPEEDS = 0.2, 1.3, 1.7
"""Of the web, m/s: dry, and with more and more of the arc on air."""


def drive(speed: float) -> Drive:
    """A held roller, and a driver with enough friction to pull the web around it, whose rim has a speed in m/s."""
    driver = {"name": "driver", "center": [0.0, 0.0], "radius": RADIUS, "speed": speed / PITCH}
    roller = {"name": "roller", "center": [0.4, 0.0], "radius": RADIUS, "speed": 0.0, "friction": FRICTION}
    film = {"film_radius": PITCH, "web_width": WIDTH, "roughness": ROUGHNESS, "air_viscosity": VISCOSITY}
    return Drive(
        belt={
            "profile": "flat-polyamide",
            "width": WIDTH,
            "bending_stiffness": 1.2e-5,
            "installed_tension": 200.0,
        },
        pulley=[driver, roller],
        contact={"friction": 3.0, "friction_law": "air_film", **film},
        simulation={"duration": 1.0},
    )


def tight_of(slack: float, entrained: float) -> float:
    """Tension less m v^2 behind the arc from that before it, N."""

    def growth(_angle: float, tension: FloatArray) -> FloatArray:
        height = 0.643 * PITCH * (6.0 * VISCOSITY * entrained * WIDTH / tension) ** (2.0 / 3.0)
        return np.asarray(FRICTION * np.clip(1.5 - height / (2.0 * ROUGHNESS), 0.0, 1.0) * tension)

    return float(solve_ivp(growth, (0.0, np.pi), [slack], rtol=1e-9, atol=1e-9).y[0, -1])


def test_tensions_of_a_sliding_web() -> None:
    """To 0.3 %, half the share of the layers (T / k_p)^(1/2) at the ends of the arc, where pressures are others."""
    there, ratios = None, list[float]()
    for faster in SPEEDS:
        there = bd.steady_state(drive(faster), start=there)
        seen = there.dataset.isel(time=-1)
        speed = float(seen.belt_speed.mean())
        slack, tight = np.sort(seen.span_tension.values) - MASS * speed**2
        assert tight == pytest.approx(tight_of(slack, speed), rel=3e-3)
        ratios.append(tight / slack)
    assert ratios[0] == pytest.approx(np.exp(np.pi * FRICTION), rel=3e-3)
    assert ratios[-1] < 0.9 * ratios[0]

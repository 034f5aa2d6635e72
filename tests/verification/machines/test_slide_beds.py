"""Slide beds and idlers under goods, drawn at random: the pull at the head drum against an independent balance.

A rigid bed carries all of belt and goods between the drums, so that the head pulls by

    F = sum over supports of L (f (m_b + m_g) g cos(a) + m_g g sin(a)).

A belt of the tension T hangs over sqrt(T / k) at either end of a bed of the stiffness k; the default leaves less than
1 % of the load there. Where a support ends before the drums, it carries half of the belt that hangs there.
"""

from math import cos, exp, log, radians, sin

import numpy as np
import pytest

import beltdyn as bd

G = 9.81
TOLERANCE = 0.012
"""0.8 % hang on the belt near the drums, 0.4 % is left of the mesh."""


def drawn(seed: int) -> tuple[bd.Drive, float]:
    """A conveyor with a bed or idlers under its upper strand, by odd seeds its lower one, and its pull, N."""
    rng = np.random.default_rng(seed)
    length = exp(rng.uniform(0.0, log(40.0)))
    slope = radians(rng.uniform(0.0, 35.0)) if rng.random() < 0.5 else 0.0
    radius, friction = rng.uniform(0.03, 0.2), rng.uniform(0.05, 0.5)
    belt, goods = exp(rng.uniform(log(0.05), log(4.0))), exp(rng.uniform(0.0, log(80.0)))
    idlers, whole = rng.random() < 0.3, rng.random() < 0.6
    support = {"kind": "idlers", "spacing": 1.0} if idlers else {"kind": "guide"}
    friction *= 0.1 if idlers else 1.0
    along = friction * (belt + goods) * cos(slope) + goods * sin(slope)
    sense, gap = -1.0 if seed % 2 == 0 else 1.0, 0.0 if whole else 0.05 * length
    pull = G * (along * (length - 2.0 * gap) + friction * belt * cos(slope) * gap)
    tension = max(pull * rng.uniform(1.2, 5.0), 3.0 * belt * G * length)
    span = {"span": ["tail", "head"]} | ({"start": gap, "end": length - gap} if gap else {})
    # a stiff belt leaves a drum EI / (2 T R) outside the tangent, and presses on the end of a bed by EI / (2 R gap)
    bending = min(1e-3, 1e-3 * pull * radius * gap / friction) if gap else 1e-3
    drive = bd.Drive(
        gravity=[0.0, -G],
        belt={
            "installed_tension": tension,
            "width": 0.5,
            "thickness": 0.003,
            "axial_stiffness": tension / rng.uniform(0.002, 0.01),
            "bending_stiffness": bending,
            "mass_per_length": belt,
            "friction": 0.5,
        },
        pulley=[
            {
                "name": "head",
                "center": [sense * length * cos(slope), length * sin(slope)],
                "radius": radius,
                "speed": rng.uniform(0.2, 2.0) / radius,
            },
            {"name": "tail", "center": [0.0, 0.0], "radius": radius, "inertia": 0.01},
        ],
        support=[support | span | {"friction": friction}],
        goods=[span | {"mass_per_length": goods}],
        simulation={"duration": 1.0},
    )
    return drive, pull


def error_of(drive: bd.Drive, pull: float) -> float:
    """Of the pull at the head drum in steady running, relative."""
    torque = float(bd.steady_state(drive).dataset.shaft_torque.values[-1, 0])
    return torque / drive.pulleys[0].radius / pull - 1.0


@pytest.mark.parametrize("seed", [1, 2, 113, 126, 155])
def test_the_pull_of_a_conveyor(seed: int) -> None:
    assert abs(error_of(*drawn(seed))) < TOLERANCE


@pytest.mark.slow
def test_the_pulls_of_eighty_conveyors() -> None:
    errors = [error_of(*drawn(seed)) for seed in range(100, 180)]
    assert np.max(np.abs(errors)) < TOLERANCE
    assert abs(np.mean(errors)) < 0.004


def test_a_bed_of_the_old_softness_loses_friction() -> None:
    """Belt and goods that sink in by a millimeter hang over 0.1 m at either end of 2 m."""
    level = bd.Drive(
        gravity=[0.0, -G],
        belt={
            "installed_tension": "2 kN",
            "width": "500 mm",
            "thickness": "2 mm",
            "axial_stiffness": "400 kN",
            "bending_stiffness": 1e-3,
            "mass_per_length": "2 kg/m",
            "friction": 0.4,
        },
        pulley=[
            {"name": "head", "center": [0.0, 0.0], "radius": "50 mm", "speed": 10.0},
            {"name": "tail", "center": [2.0, 0.0], "radius": "50 mm", "inertia": 0.01},
        ],
        support=[{"kind": "guide", "span": ["tail", "head"], "friction": 0.3}],
        goods=[{"span": ["tail", "head"], "mass_per_length": 20.0}],
        simulation={"duration": 1.0},
    )
    pull = 0.3 * 22.0 * G * 2.0
    assert abs(error_of(level, pull)) < TOLERANCE
    soft = level.replace(support=[level.supports[0].replace(stiffness=22.0 * G / 1e-3)])
    assert error_of(soft, pull) == pytest.approx(-2.0 * (2000.0 / (22.0 * G / 1e-3)) ** 0.5 / 2.0, abs=0.02)

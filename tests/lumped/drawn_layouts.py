"""Layouts drawn at random, with an installed tension that is asked for: some fit, some cannot be."""

from contextlib import suppress
from math import hypot
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError
from beltdyn.model import Path
from tests.lumped.drawn_drives import SEED, are_clear, drawn_layout, tensioner_for

_FITTING = 0.8
"""Share of layouts that a belt can run around for sure; the others are scattered."""
_OVERLAPPING = 0.1
"""Share of the scattered ones whose pulleys may overlap."""


def layout_at_rest(seed: int) -> dict[str, Any]:
    """What makes the drive of a seed: 2 to 9 pulleys, a belt, contact, at most one tensioner."""
    rng, count = np.random.default_rng([SEED, 3, seed]), 2 + seed % 8

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    small = between(0.008, 0.15)
    centers, radii, carried = _fitting(rng, count, small) if rng.random() < _FITTING else _scattered(rng, count, small)
    least = float(np.min(np.abs(radii)))
    tension = 300.0 * (small / 0.03) ** 1.5 * between(0.05, 10.0)
    thickness = rng.uniform(0.02, 0.2) * least
    belt = {
        "width": 5.0 * thickness,
        "thickness": thickness,
        "poissons_ratio": 0.3,
        "axial_stiffness": tension / between(2e-4, 3e-2),
        "bending_stiffness": tension * (between(0.01, 0.7) * least) ** 2,
        "mass_per_length": 1200.0 * 5.0 * thickness**2,
        "installed_tension": tension,
    }
    if rng.random() < 0.15:
        belt["elements"] = int(rng.integers(40, 400))
    contact: dict[str, Any] = {"friction": rng.uniform(0.25, 0.9)}
    if rng.random() < 0.2:
        contact["stiffness"] = tension / least**2 * between(0.3, 1e4)
    pulleys: list[dict[str, Any]] = [
        {
            "name": f"pulley {k}",
            "center": centers[k].tolist(),
            "radius": abs(float(radii[k])),
            "side": "inside" if radii[k] > 0.0 else "outside",
            "inertia": 1e-3,
            "mass": 0.1,
        }
        for k in range(count)
    ]
    pulleys[0]["speed"] = {"kind": "constant", "value": 0.0}
    del pulleys[0]["inertia"]
    drive: dict[str, Any] = {
        "belt": belt,
        "pulley": pulleys,
        "contact": contact,
        "gravity": [0.0, -9.81] if rng.random() < 0.5 else [0.0, 0.0],
        "simulation": {"duration": 1.0, "output_interval": 0.01},
    }
    if carried is not None:
        with suppress(ValueError):  # there is no path
            _add_tensioner(rng, drive, Path(centers, radii), carried)
    return drive


def _add_tensioner(rng: np.random.Generator, drive: dict[str, Any], path: Path, carried: int) -> None:
    """A spring that holds the tension, or another one; or a fixed tensioner that takes up a length."""
    tension = drive["belt"]["installed_tension"]
    if rng.random() < 0.25:
        gradient = path.gradient(carried)
        missing = rng.uniform(-0.5, 1.5) * abs(float(path.radii[carried]))
        drive["belt"]["length"] = (path.length + missing) / (1.0 + tension / drive["belt"]["axial_stiffness"])
        direction = (gradient / hypot(*gradient)).tolist()
        drive["tensioner"] = [{"kind": "fixed", "pulley": f"pulley {carried}", "direction": direction}]
    else:
        held = 1.0 if rng.random() < 0.6 else rng.uniform(0.2, 3.0)
        drive["tensioner"] = [tensioner_for(rng, path, carried, held * tension)]


def _fitting(rng: np.random.Generator, count: int, small: float) -> tuple[FloatArray, FloatArray, int | None]:
    while True:
        try:
            ring, carried = drawn_layout(rng, count, small)
        except (BeltdynError, ValueError, ArithmeticError):
            continue
        if are_clear(ring.centers, ring.radii):
            return ring.centers, ring.radii, carried


def _scattered(rng: np.random.Generator, count: int, small: float) -> tuple[FloatArray, FloatArray, int | None]:
    """Pulleys anywhere in a square, in the order of their angles, some of them on the back of the belt."""
    radii = small * np.exp(rng.uniform(0.0, np.log(3.5), count))
    overlapping = rng.random() < _OVERLAPPING
    while True:
        centers = rng.uniform(-1.0, 1.0, (count, 2)) * small * rng.uniform(2.0, 5.0) * np.sqrt(count)
        if overlapping or are_clear(centers, radii):
            break
    middle = centers - centers.mean(axis=0)
    order = np.argsort(np.arctan2(middle[:, 1], middle[:, 0]))
    sides = np.where(rng.random(count) < (0.0 if count < 3 else 0.2), -1.0, 1.0)
    return centers[order], radii * sides, int(rng.integers(0, count)) if rng.random() < 0.5 else None

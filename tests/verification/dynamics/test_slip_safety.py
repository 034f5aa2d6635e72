"""The slip safety against traction: loads are raised in steady running until the belt slides through."""

from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, Path
from beltdyn.parts.quantity import RPM
from beltdyn.points.changed_drive import with_load
from beltdyn.results import Run, summarize
from beltdyn.results.incidents import SLIDING_LIMIT
from beltdyn.state.steady import steady_state

KINDS = (("fixed", ""), ("sliding", "slack"), ("rotary", "slack"), ("sliding", "tight"), ("rotary", "tight"))
QUICK, ALL = (0, 3), sorted({*range(105)} - {0, 3})
"""Seeds of random drives, of the kind ``KINDS[seed % 5]``."""
WITHIN = 0.05
"""Error of the slip safety that is allowed: it leaves out bending, and creep on the part of the arc that adheres."""
NEAR = 0.005
"""Part of the load up to which gross slip is looked for."""
STRIDE = 1.3


def random_drive(seed: int) -> Drive:
    """Two to five pulleys, the first of which drives; a pulley at the back of its slack or tight span tensions."""
    random = np.random.default_rng(seed)
    kind, side = KINDS[seed % len(KINDS)]
    count = int(random.integers(2, 6 if kind == "fixed" else 5))
    radii = random.uniform(0.03, 0.08, count)
    turns = 2.0 * np.pi * (np.arange(count) + random.uniform(-0.15, 0.15, count)) / count
    centers = random.uniform(0.2, 0.3) * np.column_stack([np.cos(turns), np.sin(turns)])
    tension, stiffness = random.uniform(200.0, 500.0), random.uniform(5e4, 3e5)
    pulleys: list[dict[str, Any]] = [
        {"name": f"p{number}", "center": center, "radius": radius, "inertia": 1e-3}
        for number, (center, radius) in enumerate(zip(centers.tolist(), radii.tolist(), strict=True))
    ]
    pulleys[0]["speed"] = _constant(random.uniform(500.0, 2500.0) / RPM)
    tensioners = []
    if kind != "fixed":
        one, other = (0, 1) if side == "slack" else (count - 1, 0)
        way = centers[other] - centers[one]
        inward = np.array([-way[1], way[0]]) / np.linalg.norm(way)  # the belt runs counter-clockwise
        radius, pressed = random.uniform(0.025, 0.04), random.uniform(0.01, 0.04)
        center = 0.5 * (centers[one] + centers[other]) + inward * (pressed - radius - 0.5 * (radii[one] + radii[other]))
        idler = {"name": "idler", "center": center.tolist(), "radius": radius, "side": "outside"}
        pulleys.insert(one + 1, {**idler, "inertia": 1e-4, "mass": 0.2})
    signed = [one["radius"] * (-1.0 if "side" in one else 1.0) for one in pulleys]
    taking = [number for number, one in enumerate(pulleys) if number and one["name"] != "idler"]
    path = Path(np.array([one["center"] for one in pulleys]), np.array(signed))
    if kind != "fixed":
        tensioners.append(_tensioner(kind, center, inward, tension * path.gradient(one + 1), random))
    friction = random.uniform(0.2, 0.6)
    held = tension * np.tanh(0.5 * friction * np.min(path.wrap_angles[[0, *taking]]))
    forces = random.uniform(0.2, 1.0, len(taking))
    forces *= random.uniform(0.4, 1.2) * held / forces.sum()
    for number, force in zip(taking, forces.tolist(), strict=True):
        pulleys[number]["torque"] = _constant(-force * pulleys[number]["radius"])
    return Drive(
        belt={
            "length": path.length / (1.0 + tension / stiffness),
            "width": 0.02,
            "thickness": 0.003,
            "density": 1700.0,
            "youngs_modulus": stiffness / (0.02 * 0.003),
            "poissons_ratio": 0.3,
            "bending_factor": 0.02,
        },
        contact={"friction": friction},
        pulley=pulleys,
        tensioner=tensioners,
        simulation={"duration": 1.0, "output_interval": 0.01, "frame": "staying"},
    )


def _constant(value: float) -> dict[str, Any]:
    return {"kind": "constant", "value": value}


def _tensioner(kind: str, center: FloatArray, inward: FloatArray, hub: FloatArray, random: np.random.Generator) -> Any:
    """A tensioner that presses inwards and balances a force of the hub at the center given."""
    if kind == "sliding":
        direction = inward + random.uniform(-0.4, 0.4) * np.array([-inward[1], inward[0]])
        direction /= np.linalg.norm(direction)
        given = {"direction": direction.tolist(), "mass": 0.3, "rate": random.uniform(0.0, 5e3)}
        return {"kind": "sliding", "pulley": "idler", "preload": float(hub @ direction), **given}
    arm = random.choice([-1.0, 1.0]) * np.array([-inward[1], inward[0]]) + random.uniform(-0.5, 0.5) * inward
    arm *= random.uniform(0.05, 0.1)
    preload = abs(float(hub @ np.array([-arm[1], arm[0]])))
    given = {"pivot": (center - arm).tolist(), "inertia": 1e-3, "rate": random.uniform(0.0, 20.0)}
    return {"kind": "rotary", "pulley": "idler", "preload": preload, **given}


def load_at_gross_slip(drive: Drive, run: Run) -> float:
    """Largest factor on the loads with which the belt does not slide through, by continuation in steady running."""
    holds, slides = 1.0, np.inf
    while slides - holds > NEAR * holds:
        factor = STRIDE * holds if slides == np.inf else 0.5 * (holds + slides)
        try:
            there = steady_state(with_load(drive, factor), start=run)
        except ConvergenceError:
            slides = factor
            continue
        if slides_through(there):
            slides = factor
        else:
            holds, run = factor, there
    return holds


def slides_through(run: Run) -> bool:
    pulleys = summarize(run).pulleys
    rim = abs(pulleys[0].speed) * float(run.drive.radii[0])
    return any(abs(one.sliding_speed) > SLIDING_LIMIT * rim for one in pulleys)


def compared(seed: int) -> tuple[float, float]:
    """The slip safety of a random drive, and the factor on its loads at which it slides."""
    drive = random_drive(seed)
    run = steady_state(drive)
    safeties = [one.slip_safety for one in summarize(run).pulleys]
    return float(np.nanmin(safeties)), load_at_gross_slip(drive, run)


@pytest.mark.parametrize("seed", [*QUICK, *(pytest.param(seed, marks=pytest.mark.slow) for seed in ALL)])
def test_the_slip_safety_is_the_load_at_which_the_belt_slides_through(seed: int) -> None:
    safety, found = compared(seed)
    assert safety == pytest.approx(found, rel=WITHIN)

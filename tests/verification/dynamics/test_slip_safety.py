"""The slip safety against traction: loads are raised in steady running until the belt slides through.

All loads together, or that of one pulley alone, with rough other pulleys so that it is the one that slides; drives with
tensioners, and heavy belts with supports, goods and take-ups by weight.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.machines import Constant
from beltdyn.model import Drive, Path
from beltdyn.parts.quantity import RPM
from beltdyn.points.changed_drive import with_load
from beltdyn.results import Run, summarize
from beltdyn.results.incidents import SLIDING_LIMIT
from beltdyn.state.steady import steady_state
from tests.lumped.drawn_heavy import drawn_heavy, scaled

KINDS = (("fixed", ""), ("sliding", "slack"), ("rotary", "slack"), ("sliding", "tight"), ("rotary", "tight"))
QUICK, ALL = (0, 3), sorted({*range(105)} - {0, 3})
"""Seeds of random drives, of the kind ``KINDS[seed % 5]``."""
WITHIN = 0.02
"""Error of the slip safety that is allowed: it leaves out bending, and creep on the part of the arc that adheres."""
NEAR = 0.004
"""Part of the load up to which gross slip is looked for."""
STRIDE = 0.98
"""First load, over that by the slip safety."""
ROUGH = 4.0
"""Friction of other pulleys over their own, which keeps them from sliding first."""
HEAVY_QUICK, HEAVY = (3,), sorted({*range(28)} - {1, 3, 18, 22})
"""Seeds of heavy belts: 1 and 22 sag too much for their installed tension, 18 has a factor of 115."""
FACTORS_TO_35 = (0, 2), (0, 3), (5, 3), (7, 3), (12, 3), (22, 4), (26, 4), (33, 3), (50, 3)
"""Seeds and pulleys that slide at 15 to 35 times their own load."""


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


def load_at_gross_slip(at: Callable[[float], Drive], run: Run, expected: float) -> float:
    """Largest factor on loads with which the belt does not slide through, by continuation in steady running."""
    holds, slides, factor = 1.0, np.inf, max(STRIDE * expected, 1.0)
    while slides - holds > NEAR * holds:
        try:
            there = steady_state(at(factor), start=run)
        except ConvergenceError:
            slides = factor
        else:
            if slides_through(there):
                slides = factor
            else:
                holds, run = factor, there
        factor = holds / STRIDE if slides == np.inf else 0.5 * (holds + slides)
    return 0.5 * (holds + slides)


def slides_through(run: Run) -> bool:
    pulleys = summarize(run).pulleys
    rim = abs(pulleys[0].speed) * float(run.drive.radii[0])
    return any(abs(one.sliding_speed) > SLIDING_LIMIT * rim for one in pulleys)


def least_safety(run: Run) -> float:
    return float(np.nanmin([one.slip_safety for one in summarize(run).pulleys]))


@pytest.mark.parametrize("seed", [*QUICK, *(pytest.param(seed, marks=pytest.mark.slow) for seed in ALL)])
def test_the_slip_safety_is_the_load_at_which_the_belt_slides_through(seed: int) -> None:
    drive = random_drive(seed)
    run = steady_state(drive)
    safety = least_safety(run)
    assert safety == pytest.approx(load_at_gross_slip(partial(with_load, drive), run, safety), rel=WITHIN)


@pytest.mark.parametrize(
    ("seed", "pulley"),
    [
        (3, 1),
        *(
            pytest.param(seed, pulley, marks=pytest.mark.slow)
            for seed, pulley in (*((seed, pulley) for seed in range(1, 15) for pulley in (1, 2)), *FACTORS_TO_35)
        ),
    ],
)
def test_the_own_slip_safety_is_the_own_load_at_which_a_pulley_slides(seed: int, pulley: int) -> None:
    drawn = random_drive(seed)
    friction = ROUGH * float(drawn.contact.friction or 0.0)
    others = [one if k == pulley else one.replace(friction=friction) for k, one in enumerate(drawn.pulleys)]
    drive = drawn.replace(pulley=others)
    if drive.pulleys[pulley].torque is None:
        pytest.skip("an idler has no load")

    def loaded(factor: float) -> Drive:
        pulleys, own = list(drive.pulleys), drive.pulleys[pulley].torque
        assert own is not None
        pulleys[pulley] = pulleys[pulley].replace(torque=Constant(value=factor * float(own.at([0.0])[0])))
        return drive.replace(pulley=pulleys)

    run = steady_state(drive)
    safety = summarize(run).pulleys[pulley].own_load_safety
    assert safety == pytest.approx(load_at_gross_slip(loaded, run, safety), rel=WITHIN)


@pytest.mark.parametrize("seed", [*HEAVY_QUICK, *(pytest.param(seed, marks=pytest.mark.slow) for seed in HEAVY)])
def test_the_slip_safety_of_heavy_belts(seed: int) -> None:
    """Lifts, slopes and conveyors with supports, goods and take-ups by weight: what the belt drags is a load."""
    run = steady_state(drawn_heavy(seed))
    safety = least_safety(run)
    assert safety == pytest.approx(load_at_gross_slip(partial(scaled, run.drive), run, safety), rel=WITHIN)


def test_near_the_edge_the_pulley_that_holds_has_its_own_slip_safety() -> None:
    """A V-belt over a small and a large pulley: the small one slides at 3 % more, the large one at 10 %."""

    def drive(torque: float) -> Drive:
        return Drive(
            belt={
                "installed_tension": 2083.0,
                "width": 0.017,
                "thickness": 0.011,
                "axial_stiffness": 89e3,
                "bending_stiffness": 1e-4,
                "mass_per_length": 1e-3,
                "wedge_angle": "40 deg",
                "friction": 0.4,
            },
            pulley=[
                {"name": "motor", "center": [0.0, 0.0], "radius": 0.075, "speed": 26.18},
                {"name": "driven", "center": [0.6, 0.0], "radius": 0.2, "inertia": 0.1, "torque": -torque},
            ],
            simulation={"duration": 1.0},
        )

    limits = [torque * summarize(steady_state(drive(torque))).pulleys[1].slip_safety for torque in (975.0, 980.0)]
    assert limits == pytest.approx([1082.0, 1082.0], rel=WITHIN)

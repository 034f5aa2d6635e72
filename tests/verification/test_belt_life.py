"""Damage of cords against rainflow on the true history of a material point, of drives drawn at random.

The true history is taken apart from the package: from the nodes of the result, at 200 places of each element, with the
derivatives of Hermite polynomials; its tension is the axial force of the elements by the law of stretch, and 2 EI k^2
more. That this is the tension of the line of force follows from the energy W(g) + EI (3 g^2 - 1) / 4 t^2 per reference
length, with the stretch g and the rate of turn t = k g: the axial force is dW/dg + 3/2 EI k^2 at g = 1, and along a
smooth rim that and EI k^2 / 2 have a constant sum.
"""

from typing import Any

import numpy as np
import pytest
from scipy.interpolate import BPoly

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.results import Run
from beltdyn.results.damage import hourly_damage, rainflow_of_turn
from beltdyn.results.mechanics import element_lengths

PLACES, SMALLEST = 200, 0.05
TOLERANCE = 2e-3
"""Of the damage: eight places an element against 200. Ripples below 5 % of the largest range count as none in both."""


def drawn(seed: int) -> bd.Drive:
    """A drive of two or three pulleys with fatigue data, in the plane of gravity or without."""
    rng = np.random.default_rng(seed)
    small, large, tension = rng.uniform(0.04, 0.08), rng.uniform(0.06, 0.15), rng.uniform(300.0, 900.0)
    radii, centers = [small, large], [[0.0, 0.0], [rng.uniform(0.4, 1.0), 0.0]]
    if rng.random() < 0.5:
        radii.append(rng.uniform(0.04, 0.08))
        centers.append([0.5 * centers[1][0], rng.uniform(0.3, 0.6)])
    slope = rng.uniform(4.0, 12.0)
    load = -rng.uniform(0.2, 0.7) * tension * large
    pulleys: list[dict[str, Any]] = [
        {"name": f"p{number}", "center": center, "radius": radius}
        for number, (center, radius) in enumerate(zip(centers, radii, strict=True))
    ]
    sense = float(rng.choice([-1.0, 1.0]))
    pulleys[0]["speed"] = sense * rng.uniform(50.0, 200.0)
    pulleys[1] |= {"torque": sense * load, "inertia": 0.01}
    for pulley in pulleys[2:]:
        pulley["inertia"] = 0.001
    line: dict[str, Any] = {"cycles": [1e6, 1e6 * 4.0**slope], "forces": [4.0 * tension, tension], "source": "drawn"}
    line |= {"range_exponent": float(rng.choice([0.0, 0.5, 1.0]))}
    belt = {
        "axial_stiffness": float(rng.uniform(1e5, 4e5)),
        "bending_stiffness": float(10 ** rng.uniform(-3.0, -1.0)),
        "mass_per_length": 0.1,
        "width": 0.02,
        "thickness": 0.006,
        "installed_tension": tension,
        "cord_fatigue": line | {"bending_force": float(rng.uniform(0.1, 0.5) * tension * small)},
    }
    return bd.Drive(belt=belt, pulley=pulleys, contact={"friction": 2.0}, simulation={"duration": 1.0})


def true_forces(run: Run) -> FloatArray:
    """Force in the cords at many places of all elements, N, in the order of the belt."""
    drive, nodes = run.drive, run.dataset["nodal_coordinates"].values[-1]
    lengths = element_lengths(run.dataset.isel(field_time=slice(-1, None)), drive.belt_length)
    lengths, xi = np.ravel(lengths), (np.arange(PLACES) + 0.5) / PLACES
    line, curvatures, tensions = drive.belt.cord_fatigue, list[FloatArray](), list[float]()
    assert line is not None
    for first, last, length in zip(nodes, np.roll(nodes, -1, axis=0), lengths, strict=True):
        values = [[first[0:2], first[2:4], first[4:6]], [last[0:2], last[2:4], last[4:6]]]
        curve = BPoly.from_derivatives([0.0, length], values)
        q, w = curve.derivative(1)(xi * length), curve.derivative(2)(xi * length)
        stretch = np.linalg.norm(q, axis=1)
        curvatures.append((q[:, 0] * w[:, 1] - q[:, 1] * w[:, 0]) / stretch**3)
        axial = drive.belt.stretch_parameters.tension
        tensions.append(float(np.mean([axial(one) for one in stretch[4::8]])))
    bending = np.stack(curvatures)
    force_line = np.array(tensions) + 2.0 * drive.belt.bending_stiffness * np.mean(bending**2, axis=1)
    ends = np.cumsum(lengths)
    places = ((ends - lengths)[:, None] + lengths[:, None] * xi).ravel()
    tension = np.interp(places, ends - 0.5 * lengths, force_line, period=ends[-1])
    return np.asarray(tension + line.bending_force * np.abs(bending.ravel()))


def damage_by(run: Run, forces: FloatArray) -> float:
    """Miner's sum of a turn with some forces, by the slope of the S-N line."""
    line = run.drive.belt.cord_fatigue
    assert line is not None
    cycles = rainflow_of_turn(forces).above(SMALLEST)
    slope = np.log(line.cycles[1] / line.cycles[0]) / np.log(line.forces[0] / line.forces[1])
    force = line.equivalent_force(np.maximum(cycles.low, 0.0), cycles.high)
    return float(np.sum(cycles.number / (line.cycles[0] * (force / line.forces[0]) ** -slope)))


def require_true(seed: int) -> None:
    run = bd.steady_state(drawn(seed))
    damage, exact = hourly_damage(run), damage_by(run, true_forces(run))
    assert damage.cord.sum() / damage.turns == pytest.approx(exact, rel=TOLERANCE), seed
    table, belt = bd.life(run.drive).dataset, run.drive.belt
    assert belt.cord_fatigue is not None
    depth = belt.thickness - (belt.back_offset or 0.5 * belt.thickness)
    bending = belt.cord_fatigue.bending_force * np.abs(table.bending_strain.values[0]) / depth
    kept = damage_by(run, table.tension.values[0] + bending)
    assert kept == pytest.approx(float(table.cord_damage_rate[0]) / damage.turns, rel=TOLERANCE), seed


@pytest.mark.parametrize("seed", [3])
def test_damage_is_that_of_the_true_history(seed: int) -> None:
    require_true(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 130))
def test_damage_of_drawn_drives(seed: int) -> None:
    require_true(seed)

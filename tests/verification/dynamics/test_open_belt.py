"""Verified: belts with ends.

Against: Euler and Eytelwein's formula of a belt that slides on a drum; statics of a hanging belt; vibrations of a
string with a mass at its end; the first law.
"""

from collections.abc import Callable
from importlib.resources import files
from math import pi

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from beltdyn.model import Drive, loads
from beltdyn.results import Run
from beltdyn.results.energy_balance import largest_closure
from beltdyn.solvers.flutter import Vibrations
from beltdyn.state.equilibrium import equilibrium
from beltdyn.system.build import belt_system
from beltdyn.system.state import straight
from beltdyn.transient.simulate import simulate

GRAVITY = 9.81
PULL = {"name": "pull", "kind": "pulled", "direction": [0.0, -1.0], "tension": 100.0}


@pytest.fixture(scope="module")
def brake() -> Drive:
    """A band over half of a drum, with a weight at its second end."""
    drive = loads(files("beltdyn").joinpath("examples", "band_brake.toml").read_text(encoding="utf-8"))
    return drive.with_({"belt.elements": 60})


def braked(brake: Drive, *, mirrored: bool, pull: bool) -> Run:
    """The drum dragged by the belt for a short time; mirrored, the ends change places and the drum its direction."""
    ends = [end.model_dump() for end in brake.ends]
    if pull:
        ends[1] = PULL
    speed = {"kind": "cosine_ramp", "start": 0.0, "end": 0.1, "value": -12.0 if mirrored else 12.0}
    if mirrored:
        ends = [ends[1], ends[0] | {"point": [-0.15, -0.3]}]
    return simulate(
        brake.replace(
            end=ends,
            pulley=[brake.pulleys[0].replace(speed=speed)],
            simulation=brake.simulation.replace(duration=0.3),
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mirrored", "pull"),
    [
        pytest.param(False, False, marks=pytest.mark.slow),
        pytest.param(False, True, marks=pytest.mark.slow),
        (True, True),
    ],
)
def test_tensions_of_a_band_brake(brake: Drive, measured: Callable[..., None], mirrored: bool, pull: bool) -> None:
    """T1 / T2 = exp(mu angle) at every instant of sliding, short of bending, E I / R^2 over the tension.

    The angle is that by which the belt turns. It touches the drum over less, by the layers sqrt(E I / T) in which it
    bends, but presses on the drum at their ends as much more.

    The drum drags the belt away from its fixed end. The torque is (T1 - T2) R, and the account of energy closes with
    the work that weight and force do on the end.
    """
    run = braked(brake, mirrored=mirrored, pull=pull)
    data, belt, radius = run.dataset, run.drive.belt, float(run.drive.radii[0])
    slides = (np.abs(data["sliding_speed"].values[:, 0]) > 0.5).nonzero()[0]
    assert slides.size > 100
    last = slides[slides.size // 2 :]
    after, before = data["span_tension"].values[last].mean(axis=0)
    tight, slack = (after, before) if mirrored else (before, after)
    ratio, capstan = tight / slack, float(np.exp(run.drive.frictions[0] * run.drive.path.wrap_angles[0]))
    torque, expected = abs(float(data["pulley_torque"].values[last, 0].mean())), (tight - slack) * radius
    closure = largest_closure(data).error
    measured(ratio=ratio, capstan=capstan, torque=torque, by_tensions=expected, closure=closure)
    bending = belt.bending_stiffness / (radius**2 * slack)
    assert ratio == pytest.approx(capstan, rel=2.0 * bending + 1e-3)  # 0.1 %: the error of the mesh that the run tells
    assert torque == pytest.approx(expected, rel=2.0 * bending + 1e-3 + belt.thickness / radius)
    assert abs(closure) < 0.005


def test_a_weight_at_rest_gives_the_tension(brake: Drive, measured: Callable[..., None]) -> None:
    """m g and the weight of the belt below; without friction the same on both sides of the drum at one height."""
    run = equilibrium(brake)
    data, belt = run.dataset, run.drive.belt
    load = belt.mass_per_length * GRAVITY
    pulled = 10.0 * GRAVITY
    element = run.drive.belt_length / belt.given_elements
    lowest = float(data["belt_tension"].values[-1])
    free, held = (float(length) for length in run.drive.path.span_lengths)
    hanging, anchored = data["span_tension"].values
    measured(lowest=lowest, hanging=hanging, anchored=anchored, weight=pulled)
    assert lowest == pytest.approx(pulled + 0.5 * load * element, rel=1e-6)
    bending = belt.bending_stiffness / float(run.drive.radii[0]) ** 2
    assert hanging == pytest.approx(pulled + 0.5 * load * free, rel=1e-4)
    assert anchored == pytest.approx(pulled + load * (free - 0.5 * held), abs=bending)
    anchor = float(data["belt_tension"].values[0]) - 0.5 * load * element
    total = pulled + load * run.drive.belt_length + anchor * abs(float(run.drive.path.span_directions[-1, 1]))
    assert data["hub_force"].values[0, 1] == pytest.approx(-total, rel=1e-6)


@pytest.mark.parametrize("mass", [0.0, 0.5, 20.0])
def test_a_string_with_a_mass_at_its_end(brake: Drive, measured: Callable[..., None], mass: float) -> None:
    """Across: cot x = m x / M with x = w L sqrt(rho A / T); M is the mass of the string, m that at its end.

    Without a mass the end is free, f = sqrt(T / rho A) / 4 L; a large one holds it, f = sqrt(T / rho A) / 2 L from the
    second frequency on. Short of bending, sqrt(E I / T) / L, without stiffness to speak of here.
    """
    length = 1.0
    belt = brake.belt.replace(elements=30, bending_factor=1e-6 * brake.belt.bending_factor, length=length)
    pull = 100.0
    total = belt.mass_per_length * length
    system = belt_system(
        belt,
        closure="open",
        fixed=[(0, 0), (0, 1)],
        forces=[(-1, (pull, 0.0))],
        masses=[(-1, mass * total)],
    )
    g = float(belt.stretch_parameters.stretch(pull))
    state = straight(system)
    nodes = state.nodes(system)
    nodes[:, :3:2] *= g  # places and tangents along the belt
    vibrations = Vibrations(system)
    free = ~system.supports.fixed
    stiffness, _, inertia = (
        vibrations.matrix(values).toarray()[: free.size, : free.size][np.ix_(free, free)]
        for values in vibrations.tangents(0.0, state.position, np.zeros_like(state.position))
    )
    values, ways = eigh(stiffness, inertia, subset_by_index=[0, 9])
    across = [
        float(np.sqrt(value))
        for value, way in zip(values, ways.T, strict=True)
        if np.abs(np.insert(way, 0, [0.0, 0.0]).reshape(-1, 6)[:, 1]).max() > 1e-3 * np.abs(way).max()
    ]
    speed = g * np.sqrt(pull / (belt.mass_per_length * g))  # of waves, in lengths of the stretched belt
    expected = [
        brentq(lambda x: np.cos(x) - mass * x * np.sin(x), low, low + pi) * speed / (length * g) for low in (1e-9, pi)
    ]
    measured(first=across[0], first_by_hand=expected[0], second=across[1], second_by_hand=expected[1])
    np.testing.assert_allclose(across[:2], expected, rtol=1e-3)

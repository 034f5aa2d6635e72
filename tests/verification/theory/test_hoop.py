"""Verified: a belt without pulleys spins as a circle under its hoop tension (Routh).

Against: the stretch of a hoop by Green's strain with the bending of a belt that was straight, in closed form.
"""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt
from beltdyn.model.simulation import Instants
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.trajectory import Chunk, Statistics, Task
from beltdyn.system.build import belt_system
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe
from beltdyn.system.state import State, belt_section
from beltdyn.theory.span import hoop_stretch, hoop_tension

SPEED, TURNS = 200.0, 2.0


def theory(belt: Belt) -> tuple[float, float]:
    """Stretch and tension."""
    section, turning = belt_section(belt), 2.0 * pi / belt.given_length
    g = hoop_stretch(SPEED / turning, section.axial, section.mass, bending_stiffness=section.bending, turning=turning)
    return g, float(section.stretch.tension(g))


def spin(belt: Belt, g: float, rtol: float) -> tuple[FloatArray, Observations]:
    """Radius of the nodes, shape (k, N), and observations over two turns from the state of the theory."""
    system = belt_system(belt, closure="shared_node")
    angle = 2.0 * pi * np.arange(system.nodes) / system.nodes
    out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    forward = np.stack([-out[:, 1], out[:, 0]], axis=1)
    radius = g * belt.given_length / (2.0 * pi)
    place = np.hstack([radius * out, g * forward, -out]).ravel()
    velocity = SPEED * np.hstack([radius * forward, -g * out, -forward]).ravel()
    end = TURNS * 2.0 * pi / SPEED
    instants = Instants(0.01 * end, end)
    times = instants[np.arange(101)]
    task = Task(system, State(place, velocity, 0.0 * place), instants, [], SPEED * radius, Statistics())
    position, velocities = Chunk.join(list(GeneralizedAlpha(0.8, rtol, None)(task))).at(times)
    nodes = position.reshape(len(position), -1, 6)[:, :, :2]
    return np.linalg.norm(nodes, axis=2), observe(system, times, position, velocities)


def test_tension_converges_to_that_of_a_hoop(
    belt: Belt, order: Callable[..., float], measured: Callable[..., None], curve: Callable[..., None]
) -> None:
    """At order 4; g and T differ from rho A v^2 of an inextensible, flexible belt by g and by 3/2 EI kappa^2 g."""
    meshes, errors, spreads = [10, 20, 40], [], []
    for elements in meshes:
        ring = belt.replace(elements=elements)
        g, force = theory(ring)
        radii, seen = spin(ring, g, 1e-6)
        errors.append(abs(float(seen.belt_tension.mean()) / force - 1.0))
        spreads.append(float(np.ptp(radii) / radii.mean()))
    fitted = order(meshes, errors)
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)}, order=fitted, spread=spreads[-1])
    curve("hoop", meshes, errors, "mean tension")
    curve("hoop", meshes, spreads, "radius of the nodes, largest − smallest", "s--")
    assert fitted == pytest.approx(4.0, abs=0.2)
    assert spreads[-1] < 1e-5
    rim = g * SPEED * belt.given_length / (2.0 * pi)
    assert force == pytest.approx(hoop_tension(belt.mass_per_length / g, rim), rel=1e-3)  # bending carries 2e-4 of it

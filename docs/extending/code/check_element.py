import numpy as np

import beltdyn as bd
from beltdyn.arrays import blank
from beltdyn.elements import ELEMENTS, Section
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Linear

kind, length = ELEMENTS["cable"], 0.05
section = Section(Linear(1e4), *[0.0] * 7)._replace(bending=0.02, mass=0.1)
element, work = kind.element(section, gauss_points(4)), blank(kind.workspace)
straight = np.array([0.0, 0.0, 1.0, 0.0, length, 0.0, 1.0, 0.0])
scale = np.tile([length, length, 1.0, 1.0], 2)


def force(e):
    """Of an element, for changes that strain alike."""
    kind.force(element, e, length, True, work)
    return scale * work.gradient


def energy(e):
    return kind.energy(element, e, length)


bent = straight + 0.1 * scale * np.random.default_rng(0).uniform(-1.0, 1.0, 8)
moves, step = np.diag(1e-5 * scale), 2e-5
slopes = np.array([energy(bent + h) - energy(bent - h) for h in moves]) / step
assert np.allclose(force(bent), slopes, rtol=0.0, atol=1e-8 * np.abs(slopes).max())
slopes = np.array([force(bent + h) - force(bent - h) for h in moves]) / step
force(bent)
assert np.allclose(scale[:, None] * work.tangent * scale, slopes, rtol=0.0, atol=1e-8 * np.abs(slopes).max())

turn = np.array([[np.cos(2.0), np.sin(2.0)], [-np.sin(2.0), np.cos(2.0)]])
moved = straight.reshape(4, 2) @ turn + np.outer([1.0, 0.0, 1.0, 0.0], [0.3, -0.4])
assert np.abs(force(moved.ravel())).max() < 1e-13 * section.axial * length

drive = bd.example("two_pulley")
drive = drive.replace(
    belt=drive.belt.replace(discretization="cable", elements=60),
    simulation=drive.simulation.replace(start="equilibrium", duration=0.12),
)
run = bd.simulate(drive)
tension = run.dataset["span_tension"].values
assert np.allclose(tension[0], 26.6, rtol=0.01)
driver, driven = run.dataset["pulley_speed"].values[-1]
assert 0.8 * driver < driven < 1.1 * driver

"""Verified: Kelvin-Voigt damping in stretch and bending.

Against: the damping ratio omega tau / 2 of a mode whose damping is tau times its stiffness, with the natural
frequencies of the bar fixed at one end, (2k - 1) pi / 2L sqrt(EA / m), and of the pinned beam, (k pi / L)^2
sqrt(EI / m), m the mass of a meter; and the balance of energy of an element that flies, bends and stretches freely.
"""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eig

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.ancf import ANCF, element_mass
from beltdyn.elements.ancf.elastic_force import element_energy, element_force
from beltdyn.elements.ancf.element import Ancf
from beltdyn.elements.ancf.material_damping import damping_force
from beltdyn.elements.kind import DampingFactors
from beltdyn.model import Belt
from beltdyn.quadrature import gauss_points
from beltdyn.system.state import belt_section

TIME = 1e-4
"""Damping time, s."""


def make_belt(elements: int) -> Belt:
    """A thin belt of 1 m: shear and rotary inertia change its bending by (pi h / L)^2 = 1e-5 and less."""
    return Belt(
        length=1.0,
        width=0.01,
        thickness=1e-3,
        density=1000.0,
        youngs_modulus=1e8,
        poissons_ratio=0.3,
        elements=elements,
        stretch_damping_time=TIME,
        bending_damping_time=TIME,
    )


def straight_matrices(belt: Belt) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mass, damping and stiffness of the straight open belt, shape (6 N, 6 N)."""
    section, length = belt_section(belt), belt.given_length / belt.given_elements
    unloaded = np.array([0, 0, 1, 0, 0, 1, length, 0, 1, 0, 0, 1], dtype=float)
    element, work = Ancf(section, gauss_points(4)), blank(ANCF.workspace)
    damping_force(element, unloaded, np.zeros(12), length, DampingFactors(0.0, 1.0, 0.0), work)
    damping = work.tangent.copy()
    element_force(element, unloaded, length, True, work)
    stiffness = work.tangent
    size = 6 * (belt.given_elements + 1)
    whole = np.zeros((3, size, size))
    for first in range(0, 6 * belt.given_elements, 6):
        rows = slice(first, first + 12)
        whole[:, rows, rows] += [element_mass(section, length), damping, stiffness]
    return whole[0], whole[1], whole[2]


def oscillations(matrices: tuple[FloatArray, FloatArray, FloatArray], free: FloatArray) -> FloatArray:
    """Slowest complex eigenvalues with a positive imaginary part, by frequency."""
    mass, damping, stiffness = (matrix[np.ix_(free, free)] for matrix in matrices)
    none, unit = np.zeros_like(mass), np.eye(free.size)
    values = eig(np.block([[none, unit], [-stiffness, -damping]]), np.block([[unit, none], [none, mass]]), right=False)
    values = values[(values.imag > 1e-3 * abs(values)) & np.isfinite(values)]
    return np.asarray(values[np.argsort(abs(values))])


@pytest.mark.parametrize("kind", ["stretch", "bending"])
def test_modes_decay_with_half_omega_tau(kind: str, measured: Callable[..., None]) -> None:
    """Frequency and damping ratio of the first three modes, to what 16 elements and the thin beam leave open: 1e-4."""
    belt = make_belt(16)
    nodes = np.arange(belt.given_elements + 1)
    k = np.arange(1, 4)
    if kind == "stretch":
        free = np.concatenate([6 * nodes[1:], 6 * nodes + 2])
        exact = (2 * k - 1) * np.pi / 2 * np.sqrt(belt.axial_stiffness / belt.mass_per_length)
    else:
        free = np.concatenate([6 * nodes[1:-1] + 1, 6 * nodes + 3, 6 * nodes + 4])
        exact = (k * np.pi) ** 2 * np.sqrt(belt.bending_stiffness / belt.mass_per_length)
    found = oscillations(straight_matrices(belt), np.sort(free))[:3]
    frequency, ratio = abs(found), -found.real / abs(found)
    measured(**{f"omega_{n}": w for n, w in zip(k, frequency, strict=True)})
    measured(**{f"zeta_{n}": zeta for n, zeta in zip(k, ratio, strict=True)})
    np.testing.assert_allclose(frequency, exact, rtol=1e-4)
    np.testing.assert_allclose(ratio, 0.5 * exact * TIME, rtol=1e-4)


@pytest.mark.slow
def test_energy_of_a_free_flight_is_lost_to_damping_alone(measured: Callable[..., None]) -> None:
    """Kinetic and strain energy and the loss together stay as they are, momentum and angular momentum too, to 1e-9."""
    belt = make_belt(16).replace(thickness="5 mm", stretch_damping_time="1 ms", bending_damping_time="2 ms")
    section, length = belt_section(belt), belt.given_length / belt.given_elements
    element, mass, work = Ancf(section, gauss_points(4)), element_mass(section, length), blank(ANCF.workspace)
    random = np.random.default_rng(2)
    scale = np.tile([length, length, 1, 1, 1, 1], 2)
    start = np.array([0, 0, 1, 0, 0, 1, length, 0, 1, 0, 0, 1]) + 0.1 * scale * random.uniform(-1, 1, 12)
    velocity = 20.0 * scale * random.uniform(-1, 1, 12)

    def rates(_time: float, state: FloatArray) -> FloatArray:
        e, rate = np.ascontiguousarray(state[:12]), np.ascontiguousarray(state[12:24])
        element_force(element, e, length, False, work)
        lost = sum(damping_force(element, e, rate, length, DampingFactors(0.0, 0.0, 0.0), work))
        return np.concatenate([rate, -np.linalg.solve(mass, work.gradient), [lost]])

    run = solve_ivp(rates, (0.0, 2e-3), np.concatenate([start, velocity, [0.0]]), "DOP853", rtol=1e-11, atol=1e-13)
    assert run.success
    states = run.y.T[[0, -1]]
    energy = [0.5 * y[12:24] @ mass @ y[12:24] + element_energy(element, y[:12].copy(), length) + y[24] for y in states]
    spins = [(mass @ y[12:24]) @ np.stack([-y[1:12:2], y[:12:2]], axis=1).ravel() for y in states]
    lost = states[-1][24] / energy[0]
    measured(lost=lost, energy=energy[1] / energy[0] - 1.0, angular_momentum=spins[1] / spins[0] - 1.0)
    assert lost > 0.1
    assert energy[1] == pytest.approx(energy[0], rel=1e-9)
    assert spins[1] == pytest.approx(spins[0], rel=1e-9)
    drift = np.tile([1.0, 1.0, 0, 0, 0, 0], 2)
    assert drift @ mass @ states[1][12:24] == pytest.approx(drift @ mass @ states[0][12:24], rel=1e-9)

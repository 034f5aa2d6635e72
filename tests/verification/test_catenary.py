"""Verified: a soft belt that hangs between two pins under its weight.

Against: the elastic catenary with the material law of the element, N = EA (g^2 - 1) g / 2 at the stretch g, whose
half span and sag are integrals over the reference length s of g H / T and g w s / T with T = sqrt(H^2 + (w s)^2); and
the parabola w l^2 / 8H of a taut belt; and its swinging by Irvine's equation.
"""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt
from beltdyn.solvers.flutter import Vibrations
from beltdyn.state.static import find_equilibrium
from beltdyn.stretch import StretchParameters
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import State
from beltdyn.theory.span import lowest_frequency, sag_parameter

GRAVITY = 9.81
PINS = [(0, 0), (0, 1), (-1, 0), (-1, 1)]


def hang(elements: int) -> tuple[Belt, System]:
    """A belt of 1 m without bending stiffness to speak of: E I / w L^3 = 8e-11."""
    belt = Belt(
        length=1.0,
        width=0.01,
        thickness=1e-3,
        density=1000.0,
        youngs_modulus=1e7,
        poissons_ratio=0.3,
        elements=elements,
        bending_factor=1e-6,
    )
    return belt, belt_system(belt, closure="open", fixed=PINS, gravity=(0.0, -GRAVITY))


def half_shape(pull: float, weight: float, law: StretchParameters, upto: float) -> FloatArray:
    """Place (x, y) over the lowest point of the belt's point at the reference length s = upto from it."""
    points, weights = np.polynomial.legendre.leggauss(100)
    s = 0.5 * upto * (points + 1.0)
    tension = np.hypot(pull, weight * s)
    factor = 0.5 * upto * weights * law.stretch(tension) / tension
    return np.array([factor.sum() * pull, (factor * s).sum() * weight])


def catenary(belt: Belt, span: float) -> tuple[float, FloatArray, FloatArray]:
    """Horizontal pull, places of the nodes over the lowest point, and their tangents' angles."""
    law, weight = belt.stretch_parameters, belt.mass_per_length * GRAVITY
    half = 0.5 * belt.given_length
    pull = float(
        brentq(lambda h: half_shape(h, weight, law, half)[0] - 0.5 * span, 1e-3 * weight, 1e2 * weight, xtol=1e-16)
    )
    s = np.linspace(-half, half, belt.given_elements + 1)
    places = np.array([half_shape(pull, weight, law, abs(u)) * [np.sign(u), 1.0] for u in s])
    return pull, places, np.arctan2(weight * s, pull)


def test_hangs_as_an_elastic_catenary(
    along: Callable[[System, FloatArray, FloatArray], State],
    order: Callable[..., float],
    measured: Callable[..., None],
) -> None:
    """Order 4, and 1e-9 m with 64 elements at a sag of 0.19 m."""
    meshes, errors = [8, 16, 32, 64], []
    for elements in meshes:
        belt, system = hang(elements)
        _, exact, angles = catenary(belt, 0.9)
        nodes = find_equilibrium(system, along(system, exact, angles)).state.nodes(system)
        errors.append(float(np.abs(nodes[:, :2] - exact).max()))
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)}, order=order(meshes, errors))
    assert order(meshes, errors) > 4.0
    assert errors[-1] < 1e-9


def test_a_taut_belt_sags_as_a_parabola(
    along: Callable[[System, FloatArray, FloatArray], State], measured: Callable[..., None]
) -> None:
    """Sag w l^2 / 8H, short of terms (sag / l)^2 of the catenary and of the stretch, H / EA."""
    belt, system = hang(32)
    span = 0.999
    pull, exact, angles = catenary(belt, span)
    nodes = find_equilibrium(system, along(system, exact, angles)).state.nodes(system)
    sag = nodes[0, 1] - nodes[16, 1]
    parabola = belt.mass_per_length * GRAVITY * span**2 / (8.0 * pull)
    measured(sag=sag, parabola=parabola)
    assert sag == pytest.approx(parabola, rel=4.0 * (parabola / span) ** 2 + pull / belt.axial_stiffness)


@pytest.mark.parametrize(("span", "waves"), [(1.02, 1), (1.005, 1), (0.997, 2)])
def test_a_sagging_belt_swings_as_irvine_has_it(
    along: Callable[[System, FloatArray, FloatArray], State], measured: Callable[..., None], span: float, waves: int
) -> None:
    """Lowest eigenvalue about the equilibrium, short of terms (w l / T)^2 and T / EA.

    From lambda = 2 pi on the antisymmetric swing comes first, of two waves.
    """
    belt, system = hang(32)
    pull, exact, angles = catenary(belt, span)
    state = find_equilibrium(system, along(system, exact, angles)).state
    free = ~system.supports.fixed.ravel()
    vibrations = Vibrations(system)
    stiffness, _, mass = (
        vibrations.matrix(values).toarray()[: free.size, : free.size][np.ix_(free, free)]
        for values in vibrations.tangents(0.0, state.position, np.zeros_like(state.position))
    )
    found = float(np.sqrt(eigh(stiffness, mass, eigvals_only=True)[0])) / (2.0 * np.pi)
    stretched = belt.mass_per_length * belt.given_length / span
    parameter = sag_parameter(stretched * GRAVITY, span, pull, belt.axial_stiffness)
    expected = lowest_frequency(span, pull, stretched, sag_parameter=parameter)
    straight = lowest_frequency(span, pull, stretched)
    measured(lambda_squared=parameter, found=found, irvine=expected, straight=straight)
    tolerance = (stretched * GRAVITY * span / pull) ** 2 / 4.0 + pull / belt.axial_stiffness
    assert found == pytest.approx(expected, rel=tolerance)
    assert (parameter > 4.0 * np.pi**2) == (waves == 2)

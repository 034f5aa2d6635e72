"""Verified: a cantilever under a transverse load at its tip, from small to large deflection, thick to thin.

Against: the elastica, as tabulated by K. Mattiasson, "Numerical results from large deflection beam and frame problems
analyzed by means of elliptic integrals", Int. J. Numer. Methods Eng. 17 (1981) 145-153, and by elliptic integrals of
our own; and Timoshenko's tip deflection P L^3 / 3EI + P L / k_s G A at small load.
"""

from collections.abc import Callable
from math import asin, pi, sin, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.state import belt_section, straight

Cantilever = Callable[..., tuple[Belt, System]]

LOADS = range(1, 11)
"""P L^2 / EI."""
MATTIASSON = {1: (0.05643, 0.30172), 2: (0.16064, 0.49346), 5: (0.38763, 0.71379), 10: (0.55500, 0.81061)}
"""Shortening u / L and deflection w / L of the tip; half of the last printed digit is 5e-6."""


def elastica(load: float) -> tuple[float, float, float]:
    """Tip of the elastica by elliptic integrals: shortening, deflection, slope, for P L^2 / EI."""
    root = sqrt(load)

    def modulus(slope: float) -> tuple[float, float]:
        parameter = 0.5 * (1.0 + sin(slope))
        return parameter, asin(1.0 / sqrt(2.0 * parameter))

    def excess_length(slope: float) -> float:
        parameter, amplitude = modulus(slope)
        return float(ellipk(parameter) - ellipkinc(amplitude, parameter)) - root

    slope = brentq(excess_length, 1e-9, 0.5 * pi - 1e-12, xtol=1e-14)
    parameter, amplitude = modulus(slope)
    rise = 1.0 - 2.0 * float(ellipe(parameter) - ellipeinc(amplitude, parameter)) / root
    return 1.0 - sqrt(2.0 * sin(slope)) / root, rise, slope


def tip(nodes: FloatArray) -> FloatArray:
    """Shortening, deflection and slope of the section at the tip of a cantilever of 1 m."""
    return np.array([1.0 - nodes[-1, 0], nodes[-1, 1], np.arctan2(-nodes[-1, 4], nodes[-1, 5])])


@pytest.fixture(scope="module")
def tips(make_cantilever: Cantilever) -> Callable[[float, int], dict[int, FloatArray]]:
    """The tip under each load, the loads growing one after the other."""

    def follow(thickness: float, elements: int) -> dict[int, FloatArray]:
        found, state = {}, None
        for load in LOADS:
            _, system = make_cantilever(thickness, elements, force=float(load))
            state = find_equilibrium(system, state or straight(system)).state
            found[load] = tip(state.nodes(system))
        return found

    return follow


@pytest.mark.parametrize("load", MATTIASSON)
def test_elliptic_integrals_give_the_published_table(load: int) -> None:
    assert elastica(load)[:2] == pytest.approx(MATTIASSON[load], abs=5e-6)


def test_thin_belt_bends_as_published(
    tips: Callable[[float, int], dict[int, FloatArray]], measured: Callable[..., None], curve: Callable[..., None]
) -> None:
    """At h / L = 1e-3 shear, stretch and the mesh of 64 elements together miss the elastica by less than 1e-6."""
    found = tips(1e-3, 64)
    for k, name in enumerate(("shortening u/L", "deflection w/L")):
        curve("elastica/tip", LOADS, [elastica(load)[k] for load in LOADS], f"{name}, elastica", "-")
        curve("elastica/tip", LOADS, [found[load][k] for load in LOADS], f"{name}, 64 elements", "o")
    for load in LOADS:
        exact = elastica(load)
        u, w, slope = found[load] - exact
        measured(load=load, u=u, w=w, slope=slope)
        assert found[load] == pytest.approx(exact, abs=1e-6)
    for load, published in MATTIASSON.items():
        assert found[load][:2] == pytest.approx(published, abs=6e-6)


@pytest.mark.slow
def test_converges_with_the_mesh(
    tips: Callable[[float, int], dict[int, FloatArray]],
    order: Callable[..., float],
    measured: Callable[..., None],
    curve: Callable[..., None],
) -> None:
    """A cubic cannot bend far without stretching: order 2 while a thin belt resists (membrane locking), then 4."""
    meshes, exact = [8, 16, 32, 64], np.array([elastica(load) for load in LOADS])
    errors = [float(np.abs(np.array(list(tips(1e-3, n).values())) - exact).max()) for n in meshes]
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)})
    curve("elastica/mesh", meshes, errors, "thin belt, h/L = 0.001")
    assert order(meshes[:2], errors[:2]) > 2.0
    assert order(meshes[1:3], errors[1:3]) > 3.0
    assert order(meshes[2:], errors[2:]) > 4.0


@pytest.mark.parametrize("elements", [4, 8])
@pytest.mark.parametrize("thickness", [1e-1, 1e-2, 1e-3, 1e-4])
def test_no_shear_locking(
    make_cantilever: Cantilever, measured: Callable[..., None], thickness: float, elements: int
) -> None:
    """Timoshenko's deflection at any thickness; conditioning costs ROUNDING * E A L^2 / EI, the load's square 1e-12."""
    load = 1e-6
    belt, system = make_cantilever(thickness, elements, force=load)
    section = belt_section(belt)
    deflection = find_equilibrium(system, straight(system)).state.nodes(system)[-1, 1]
    timoshenko = load * (1.0 / 3.0 + section.bending / section.shear)
    measured(thickness=thickness, elements=elements, error=deflection / timoshenko - 1.0)
    conditioning = np.finfo(float).eps * section.axial / section.bending
    assert deflection == pytest.approx(timoshenko, rel=1e-12 + float(conditioning))


def test_a_clamp_that_holds_the_tangent_costs_order(
    make_cantilever: Cantilever, order: Callable[..., float], measured: Callable[..., None]
) -> None:
    """It forbids the shear at the wall, within the first element, so that the error falls with the element's length."""
    load, meshes, errors = 1e-6, [4, 8, 16, 32], []
    for elements in meshes:
        belt, system = make_cantilever(1e-1, elements, force=load, held=[(0, k) for k in range(6)])
        section = belt_section(belt)
        deflection = find_equilibrium(system, straight(system)).state.nodes(system)[-1, 1]
        errors.append(1.0 - deflection / (load * (1.0 / 3.0 + section.bending / section.shear)))
    fitted = order(meshes, errors)
    measured(**{f"error_{n}": error for n, error in zip(meshes, errors, strict=True)}, order=fitted)
    assert fitted == pytest.approx(1.0, abs=0.01)

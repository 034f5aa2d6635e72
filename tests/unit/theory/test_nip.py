"""Closed forms of nips: a foundation gives a parabola of pressure, whose integral is the force."""

from math import inf

import numpy as np
import pytest

from beltdyn.theory.nip import (
    cover_modulus,
    equivalent_radius,
    force,
    half_width,
    hertz_compliance,
    hertz_half_width,
    indentation_of,
    line_force,
    nip_damping,
    series,
)


def test_the_force_is_the_integral_of_the_parabola() -> None:
    depth, stiffness, radius = 4e-4, 3e8, 0.06
    half = half_width(depth, radius)
    place = np.linspace(-half, half, 20_001)
    pressure = stiffness * (depth - place**2 / (2.0 * radius))
    assert pressure[0] == pytest.approx(0.0, abs=1e-9 * stiffness * depth)
    assert force(depth, stiffness, radius) == pytest.approx(float(np.trapezoid(pressure, place)), rel=1e-8)


def test_the_indentation_is_that_of_the_force() -> None:
    depth = indentation_of(2000.0, 2.6e8, 0.053)
    assert force(depth, 2.6e8, 0.053) == pytest.approx(2000.0, rel=1e-12)


def test_solid_rollers_press_as_hertz_says() -> None:
    """On a hard belt force, width and peak pressure of the local law are those of the half ellipse."""
    width, radius, modulus, load = 0.2, 0.05, 1e8, 2000.0
    hertz, stiffness = hertz_compliance(modulus, radius, width), 1e15
    depth = indentation_of(load, stiffness, radius, hertz)
    half = hertz_half_width(load / width, modulus, radius)
    assert half_width(depth, radius) == pytest.approx(half, rel=1e-4)
    peak = float(line_force(np.array(depth), stiffness, hertz)) / width
    assert peak == pytest.approx(2.0 * load / width / (np.pi * half), rel=1e-4)


def test_solid_rollers_and_a_soft_belt_give_way_in_series() -> None:
    stiffness, radius, depth = 3e8, 0.06, 4e-4
    loads = line_force(np.linspace(0.0, depth, 7), stiffness, 2e-15)
    np.testing.assert_allclose(loads / stiffness + 2e-15 * loads**2, np.linspace(0.0, depth, 7), atol=1e-18)
    half = half_width(depth, radius)
    place = np.linspace(-half, half, 20_001)
    whole = float(np.trapezoid(line_force(depth - place**2 / (2.0 * radius), stiffness, 2e-15), place))
    assert force(depth, stiffness, radius, 2e-15) == pytest.approx(whole, rel=1e-7)
    assert force(depth, stiffness, radius, 1e-30) == pytest.approx(force(depth, stiffness, radius), rel=1e-9)


@pytest.mark.parametrize(("solid", "first"), [(0.0, 3.0 * np.pi / 32.0), (1.0, 1.0 / 3.0)])
def test_a_damper_loses_what_hysteresis_does(solid: float, first: float) -> None:
    """At small losses 3 pi eta a / 32 v of a foundation and eta a / 3 v of solid rollers."""
    found = [nip_damping(eta, 0.01, 2.0, solid) * 2.0 / (0.01 * eta) for eta in (1e-6, 1e-3, 0.3)]
    assert found[0] == pytest.approx(first, rel=1e-3)
    assert first < found[1] < found[2] < 1.5 * first
    eta, power = 0.3, 1.0 - 0.5 * solid
    place = np.linspace(-1.0, 1.0, 200_001)
    load = np.maximum(1.0 - place**2 - 2.0 * found[2] * eta * place, 0.0) ** power
    lost = -2.0 * float(np.trapezoid(load * place, place))
    assert lost == pytest.approx(np.pi * eta * (1.0 / 3.0 if solid else 0.25), rel=1e-5)
    assert nip_damping(eta, 0.01, 0.0, solid) == 0.0


def test_rollers_open_as_one_on_a_plane() -> None:
    assert equivalent_radius(0.1, 0.1) == pytest.approx(0.05)
    assert equivalent_radius(0.1, inf) == pytest.approx(0.1)


def test_springs_in_series() -> None:
    assert series(3.0, 6.0) == pytest.approx(2.0)
    assert series(3.0, inf) == pytest.approx(3.0)
    assert series(inf, inf) == inf


def test_a_cover_that_cannot_expand_sideways_is_stiffer() -> None:
    assert cover_modulus(4e6, 0.0) == pytest.approx(4e6)
    assert cover_modulus(4e6, 0.45) == pytest.approx(4e6 * 0.55 / (1.45 * 0.1))

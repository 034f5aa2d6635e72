"""Closed forms of nips: a foundation gives a parabola of pressure, whose integral is the force."""

from math import inf

import numpy as np
import pytest

from beltdyn.theory.nip import cover_modulus, equivalent_radius, force, half_width, indentation_of, series


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

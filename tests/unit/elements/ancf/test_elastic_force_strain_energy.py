from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.elements.ancf.elastic_force import energy_curvature, energy_density, energy_gradient, thickness_energy
from beltdyn.elements.kind import Section
from beltdyn.kernel import interpreted
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Green

ARGUMENTS = ("metric", "turning", "sine", "sine_rate")
STRAINS = [(1.0, 0.0, 0.0, 0.0), (1.02, 12.0, 0.0, 0.0), (0.9, -30.0, 0.2, 4.0), (1.3, 8.0, -0.4, -25.0)]
EXACT = 1e-12  # complex steps take no differences

pytestmark = pytest.mark.parametrize("strain", STRAINS)


def complex_step(function: Callable[..., Any], strain: tuple[float, ...], argument: int, section: Section) -> Any:
    """Derivative of the uncompiled function with respect to one argument."""
    step = 1e-30
    shifted = list(map(complex, strain))
    shifted[argument] += 1j * step
    return np.imag(interpreted(function)(*shifted, section)) / step


def test_energy_is_that_of_the_section(strain: tuple[float, float, float, float], section: Section) -> None:
    """The closed form against the integral over the thickness of E eps^2 / 2 and of the shear energy, without alpha."""
    metric, turning, sine, rate = strain
    points, weights = gauss_points(3)
    young, width, thickness, shear_modulus = 2.0, 0.7, 0.2, 1.1
    whole = Section(
        stretch=Green(young * width * thickness),
        bending=young * width * thickness**3 / 12.0,
        quartic=young * width * thickness**5 / 80.0,
        shear=shear_modulus * width * thickness,
        shear_gradient=shear_modulus * width * thickness**3 / 12.0,
        thickness=0.0,
        mass=0.0,
        rotary_inertia=0.0,
    )
    stretch, bend = np.sqrt(metric), turning + rate
    total = 0.0
    for y, weight in zip((points - 0.5) * thickness, weights, strict=True):
        # r_x = t (g - y k) - n y s theta, at the height y of the section
        strain_xx = 0.5 * ((stretch - y * bend) ** 2 + (y * sine * turning) ** 2 - 1.0)
        shear = 0.5 * shear_modulus * (metric * sine**2 + (y * sine * rate) ** 2)
        total += weight * width * thickness * (0.5 * young * strain_xx**2 + shear)
    assert energy_density(metric, turning, sine, rate, whole) == pytest.approx(total, rel=EXACT)


def test_gradient(strain: tuple[float, float, float, float], section: Section) -> None:
    by_step = [complex_step(energy_density, strain, argument, section) for argument in range(4)]
    np.testing.assert_allclose(energy_gradient(*strain, section), by_step, rtol=EXACT)


def test_curvature(strain: tuple[float, float, float, float], section: Section) -> None:
    curvature = energy_curvature(*strain, section)._asdict()
    letters = ("g", "t", "s", "p")
    for j, second in enumerate(letters):
        column = complex_step(energy_gradient, strain, j, section)
        for i, first in enumerate(letters[: j + 1]):
            assert curvature[first + second] == pytest.approx(column[i], rel=EXACT, abs=EXACT)


def test_thickness_energy_is_that_of_a_linear_strain(
    strain: tuple[float, float, float, float], section: Section, length: float
) -> None:
    ends = 0.01 * strain[1], strain[2]
    points, weights = gauss_points(2)
    integral = weights @ (ends[0] + points * (ends[1] - ends[0])) ** 2
    expected = 0.5 * section.thickness * length * integral
    assert thickness_energy(*ends, section, length) == pytest.approx(expected, rel=EXACT)

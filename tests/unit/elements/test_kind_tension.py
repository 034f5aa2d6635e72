"""Tension of a stretched line against the slope of its energy, and of its losses."""

import pytest

from beltdyn.elements.kind import Section, axial_force, axial_tension, damping_tension
from beltdyn.elements.truss import Truss
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Green

AXIAL, DAMPING = 1e4, 20.0
SECTION = Section(Green(AXIAL), *[0.0] * 7)._replace(axial_damping=DAMPING)


@pytest.mark.parametrize("stretch", [0.7, 1.0, 1.003, 1.4])
def test_tension_is_the_slope_of_the_energy(stretch: float) -> None:
    """N = dU/dg of U = EA (g^2 - 1)^2 / 8 at the stretch g, with complex steps, which take no differences."""
    slope = (AXIAL / 8.0 * ((stretch + 1e-30j) ** 2 - 1.0) ** 2).imag / 1e-30
    assert axial_force(Green(AXIAL), stretch**2) == pytest.approx(slope, rel=1e-12)


@pytest.mark.parametrize("rate", [-0.3, 0.0, 2.0])
def test_damping_tension_does_the_work_that_is_lost(rate: float) -> None:
    """N dg/dt = EA tau (dg/dt)^2."""
    stretch = 1.1
    metric_rate = 2.0 * stretch * rate
    lost = DAMPING * rate**2
    assert damping_tension(stretch**2, metric_rate, SECTION) * rate == pytest.approx(lost, rel=1e-12)


def test_both_together() -> None:
    both = axial_force(SECTION.stretch, 1.21) + damping_tension(1.21, 0.5, SECTION)
    assert axial_tension(Truss(SECTION, gauss_points(1)), 1.21, 0.5) == both

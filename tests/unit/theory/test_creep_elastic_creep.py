"""Elastic creep in the Coulomb limit."""

from math import exp, pi

import numpy as np
import pytest

from beltdyn.stretch import Linear
from beltdyn.theory.creep import entry_strain, gross_slip_tensions, slip_arc, speed_loss


def test_speed_loss_at_small_strain() -> None:
    assert speed_loss(110.0, 90.0, Linear(1e7)) == pytest.approx(20.0 / 1e7, rel=1e-4)


def test_gross_slip_uses_all_of_the_wrap() -> None:
    tight, slack = gross_slip_tensions(30.0, 0.4, 0.4, 0.08, mass_per_length=0.02, speed=10.0)
    assert slip_arc(tight, slack, 0.4, mass_per_length=0.02, speed=10.0) == pytest.approx(pi)
    assert (tight - 2.0) / (slack - 2.0) == pytest.approx(exp(0.4 * pi))


def test_gross_slip_without_friction_transmits_nothing() -> None:
    tight, slack = gross_slip_tensions(30.0, 1e-6, 0.4, 0.08)
    assert (tight, slack) == pytest.approx((30.0, 30.0), rel=1e-5)


@pytest.mark.parametrize("stiffness", [1e6, 1e8, 1e10])
def test_curvature_and_angle_where_a_belt_first_touches(stiffness: float) -> None:
    """Of the beam on springs, by its two decaying exponentials and the span's own, matched where the depth is zero."""
    tension, bending, radius = 160.0, 1e-3, 0.01
    squares = np.roots([bending, -tension, stiffness]).astype(complex)
    first, second = np.sqrt(squares)
    layer = np.sqrt(bending / tension)
    # depth T / R k + a e^(-first x) + b e^(-second x); curvature 1 / R + d'', which decays over the layer in the span
    rows = [[1.0, 1.0], [first**2 + layer * first**3, second**2 + layer * second**3]]
    a, b = np.linalg.solve(rows, [-tension / radius / stiffness, -1.0 / radius])
    curvature = 1.0 / radius + (a * first**2 + b * second**2).real
    angle = (a * first + b * second).real
    numbers = {"bending_stiffness": bending, "axial_stiffness": 5e3, "contact_stiffness": stiffness}
    lost = entry_strain(np.array([tension]), np.array([radius]), bent_strain=-1.5, loss_factor=0.2, **numbers)
    share = 2.0 + np.pi / 8.0 * 0.2
    assert lost[0] == pytest.approx(share * bending / 5e3 * curvature**2 + 0.5 * angle**2, rel=1e-9)

"""Elastic creep in the Coulomb limit."""

from math import exp, pi

import pytest

from beltdyn.stretch import Linear
from beltdyn.theory.elastic_creep import gross_slip_tensions, slip_arc, speed_loss


def test_speed_loss_at_small_strain() -> None:
    assert speed_loss(110.0, 90.0, Linear(1e7)) == pytest.approx(20.0 / 1e7, rel=1e-4)


def test_gross_slip_uses_all_of_the_wrap() -> None:
    tight, slack = gross_slip_tensions(30.0, 0.4, 0.4, 0.08, mass_per_length=0.02, speed=10.0)
    assert slip_arc(tight, slack, 0.4, mass_per_length=0.02, speed=10.0) == pytest.approx(pi)
    assert (tight - 2.0) / (slack - 2.0) == pytest.approx(exp(0.4 * pi))


def test_gross_slip_without_friction_transmits_nothing() -> None:
    tight, slack = gross_slip_tensions(30.0, 1e-6, 0.4, 0.08)
    assert (tight, slack) == pytest.approx((30.0, 30.0), rel=1e-5)

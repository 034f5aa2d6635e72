"""The tension of a spinning hoop."""

import pytest

from beltdyn.stretch import Green
from beltdyn.theory.span import hoop_stretch, hoop_tension


def test_stretch_carries_the_hoop_tension() -> None:
    axial, mass, transport = 1e4, 0.1, 40.0
    g = hoop_stretch(transport, axial, mass)
    assert float(Green(axial).tension(g)) == pytest.approx(hoop_tension(mass / g, transport * g), rel=1e-12)


def test_a_ring_at_rest_contracts_by_bending() -> None:
    """G = 1 - 3 EI kappa^2 / EA, as in pure bending."""
    assert hoop_stretch(0.0, 1e4, 0.1, bending_stiffness=1e-3, turning=5.0) ** 2 == pytest.approx(1.0 - 7.5e-6)

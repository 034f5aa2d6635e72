"""Creep on a rigid pulley: closed forms, their limits, and the integrated arc."""

from math import exp

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from beltdyn.stretch import Green
from beltdyn.theory.creep import (
    creep_speed_loss,
    creeping_arc,
    entry_creep,
    friction_along_arc,
    layer_length,
    tension_along_arc,
)

LAW, ARC, TIGHT, SLACK = Green(1e5), 0.25, 1900.0, 1300.0
X = np.linspace(0.0, ARC, 4001)


@pytest.mark.parametrize("layer", [0.01, 0.1, 10.0])
def test_profile(layer: float) -> None:
    tension, friction = (f(X, TIGHT, SLACK, ARC, layer) for f in (tension_along_arc, friction_along_arc))
    np.testing.assert_allclose(tension[[0, -1]], [TIGHT, SLACK], rtol=1e-12)
    slope = np.gradient(tension, X, edge_order=2)
    np.testing.assert_allclose(friction, -slope, atol=1e-3 * np.abs(friction).max())


def test_limits_of_the_speed_loss() -> None:
    elastic = 1.0 - float(LAW.stretch(SLACK) / LAW.stretch(TIGHT))
    assert creep_speed_loss(TIGHT, SLACK, LAW, ARC, 1e-3 * ARC) == pytest.approx(elastic, rel=1e-12)
    speed, small = 10.0, 1e-3
    layer = layer_length(1e3, speed, LAW)
    viscous = 2.0 * small * (TIGHT - SLACK) / (1e3 * ARC) / speed
    assert layer == pytest.approx(10.0)
    assert creep_speed_loss(small * TIGHT, small * SLACK, LAW, ARC, layer) == pytest.approx(viscous, rel=1e-3)


@pytest.mark.parametrize("layer", [0.1, 1.0])
def test_integrated_arc_at_small_strain(layer: float) -> None:
    """Without the cap: EA so large that the law of tension is linear."""
    axial, speed = 1e8, 5.0
    factor = axial / (layer * speed)
    g = float(Green(axial).stretch(TIGHT))
    rim = speed * (g + (TIGHT - SLACK) / axial / np.expm1(ARC / layer))
    tension, friction = creeping_arc(
        X,
        TIGHT,
        rim,
        speed,
        law=Green(axial),
        mass=0.0,
        radius=0.08,
        friction=1e3,
        creep_rate_factor=factor,
    )
    np.testing.assert_allclose(tension, tension_along_arc(X, TIGHT, SLACK, ARC, layer), rtol=1e-4)
    np.testing.assert_allclose(friction, friction_along_arc(X, TIGHT, SLACK, ARC, layer), rtol=1e-3)


def test_cap_gives_the_capstan_ratio() -> None:
    """A rim that is much slower than the belt: all of the arc slides and the tension grows with e^(mu theta)."""
    tension, friction = creeping_arc(
        X,
        SLACK,
        0.0,
        5.0,
        law=Green(1e8),
        mass=0.0,
        radius=0.08,
        friction=0.3,
        creep_rate_factor=1e5,
    )
    assert tension[-1] / tension[0] == pytest.approx(exp(0.3 * ARC / 0.08), rel=1e-4)
    np.testing.assert_allclose(friction, -0.3 * tension / 0.08, rtol=1e-4)


@pytest.mark.parametrize("creep", [0.1, 0.5, 2.0, 3.5])
@pytest.mark.parametrize("lengths", [0.5, 2.0, 4.0, 8.0])
def test_creep_at_the_entry_is_that_of_an_integrated_arc(creep: float, lengths: float) -> None:
    """dv/dn = min(v, v_c): the slip velocity grows by V dT / EA from v0 on; where it cannot, the whole arc slides."""
    saturation = 0.02
    found = entry_creep(creep * saturation, saturation, lengths)
    if creep >= lengths:
        assert found == saturation
        return
    grown = solve_ivp(
        lambda _, v: np.minimum(v, saturation), (0.0, lengths), [found], rtol=1e-10, atol=1e-14, max_step=0.01
    ).y[0, -1]
    assert grown - found == pytest.approx(creep * saturation, rel=1e-4)

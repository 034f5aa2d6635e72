"""The belt at rest: limits."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.stretch import Green, StretchParameters
from beltdyn.theory.span import open_belt
from beltdyn.theory.static_tension import static_tension, stretch_with_penetration

RADII = (0.08, 0.1)
LENGTH = 0.99 * open_belt(0.4, RADII).length


def test_hard_pulleys_leave_the_stretch_of_the_path() -> None:
    found = static_tension(LENGTH, 0.4, RADII, law=Green(1e4), contact_stiffness=1e13)
    assert found.tension == pytest.approx(float(Green(1e4).tension(1.0 / 0.99)), rel=1e-6)


def test_depth_balances_the_tension_of_the_arc() -> None:
    found = static_tension(LENGTH, 0.4, RADII, law=Green(1e4), contact_stiffness=1e6)
    for depth, force, radius in zip(found.penetration, found.arc_tension, RADII, strict=True):
        assert 1e6 * depth * (radius - depth) == pytest.approx(force, rel=0.02)  # times the stretch
        assert force > found.tension


def test_softer_contact_leaves_less_tension() -> None:
    forces = [static_tension(LENGTH, 0.4, RADII, law=Green(1e4), contact_stiffness=k).tension for k in (5e5, 1e6, 1e7)]
    assert forces == sorted(forces)


def test_a_slack_belt_is_refused() -> None:
    with pytest.raises(ModelError, match="slack"):
        static_tension(1.01 * open_belt(0.4, RADII).length, 0.4, RADII, law=Green(1e4), contact_stiffness=1e7)


@pytest.mark.parametrize("excess", [1.0, 1.001, 1.4])
@pytest.mark.parametrize("sinking", [0.0, 1e-7, 1e-2])
def test_a_belt_that_sinks_in_is_as_long_as_its_path(
    stretch_law: StretchParameters, excess: float, sinking: float
) -> None:
    law, length, path = stretch_law, 1.2, excess * 1.2
    g = stretch_with_penetration(length, path, law, sinking)
    assert g * length + sinking * float(law.tension(g)) * g == pytest.approx(path, rel=4 * np.finfo(float).eps)
    assert 1.0 <= g <= path / length

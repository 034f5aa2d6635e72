"""The stretch of a belt that sinks into its pulleys."""

import numpy as np
import pytest

from beltdyn.theory.stretch import tension
from beltdyn.theory.sunk_belt import sunk_stretch

LENGTH, STIFFNESS = 1.2, 5e3


@pytest.mark.parametrize("path", [LENGTH, 1.001 * LENGTH, 1.4 * LENGTH])
@pytest.mark.parametrize("sinking", [0.0, 1e-7, 1e-2])
def test_the_belt_is_as_long_as_its_path(path: float, sinking: float) -> None:
    g = sunk_stretch(LENGTH, path, STIFFNESS, sinking)
    assert g * LENGTH + sinking * float(tension(g, STIFFNESS)) * g == pytest.approx(path, rel=4 * np.finfo(float).eps)
    assert 1.0 <= g <= path / LENGTH

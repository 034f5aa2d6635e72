"""A belt at rest that sinks into its pulleys."""

import numpy as np
import pytest

from beltdyn.stretch import StretchParameters
from beltdyn.theory.stretch import stretch_with_penetration


@pytest.mark.parametrize("excess", [1.0, 1.001, 1.4])
@pytest.mark.parametrize("sinking", [0.0, 1e-7, 1e-2])
def test_a_belt_that_sinks_in_is_as_long_as_its_path(
    stretch_law: StretchParameters, excess: float, sinking: float
) -> None:
    law, length, path = stretch_law, 1.2, excess * 1.2
    g = stretch_with_penetration(length, path, law, sinking)
    assert g * length + sinking * float(law.tension(g)) * g == pytest.approx(path, rel=4 * np.finfo(float).eps)
    assert 1.0 <= g <= path / length

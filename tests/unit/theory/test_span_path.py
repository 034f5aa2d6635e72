"""The open belt, against the general path of the model."""

import numpy as np
import pytest

from beltdyn.model import Path
from beltdyn.theory.span import open_belt


@pytest.mark.parametrize("radii", [(0.08, 0.08), (0.08, 0.12), (0.2, 0.05)])
def test_agrees_with_the_path_of_a_drive(radii: tuple[float, float]) -> None:
    mine, path = open_belt(0.4, radii), Path(np.array([[0.0, 0.0], [0.4, 0.0]]), np.array(radii))
    assert mine.length == pytest.approx(path.length, rel=1e-14)
    np.testing.assert_allclose(mine.wrap, path.wrap_angles, rtol=1e-14)
    np.testing.assert_allclose(mine.span, path.span_lengths, rtol=1e-14)

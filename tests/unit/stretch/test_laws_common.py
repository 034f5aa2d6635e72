"""A stretch law of the package under the common type is the law itself."""

from typing import Any

import numpy as np

from beltdyn.stretch import CommonStretch, Green, Linear, Measured, StretchParameters, as_common, stretching

STRETCHES = np.array([0.8, 1.003, 1.033, 1.5])


def test_a_law_under_the_common_type_is_itself(stretch_law: StretchParameters) -> None:
    common = as_common(stretch_law)
    if not isinstance(stretch_law, Linear | Green | Measured):
        assert common is stretch_law  # a law that was added with a file and a line; kernels are compiled for it
        return
    assert isinstance(common, CommonStretch)
    assert common.own == stretch_law
    assert common.stiffness == stretch_law.stiffness
    for g in STRETCHES:
        assert stretching(common, g * g) == stretching(stretch_law, g * g)
    tensions = stretch_law.tension(STRETCHES)
    np.testing.assert_array_equal(common.tension(STRETCHES), tensions)
    np.testing.assert_array_equal(common.tangent_stiffness(STRETCHES), stretch_law.tangent_stiffness(STRETCHES))
    np.testing.assert_array_equal(common.stretch(tensions), stretch_law.stretch(tensions))


def test_a_law_from_outside_keeps_its_type() -> None:
    law: Any = object()
    assert as_common(law) is law

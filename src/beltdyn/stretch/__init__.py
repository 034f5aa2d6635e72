"""Stretch laws, tension over stretch; importing one here registers it.

The laws of the package have one type, `CommonStretch`, chosen at run time: belts of any share compiled kernels.
"""

from collections import ChainMap
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.kernel import by_type, kernel
from beltdyn.stretch.law import LAWS as LAWS
from beltdyn.stretch.law import Stretching as Stretching
from beltdyn.stretch.law import StretchLaw as StretchLaw
from beltdyn.stretch.law import StretchParameters as StretchParameters
from beltdyn.stretch.laws import Green as Green
from beltdyn.stretch.laws import Linear as Linear
from beltdyn.stretch.laws import Measured as Measured
from beltdyn.stretch.laws import green, linear, measured
from beltdyn.stretch.laws import through as through

_LINEAR, _GREEN, _MEASURED = range(3)
_NO_PIECES = np.zeros((1, 6))


class CommonStretch(NamedTuple):
    """Parameters of one of the laws."""

    stiffness: float
    """EA, N, without strain."""
    law: int
    """Number of the law that holds."""
    pieces: FloatArray
    """Pieces of a measured curve, shape (k, 6); without effect in other laws."""

    @property
    def own(self) -> StretchParameters:
        """Parameters of the law that holds."""
        if self.law == _MEASURED:
            return Measured(self.stiffness, self.pieces)
        return Green(self.stiffness) if self.law == _GREEN else Linear(self.stiffness)

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension N, N, at a stretch g."""
        return self.own.tension(stretch)

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg, N."""
        return self.own.tangent_stiffness(stretch)

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Stretch g under a tension (N)."""
        return self.own.stretch(tension)


def as_common(law: StretchParameters) -> StretchParameters:
    """Parameters of a law of the package under the common type; others as they are."""
    if isinstance(law, Measured):
        return CommonStretch(law.stiffness, _MEASURED, law.pieces)
    if isinstance(law, Linear | Green):
        return CommonStretch(law.stiffness, _GREEN if isinstance(law, Green) else _LINEAR, _NO_PIECES)
    return law


@kernel
def common_stretch(law: CommonStretch, metric: float) -> Stretching:
    """Kernel of the common type: strain energy by the law that holds; see `StretchLaw.stretching`."""
    if law.law == _LINEAR:
        return linear(Linear(law.stiffness), metric)
    if law.law == _GREEN:
        return green(Green(law.stiffness), metric)
    return measured(Measured(law.stiffness, law.pieces), metric)


stretching = by_type(ChainMap(LAWS.by_class("stretching"), {CommonStretch: common_stretch}), "stretching")
"""Strain energy of stretch per reference length and its derivatives in G = q . q; see `StretchLaw.stretching`."""

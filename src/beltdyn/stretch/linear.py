"""Tension proportional to elongation, N = EA (g - 1): the axial stiffness of catalogues and tests."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.stretch.law import Stretching, StretchLaw


class Linear(NamedTuple):
    """Parameters of the linear law."""

    stiffness: float
    """EA, N."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension EA (g - 1), N."""
        return np.asarray(self.stiffness * (np.asarray(stretch, dtype=float) - 1.0))

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg = EA, N."""
        return np.full(np.shape(stretch), self.stiffness)

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Stretch 1 + N / EA."""
        return np.asarray(1.0 + np.asarray(tension, dtype=float) / self.stiffness)


@kernel
def linear(law: Linear, metric: float) -> Stretching:
    """Strain energy EA / 2 (g - 1)^2 with g = sqrt(G), and its derivatives in G.

    Parameters
    ----------
    law
        Parameters.
    metric
        G = q . q with q = dr/dx, dimensionless.
    """
    g = metric**0.5
    strain = (metric - 1.0) / (g + 1.0)
    return Stretching(
        0.5 * law.stiffness * strain * strain,
        0.5 * law.stiffness * strain / g,
        0.25 * law.stiffness / (metric * g),
    )


register(StretchLaw("linear", "tension proportional to elongation", Linear, linear))

"""Linear stretch laws: of engineering strain, and of Green's strain as in the paper."""

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


class Green(NamedTuple):
    """Parameters of the published law."""

    stiffness: float
    """EA, N."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension EA (g^2 - 1) g / 2, N."""
        g = np.asarray(stretch, dtype=float)
        return np.asarray(0.5 * self.stiffness * (g * g - 1.0) * g)

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg = EA (3 g^2 - 1) / 2, N."""
        g = np.asarray(stretch, dtype=float)
        return np.asarray(0.5 * self.stiffness * (3.0 * g * g - 1.0))

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Root of g^3 - g - 2 N / EA = 0 that is 1 without tension.

        By Cardano's formula 2 / sqrt(3) cos(arccos(x) / 3) with x = sqrt(27) N / EA, or with arcosh for x > 1. Below
        -EA / sqrt(27) a belt of this law gives way.
        """
        x = np.sqrt(27.0) * np.asarray(tension, dtype=float) / self.stiffness
        third = np.where(
            x <= 1.0,
            np.cos(np.arccos(np.clip(x, -1.0, 1.0)) / 3.0),
            np.cosh(np.arccosh(np.maximum(x, 1.0)) / 3.0),
        )
        return np.asarray(2.0 / np.sqrt(3.0) * third)


@kernel
def green(law: Green, metric: float) -> Stretching:
    """Strain energy EA / 8 (G - 1)^2 and its derivatives.

    Parameters
    ----------
    law
        Parameters.
    metric
        G = q . q with q = dr/dx, dimensionless.
    """
    excess = metric - 1.0
    return Stretching(
        0.125 * law.stiffness * excess * excess,
        0.25 * law.stiffness * excess,
        0.25 * law.stiffness,
    )


register(StretchLaw("green", "as published, by Green's strain", Green, green))

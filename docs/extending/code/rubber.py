"""A cord of rubber: N = EA (g - 1 / g^2) / 3, neo-Hooke's law at constant volume."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.stretch.law import Stretching, StretchLaw, register


class Rubber(NamedTuple):
    """Parameters of neo-Hooke's law."""

    stiffness: float
    """EA without strain, N."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension EA (g - 1 / g^2) / 3, N."""
        g = np.asarray(stretch, dtype=float)
        return np.asarray(self.stiffness / 3.0 * (g - g**-2))

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg = EA (1 + 2 / g^3) / 3, N."""
        return np.asarray(self.stiffness / 3.0 * (1.0 + 2.0 * np.asarray(stretch, dtype=float) ** -3))

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Root of g^3 - (3 N / EA) g^2 - 1 = 0, by Newton's method from above, where the cubic is convex."""
        t = 3.0 * np.asarray(tension, dtype=float) / self.stiffness
        g = 1.0 + np.maximum(t, 0.0)
        for _ in range(50):
            g = g - (g**3 - t * g**2 - 1.0) / (3.0 * g**2 - 2.0 * t * g)
        return np.asarray(g)


@kernel
def rubber(law: Rubber, metric: float) -> Stretching:
    """Strain energy (J/m) and its derivatives (N) in G."""
    return Stretching(
        law.stiffness / 3.0 * (0.5 * metric + metric**-0.5 - 1.5),
        law.stiffness / 6.0 * (1.0 - metric**-1.5),
        law.stiffness / 4.0 * metric**-2.5,
    )


register(StretchLaw("rubber", "of a cord of rubber", Rubber, rubber, Rubber))

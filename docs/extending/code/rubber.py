"""A cord of rubber by Mooney (1940) and Rivlin: N = EA (g - 1 / g^2) (1 - s + s / g) / 3, at constant volume."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.extend import Parameter, Stretching, StretchLaw, kernel, register


class Rubber(NamedTuple):
    """Parameters of the law of Mooney and Rivlin."""

    stiffness: float
    """EA without strain, N."""
    second_share: float
    """s, the second constant over the sum of both: C2 / (C1 + C2)."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension, N."""
        g, s = np.asarray(stretch, dtype=float), self.second_share
        return np.asarray(self.stiffness / 3.0 * (g - g**-2) * (1.0 - s + s / g))

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg, N."""
        g, s = np.asarray(stretch, dtype=float), self.second_share
        return np.asarray(self.stiffness / 3.0 * ((1.0 - s) * (1.0 + 2.0 * g**-3) + 3.0 * s * g**-4))

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Stretch under a tension, by Newton's method, which converges from one side: N(g) is concave."""
        force = np.asarray(tension, dtype=float)
        g = np.ones_like(force)
        for _ in range(50):
            g = g - (self.tension(g) - force) / self.tangent_stiffness(g)
        return np.asarray(g)


@kernel
def rubber(law: Rubber, metric: float) -> Stretching:
    """Strain energy (J/m) and its derivatives (N) in G = g^2."""
    sixth, s, g = law.stiffness / 6.0, law.second_share, metric**0.5
    return Stretching(
        sixth * ((1.0 - s) * (metric + 2.0 / g - 3.0) + s * (2.0 * g + 1.0 / metric - 3.0)),
        sixth * ((1.0 - s) * (1.0 - metric**-1.5) + s * (1.0 / g - metric**-2)),
        sixth * ((1.0 - s) * 1.5 * metric**-2.5 + s * (2.0 * metric**-3 - 0.5 * metric**-1.5)),
    )


_KEY = Parameter("second_share", "", "the second constant of Mooney and Rivlin over the sum of both", example=0.2)
register(StretchLaw("rubber", "of a cord of rubber", Rubber, rubber, (_KEY,)))

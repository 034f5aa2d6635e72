"""Stretch of a belt at rest with penetration; the stretch laws are in `beltdyn.stretch`."""

import numpy as np

from beltdyn.stretch import StretchParameters


def stretch_with_penetration(length: float, path: float, law: StretchParameters, sinking: float) -> float:
    """Stretch g of a belt at rest with penetration: the root of g length + sinking T g = path, T of g.

    Examples
    --------
    >>> from beltdyn.stretch import Linear
    >>> round(bd.theory.stretch.stretch_with_penetration(1.0, 1.01, Linear(1e4), sinking=1e-5), 6)
    1.009083
    """
    lower, upper = 1.0, path / length
    g = upper
    while True:
        force = float(law.tension(g))
        excess = g * length + sinking * force * g - path
        lower, upper = (lower, g) if excess > 0.0 else (g, upper)
        slope = length + sinking * (force + float(law.tangent_stiffness(g)) * g)
        ahead = g - excess / slope
        if not lower < ahead < upper:
            ahead = 0.5 * (lower + upper)
        if abs(ahead - g) <= np.finfo(float).eps * g:
            return ahead
        g = ahead

"""A span pressed across its middle: a string with bending stiffness between hinges.

With the tension T, the bending stiffness EI and u = l/2 sqrt(T / EI), a force F deflects the middle by

    w = F l / 4T (1 - tanh(u) / u),

which is F l / 4T of a string for large u, and F l^3 / 48 EI of a beam for small u. A span between fixed centers is
stretched by 2 w^2 / l, as by a bent line of two straight halves.
"""

from math import sqrt, tanh

_SMALL = 1e-3
"""u below which 1 - tanh(u) / u is its series, u^2 / 3."""


def deflection_force(deflection: float, length: float, tension: float, bending: float = 0.0) -> float:
    """Force across the middle of a span that deflects it, N.

    Parameters
    ----------
    deflection : float
        Of the middle, m.
    length : float
        Of the span, m.
    tension : float
        N.
    bending : float, default 0
        Bending stiffness, N m^2.

    Examples
    --------
    >>> from beltdyn.theory.stiff_span import deflection_force
    >>> deflection_force(0.01, 0.5, 200.0)  # 4 T w / l of a string
    16.0
    """
    return 4.0 * tension * deflection / length / _flexibility(length, tension, bending)


def stretching(deflection: float, length: float) -> float:
    """How much longer a span becomes by a deflection of its middle, m."""
    return 2.0 * deflection**2 / length


def _flexibility(length: float, tension: float, bending: float) -> float:
    """1 - tanh(u) / u."""
    if not bending > 0.0:
        return 1.0
    half = 0.5 * length * sqrt(tension / bending)
    return half**2 / 3.0 if half < _SMALL else 1.0 - tanh(half) / half

"""Tension ratio of a sliding belt on a pulley (Euler 1769, Eytelwein 1808), at rest or in motion."""

from math import exp, log


def capstan_ratio(friction: float, angle: float) -> float:
    """Ratio e^(mu theta) of the tensions at the ends of an arc of sliding.

    Examples
    --------
    Half a turn with a friction of 0.5:

    >>> from math import pi
    >>> round(bd.theory.capstan.capstan_ratio(0.5, pi), 3)
    4.81
    """
    return exp(friction * angle)


def tight_tension(
    slack: float, friction: float, angle: float, *, mass_per_length: float = 0.0, speed: float = 0.0
) -> float:
    """Tension T1 at the tight end: (T1 - rho A v^2) = (T2 - rho A v^2) e^(mu theta).

    Examples
    --------
    >>> from math import pi
    >>> round(bd.theory.capstan.tight_tension(100.0, 0.5, pi, mass_per_length=0.1, speed=20.0), 1)
    328.6
    """
    lifted = mass_per_length * speed**2
    return lifted + (slack - lifted) * capstan_ratio(friction, angle)


def sliding_angle(
    tight: float, slack: float, friction: float, *, mass_per_length: float = 0.0, speed: float = 0.0
) -> float:
    """Sliding arc between two tensions, ln((T1 - rho A v^2) / (T2 - rho A v^2)) / mu, rad.

    Parameters are those of `tight_tension`, with the tight tension T1 (N) in place of the angle.

    Examples
    --------
    >>> round(bd.theory.capstan.sliding_angle(tight=300.0, slack=100.0, friction=0.5), 3)
    2.197
    """
    lifted = mass_per_length * speed**2
    return log((tight - lifted) / (slack - lifted)) / friction

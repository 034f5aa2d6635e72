"""Elastic creep of a two-pulley drive with Coulomb friction (Grashof 1883): adhesion, sliding, loss of speed."""

from math import exp, pi

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.stretch import StretchParameters
from beltdyn.theory.capstan import sliding_angle
from beltdyn.theory.path import open_belt


def speed_loss(tight: float, slack: float, law: StretchParameters) -> float:
    """Loss of speed (v1 - v2) / v1 = 1 - g(T2) / g(T1) of the rims, (T1 - T2) / EA at small strain.

    Where the belt runs onto a pulley it adheres and has the speed of the rim: c g(T1) on the driver, c g(T2) on the
    driven pulley, with the same c, the reference length that passes per second.

    Examples
    --------
    >>> from beltdyn.stretch import Linear
    >>> f"{bd.theory.elastic_creep.speed_loss(tight=300.0, slack=100.0, law=Linear(1e5)):.3%}"
    '0.199%'
    """
    return 1.0 - float(law.stretch(slack) / law.stretch(tight))


def slip_arc(tight: float, slack: float, friction: float, *, mass_per_length: float = 0.0, speed: float = 0.0) -> float:
    """Sliding arc before the exit of a pulley, rad; on the rest of the wrap the belt adheres.

    Parameters are those of `capstan.sliding_angle`.
    """
    return sliding_angle(tight, slack, friction, mass_per_length=mass_per_length, speed=speed)


def entry_strain(
    tension: FloatArray,
    radii: FloatArray,
    *,
    bending_stiffness: float,
    axial_stiffness: float,
    contact_stiffness: float,
    bent_strain: float,
    loss_factor: float = 0.0,
) -> FloatArray:
    """Strain lost by the belt at the entry of a pulley against its span, and the resulting loss of rim speed.

    In a span of tension T the belt bends towards a rim of stiffness k.  With q = EI k / T^2 the beam on springs, E I
    d'''' - T d'' + k d = T / R, meets the rim with the curvature kappa and the angle alpha,

        kappa R = sqrt(q) / (1 + sqrt(q) + sqrt(1 + 2 sqrt(q))),    alpha^2 = T / (k R^2).

    What does not depend on the place along a belt, T g - psi and the energy of bending, takes (1/2 - e) EI kappa^2 from
    the strain's EA, with e EI kappa^2 / EA the strain of a bent belt without tension; hysteresis takes pi/8 eta EI
    kappa^2, half of what bending forth and back loses.  The rim sees cos(alpha) of the belt's speed.
    """
    pull = np.maximum(tension, 1e-9 * axial_stiffness)
    root = np.sqrt(bending_stiffness * contact_stiffness) / pull
    bent = (root / (1.0 + root + np.sqrt(1.0 + 2.0 * root)) / radii) ** 2
    share = 0.5 - bent_strain + pi / 8.0 * loss_factor
    return np.asarray(share * bending_stiffness / axial_stiffness * bent + 0.5 * pull / (contact_stiffness * radii**2))


def gross_slip_tensions(
    installed: float,
    friction: float,
    distance: float,
    radius: float,
    *,
    mass_per_length: float = 0.0,
    speed: float = 0.0,
) -> tuple[float, float]:
    """Tight and slack tension of a drive with equal pulleys at gross slip.

    At small strain the belt's length fixes the mean of the tension over the path: with the lifted tension
    T0 = rho A v^2, span l, T1 - T0 = (T2 - T0) e^(mu pi), and arcs with the mean (T1 - T2) / (mu pi),

        l (T1 - T0 + T2 - T0) + 2 R (T1 - T2) / mu = (2 l + 2 pi R) (T - T0).

    Examples
    --------
    >>> tight, slack = bd.theory.elastic_creep.gross_slip_tensions(200.0, friction=0.3, distance=0.4, radius=0.05)
    >>> round(tight, 1), round(slack, 1)
    (293.5, 114.4)
    """
    belt, lifted = open_belt(distance, (radius, radius)), mass_per_length * speed**2
    ratio = exp(friction * belt.wrap[0])
    weight = belt.span * (ratio + 1.0) + 2.0 * radius * (ratio - 1.0) / friction
    slack = belt.length * (installed - lifted) / weight
    return lifted + ratio * slack, lifted + slack

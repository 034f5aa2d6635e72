"""A belt running without load or contact: the tension rho A v^2 balances any curvature."""

from math import sqrt


def hoop_tension(mass_per_length: float, speed: float) -> float:
    """Centrifugal tension T = rho A v^2 (Routh 1860) of a running belt without contact.

    Examples
    --------
    >>> bd.theory.hoop.hoop_tension(mass_per_length=0.1, speed=20.0)
    40.0
    """
    return mass_per_length * speed**2


def hoop_stretch(
    transport_speed: float,
    axial_stiffness: float,
    mass_per_length: float,
    *,
    bending_stiffness: float = 0.0,
    turning: float = 0.0,
) -> float:
    """Stretch g of a spinning hoop by Green's strain, exactly: g^2 = 1 + (2 rho A c^2 - 3 EI kappa^2) / EA.

    With v = c g and rho A / g kg in a running meter the hoop tension is rho A c^2 g.  The belt carries it by stretch,
    EA (g^2 - 1) g / 2, and, as it was straight unstressed, by bending, 3/2 EI kappa^2 g (Eq. 14).

    Examples
    --------
    >>> round(bd.theory.hoop.hoop_stretch(20.0, axial_stiffness=1e5, mass_per_length=0.1), 6)
    1.0004
    """
    inertia = 2.0 * mass_per_length * transport_speed**2
    return sqrt(1.0 + (inertia - 3.0 * bending_stiffness * turning**2) / axial_stiffness)

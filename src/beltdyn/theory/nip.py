"""The nip of two rollers on elastic foundations: a parabola of pressure (Johnson 1985, Contact Mechanics, 4.3)."""

from math import inf, pi, sqrt


def cover_modulus(youngs_modulus: float, poissons_ratio: float) -> float:
    """Modulus of a layer on a rigid core that cannot expand sideways, Pa.

    Examples
    --------
    >>> round(bd.theory.nip.cover_modulus(4e6, 0.45) / 4e6, 3)
    3.793
    """
    nu = poissons_ratio
    return youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


def series(*stiffnesses: float) -> float:
    """Stiffness of springs in series; infinite ones do not give way.

    Examples
    --------
    >>> bd.theory.nip.series(3.0, 6.0)
    2.0
    """
    compliance = sum(0.0 if one == inf else 1.0 / one for one in stiffnesses)
    return inf if compliance == 0.0 else 1.0 / compliance


def equivalent_radius(*radii: float) -> float:
    """Radius of a roller on a plane that opens as two rollers do, 1 / (1 / R_1 + 1 / R_2), m.

    Examples
    --------
    >>> bd.theory.nip.equivalent_radius(0.1, 0.1)
    0.05
    """
    return 1.0 / sum(1.0 / one for one in radii)


def half_width(indentation: float, radius: float) -> float:
    """Half of the width of the nip, a = sqrt(2 R d), m.

    Parameters
    ----------
    indentation
        d, by how much the undeformed rollers overlap, m.
    radius
        R, of `equivalent_radius`, m.

    Examples
    --------
    >>> bd.theory.nip.half_width(5e-4, 0.1)
    0.01
    """
    return sqrt(2.0 * radius * indentation)


def force(indentation: float, stiffness: float, radius: float) -> float:
    """Force of a foundation of stiffness K (N/m^2 over the length of the belt), F = 4 K a d / 3, N.

    The line force is the parabola K (d - x^2 / 2 R); `indentation` and `radius` are those of `half_width`.

    Examples
    --------
    >>> round(bd.theory.nip.force(5e-4, 3e8, 0.1), 6)
    2000.0
    """
    return 4.0 / 3.0 * stiffness * half_width(indentation, radius) * indentation


def indentation_of(load: float, stiffness: float, radius: float) -> float:
    """Indentation d under a force (N), m; the inverse of `force`.

    Examples
    --------
    >>> round(bd.theory.nip.indentation_of(2000.0, 3e8, 0.1), 9)
    0.0005
    """
    return float((3.0 * load / (4.0 * stiffness * sqrt(2.0 * radius))) ** (2.0 / 3.0))


def nip_damping(loss_factor: float, half_width: float, speed: float) -> float:
    """Damping over stiffness of a foundation that loses in a nip what hysteresis does, s.

    A strip is pressed to d = a^2 / 2 R at the rate v x / R and loses 2 c v a^3 / 3 R^2; hysteresis, pi / 4 eta K d^2.

    Parameters
    ----------
    loss_factor
        eta, tan delta.
    half_width
        a, m.
    speed
        v, m/s; at a standstill there is none.

    Examples
    --------
    >>> round(bd.theory.nip.nip_damping(0.1, 0.01, 2.0) * 1e3, 4)  # ms
    0.1473
    """
    return 0.0 if speed == 0.0 else 3.0 * pi * loss_factor * half_width / (32.0 * speed)


def rolling_loss(loss_factor: float, stiffness: float, indentation: float) -> float:
    """Force that hysteresis takes to roll a foundation K (N/m^2) through a nip, pi / 4 eta K d^2, N.

    Examples
    --------
    >>> round(bd.theory.nip.rolling_loss(0.1, 3e8, 5e-4), 2)
    5.89
    """
    return 0.25 * pi * loss_factor * stiffness * indentation**2

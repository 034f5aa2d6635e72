"""Strain energy of the belt element per length, with its first and second derivatives (Eqs. 8-15)."""

from typing import NamedTuple

from beltdyn.elements.section import Section
from beltdyn.kernel import kernel
from beltdyn.stretch import stretching


class EnergyGradient(NamedTuple):
    """First derivatives of the energy density psi(G, theta, s, p)."""

    metric: float
    """d psi / dG, N."""
    turning: float
    """d psi / d theta, N m."""
    sine: float
    """d psi / ds, N."""
    sine_rate: float
    """d psi / dp, N m."""


class EnergyCurvature(NamedTuple):
    """Second derivatives of psi(G, theta, s, p), named by the pair of arguments: g, t, s, p."""

    gg: float
    gt: float
    gs: float
    gp: float
    tt: float
    ts: float
    tp: float
    ss: float
    sp: float
    pp: float


@kernel
def energy_density(metric: float, turning: float, sine: float, sine_rate: float, section: Section) -> float:
    """Strain energy per reference length, closed over the section (Eqs. 14 and 15).

    With a = G - 1, k = theta + p, c = k^2 + s^2 theta^2:

        psi = W(G) + EI alpha2 / 2 (G k^2 + a c / 2) + E I4 alpha2 / 8 c^2
              + k_s G alpha2 / 2 (A G s^2 + I s^2 p^2)

    where W is the energy of the law of stretch, EA alpha1 / 8 a^2 of the published one.  The terms odd in y vanish over
    the symmetric section, so the stray "-1" printed in Eq. 11 has no effect.

    Parameters
    ----------
    metric
        G = r_c,x . r_c,x, dimensionless (shear modulus G appears only inside `section`).
    turning
        theta, rate at which the tangent turns along the reference length, 1/m.
    sine
        s = sin(gamma), dimensionless (Eq. 7).
    sine_rate
        p = ds/dx, 1/m.
    section
        Stiffnesses of the section.

    Returns
    -------
    float
        psi, J/m.
    """
    excess = metric - 1.0
    bend = turning + sine_rate
    lean = sine * turning
    spread = bend * bend + lean * lean
    return (
        stretching(section.stretch, metric).energy
        + section.bending / 2.0 * (metric * bend * bend + 0.5 * excess * spread)
        + section.quartic / 8.0 * spread * spread
        + 0.5 * sine * sine * (section.shear * metric + section.shear_gradient * sine_rate * sine_rate)
    )


@kernel
def energy_gradient(metric: float, turning: float, sine: float, sine_rate: float, section: Section) -> EnergyGradient:
    """First derivatives of `energy_density`; parameters as there."""
    excess = metric - 1.0
    bend = turning + sine_rate
    spread = bend * bend + (sine * turning) ** 2
    weight = 0.25 * (section.bending * excess + section.quartic * spread)
    moment = section.bending * metric * bend
    return EnergyGradient(
        stretching(section.stretch, metric).slope
        + 0.5 * section.bending * (bend * bend + 0.5 * spread)
        + 0.5 * section.shear * sine * sine,
        moment + weight * 2.0 * (bend + sine * sine * turning),
        sine * (weight * 2.0 * turning * turning + section.shear * metric + section.shear_gradient * sine_rate**2),
        moment + weight * 2.0 * bend + section.shear_gradient * sine * sine * sine_rate,
    )


@kernel
def energy_curvature(metric: float, turning: float, sine: float, sine_rate: float, section: Section) -> EnergyCurvature:
    """Second derivatives of `energy_density`; parameters as there."""
    excess = metric - 1.0
    bend = turning + sine_rate
    square = sine * sine
    spread = bend * bend + square * turning * turning
    weight = 0.25 * (section.bending * excess + section.quartic * spread)
    by_turning = 2.0 * (bend + square * turning)
    by_sine = 2.0 * sine * turning * turning
    by_rate = 2.0 * bend
    half, quarter = 0.25 * section.bending, 0.25 * section.quartic
    stiff = section.bending * metric
    return EnergyCurvature(
        stretching(section.stretch, metric).curvature,
        section.bending * bend + half * by_turning,
        half * by_sine + section.shear * sine,
        section.bending * bend + half * by_rate,
        stiff + weight * 2.0 * (1.0 + square) + quarter * by_turning * by_turning,
        weight * 4.0 * sine * turning + quarter * by_turning * by_sine,
        stiff + weight * 2.0 + quarter * by_turning * by_rate,
        weight * 2.0 * turning * turning
        + quarter * by_sine * by_sine
        + section.shear * metric
        + section.shear_gradient * sine_rate * sine_rate,
        quarter * by_sine * by_rate + 2.0 * section.shear_gradient * sine * sine_rate,
        stiff + weight * 2.0 + quarter * by_rate * by_rate + section.shear_gradient * square,
    )


@kernel
def thickness_energy(strain_i: float, strain_j: float, section: Section, length: float) -> float:
    """Energy of the thickness stretch, linear between its nodal values, J (second term of Eq. 8).

    Parameters
    ----------
    strain_i, strain_j
        eps_yy = (r_y . r_y - 1) / 2 at the two nodes.
    section
        Stiffnesses of the section.
    length
        Reference length of the element, m.
    """
    return section.thickness * length / 6.0 * (strain_i * strain_i + strain_i * strain_j + strain_j * strain_j)

"""Coefficients of generalised-alpha (Chung and Hulbert 1993); the method is described in `alpha_step`."""

from typing import NamedTuple

from beltdyn.kernel import kernel


class Method(NamedTuple):
    """Coefficients of the method for one spectral radius."""

    am: float
    af: float
    gamma: float
    beta: float
    error: float
    """Local error of the position over h^2 (A1 - A0)."""


@kernel
def method_of(rho: float) -> Method:
    """Coefficients for the spectral radius rho at infinite frequency (Chung and Hulbert 1993)."""
    am, af = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 + af - am
    beta = 0.25 * (gamma + 0.5) ** 2
    return Method(am, af, gamma, beta, abs(beta + 0.5 * (am - af) - 1.0 / 6.0))

"""Tension by the stretch of the centreline and by its rate (first term of Eq. 14)."""

from math import sqrt
from typing import TYPE_CHECKING

from beltdyn.elements.section import Section
from beltdyn.kernel import kernel

if TYPE_CHECKING:
    from beltdyn.elements.kind import Element


@kernel
def axial_force(metric: float, section: Section) -> float:
    """Tension carried by the stretch of the centreline, EA alpha1 (G - 1) / 2 sqrt(G), N.

    Parameters
    ----------
    metric
        G = q . q with q = dr/dx, dimensionless.
    section
        With its axial stiffness.
    """
    return 0.5 * section.axial * (metric - 1.0) * metric**0.5


@kernel
def damping_tension(metric: float, metric_rate: float, section: Section) -> float:
    """Tension by the rate of stretch, EA alpha1 tau_s |q| deps/dt, N: to be added to `axial_force`.

    Parameters
    ----------
    metric, metric_rate
        q . q and its rate, 1/s.
    section
        With its factors of damping.
    """
    return 0.5 * section.axial_damping * metric_rate * sqrt(metric)


@kernel
def axial_tension(element: "Element", metric: float, metric_rate: float) -> float:
    """Tension of an element that stretches by the strain (G - 1) / 2, N: both parts."""
    return axial_force(metric, element.section) + damping_tension(metric, metric_rate, element.section)

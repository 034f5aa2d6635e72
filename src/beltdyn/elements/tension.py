"""Tension by the stretch of the centreline, 2 g dW/dG, and by its rate."""

from math import sqrt
from typing import TYPE_CHECKING

from beltdyn.elements.section import Section
from beltdyn.kernel import kernel
from beltdyn.stretch import StretchParameters, stretching

if TYPE_CHECKING:
    from beltdyn.elements.kind import Element


@kernel
def axial_force(law: StretchParameters, metric: float) -> float:
    """Tension carried by the stretch of the centreline, 2 sqrt(G) dW/dG, N.

    Parameters
    ----------
    law
        Parameters of the law of stretch.
    metric
        G = q . q with q = dr/dx, dimensionless.
    """
    return 2.0 * stretching(law, metric).slope * metric**0.5


@kernel
def damping_tension(metric: float, metric_rate: float, section: Section) -> float:
    """Tension by the rate of stretch, EA alpha1 tau_s dg/dt with g = |q|, N: to be added to `axial_force`.

    Parameters
    ----------
    metric, metric_rate
        q . q and its rate, 1/s.
    section
        With its factors of damping.
    """
    return 0.5 * section.axial_damping * metric_rate / sqrt(metric)


@kernel
def axial_tension(element: "Element", metric: float, metric_rate: float) -> float:
    """Tension of an element by the stretch law of its section, N: both parts."""
    return axial_force(element.section.stretch, metric) + damping_tension(metric, metric_rate, element.section)

"""Estimated discretisation errors of a running drive, from element length, layout, stiffnesses and tension.

A belt takes on the curvature of a pulley within the length lambda = sqrt(l_s max(l_s, l_b)), where it sinks in over
l_s = sqrt(T / k_p) and bends over l_b = sqrt(E I alpha2 / T).  An element of length l covers phi = l / R of a pulley.
With the strain e = T / E A, y = l / lambda, and q = y^2 / (1 + (y / 12)^2), the errors grow as

    tension            sum over pulleys of R phi^3 q / (e L),
    peak pressure      y q,
    mean pressure      the same, and with the tension,
    slip, losses       phi^3 q / sqrt(e) on the smallest pulley.

The factors are those that leave hardly any error above twice its estimate in drives made at random; the documentation
has how they were found and how far they hold.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.parts.finding import Finding, listing

ERROR_LIMITS: Mapping[str, float] = MappingProxyType(
    {"tension": 0.01, "mean pressure": 0.05, "peak pressure": 0.2, "slip": 0.1, "losses": 0.2}
)
"""Quantities affected by the mesh, and the largest relative error of a mesh that resolves them."""

PRESSURES = ("mean pressure", "peak pressure")
"""Quantities that the default number of elements need not resolve."""

_TENSION, _MEAN, _PEAK, _SLIP, _LOSSES = 2e-4, 2e-4, 1.2e-3, 3e-3, 1e-2
_SURE = 2.0
"""Estimates that errors hardly ever exceed."""
_COARSE = 12.0
"""y above which elements touch at single points, and errors grow more slowly."""
_MOST = 100_000


class OnPulleys(Protocol):
    """What the mesh of a belt on its pulleys depends on."""

    @property
    def belt(self) -> Belt:
        """The belt; its length and elements are ignored."""

    @property
    def belt_length(self) -> float:
        """Unstretched length of the belt, m."""

    @property
    def radii(self) -> FloatArray:
        """Effective radii, shape (n,), m."""

    @property
    def contact_stiffness(self) -> float:
        """Normal force per metre of belt and metre of penetration, N/m^2."""


@dataclass(frozen=True, slots=True)
class Running:
    """The operating point of a belt, as far as its mesh depends on it.

    Attributes
    ----------
    tension : float
        Mean tension, N.
    lifted : float
        Part of it that the belt's speed takes from the pulleys, m v^2, N.
    """

    tension: float
    lifted: float = 0.0


def layer_lengths(drive: OnPulleys, tension: float) -> tuple[float, float]:
    """Lengths over which a tensioned belt bends at the ends of an arc.

    Parameters
    ----------
    drive : Drive
        The drive.
    tension : float
        N.

    Returns
    -------
    bending, sinking : float
        sqrt(E I alpha2 / T) and sqrt(T / k_p), m.

    Examples
    --------
    >>> bending, sinking = bd.layer_lengths(drive, tension=30.0)
    >>> print(f"{1e3 * bending:.2f} mm, {1e3 * sinking:.2f} mm")
    5.27 mm, 1.73 mm
    """
    return math.sqrt(drive.belt.bending_stiffness / tension), math.sqrt(tension / drive.contact_stiffness)


def element_angles(drive: OnPulleys, elements: int) -> FloatArray:
    """Angle per element on each pulley, rad; for other kinds that of a cubic with the same error."""
    return drive.belt.element_kind.cubic_angle(drive.belt_length / (elements * drive.radii))


def mesh_errors(drive: OnPulleys, running: Running, elements: int) -> dict[str, float]:
    """Estimate the discretisation errors of a mesh.

    Parameters
    ----------
    drive : Drive
        The drive.
    running : Running
        Its tension, which must be above what its speed takes from the pulleys.
    elements : int
        Number of elements.

    Returns
    -------
    dict of str to float
        Relative error of each of `ERROR_LIMITS`, without sign.

    Examples
    --------
    >>> errors = bd.mesh_errors(drive, bd.model.Running(tension=30.0), elements=100)
    >>> print(f"{errors['slip']:.2%} of the slip, {errors['losses']:.1%} of the losses")
    0.33% of the slip, 1.1% of the losses
    """
    angles, radii = element_angles(drive, elements), drive.radii
    bending, sinking = layer_lengths(drive, running.tension - running.lifted)
    fineness = angles * radii / np.sqrt(sinking * max(sinking, bending))
    strain = float(drive.belt.stretch_parameters.stretch(running.tension)) - 1.0
    depth = fineness**2 / (1.0 + (fineness / _COARSE) ** 2)
    turning = angles**3 * depth
    tension = _TENSION * float(np.sum(radii * turning)) / (strain * drive.belt_length)
    peak = float(np.max(fineness * depth))
    creep = float(np.max(turning)) / math.sqrt(strain)
    errors = tension, tension + _MEAN * peak, _PEAK * peak, _SLIP * creep, _LOSSES * creep
    return dict(zip(ERROR_LIMITS, errors, strict=True))


def elements_needed(drive: OnPulleys, running: Running) -> dict[str, int]:
    """Number of elements for which twice the estimated error of each quantity is within its limit.

    Twice, since hardly any error is more.

    Parameters
    ----------
    drive : Drive
        The drive; its own number of elements does not matter.
    running : Running
        As for `mesh_errors`.

    Returns
    -------
    dict of str to int
        For each of `ERROR_LIMITS`.

    Examples
    --------
    >>> bd.elements_needed(drive, bd.model.Running(tension=30.0))["slip"]
    56
    """
    return {name: fewest(drive, running, name, limit / _SURE) for name, limit in ERROR_LIMITS.items()}


def fewest(drive: OnPulleys, running: Running, name: str, limit: float) -> int:
    """Fewest elements whose estimate of one of `ERROR_LIMITS` is within a limit, by bisection."""
    few, many = 0, _MOST
    while many - few > 1:
        middle = (few + many) // 2
        if mesh_errors(drive, running, middle)[name] > limit:
            few = middle
        else:
            many = middle
    return many


def unresolved(errors: Mapping[str, float], needed: Mapping[str, int], *, pressures: bool) -> list[Finding]:
    """Quantities that a mesh does not resolve, and meshes that would; empty if it resolves all.

    Parameters
    ----------
    errors
        Result of `mesh_errors`; an unknown error, NaN, counts as resolved.
    needed
        Result of `elements_needed`.
    pressures
        Whether to include pressures, as for a given number of elements; the default number ignores them.
    """
    asked = ERROR_LIMITS if pressures else ERROR_LIMITS.keys() - PRESSURES
    names = sorted((name for name in asked if errors[name] > ERROR_LIMITS[name]), key=lambda name: -needed[name])
    if not names:
        return []
    most, *fewer = names
    other = f", or {needed[fewer[0]]} for all but {most}" if fewer else ""
    return [
        Finding(
            f"the belt has too few elements for {listing([f'{name} ({_size(errors[name])})' for name in names])}.",
            "These have errors of about that size; speeds and torques need fewer elements.",
            f"Set belt.elements = {needed[most]} for all of these{other}.",
        )
    ]


def _size(error: float) -> str:
    """An error in percent, without a number above 100%."""
    return f"{error:.{0 if error > 0.1 else 1}%}" if error < 1.0 else "over 100%"

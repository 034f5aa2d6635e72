"""What to expect of a belt at rest on its pulleys, before anything is simulated."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltdyn.model.drive import Drive
from beltdyn.theory.stretch import tension as stretch_tension


@dataclass(frozen=True)
class Installation:
    """Estimates for the belt at rest, without friction and bending stiffness.

    Attributes
    ----------
    strain : float
        Strain of the belt laid on its path, path / length - 1.
    laid_tension : float
        Tension of the laid belt, N.
    tension : float
        Tension once the belt has sunk into the pulleys, N.
    penetrations : ndarray, shape (n,), m
        How deep it sinks into each pulley.
    """

    strain: float
    laid_tension: float
    tension: float
    penetrations: NDArray[np.float64]


def layer_lengths(drive: Drive, tension: float) -> tuple[float, float]:
    """Lengths within which a belt under a tension (N) turns at the ends of an arc.

    Returns
    -------
    bending, sinking : float
        sqrt(E I alpha2 / T) and sqrt(T / k_p), m.
    """
    return math.sqrt(drive.belt.bending_stiffness / tension), math.sqrt(tension / drive.contact.stiffness)


def install(drive: Drive) -> Installation:
    """Estimate tension and penetration of the belt at rest.

    At the stretch g the tension is T = E A alpha1 (g^2 - 1) g / 2 (the axial term of the strain energy). On a
    pulley of radius R it presses with T g / R per unstretched metre, so the belt sinks by d = T g / (R k_p),
    which shortens the path by the wrap angle times d.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    Installation
    """
    from scipy.optimize import brentq

    length, path = drive.belt.length, drive.path
    radii = np.array([pulley.radius for pulley in drive.pulleys])

    def tension(stretch: float) -> float:
        return float(stretch_tension(stretch, drive.belt.axial_stiffness))

    def penetrations(stretch: float) -> NDArray[np.float64]:
        return np.asarray(tension(stretch) * stretch / (radii * drive.contact.stiffness))

    def excess(stretch: float) -> float:
        return stretch * length + float(path.wrap_angles @ penetrations(stretch)) - path.length

    laid = path.length / length
    stretch = float(brentq(excess, 1.0, laid * (1 + 1e-9), xtol=1e-14))
    return Installation(laid - 1, tension(laid), tension(stretch), penetrations(stretch))

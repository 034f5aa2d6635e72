"""What to expect of a belt at rest on its pulleys, before anything is simulated."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltdyn.model.drive import Drive
from beltdyn.model.path import Path
from beltdyn.model.rest import carriers_of, come_to_rest
from beltdyn.theory.sagging_span import lowest_frequency, sag_parameter
from beltdyn.theory.stretch import tension as tension_of

FloatArray = NDArray[np.float64]


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
    tensioner_positions : ndarray, shape (K,), m or rad
        Where springs hold the sliding and the rotary tensioners.
    path : Path
        The path with the tensioners there, before the belt sinks in.
    hub_loads : ndarray, shape (n, 2), N
        Force of the belt on each pulley, T (u_out - u_in), of size 2 T sin(wrap angle / 2).
    span_frequencies : ndarray, shape (n,), Hz
        Lowest frequency at which each span swings across, with the bending stiffness of the belt and its sag.
    """

    strain: float
    laid_tension: float
    tension: float
    penetrations: FloatArray
    tensioner_positions: FloatArray
    path: Path
    hub_loads: FloatArray
    span_frequencies: FloatArray

    @property
    def span_tensions(self) -> FloatArray:
        """Tension of each span, shape (n,), N: the same in all, without friction."""
        return np.full(self.path.count, self.tension)


def layer_lengths(drive: Drive, tension: float) -> tuple[float, float]:
    """Lengths within which a belt under a tension (N) turns at the ends of an arc.

    Returns
    -------
    bending, sinking : float
        sqrt(E I alpha2 / T) and sqrt(T / k_p), m.
    """
    return math.sqrt(drive.belt.bending_stiffness / tension), math.sqrt(tension / drive.contact.stiffness)


def install(drive: Drive) -> Installation:
    """Estimate tension, penetration and the place of tensioners for the belt at rest.

    `beltdyn.model.rest` has the equations.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    Installation

    Examples
    --------
    >>> round(bd.install(drive).tension, 1)  # N
    26.6
    """
    carriers = carriers_of(drive.tensioners, [pulley.name for pulley in drive.pulleys], drive.path)
    rest, positions = come_to_rest(drive.path, drive.belt, drive.contact, carriers)
    path, laid = rest.path, rest.path.length / drive.belt.length
    turned = path.span_directions - np.roll(path.span_directions, 1, axis=0)
    return Installation(
        strain=laid - 1,
        laid_tension=float(tension_of(laid, drive.belt.axial_stiffness)),
        tension=rest.tension,
        penetrations=rest.penetrations,
        tensioner_positions=positions,
        path=path,
        hub_loads=rest.tension * turned,
        span_frequencies=_span_frequencies(drive, path, rest.tension),
    )


def _span_frequencies(drive: Drive, path: Path, tension: float) -> FloatArray:
    """First frequencies of spans, Hz; see `theory.sagging_span`.

    The mass of a metre is that of the stretched belt. A slack belt does not swing: zero.
    """
    if not tension > 0.0:
        return np.zeros(path.count)
    belt, mass = drive.belt, drive.belt.mass_per_length * drive.belt.length / path.length
    across = np.abs(path.span_directions @ np.array([-drive.gravity[1], drive.gravity[0]]))
    found = [
        lowest_frequency(
            length,
            tension,
            mass,
            bending=belt.bending_stiffness,
            sag_parameter=sag_parameter(mass * gravity, length, tension, belt.axial_stiffness),
        )
        for length, gravity in zip(path.span_lengths.tolist(), across.tolist(), strict=True)
    ]
    return np.array(found)

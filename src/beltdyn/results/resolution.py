"""How well the mesh of a run resolves tension and contact, estimated from the run itself.

A cubic element that cannot follow a pulley's circle makes the normal force ripple along the arc, and so much stretches
and slackens inside that the mean tension rises.  Both errors fall with the fourth power of the number of elements.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.model import Drive, layer_lengths
from beltdyn.results.recorded import Recorded

FloatArray = NDArray[np.float64]

FORCE_LIMIT = 0.05
"""Largest estimated error of the normal force, over its mean, of a mesh that resolves contact."""

TENSION_LIMIT = 0.01
"""Largest estimated error of the mean tension, over that tension."""

_VARIABLES = ("belt_tension", "tension_variation", "contact_position", "contact_pulley", "normal_force")
_WINDOW = 0.2
_INSTANTS = 20
_MIDDLE = 0.7
_TREND = 3
_FEWEST = 8
_REFINEMENT = 2
"""Factor on the elements where too few points touch to tell more."""
_TENSION_FACTOR = 2.0


@dataclass(frozen=True, slots=True)
class Resolution:
    """Estimated errors of the mesh over the last fifth of a run.

    Attributes
    ----------
    force_errors : tuple of float
        For each pulley the root mean square ripple of the normal force about a cubic trend along the middle of the
        arc, over its mean; NaN without contact, and infinite with too few points in contact to tell.
    tension_error : float
        Twice the mean square of the variation of the axial force within elements over the squared mean tension: what
        the mean tension is too high by.
    layers : tuple of float
        Lengths within which the belt turns straight at the ends of an arc, sqrt(E I alpha2 / T) and sqrt(T / k_p), m;
        peaks of the contact force there are resolved by elements no longer than the longer one.
    elements : int
        Number of elements for which the errors fall to `FORCE_LIMIT` and `TENSION_LIMIT`.
    """

    force_errors: tuple[float, ...]
    tension_error: float
    layers: tuple[float, float]
    elements: int

    def resolves(self, pulley: int) -> bool:
        """Whether the contact forces on a pulley are resolved, or there are none."""
        return not self.force_errors[pulley] > FORCE_LIMIT

    @property
    def resolves_tension(self) -> bool:
        """Whether the tension is resolved."""
        return not self.tension_error > TENSION_LIMIT


def estimate_resolution(dataset: Recorded, drive: Drive) -> Resolution:
    """Estimate how well the mesh of a run resolves tension and contact.

    Parameters
    ----------
    dataset : Recorded
        Its results, with at least one output.
    drive : Drive
        The drive.

    Returns
    -------
    Resolution
        Validated against converged meshes in the documentation.
    """
    window = _last_instants(dataset)
    errors = tuple(_force_error(window, drive, number) for number in range(len(drive.pulleys)))
    tension = float(window["belt_tension"].mean())
    variation = float((window["tension_variation"] ** 2).mean())
    tension_error = _TENSION_FACTOR * variation / tension**2 if tension > 0.0 else math.nan
    belt = drive.belt
    layers = layer_lengths(drive, tension) if tension > 0.0 else (math.nan, math.nan)
    order = 2 if belt.links else 4
    excess = [error / FORCE_LIMIT for error in errors] + [tension_error / TENSION_LIMIT]
    factors = [ratio ** (1.0 / order) if math.isfinite(ratio) else _REFINEMENT for ratio in excess if ratio > 1.0]
    elements = math.ceil(belt.elements * max(factors, default=1.0) / belt.multiple) * belt.multiple
    return Resolution(errors, tension_error, layers, elements)


def _last_instants(dataset: Recorded) -> dict[str, NDArray[Any]]:
    """Some outputs from the last part of the run."""
    time = np.asarray(dataset["field_time"])
    first = int(np.searchsorted(time, time[-1] - _WINDOW * (time[-1] - time[0])))
    rows = np.unique(np.linspace(first, len(time) - 1, _INSTANTS).round().astype(int))
    return {name: np.asarray(dataset[name][rows]) for name in _VARIABLES}


def _force_error(window: Mapping[str, NDArray[Any]], drive: Drive, pulley: int) -> float:
    """Ripple of the normal force along the middle of the arc, over its mean."""
    ripples, means = list[float](), list[float]()
    center = np.array(drive.pulleys[pulley].center)
    places, touched = window["contact_position"], window["contact_pulley"] == pulley
    for k, force in enumerate(window["normal_force"]):
        angle, pressed = _along_arc(places[k][touched[k]] - center), force[touched[k]]
        middle = np.abs(angle) <= 0.5 * _MIDDLE * np.ptp(angle) if angle.size else np.zeros(0, dtype=bool)
        if np.count_nonzero(middle) < _FEWEST:
            ripples += [math.inf] * bool(angle.size)
            continue
        trend = np.polynomial.Polynomial.fit(angle[middle], pressed[middle], _TREND)
        ripples.append(float(np.mean((pressed[middle] - trend(angle[middle])) ** 2)))
        means.append(float(np.mean(pressed[middle])))
    if not ripples:
        return math.nan
    return math.sqrt(np.mean(ripples)) / float(np.mean(means)) if means and np.mean(means) > 0.0 else math.inf


def _along_arc(place: FloatArray) -> FloatArray:
    """Angles of points around a pulley's centre, rad, zero in the middle between the outermost."""
    if not len(place):
        return np.zeros(0)
    mean = place.mean(axis=0)
    turned = np.arctan2(mean[0] * place[:, 1] - mean[1] * place[:, 0], place @ mean)
    return np.asarray(turned - 0.5 * (turned.min() + turned.max()))

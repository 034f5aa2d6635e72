"""Contact forces over the arc of a pulley, averaged over many outputs, and how far those of a run are from them."""

from dataclasses import dataclass
from math import pi

import numpy as np
import xarray as xr

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.results import Run
from beltdyn.system.build import contact_points
from validation.paper.measures import SETTLED

BINS = 36
"""Equal parts of the nominal arc; 5 degrees each on half a pulley."""

_MIDDLE = slice(BINS // 10, BINS - BINS // 10)
_NEAR = 0.05


@dataclass(frozen=True, eq=False)
class ContactSamples:
    """Forces at all contact points on the nominal arc of a pulley, at all outputs of a window.

    Attributes
    ----------
    place : ndarray, shape (k,)
        Angle from the start of the nominal arc over the nominal wrap angle, 0 to 1.
    weight : ndarray, shape (k,)
        Part of the element that a point stands for, as in the integral of the forces.
    normal, friction : ndarray, shape (k,), N/m
        Forces on the belt; zero at points that do not touch.
    """

    place: FloatArray
    weight: FloatArray
    normal: FloatArray
    friction: FloatArray

    @property
    def bin(self) -> IntArray:
        """Part of the arc that every point lies in."""
        return np.asarray(self.place * BINS, dtype=np.intp)

    def mean(self, kind: str) -> FloatArray:
        """Mean force in every part of the arc, over belt and outputs, N/m, shape (BINS,).

        Points move with the belt and pass every angle, so that this is what the force at an angle is in the mean,
        whether it is found at Gauss points or at nodes.
        """
        return self._mean(self.weight * getattr(self, kind))

    def _mean(self, values: FloatArray) -> FloatArray:
        """Sums of weighted values over those of the weights; NaN where there is no point."""
        with np.errstate(invalid="ignore"):
            return np.asarray(np.bincount(self.bin, values, BINS) / np.bincount(self.bin, self.weight, BINS))

    def unevenness(self) -> float:
        """Normal force less its mean at the place, root mean square in the middle of the arc, over the mean there.

        NaN where nothing touches.
        """
        mean = self.mean("normal")
        square = self._mean(self.weight * (self.normal - mean[self.bin]) ** 2)
        with np.errstate(invalid="ignore"):
            return float(np.sqrt(np.mean(square[_MIDDLE])) / np.mean(mean[_MIDDLE]))


def contact_samples(run: Run) -> list[ContactSamples]:
    """Collect contact forces over the end of a run, on pulleys that turn counter-clockwise.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    list of ContactSamples
        For every pulley those of the points on its nominal arc that are nearer than 5 % of the radius to the rim.
    """
    instants = run.dataset["field_time"].values
    first = int(np.searchsorted(instants, instants[-1] - SETTLED, side="right"))
    names = ["contact_position", "contact_pulley", "normal_force", "friction_force"]
    window = run.dataset[names].isel(field_time=slice(first, None)).load()
    contact = contact_points(run.drive.contact)
    weights = np.tile(contact.weights, window.sizes["contact_point"] // contact.weights.size)
    return [_on_pulley(run, window, weights, pulley) for pulley in range(len(run.drive.pulleys))]


def _on_pulley(run: Run, window: xr.Dataset, weights: FloatArray, pulley: int) -> ContactSamples:
    path, center = run.drive.path, run.drive.centers[pulley]
    arm = window["contact_position"].values - center
    start = path.span_points[pulley - 1, 1] - center
    turned = np.arctan2(start[0] * arm[..., 1] - start[1] * arm[..., 0], arm @ start) % (2.0 * pi)
    place = turned / path.wrap_angles[pulley]
    near = np.abs(np.linalg.norm(arm, axis=-1) / run.drive.radii[pulley] - 1.0) < _NEAR
    chosen = near & (place < 1.0)
    touching = window["contact_pulley"].values == pulley
    normal, friction = (np.where(touching, window[f"{kind}_force"].values, 0.0) for kind in ("normal", "friction"))
    weight = np.broadcast_to(weights, place.shape)
    return ContactSamples(place[chosen], weight[chosen], normal[chosen], friction[chosen])


def mean_forces(run: Run, kind: str) -> FloatArray:
    """Mean forces over the arcs of all pulleys as they were kept, one after the other, N/m, shape (pulleys * BINS,)."""
    return np.asarray(run.dataset[f"arc_{kind}_force"]).ravel()

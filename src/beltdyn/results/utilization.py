"""Utilization: design power at each pulley over the rated power of the belt there."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Prepared
from beltdyn.model.path import span_directions, wrap_angles
from beltdyn.model.rating import PowerRating
from beltdyn.model.tooth_rating import MeshRating

_LOADED = 0.01
"""Share of the largest power from which a pulley transmits power; idlers take less by friction."""


def rate(
    prepared: Prepared, speeds: FloatArray, powers: FloatArray, centers: FloatArray
) -> PowerRating | MeshRating | None:
    """Rate the belt of a drive; None where its profile has no rating.

    Wrap angles are those of straight spans, as in catalogues. NaN for pulleys on the back of the belt, for which
    catalogues have no rating, and of a toothed belt for those without teeth.
    """
    belt = prepared.drive.rated_belt
    if belt is None:
        return None
    sizes = np.abs(powers)
    loaded = sizes > _LOADED * np.nanmax(sizes, initial=0.0)
    speed = float(abs(speeds[prepared.reference] * prepared.radii[prepared.reference]))
    wraps = wrap_angles(span_directions(centers, *prepared.path.shape), prepared.path.radii)
    found = belt.on(2.0 * prepared.radii, wraps, speed, loaded)
    by_teeth = prepared.belt.teeth is not None
    inside = np.array([one.side == "inside" for one in prepared.pulleys])
    return found.on(prepared.toothed if by_teeth else inside)


def utilization(drive: Drive, rated: FloatArray, powers: FloatArray) -> FloatArray:
    """Design power over rated power at each pulley, with the drive's service factor; inf where the rated power is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((drive.limits.service_factor or 1.0) * np.abs(powers) / rated)

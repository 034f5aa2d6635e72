"""Utilization: design power at each pulley over the rated power of the belt there."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Prepared
from beltdyn.model.path import span_directions, wrap_angles
from beltdyn.model.rating import PowerRating

_LOADED = 0.01
"""Share of the largest power from which a pulley transmits power; idlers take less by friction."""


def rate(prepared: Prepared, speeds: FloatArray, powers: FloatArray, centers: FloatArray) -> PowerRating | None:
    """Rate the belt of a drive; None where its profile has no rating.

    Wrap angles are those of straight spans, as in catalogues. NaN for pulleys on the back of the belt, for which
    catalogues have no rating.
    """
    belt = prepared.drive.rated_belt
    if belt is None:
        return None
    sizes = np.abs(powers)
    loaded = sizes > _LOADED * np.nanmax(sizes, initial=0.0)
    speed = float(abs(speeds[prepared.reference] * prepared.radii[prepared.reference]))
    wraps = wrap_angles(span_directions(centers, prepared.path.radii, prepared.path.ends), prepared.path.radii)
    found = belt.on(2.0 * prepared.radii, wraps, speed, loaded)
    grooved = np.array([pulley.side == "inside" for pulley in prepared.pulleys])
    basic, ratio, power = (np.where(grooved, one, np.nan) for one in (found.basic, found.ratio, found.power))
    return found._replace(basic=basic, ratio=ratio, power=power)


def utilization(drive: Drive, rated: FloatArray, powers: FloatArray) -> FloatArray:
    """Design power over rated power at each pulley, with the drive's service factor; inf where the rated power is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((drive.limits.service_factor or 1.0) * np.abs(powers) / rated)

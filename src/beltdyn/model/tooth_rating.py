"""The rating of a toothed belt: the pull of its teeth in mesh, and the width that a pull needs."""

from math import inf
from typing import NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.model.toothing import Toothing
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import AngularSpeed, Length, Ratio, Speed
from beltdyn.theory.rating import mesh_factor, speed_factor


class ToothRating(Part):
    """How the teeth of a profile are rated, with standard widths; the law is that of `beltdyn.theory.rating`.

    Examples
    --------
    >>> rating = bd.read_catalogue()["HTD 8M"].tooth_rating
    >>> rating.counted_teeth, rating.next_width(0.024)
    (6.0, 0.03)
    """

    counted_teeth: Ratio = Field(gt=0, description="the largest number of teeth in mesh that counts")
    speed_loss: Ratio = Field(
        0.0, ge=0, lt=1, description="the relative loss of the allowed tooth load for ten times the pulley speed"
    )
    loss_speed: AngularSpeed | None = Field(
        None, gt=0, description="the pulley speed from which on the allowed tooth load falls, in rad/s"
    )
    largest_speed: Speed = Field(gt=0, description="the largest belt speed, in m/s")
    widths: tuple[Length, ...] = Field((), description="the standard widths, in m")
    source: str = Field(min_length=1, description="the source of the rating, as text")

    def next_width(self, width: float) -> float:
        """The next standard width, m; the width itself without standard widths, infinite beyond them."""
        if not self.widths:
            return width
        return min((one for one in self.widths if one >= width * (1.0 - 1e-9)), default=inf)

    def load_factor(self, speed: FloatArray | float) -> FloatArray:
        """Allowed load of a tooth over that at rest, for speeds of a pulley in rad/s."""
        if self.loss_speed is None:
            return np.ones_like(np.asarray(speed, dtype=float))
        return speed_factor(speed, self.speed_loss, self.loss_speed)


class MeshRating(NamedTuple):
    """The rating of a toothed belt on each of n pulleys, arrays of shape (n,)."""

    diameter: FloatArray
    """Of the tension line, m."""
    wrap: FloatArray
    """Wrap angle, rad."""
    in_mesh: FloatArray
    """Pitches on the arc."""
    mesh_factor: FloatArray
    """Of the teeth in mesh that count."""
    load: FloatArray
    """Allowed on a tooth at the speed of the pulley, N."""
    pull: FloatArray
    """Allowed, N."""
    power: FloatArray
    """W."""

    def on(self, pulleys: BoolArray) -> "MeshRating":
        """That of some pulleys; NaN for others."""
        kept = (np.where(pulleys, one, np.nan) for one in self[2:])
        return MeshRating(self.diameter, self.wrap, *kept)


class RatedTeeth(NamedTuple):
    """A toothed belt as it is rated."""

    rating: ToothRating
    toothing: Toothing
    """Of the width of the belt."""
    width: float
    """m."""
    mass: float
    """Per length, kg/m."""
    largest_tension: float | None
    """Allowed, N."""

    def on(self, diameters: FloatArray, wraps: FloatArray, speed: float, loaded: BoolArray) -> MeshRating:
        """Rate the belt on pulleys with diameters of its tension line (m), wrap angles (rad) and a belt speed (m/s)."""
        counted, allowed = self.rating.counted_teeth, self.toothing.largest_tooth_load or 0.0
        in_mesh = 0.5 * diameters * wraps / self.toothing.pitch
        factor = mesh_factor(in_mesh, counted)
        load = allowed * self.rating.load_factor(2.0 * speed / diameters)
        held = np.minimum(factor * counted * load, self.largest_tension or np.inf)
        pull = np.maximum(held - self.mass * speed**2, 0.0)
        return MeshRating(diameters, wraps, in_mesh, factor, load, pull, pull * speed)

"""Contact forces along the belt on one pulley, and what can be said of their shape."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.results import Run
from beltdyn.show.plot.contact_pressure import unwrap
from validation.paper.kept import sliding
from validation.paper.measures import rms

END = 0.2
"""Part of the nominal arc at each end that the straight line leaves out."""

_GRID = 241


@dataclass(frozen=True, eq=False)
class Distribution:
    """Contact forces on the belt from where it meets a pulley to where it leaves.

    Attributes
    ----------
    distance : ndarray, shape (k,), m
        Unstretched length of belt from the first point in contact, as in the figures of the paper.
    place : ndarray, shape (k,)
        Angle from the tangent point of the path over the nominal wrap angle: 0 at entry, 1 at exit.
    normal, friction : ndarray, shape (k,), N/m
        Forces on the belt; friction counter-clockwise positive.
    gliding : ndarray of bool, shape (k,)
        Where friction is what Coulomb's law allows.
    """

    distance: FloatArray
    place: FloatArray
    normal: FloatArray
    friction: FloatArray
    gliding: BoolArray

    def force(self, kind: str) -> FloatArray:
        """Normal force for "normal", friction force for "friction"."""
        return self.normal if kind == "normal" else self.friction

    def on_grid(self, kind: str, ends: bool) -> FloatArray:
        """A force at fixed places of the arc, with or without its ends, linear between points, N/m."""
        low, high = (0.0, 1.0) if ends else (END, 1.0 - END)
        return np.interp(np.linspace(low, high, _GRID), self.place, self.force(kind))


@lru_cache(maxsize=64)
def distribution(run: Run, pulley: int) -> Distribution:
    """Contact forces at the last output of a run, on a pulley that turns counter-clockwise.

    Parameters
    ----------
    run : Run
        What was kept of a run.
    pulley : int
        Number of the pulley.
    """
    data, drive = run.dataset, run.drive
    wrap = unwrap(data["belt_coordinate"].values, data["contact_pulley"].values == pulley, drive.belt_length, 1.0)
    center = drive.centers[pulley]
    start = drive.path.span_points[pulley - 1, 1] - center
    points = data["contact_position"].values[wrap.points] - center
    angle = np.arctan2(start[0] * points[:, 1] - start[1] * points[:, 0], points @ start)
    angle = np.where(angle < -0.5 * np.pi, angle + 2.0 * np.pi, angle)
    normal, friction = (data[f"{kind}_force"].values[wrap.points] for kind in ("normal", "friction"))
    return Distribution(
        distance=wrap.distance,
        place=angle / drive.path.wrap_angles[pulley],
        normal=normal,
        friction=friction,
        gliding=sliding(run)[wrap.points],
    )


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line fitted to a force over the arc without its ends.

    Attributes
    ----------
    slope, value : float, N/m
        Change over the nominal arc, and value at its start.
    level : float, N/m
        Mean magnitude of the force where it was fitted.
    deviation : float
        Root mean square of force less line there, over `level`.
    deviation_with_ends : float
        The same over the whole arc but for points that glide.
    """

    slope: float
    value: float
    level: float
    deviation: float
    deviation_with_ends: float

    def at(self, place: FloatArray) -> FloatArray:
        """The line at places of the arc, N/m."""
        return self.value + self.slope * place


def fit_line(forces: Distribution, kind: str) -> Line:
    """Fit a straight line to a force by least squares.

    Parameters
    ----------
    forces : Distribution
        The forces.
    kind : {"normal", "friction"}
        Which one.
    """
    middle = (forces.place > END) & (forces.place < 1.0 - END)
    force, place = forces.force(kind), forces.place
    slope, value = np.polyfit(place[middle], force[middle], 1)
    level = float(np.abs(force[middle]).mean())
    off = force - value - slope * place
    return Line(float(slope), float(value), level, rms(off[middle]) / level, rms(off[~forces.gliding]) / level)


@dataclass(frozen=True, slots=True)
class Peak:
    """How far friction rises above its straight line at an end of the arc.

    Attributes
    ----------
    excess : float
        Largest magnitude of friction less that of the line at the same place, over the level in the middle.
    force : float, N/m
        Friction there.
    distance : float, m
        Length of belt between it and the end of contact.
    """

    excess: float
    force: float
    distance: float


def find_peak(forces: Distribution, at_exit: bool) -> Peak:
    """Find the highest point of friction above its line at the inlet or the exit.

    Parameters
    ----------
    forces : Distribution
        The forces.
    at_exit : bool
        Whether to look at the exit.
    """
    line = fit_line(forces, "friction")
    (end,) = np.nonzero(forces.place > 1.0 - END if at_exit else forces.place < END)
    above = np.abs(forces.friction[end]) - np.abs(line.at(forces.place[end]))
    top = int(end[np.argmax(above)])
    distance = forces.distance[-1] - forces.distance[top] if at_exit else forces.distance[top]
    return Peak(float(above.max()) / line.level, float(forces.friction[top]), float(distance))

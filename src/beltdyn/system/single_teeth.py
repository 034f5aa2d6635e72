"""Single teeth of a travelling belt: the force on each, and when they jump to other grooves."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import tooth_force, tooth_numbers
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.contact.surface import ToothedRims
from beltdyn.kernel import kernel
from beltdyn.system.arrays import System
from beltdyn.system.element_state import centreline, element_workspace, gather_motion
from beltdyn.system.frame import passed_lengths
from beltdyn.system.meshing import toothed_pulleys
from beltdyn.system.moving_center import pulley_state

_TURNS = 2.0 * np.pi
_BESIDE = 1.01
"""Distance from the shaft, over that of the nearest point, of points that stand for a belt that has left a pulley."""
_STICKS = 0.7
"""Pitches by which teeth are off the grooves that hold them before they count as held by the next ones."""


def tooth_coordinates(system: System) -> FloatArray:
    """Material coordinates of single teeth, m, shape (teeth,); none of spread ones."""
    pitch = float(system.rims.table.spacing[0]) if isinstance(system.rims, ToothedRims) else 0.0
    if pitch == 0.0:
        return np.zeros(0)
    return pitch * np.arange(round(float(np.sum(system.length)) / pitch), dtype=float)


def tooth_forces(system: System, position: FloatArray, velocity: FloatArray) -> FloatArray:
    """Forces of single teeth on the belt in k states, N, shape (k, teeth), positive along the belt."""
    found = np.zeros((position.shape[0], tooth_coordinates(system).size))
    if found.size:
        fill_tooth_forces(system, position, velocity, element_workspace(system), found)
    return found


@kernel
def fill_tooth_forces(
    system: System, position: FloatArray, velocity: FloatArray, work: np.record, found: FloatArray
) -> None:
    """Add the forces of teeth to zeros; see `tooth_forces`.

    Parameters
    ----------
    system
        With single teeth on a mesh that travels.
    position, velocity : ndarray, shape (k, n N + D)
        The states.
    work
        From `element_workspace`.
    found : ndarray, shape (k, teeth)
        Changed in place, N.
    """
    for k in range(position.shape[0]):
        for element in range(system.length.size):
            gather_motion(system, element, position[k], velocity[k], work.coordinates)
            for curve in range(system.control.shape[1]):
                piece = centreline(system, element, curve, work)
                for p in range(system.pulleys.size):
                    pulley = pulley_state(system, p, position[k], velocity[k])
                    if out_of_reach(piece.control, pulley):
                        continue
                    first, last = tooth_numbers(pulley.surface, piece)
                    for number in range(first, last):
                        if number < found.shape[1]:
                            found[k, number] += tooth_force(pulley.surface, piece, pulley, number, work.contact)


# Jumps: teeth on a pulley that change their grooves


class JumpWatch:
    """Watches the mean way of the teeth in mesh off the grooves in which they began, over successive states."""

    def __init__(self, system: System, along: FloatArray) -> None:
        assert isinstance(system.rims, ToothedRims)
        self._system, self._along, self._table = system, along, system.rims.table
        self._pulleys = toothed_pulleys(system)
        self._last = np.zeros(self._pulleys.size)
        self._held = np.zeros(self._pulleys.size, dtype=np.int64)
        self.events = list[tuple[float, int, int]]()
        """Times (s), numbers of pulleys, and grooves by which the belt went ahead or, negative, fell back."""

    def take(self, time: FloatArray, position: FloatArray, centers: FloatArray, places: FloatArray) -> None:
        """Look at k further states: centers of pulleys (k, P, 2) and places of contact points (k, points, 2), m."""
        for row, pulley in enumerate(self._pulleys.tolist()):
            self._follow(row, time, self._off(pulley, position, places - centers[:, None, pulley]))

    def _off(self, pulley: int, position: FloatArray, places: FloatArray) -> FloatArray:
        """Mean misfit of the teeth in grooves, or of the nearest ones, in pitches, -1/2 to 1/2; shape (k,)."""
        system, row = self._system, self._table[pulley]
        away = places[:, :, 0] ** 2 + places[:, :, 1] ** 2
        reach = system.rims.radius[pulley] + row.height
        nearest = np.min(away, axis=1, keepdims=True)
        state, point = np.nonzero(away <= np.maximum(reach**2, _BESIDE**2 * nearest))
        angle = row.phase + position[:, system.first_body + pulley] - row.rate * passed_lengths(system.frame, position)
        direction = np.arctan2(places[state, point, 1], places[state, point, 0])
        ahead = (angle[state] - direction + row.rate * self._along[point]) / row.groove
        size = len(position)
        mean = [np.bincount(state, one(_TURNS * ahead), size) for one in (np.cos, np.sin)]
        return np.asarray(np.arctan2(mean[1], mean[0]) / _TURNS)

    def _follow(self, row: int, time: FloatArray, off: FloatArray) -> None:
        """Go on with the misfits of a pulley."""
        sense = 1 if self._table.rate[self._pulleys[row]] > 0.0 else -1
        for number, here in enumerate(off.tolist()):
            self._last[row] += (here - self._last[row] + 0.5) % 1.0 - 0.5
            if abs(self._last[row] - self._held[row]) > _STICKS:
                change = int(np.sign(self._last[row] - self._held[row]))
                self._held[row] += change
                self.events.append((float(time[number]), int(self._pulleys[row]), -sense * change))

"""States of a system: the laid belt (the published start) and the straight one."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Path
from beltdyn.system.arrays import Motion, System
from beltdyn.system.discretization import nodal_coordinates, point_coordinates


@dataclass(frozen=True, eq=False)
class State:
    """Position, velocity and acceleration of a system: nodal coordinates (m and 1), then bodies (rad and m)."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray

    def at(self, time: float) -> Motion:
        """The same arrays as the motion at an instant (s)."""
        return Motion(time, self.position, self.velocity, self.acceleration)

    def nodes(self, system: System) -> FloatArray:
        """Nodal coordinates as an array of shape (N, n)."""
        return self.position[: system.first_body].reshape(system.nodes, -1)


def at_rest(system: System, coordinates: FloatArray) -> State:
    """A state at nodal coordinates of shape (N, n), without motion, bodies at zero."""
    count = coordinates.size + system.bodies.size
    position = np.zeros(count)
    position[: coordinates.size] = coordinates.ravel()
    return State(position, np.zeros(count), np.zeros(count))


def laid(system: System, path: Path, tensioners: FloatArray | None = None) -> State:
    """A closed belt laid on its path at uniform stretch, at rest, out of balance.

    Node 0 stands where the belt leaves the first pulley; r_x is the stretch times the unit tangent, r_y the unit
    normal. Tensioner coordinates (m or rad) are zero by default.
    """
    stretch = path.length / float(np.sum(system.length))
    along = stretch * point_coordinates(system)
    bend = stretch**2 * path.bend(along)
    nodes = nodal_coordinates(system, path.position(along), stretch * path.tangent(along), bend)
    state = at_rest(system, nodes)
    if tensioners is not None:
        state.position[state.position.size - tensioners.size :] = tensioners
    return state


def straight(system: System) -> State:
    """The undeformed belt along the x axis from the origin, at rest."""
    along = point_coordinates(system)
    flat = np.zeros_like(along)
    place, slope = np.stack([along, flat], axis=1), np.stack([flat + 1.0, flat], axis=1)
    return at_rest(system, nodal_coordinates(system, place, slope, np.zeros_like(slope)))


def crossing_time(system: System) -> float:
    """Time that an axial wave takes from one end of the belt to the other, s."""
    section = system.element.section
    return float(np.sum(system.length)) * float(np.sqrt(section.mass / section.axial))

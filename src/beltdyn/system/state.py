"""The belt's division into elements, and states of a system: the laid belt (the published start), the straight one."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements import ELEMENTS, Element, ElementKind, Section
from beltdyn.errors import ModelError
from beltdyn.model import Belt, Path
from beltdyn.quadrature import Quadrature, gauss_points, lobatto_points
from beltdyn.stretch import as_common
from beltdyn.system.arrays import Motion, System

_REDUCED = 3
"""Lobatto points of reduced integration: exact for the bending of a cubic, not for its stretching."""


class Discretization(NamedTuple):
    """Fields of `System` that depend on the kind of elements and on their lengths; see there."""

    element: Element
    points: int
    scale: tuple[float, ...]
    length: FloatArray
    mass: FloatArray
    vectors: tuple[int, ...]
    shift: tuple[float, ...]
    control: FloatArray
    turned: int


def discretize(belt: Belt, lengths: FloatArray | None = None) -> Discretization:
    """Divide a belt into elements of its kind, by default of equal lengths; ModelError if lengths do not add up."""
    kind, section = belt.element_kind, belt_section(belt)
    whole = belt.given_length
    length = (
        np.full(belt.given_elements, whole / belt.given_elements) if lengths is None else np.asarray(lengths, float)
    )
    if (
        belt.elements not in (None, length.size)
        or length.min() <= 0.0
        or not np.isclose(length.sum(), whole, rtol=1e-9)
    ):
        raise ModelError(
            f"{length.size} elements, the shortest {length.min():g} m long and {length.sum():.10g} m in "
            f"total, do not match belt.elements = {belt.elements} and belt.length = {whole:.10g} "
            "m. Give each element a positive length, with the belt length as their sum."
        )
    return Discretization(
        element=kind.element(section, _elastic_points(belt)),
        points=kind.points,
        scale=kind.scale(float(np.mean(length))),
        length=length,
        mass=np.ascontiguousarray(kind.mass(section, length)),
        vectors=kind.vectors,
        shift=kind.shift,
        control=np.ascontiguousarray(kind.control(length)),
        turned=kind.turned,
    )


def belt_section(belt: Belt) -> Section:
    """Stiffness, damping and inertia of a belt's section."""
    return Section(
        stretch=as_common(belt.stretch_parameters),
        bending=belt.bending_stiffness,
        quartic=belt.youngs_modulus * belt.fourth_moment * belt.bending_factor,
        shear=belt.shear_stiffness,
        shear_gradient=belt.shear_stiffness * belt.second_moment / belt.area,
        thickness=belt.youngs_modulus * belt.area,
        mass=belt.mass_per_length,
        rotary_inertia=belt.rotary_inertia,
        axial_damping=belt.axial_stiffness * belt.stretch_damping_time,
        bending_damping=belt.bending_stiffness * belt.bending_damping_time,
    )


def _elastic_points(belt: Belt) -> Quadrature:
    """Where the elastic forces of an element are evaluated."""
    return lobatto_points(_REDUCED) if belt.integration == "reduced" else gauss_points(belt.quadrature_points)


def element_kind(system: System) -> ElementKind:
    """Kind of the elements of a system."""
    return next(kind for kind in ELEMENTS.labelled.values() if kind.element is type(system.element))


def curve_lengths(system: System) -> FloatArray:
    """Reference lengths of the curves of the centerline along the belt, m, shape (elements * curves,)."""
    curves = system.control.shape[1]
    return np.repeat(system.length / curves, curves)


def point_coordinates(system: System) -> FloatArray:
    """Belt coordinates of the material points of all nodes in the unstretched belt, m, shape (N * points,)."""
    ends = np.concatenate([[0.0], np.cumsum(curve_lengths(system))])
    return ends[: system.nodes * system.points]


def nodal_coordinates(system: System, place: FloatArray, slope: FloatArray, bend: FloatArray) -> FloatArray:
    """Nodal coordinates, shape (N, n), of a curve r, dr/dx, d2r/dx2 at the material points, shape (N * points, 2)."""
    return element_kind(system).nodal(place, slope, bend)


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

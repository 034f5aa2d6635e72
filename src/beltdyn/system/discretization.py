"""How a belt is cut into elements."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements import ELEMENTS, Element, ElementKind, Section
from beltdyn.errors import ModelError
from beltdyn.model import Belt
from beltdyn.quadrature import Quadrature, gauss_points, lobatto_points
from beltdyn.stretch import as_common
from beltdyn.system.arrays import System

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
    if length.size != belt.given_elements or length.min() <= 0.0 or not np.isclose(length.sum(), whole, rtol=1e-9):
        raise ModelError(
            f"{length.size} elements, the shortest {length.min():g} m long and {length.sum():.10g} m in "
            f"total, do not match belt.elements = {belt.given_elements} and belt.length = {whole:.10g} "
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

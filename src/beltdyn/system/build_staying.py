"""Arrays of a drive on a staying mesh: quintic elements, contact at many points, and the frame of the mesh."""

from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.quintic import QUINTIC, Quintic
from beltdyn.model import Belt, Prepared
from beltdyn.model.hysteresis import bending_at_points, passing_strains
from beltdyn.records import records
from beltdyn.system.arc_mesh import arc_count, staying_by_arcs, with_own_mesh
from beltdyn.system.arrays import BODY, System
from beltdyn.system.build import nodal_supports, system_of, weight_forces
from beltdyn.system.build_machines import carrying_arrays, on_other_lengths
from beltdyn.system.discretization import discretize
from beltdyn.system.frame import FlowingByArcs, StayingByArcs, flowing, staying
from beltdyn.system.material_loss import hysteresis_rows
from beltdyn.system.meshing import meshing, on_lengths
from beltdyn.system.running_web import RunningWeb, running_web
from beltdyn.system.web import WebLine, web_line

_STAYING_ELASTIC, _STAYING_CONTACT = 8, 12
"""Gauss points of an element that stays, for elastic forces and for contact."""
HELD = ((0, 0), (0, 1), (-1, 0), (-1, 1))
"""Nodes and coordinates that the ends of a web line hold."""


def staying_system(prepared: Prepared, lengths: FloatArray) -> System:
    """Arrays of a closed belt or a web line on a staying mesh of quintic elements with hysteresis, without flow."""
    belt = _staying_belt(prepared, lengths.size)
    contact = prepared.contact.replace(sampling="distributed", integration="zone", quadrature_points=_STAYING_CONTACT)
    if prepared.ends:
        system = system_of(prepared, belt, contact, "open", lengths=lengths, fixed=HELD)
        return _as_web(prepared, system._replace(frame=staying(system.control, system.length, belt.mass_per_length)))
    system = system_of(prepared, belt, contact, "shared_node", lengths=lengths)
    if prepared.belt.bending_loss_factor > 0.0:
        modulus, length = bending_at_points(prepared)
        system = _with_section(system, bending_hysteresis=modulus, passing_length=length)
    frame = staying(system.control, system.length, belt.mass_per_length)
    return meshing(prepared, _carrying(prepared, system._replace(frame=frame)))


def _carrying(prepared: Prepared, system: System) -> System:
    """The same with supports and goods, on a mesh that stays at every arc; the one given without any."""
    if not prepared.carries:
        return system
    return staying_by_arcs(prepared, system._replace(carrying=carrying_arrays(prepared, system.length)))


def on_other_mesh(prepared: Prepared, system: System, lengths: FloatArray) -> System:
    """The arrays of `staying_system` on another mesh, with the same machines."""
    if prepared.ends:
        given = ("law", "profiles", "shaft_loads", "bodies", "tensioners")
        return staying_system(prepared, lengths)._replace(**{name: getattr(system, name) for name in given})
    belt = _staying_belt(prepared, lengths.size)
    mesh = discretize(belt, lengths)
    passing = passing_strains(prepared) if belt.has_hysteresis else None
    supports = nodal_supports(lengths.size, len(mesh.scale), (), (), ())
    other = system._replace(
        **mesh._asdict() | {"element": system.element},
        nodes=lengths.size,
        first_body=lengths.size * len(mesh.scale),
        hysteresis=hysteresis_rows(belt, mesh.length, mesh.control, passing),
        supports=supports._replace(force=weight_forces(mesh, lengths.size, prepared.gravity)),
        frame=staying(mesh.control, mesh.length, belt.mass_per_length),
        rims=on_lengths(system.rims, lengths),
        carrying=on_other_lengths(prepared, system.carrying, lengths),
    )
    return staying_by_arcs(prepared, other) if prepared.carries else other


def _as_web(prepared: Prepared, system: System) -> System:
    """The arrays of an open belt as those of a web line."""
    drive = prepared.drive
    assert drive.unwinder is not None
    assert drive.winder is not None
    orders = np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0])
    return web_line(system, np.array([drive.unwinder.tension, drive.winder.tension]), orders)


def _staying_belt(prepared: Prepared, elements: int) -> Belt:
    """The belt of a drive on a staying mesh; it has hysteresis of bending point by point, apart."""
    return prepared.belt.replace(
        discretization=QUINTIC.name,
        elements=elements,
        integration="full",
        quadrature_points=_STAYING_ELASTIC,
        bending_loss_factor=0.0,
    )


def without_hysteresis(system: System) -> System:
    """The same drive with a belt that follows its strains without hysteresis."""
    if isinstance(system.element, Quintic):
        system = with_bending_loss(system, 0.0)
    return system._replace(hysteresis=system.hysteresis[:0].view(np.recarray))


def with_bending_loss(system: System, factor: float) -> System:
    """The same drive with the hysteresis of bending on a staying mesh times a factor."""
    return _with_section(system, bending_hysteresis=factor * system.element.section.bending_hysteresis)


def loses_in_bending(system: System) -> bool:
    """Whether the belt has hysteresis of bending on a staying mesh."""
    return bool(system.element.section.bending_hysteresis > 0.0)


def _with_section(system: System, **numbers: Any) -> System:
    """The same arrays with other numbers of the section of their elements."""
    element = system.element
    assert isinstance(element, Quintic)
    return system._replace(element=Quintic(element.section._replace(**numbers), element.elastic))


def open_ended(prepared: Prepared, system: System) -> System:
    """The arrays of a web line whose ends have flows of their own, for equations over time; those of a belt."""
    return running_web(prepared, system) if isinstance(system.carriage, WebLine) else system


def flowing_system(system: System, direction: FloatArray) -> System:
    """The same drive for equations over time: lengths of belt that have passed are the last coordinates of the border.

    `direction` is the unit vector along the belt at node 0, which is held as a whole in a web line.
    """
    direction = np.zeros(2) if isinstance(system.carriage, RunningWeb) else direction
    at = system.bodies.size - system.tensioners.size
    last = int(np.max(system.bodies.unknown, initial=-1)) + 1
    given, more = system.frame, arc_count(system.frame)
    own = records(BODY, inertia=np.zeros(more + 1), unknown=last + np.arange(more + 1), reach=np.ones(more + 1))
    place = system.first_body + at + more
    if isinstance(given, StayingByArcs):
        frame: Any = FlowingByArcs(
            place, given.derivative.copy(), given.growth.copy(), given.inertia.copy(), direction, given.arcs
        )
        system = with_own_mesh(system)
    else:
        frame = flowing(given, system.mass, system.vectors, place, direction)
    bodies = np.concatenate([system.bodies[:at], own, system.bodies[at:]]).view(np.recarray)
    return system._replace(bodies=bodies, frame=frame)

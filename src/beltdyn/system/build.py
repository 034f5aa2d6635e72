"""From the model, which a user describes, to the arrays, on which the kernels work.

A staying mesh has quintic elements, contact at many points and the frame of the mesh.
"""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from beltdyn.arrays import FloatArray, records
from beltdyn.contact.friction import ForceSlope, as_common
from beltdyn.contact.law import ContactLaw
from beltdyn.contact.normal import NoPull
from beltdyn.contact.surface import KINDS, SHAPES, RoundRims, ShapedRims
from beltdyn.elements.quintic import Quintic
from beltdyn.errors import ModelError
from beltdyn.machines import Goods, Tensioner
from beltdyn.model import Belt, Contact, Path, Prepared, Pulley
from beltdyn.model.hysteresis import Passing, bending_at_points, passing_strains, rolling_resistances
from beltdyn.model.nip import beside_the_path, damping_ratios, foundations, has_losses, rim_ratios
from beltdyn.model.pulley import friction_on, surface_part
from beltdyn.model.routing import radii as effective_radii
from beltdyn.quadrature import Quadrature, gauss_points, lobatto_points
from beltdyn.system.arc_mesh import arc_count, staying_by_arcs, with_own_mesh
from beltdyn.system.arrays import BODY, NoCarriage, Supports, System
from beltdyn.system.build_machines import body_arrays, carrying_arrays, machine_arrays, on_other_lengths, pulley_arrays
from beltdyn.system.frame import FlowingByArcs, StayingByArcs, Travelling, flowing, staying
from beltdyn.system.guide import Guided, behind_flows, with_carriage
from beltdyn.system.material_loss import hysteresis_rows
from beltdyn.system.meshing import meshing, on_lengths, with_teeth
from beltdyn.system.running_web import running_web
from beltdyn.system.state import Discretization, discretize
from beltdyn.system.web import WebLine, web_ends, web_line

# Weight of the belt as nodal forces (gravity is not in the paper)


def weight_forces(mesh: Discretization, nodes: int, gravity: tuple[float, float]) -> FloatArray:
    """Generalized forces of uniform gravity, the integral of rho A S^T g over the belt, shape (n * nodes,).

    A uniform acceleration moves the material points alone, not the derivatives, so that the integral is the mass matrix
    of an element times g at its points. The last element of a closed belt ends at the first node.
    """
    dof = len(mesh.scale)
    node = np.zeros(dof)
    node[: 2 * mesh.points] = np.tile(gravity, mesh.points)
    by_element = mesh.mass @ np.tile(node, 2)
    force, element = np.zeros((nodes, dof)), np.arange(len(by_element))
    force[element] += by_element[:, :dof]
    force[(element + 1) % nodes] += by_element[:, dof:]
    return force.ravel()


Closure = Literal["shared_node", "multipliers", "open"]
"""How the ends of a belt meet: at one node (Eq. 27), by Lagrange multipliers (Eq. 25), or not at all."""


def drive_system(prepared: Prepared) -> System:
    """Arrays of a drive."""
    closure: Closure = "open" if prepared.ends else prepared.simulation.joint
    smooth = system_of(prepared, prepared.belt, prepared.contact, closure, **_at_ends(prepared))
    return with_carriage(prepared, with_teeth(prepared, smooth))


def system_of(prepared: Prepared, belt: Belt, contact: Contact, closure: Closure, **more: Any) -> System:
    """Arrays of a drive with a belt and a contact in place of its own; further arguments as for `belt_system`."""
    return belt_system(
        belt,
        prepared.pulleys,
        contact,
        closure,
        tensioners=prepared.tensioners,
        path=prepared.path,
        gravity=prepared.gravity,
        passing=passing_strains(prepared) if belt.has_hysteresis else None,
        rolling=rolling_resistances(prepared),
        goods=prepared.goods,
        **more,
    )


def belt_system(
    belt: Belt,
    pulleys: Sequence[Pulley] = (),
    contact: Contact | None = None,
    closure: Closure = "open",
    *,
    tensioners: Sequence[Tensioner] = (),
    path: Path | None = None,
    gravity: tuple[float, float] = (0.0, 0.0),
    lengths: FloatArray | None = None,
    fixed: Sequence[tuple[int, int]] = (),
    forces: Sequence[tuple[int, tuple[float, float]]] = (),
    moments: Sequence[tuple[int, float]] = (),
    masses: Sequence[tuple[int, float]] = (),
    passing: Passing | None = None,
    rolling: FloatArray | None = None,
    goods: Sequence[Goods] = (),
) -> System:
    """Arrays of any belt: closed or open, on pulleys or not, with nodes fixed, loaded or free.

    Parameters
    ----------
    belt
        The belt; an open one has one node more than elements, and so has one closed by multipliers.
    pulleys
        Pulleys in the plane.
    contact
        Contact constants; needed where there are pulleys.
    closure
        How the ends meet.
    tensioners
        What carries some of the pulleys.
    path
        The path around the pulleys; needed where there are tensioners.
    gravity
        Acceleration of gravity, m/s^2; the belt's weight joins the forces on the nodes.
    lengths : ndarray, shape (elements,), optional
        Reference lengths of the elements, m; by default they are equal.
    fixed
        Pairs (node, coordinate) that do not move; coordinates 0 to 5 of the paper's element are r, r_x, r_y (Eq. 6).
    forces
        Pairs (node, force), N.
    moments
        Pairs (node, moment), N m, counter-clockwise positive; a moment turns a vector of its node, the section
        r_y of the paper's element.
    masses
        Pairs (end, mass), kg: what moves with the first (0) or the last (-1) node of an open belt.
    passing
        How strains pass along a belt with loss factors; see `hysteresis_rows`.
    rolling : ndarray, shape (pulleys,), optional
        Coefficients of rolling resistance; by default there is none.
    goods
        Goods on spans, whose schedules are among the profiles.

    Returns
    -------
    System
        The arrays, with read-only content.

    Raises
    ------
    ModelError
        If there are pulleys but no contact, or the kind of elements has no ends to leave open or nothing that a moment
        turns, or the lengths do not make the belt.
    """
    if pulleys and contact is None:
        raise ModelError("contact is missing: a belt on pulleys needs it. Give a Contact.")
    if not belt.element_kind.has_ends and closure != "shared_node":
        raise ModelError(
            f'closure = "{closure}" does not apply to belt.discretization = "{belt.discretization}", which '
            'would leave the last point of an open belt fixed. Choose closure = "shared_node", or '
            'discretization = "ancf".'
        )
    if moments and belt.element_kind.turned < 0:
        raise ModelError(
            f'moments do not apply to belt.discretization = "{belt.discretization}", whose nodes have no '
            'rotation. Omit them, or choose discretization = "ancf".'
        )
    mesh = discretize(belt, lengths)
    _attach(mesh.mass, masses)
    elements = mesh.length.size
    nodes = elements if closure == "shared_node" else elements + 1
    radii = effective_radii(pulleys, belt)
    frictions = [friction_on(pulley, belt, contact) for pulley in pulleys] if contact else []
    machines = machine_arrays(pulleys, tensioners, path, gravity, goods)
    resistances = np.zeros(len(pulleys)) if rolling is None else rolling
    shafts = pulley_arrays(pulleys, radii, frictions, resistances, machines.tensioners)
    if contact is not None:
        shafts["foundation"] = foundations(pulleys, belt, contact.given("stiffness"))
        shafts["cord"] = [contact.slip_radius == "cord" and pulley.teeth is None for pulley in pulleys]
    if path is not None and path.nips:
        shafts["rim_ratio"] = rim_ratios(path.nips, pulleys, radii)
        shafts["damping"] = damping_ratios(path, pulleys, belt, contact)
        shafts["lossy"] = has_losses(pulleys, belt) * np.isin(np.arange(len(pulleys)), path.nips)
        if contact is not None:
            for name, values in beside_the_path(path, pulleys, belt, contact.given("stiffness")).items():
                shafts[name] = values
        shafts["beside"][list(path.beside)] = 1
    bodies = body_arrays(pulleys, radii, tensioners)
    supports = nodal_supports(nodes, len(mesh.scale), fixed, forces, moments)
    return System(
        nodes=nodes,
        closed=closure == "shared_node",
        joint=closure == "multipliers",
        first_body=nodes * len(mesh.scale),
        **mesh._asdict(),
        hysteresis=hysteresis_rows(belt, mesh.length, mesh.control, passing),
        law=_contact_law(contact),
        contact=contact_points(contact),
        pulleys=shafts,
        rims=_rims(pulleys, radii),
        bodies=bodies,
        **machines._asdict(),
        supports=supports._replace(force=supports.force + weight_forces(mesh, nodes, gravity)),
        frame=Travelling(),
    )


def contact_points(contact: Contact | None) -> Quadrature:
    """Where contact is evaluated on a curve of the centerline: at Gauss points, or at its ends alone."""
    if contact is None:
        return gauss_points(1)
    if contact.sampling == "nodal":
        return lobatto_points(2)
    return gauss_points(contact.quadrature_points)


def _contact_law(contact: Contact | None) -> ContactLaw:
    """Laws of contact; some that are never used where there is none."""
    if contact is None:
        return ContactLaw(NoPull(1.0, 0.0), as_common(ForceSlope(1.0)), True)
    return ContactLaw(
        normal=contact.normal_parameters,
        friction=as_common(contact.friction_parameters),
        follow_zone=contact.sampling == "distributed" and contact.integration == "zone",
        arm_to_rim=contact.moment_arm == "rim",
    )


def _rims(pulleys: Sequence[Pulley], radii: FloatArray) -> RoundRims | ShapedRims:
    """Surfaces of the pulleys."""
    surfaces = [pulley.surface or surface_part(KINDS["circle"])() for pulley in pulleys]
    if all(surface.kind == "circle" for surface in surfaces):
        return RoundRims(radii)
    kinds = [KINDS[surface.kind] for surface in surfaces]
    table = records(SHAPES.row_type(kinds), reach=[surface.reach for surface in surfaces])
    for row, kind, surface in zip(table, kinds, surfaces, strict=True):
        SHAPES.fill(row, kind, surface.parameters)
    return ShapedRims(radii, table)


def _at_ends(prepared: Prepared) -> dict[str, Any]:
    """Keywords of `belt_system` for the ends of an open belt."""
    ends, turned = tuple(zip((0, -1), prepared.ends, strict=False)), prepared.element_kind.turned
    held = [(node, c) for node, end in ends if end.held for c in (0, 1)]
    clamped = [(node, turned + c) for node, end in ends if end.turning_held for c in (0, 1)]
    return {
        "fixed": held + clamped,
        "forces": [(node, end.force) for node, end in ends],
        "masses": [(node, end.attached_mass) for node, end in ends],
    }


def _attach(mass: FloatArray, attached: Sequence[tuple[int, float]]) -> None:
    """Add masses at ends of the belt to the mass matrices of the elements there, shape (elements, 2 n, 2 n)."""
    second = mass.shape[-1] // 2
    for end, value in attached:
        for row in np.arange(2) + (0 if end == 0 else second):
            mass[end, row, row] += value


def nodal_supports(
    nodes: int,
    dof: int,
    fixed: Sequence[tuple[int, int]],
    forces: Sequence[tuple[int, tuple[float, float]]],
    moments: Sequence[tuple[int, float]],
) -> Supports:
    """Supports and nodal loads as full vectors; negative node numbers count from the end."""
    held = np.zeros((nodes, dof), dtype=bool)
    force = np.zeros((nodes, dof))
    moment = np.zeros(nodes)
    for node, coordinate in fixed:
        held[node, coordinate] = True
    for node, pair in forces:
        force[node, :2] += pair
    for node, value in moments:
        moment[node] += value
    return Supports(held.ravel(), bool(held.any()), force.ravel(), moment)


HELD = ((0, 0), (0, 1), (-1, 0), (-1, 1))
"""Nodes and coordinates that the ends of a web line hold."""


def staying_system(prepared: Prepared, lengths: FloatArray) -> System:
    """Arrays of a drive on a staying mesh of quintic elements with hysteresis, without flow."""
    if prepared.carriage is not None:
        return axis_by_arcs(prepared, axis_system(prepared, lengths))
    belt, contact = prepared.on_staying_mesh
    if prepared.ends:
        system = system_of(prepared, belt, contact, "open", lengths=lengths, fixed=HELD)
        return _as_web(prepared, system._replace(frame=staying(system.control, system.length, belt.mass_per_length)))
    system = system_of(prepared, belt, contact, "shared_node", lengths=lengths)
    system = _losing_at_points(prepared, system)
    frame = staying(system.control, system.length, belt.mass_per_length)
    return meshing(prepared, _carrying(prepared, system._replace(frame=frame)))


def axis_system(prepared: Prepared, lengths: FloatArray) -> System:
    """Arrays of an axis on the elements of a staying mesh, whose nodes are material points yet."""
    belt, contact = prepared.on_staying_mesh
    smooth = system_of(prepared, belt, contact, "open", lengths=lengths, **_at_ends(prepared))
    return with_carriage(prepared, with_teeth(prepared, _losing_at_points(prepared, smooth)))


def axis_by_arcs(prepared: Prepared, system: System) -> System:
    """The same axis on a mesh that stays at every arc."""
    frame = staying(system.control, system.length, prepared.belt.mass_per_length)
    return staying_by_arcs(prepared, system._replace(frame=frame))


def _carrying(prepared: Prepared, system: System) -> System:
    """The same with supports and goods, on a mesh that stays at every arc; the one given without any."""
    if not prepared.carries:
        return system
    return staying_by_arcs(prepared, system._replace(carrying=carrying_arrays(prepared, system.length)))


def on_other_mesh(prepared: Prepared, system: System, lengths: FloatArray) -> System:
    """The arrays of `staying_system` on another mesh, with the same machines."""
    if prepared.ends:
        given = ("law", "profiles", "shaft_loads", "bodies", "tensioners")
        other = staying_system(prepared, lengths)._replace(**{name: getattr(system, name) for name in given})
        return other._replace(carriage=other.carriage._replace(ends=system.carriage.ends))
    belt, _ = prepared.on_staying_mesh
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
    return web_line(system, web_ends(prepared), np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0]))


def _losing_at_points(prepared: Prepared, system: System) -> System:
    """The same drive on a staying mesh with the hysteresis of bending of its belt, if it has any."""
    if prepared.belt.bending_loss_factor == 0.0:
        return system
    modulus, length = bending_at_points(prepared)
    return _with_section(system, bending_hysteresis=modulus, passing_length=length)


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

    `direction` is the unit vector along the belt at node 0, which is held as a whole in a web line and on a carriage.
    """
    direction = direction if isinstance(system.carriage, NoCarriage) else np.zeros(2)
    at = flow_place(system)
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
    return system._replace(bodies=bodies, frame=frame, carriage=behind_flows(system.carriage, more + 1))


def flow_place(system: System) -> int:
    """Number of the body before which lengths of belt that have passed stand: a tensioner, or the carriage."""
    return int(system.bodies.size - system.tensioners.size - isinstance(system.carriage, Guided))

"""How belts are cut: unknowns, masses and curves by hand, laid belts on their path, forces against energies."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import combine, fill_bernstein
from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive, Path
from beltdyn.quadrature import gauss_points, lobatto_points
from beltdyn.system.arrays import System
from beltdyn.system.assembly import assemble, fill_control
from beltdyn.system.build import Closure, belt_section, belt_system, drive_system
from beltdyn.system.discretization import curve_lengths, discretize, nodal_coordinates, point_coordinates
from beltdyn.system.motion import new_equations, no_multipliers
from beltdyn.system.observe import observe
from beltdyn.system.state import laid

Make = Callable[..., Drive]
CHAINS = {"truss": 1, "three-node-beam": 2}
"""Links of an element."""
EXACT = 1e-12


def chain(drive: Drive, discretization: str, elements: int) -> Belt:
    return drive.belt.replace(discretization=discretization, elements=elements)


@pytest.mark.parametrize("kind", CHAINS)
def test_unknowns(drive: Drive, kind: str) -> None:
    """Two for each end of a link, and nothing else."""
    belt = chain(drive, kind, 12)
    system = belt_system(belt, closure="shared_node")
    links = CHAINS[kind] * 12
    assert belt.links == links
    assert system.nodes * len(system.scale) == 2 * links
    assert system.points * system.nodes == links


@pytest.mark.parametrize("kind", CHAINS)
def test_fields_of_a_chain(drive: Drive, kind: str) -> None:
    belt = chain(drive, kind, 12)
    mesh, links = discretize(belt, belt_section(belt)), belt.links
    assert mesh.chain
    assert mesh.points == mesh.control.shape[1] == 3
    np.testing.assert_array_equal(mesh.scale, np.ones(6))
    np.testing.assert_allclose(mesh.length, 3 * belt.length / links)
    np.testing.assert_allclose(np.trace(mesh.mass, axis1=1, axis2=2).sum(), 2 * belt.mass_per_length * belt.length)


def test_fields_of_the_papers_element(drive: Drive) -> None:
    mesh, length = discretize(drive.belt, belt_section(drive.belt)), drive.belt.length / 20
    assert not mesh.chain
    assert (mesh.points, mesh.control.shape) == (1, (20, 1, 4, 4))
    np.testing.assert_allclose(mesh.scale, [1.0, 1.0, length, length, length, length])


@pytest.mark.parametrize(("kind", "resists"), [("ancf", True), ("truss", False), ("three-node-beam", True)])
def test_bending_stiffness(drive: Drive, kind: str, resists: bool) -> None:
    section = belt_section(chain(drive, kind, 12))
    assert section.bending == (drive.belt.bending_stiffness if resists else 0.0)
    assert section.axial == drive.belt.axial_stiffness


def test_curves_are_the_links(drive: Drive) -> None:
    system = belt_system(chain(drive, "truss", 9), closure="shared_node")
    corners = np.random.default_rng(0).normal(size=(6, 2))
    control = np.empty((4, 2))
    for link in range(3):
        fill_control(system, 1, link, corners.ravel(), control)
        weights = np.empty(len(control))
        for xi in (0.0, 0.3, 1.0):
            expected = (1.0 - xi) * corners[link] + xi * corners[link + 1]
            fill_bernstein(xi, weights)
            np.testing.assert_allclose(combine(control, weights), expected, atol=EXACT)


@pytest.mark.parametrize(("kind", "curves"), [("ancf", 12), ("truss", 12), ("three-node-beam", 24)])
def test_lengths_and_points(drive: Drive, kind: str, curves: int) -> None:
    length = drive.belt.length / curves
    system = belt_system(chain(drive, kind, 12), closure="shared_node")
    np.testing.assert_allclose(curve_lengths(system), np.full(curves, length))
    np.testing.assert_allclose(point_coordinates(system), length * np.arange(curves), atol=EXACT)


@pytest.mark.parametrize("kind", CHAINS)
def test_laid_belt_lies_on_its_path(drive: Drive, kind: str) -> None:
    belt = chain(drive, kind, 24)
    system = belt_system(belt, drive.pulleys, drive.contact, "shared_node")
    state = laid(system, drive.path)
    along = drive.path.length / belt.links * np.arange(belt.links)
    np.testing.assert_allclose(state.nodes(system).reshape(-1, 2), drive.path.position(along), atol=EXACT)
    np.testing.assert_array_equal(state.position[-2:], 0.0)


@pytest.mark.parametrize("closure", ["open", "multipliers"])
def test_chains_are_closed_by_a_shared_node(drive: Drive, closure: Closure) -> None:
    with pytest.raises(
        ModelError, match=f'closure = "{closure}" does not fit.*"truss".*Choose closure = "shared_node"'
    ):
        belt_system(chain(drive, "truss", 12), closure=closure)


def test_sections_stand_upright(drive: Drive) -> None:
    system = belt_system(drive.belt.replace(elements=3), closure="shared_node")
    slope = np.array([[1.1, 0.0], [0.0, 0.9], [3.0, 4.0]])
    nodes = nodal_coordinates(system, np.zeros((3, 2)), slope)
    np.testing.assert_array_equal(nodes[:, 2:4], slope)
    np.testing.assert_allclose(nodes[:, 4:], [[0.0, 1.0], [-1.0, 0.0], [-0.8, 0.6]], atol=EXACT)


@pytest.mark.parametrize("kind", ["ancf", *CHAINS])
def test_contact_points(make_drive: Make, kind: str) -> None:
    by_points = drive_system(make_drive("force_slope", "zone", discretization=kind))
    by_nodes = drive_system(make_drive("force_slope", "nodal", discretization=kind))
    assert by_points.law.follow_zone
    assert not by_nodes.law.follow_zone
    np.testing.assert_array_equal(by_points.contact, gauss_points(5))
    np.testing.assert_array_equal(by_nodes.contact, lobatto_points(2))


@pytest.mark.parametrize("places", ["fixed", "nodal"])
@pytest.mark.parametrize("kind", ["ancf", *CHAINS])
def test_forces_at_rest_are_the_slope_of_the_energies(make_drive: Make, kind: str, places: str) -> None:
    """Elasticity and penalty contact of a belt that is pushed 0.4 mm into its pulleys and disturbed by 0.1 mm."""
    system = drive_system(make_drive("force_slope", places, discretization=kind))
    sunk = laid(system, Path(system.pulleys.center, system.pulleys.radius - 4e-4)).position
    metre = np.concatenate([np.tile(1.0 / np.array(system.scale), system.nodes), np.ones(2)])
    sunk += 1e-4 * np.random.default_rng(3).normal(size=sunk.size) * metre

    def energy(position: FloatArray) -> float:
        seen = observe(system, np.zeros(1), position[None], np.zeros((1, position.size)))
        return float(seen.strain_energy[0] + seen.penalty_energy[0])

    step = 1e-8
    moves = step * np.diag(metre)[: system.first_body]
    slopes = np.array([energy(sunk + move) - energy(sunk - move) for move in moves]) / (2.0 * step)
    by_metre = forces(system, sunk) * metre[: system.first_body]
    rounding = 1e-6 * np.max(np.abs(by_metre))  # of energies of some joules in steps of 1e-8 m
    np.testing.assert_allclose(by_metre, slopes, atol=rounding)


def forces(system: System, position: FloatArray) -> FloatArray:
    """Residual of the belt at rest, shape (6 N,)."""
    equations, still = new_equations(system), np.zeros_like(position)
    assemble(
        system,
        0.0,
        position,
        still,
        still,
        no_multipliers(system),
        0.0,
        0.0,
        0.0,
        equations.work,
        equations.matrix,
        equations.loads,
    )
    assert np.max(equations.loads.stored) > 0.0
    return np.asarray(equations.matrix.node_side).ravel()

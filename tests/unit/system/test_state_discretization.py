"""How belts are cut: unknowns, masses and curves by hand, laid belts on their path, forces against energies."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive, Path, prepare
from beltdyn.quadrature import gauss_points, lobatto_points
from beltdyn.system.arrays import NO_TANGENT, Motion, System
from beltdyn.system.build import Closure, belt_system, drive_system
from beltdyn.system.element_state import fill_control
from beltdyn.system.first_order import mass_matrix
from beltdyn.system.observe import observe
from beltdyn.system.state import curve_lengths, discretize, laid, nodal_coordinates, point_coordinates
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers

Make = Callable[..., Drive]
LINKS = {"truss": 1, "three-node-beam": 2}
"""Links of an element."""
EXACT = 1e-12


def cut(drive: Drive, discretization: str, elements: int) -> Belt:
    return drive.belt.replace(discretization=discretization, elements=elements)


@pytest.mark.parametrize("kind", LINKS)
def test_unknowns(drive: Drive, kind: str) -> None:
    """Two for each end of a link, and nothing else."""
    system = belt_system(cut(drive, kind, 12), closure="shared_node")
    links = LINKS[kind] * 12
    assert system.first_body == 2 * links
    assert system.points * system.nodes == links


@pytest.mark.parametrize("kind", LINKS)
def test_fields_of_links(drive: Drive, kind: str) -> None:
    belt = cut(drive, kind, 12)
    mesh, links = discretize(belt), LINKS[kind]
    assert mesh.points == mesh.control.shape[1] == links
    assert mesh.scale == (1.0,) * (2 * links)
    np.testing.assert_allclose(mesh.length, belt.given_length / 12)
    np.testing.assert_allclose(
        np.trace(mesh.mass, axis1=1, axis2=2).sum(), 2 * belt.mass_per_length * belt.given_length
    )


def test_fields_of_the_papers_element(drive: Drive) -> None:
    mesh, length = discretize(drive.belt), drive.belt_length / 20
    assert (mesh.points, mesh.control.shape) == (1, (20, 1, 4, 4))
    np.testing.assert_allclose(mesh.scale, [1.0, 1.0, length, length, length, length])


@pytest.mark.parametrize("kind", LINKS)
def test_curves_are_the_links(drive: Drive, kind: str) -> None:
    system, links = belt_system(cut(drive, kind, 9), closure="shared_node"), LINKS[kind]
    corners = np.random.default_rng(0).normal(size=(2 * links, 2))
    control = np.empty((2, 2))
    for link in range(links):
        fill_control(system, 1, link, corners.ravel(), control)
        np.testing.assert_array_equal(control, corners[link : link + 2])


@pytest.mark.parametrize(("kind", "curves"), [("ancf", 12), ("truss", 12), ("three-node-beam", 24)])
def test_lengths_and_points(drive: Drive, kind: str, curves: int) -> None:
    length = drive.belt_length / curves
    system = belt_system(cut(drive, kind, 12), closure="shared_node")
    np.testing.assert_allclose(curve_lengths(system), np.full(curves, length))
    np.testing.assert_allclose(point_coordinates(system), length * np.arange(curves), atol=EXACT)


def test_lengths_as_given(drive: Drive) -> None:
    belt = cut(drive, "truss", 4)
    lengths = belt.given_length * np.array([0.1, 0.2, 0.3, 0.4])
    system = belt_system(belt, closure="shared_node", lengths=lengths)
    np.testing.assert_array_equal(system.length, lengths)
    np.testing.assert_allclose(
        point_coordinates(system), belt.given_length * np.array([0.0, 0.1, 0.3, 0.6]), atol=EXACT
    )
    np.testing.assert_allclose(system.mass[:, 0, 0], 0.5 * belt.mass_per_length * lengths)


@pytest.mark.parametrize("shares", [[0.3, 0.3, 0.4], [0.1, 0.2, 0.3, 0.5], [-0.1, 0.4, 0.3, 0.4]])
def test_lengths_must_make_the_belt(drive: Drive, shares: list[float]) -> None:
    belt = cut(drive, "truss", 4)
    with pytest.raises(ModelError, match=r"do not match belt\.elements = 4 .* Give each element a positive"):
        discretize(belt, belt.given_length * np.array(shares))


@pytest.mark.parametrize("kind", LINKS)
def test_laid_belt_lies_on_its_path(drive: Drive, kind: str) -> None:
    belt = cut(drive, kind, 24)
    system = belt_system(belt, drive.pulleys, drive.contact, "shared_node")
    state = laid(system, drive.path)
    links = LINKS[kind] * 24
    along = drive.path.length / links * np.arange(links)
    np.testing.assert_allclose(state.nodes(system).reshape(-1, 2), drive.path.position(along), atol=EXACT)
    np.testing.assert_array_equal(state.position[-2:], 0.0)


@pytest.mark.parametrize("closure", ["open", "multipliers"])
def test_three_node_beams_are_closed_by_a_shared_node(drive: Drive, closure: Closure) -> None:
    with pytest.raises(
        ModelError, match=f'closure = "{closure}" does not apply to.*"three-node-beam".*Choose closure = "shared_node"'
    ):
        belt_system(cut(drive, "three-node-beam", 12), closure=closure)


def test_an_open_truss_hangs_on_its_points(drive: Drive) -> None:
    """One point more than links, each end with half a link's mass."""
    system = belt_system(cut(drive, "truss", 12), closure="open")
    assert (system.nodes, system.first_body) == (13, 26)
    masses = np.diag(mass_matrix(system))[::2] / (drive.belt.mass_per_length * drive.belt_length / 12)
    np.testing.assert_allclose(masses, [0.5, *np.ones(11), 0.5])


def test_moments_need_something_that_turns(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r'moments do not apply to.*"truss".*choose discretization = "ancf"'):
        belt_system(cut(drive, "truss", 12), moments=[(3, 1.0)])


def test_sections_stand_upright(drive: Drive) -> None:
    system = belt_system(drive.belt.replace(elements=3), closure="shared_node")
    slope = np.array([[1.1, 0.0], [0.0, 0.9], [3.0, 4.0]])
    nodes = nodal_coordinates(system, np.zeros((3, 2)), slope, np.zeros((3, 2)))
    np.testing.assert_array_equal(nodes[:, 2:4], slope)
    np.testing.assert_allclose(nodes[:, 4:], [[0.0, 1.0], [-1.0, 0.0], [-0.8, 0.6]], atol=EXACT)


@pytest.mark.parametrize("kind", ["ancf", *LINKS])
def test_contact_points(make_drive: Make, kind: str) -> None:
    by_points = drive_system(prepare(make_drive("force_slope", "zone", discretization=kind)))
    by_nodes = drive_system(prepare(make_drive("force_slope", "nodal", discretization=kind)))
    assert by_points.law.follow_zone
    assert not by_nodes.law.follow_zone
    np.testing.assert_array_equal(by_points.contact, gauss_points(5))
    np.testing.assert_array_equal(by_nodes.contact, lobatto_points(2))


@pytest.mark.parametrize("places", ["fixed", "nodal"])
@pytest.mark.parametrize(
    "kind", ["ancf", *(pytest.param(one, marks=pytest.mark.slow) for one in ("truss", "three-node-beam"))]
)
def test_forces_at_rest_are_the_slope_of_the_energies(make_drive: Make, kind: str, places: str) -> None:
    """Elasticity and penalty contact of a belt that is pushed 0.4 mm into its pulleys and disturbed by 0.1 mm."""
    system = drive_system(prepare(make_drive("force_slope", places, discretization=kind)))
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
    assemble(system, Motion(0.0, position, still, still), no_multipliers(system), NO_TANGENT, equations)
    assert np.max(equations.forces.stored) > 0.0
    return np.asarray(equations.matrix.node_side).ravel()

from dataclasses import dataclass

import numpy as np
import pytest

from beltdyn.model import Belt, Drive
from beltdyn.system.build import Closure, belt_system, weight_forces
from beltdyn.system.state import Discretization, discretize

GRAVITY = (3.0, -9.0)


@dataclass
class Mesh:
    belt: Belt
    mesh: Discretization
    nodes: int

    @property
    def force(self) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        return weight_forces(self.mesh, self.nodes, GRAVITY).reshape(self.nodes, -1)


@pytest.fixture(
    params=[("ancf", "shared_node"), ("ancf", "open"), ("truss", "open"), ("three-node-beam", "shared_node")]
)
def heavy(request: pytest.FixtureRequest, drive: Drive) -> Mesh:
    kind, closure = request.param
    belt = drive.belt.replace(elements=12, discretization=kind)
    mesh = discretize(belt)
    return Mesh(belt, mesh, mesh.length.size + (closure == "open"))


def test_all_weight_is_there(heavy: Mesh) -> None:
    """Work under a translation: the sum over the material points is mass times g."""
    total = heavy.force[:, : 2 * heavy.mesh.points].reshape(-1, 2).sum(axis=0)
    np.testing.assert_allclose(
        total, heavy.belt.mass_per_length * heavy.belt.given_length * np.array(GRAVITY), rtol=1e-14
    )


@pytest.mark.parametrize("closure", ["shared_node", "open", "multipliers"])
def test_work_on_any_centreline(drive: Drive, closure: Closure) -> None:
    """Force times coordinates is the integral of rho A g . r along cubic curves, here by ten Gauss points."""
    system = belt_system(drive.belt, closure=closure)
    mesh = discretize(drive.belt)
    coordinates = np.random.default_rng(1).normal(size=(system.nodes, 6))
    points, weights = np.polynomial.legendre.leggauss(10)
    xi = 0.5 * (points + 1.0)
    work = 0.0
    for element, length in enumerate(system.length):
        i, j = coordinates[element], coordinates[(element + 1) % system.nodes]
        place = np.outer(1 - 3 * xi**2 + 2 * xi**3, i[:2]) + np.outer(3 * xi**2 - 2 * xi**3, j[:2])
        place += length * (np.outer(xi - 2 * xi**2 + xi**3, i[2:4]) + np.outer(xi**3 - xi**2, j[2:4]))
        work += 0.5 * length * drive.belt.mass_per_length * weights @ place @ np.array(GRAVITY)
    force = weight_forces(mesh, system.nodes, GRAVITY)
    assert force @ coordinates.ravel() == pytest.approx(work, rel=1e-12)


def test_gradients_of_a_closed_belt_feel_nothing(drive: Drive) -> None:
    """Equal elements pull on r_x of the node between them alike, against each other; r_y feels nothing anywhere."""
    mesh = discretize(drive.belt)
    force = weight_forces(mesh, drive.elements, GRAVITY).reshape(-1, 6)
    np.testing.assert_allclose(force[:, 2:], 0.0, atol=1e-15 * np.abs(force).max())


def test_a_truss_carries_its_weight_at_its_points(drive: Drive) -> None:
    belt = drive.belt.replace(elements=12, discretization="truss")
    mesh = discretize(belt)
    force = weight_forces(mesh, 12, GRAVITY).reshape(-1, 2)
    each = belt.mass_per_length * belt.given_length / 12 * np.array(GRAVITY)
    np.testing.assert_allclose(force, np.tile(each, (12, 1)), rtol=1e-14)

"""The constant matrices of Eqs. 25 and 26 against the bordered system that they eliminate."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.first_order import joint_constraint, mass_matrix

ROUNDING = 1e-9
"""Relative; the mass matrix has a condition number near 1e6."""


@pytest.fixture(scope="module")
def tied(drive: Drive) -> System:
    return belt_system(drive.belt, closure="multipliers")


def test_eliminates_the_multipliers_of_equation_25(tied: System) -> None:
    mass, brackets = mass_matrix(tied), joint_constraint(tied)
    jacobian = brackets.jacobian
    bordered = np.block([[mass, jacobian.T], [jacobian, np.zeros((6, 6))]])
    force, constraint = np.random.default_rng(0).normal(size=len(mass)), np.arange(6.0)
    expected = np.linalg.solve(bordered, np.concatenate([force, constraint]))[: len(mass)]
    found = brackets.accelerations(force, constraint)
    np.testing.assert_allclose(found, expected, atol=ROUNDING * np.max(np.abs(expected)))


def test_joined_nodes_accelerate_alike(tied: System) -> None:
    nodes = joint_constraint(tied).accelerations(np.random.default_rng(1).normal(size=tied.first_body)).reshape(-1, 6)
    np.testing.assert_allclose(nodes[0], nodes[-1], atol=ROUNDING * np.max(np.abs(nodes)))


@pytest.mark.parametrize("closure", ["multipliers", "open", "shared_node"])
def test_mass_matrix_holds_the_mass_of_the_belt(drive: Drive, closure: str) -> None:
    system = belt_system(drive.belt, closure=closure)  # type: ignore[arg-type]
    mass = mass_matrix(system)
    shift = np.tile([1.0, 0, 0, 0, 0, 0], system.nodes)
    assert shift @ mass @ shift == pytest.approx(drive.belt.mass_per_length * drive.belt_length, rel=1e-12)
    np.testing.assert_allclose(mass, mass.T, atol=0)


def test_a_belt_without_joint_is_refused(drive: Drive) -> None:
    with pytest.raises(ModelError, match="multipliers"):
        joint_constraint(belt_system(drive.belt))

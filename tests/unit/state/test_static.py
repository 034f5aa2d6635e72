from typing import Literal

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, prepare
from beltdyn.state.installation import drawn_in
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.state import belt_section, laid, straight

SECTION_HELD = [(0, 0), (0, 1), (0, 4), (0, 5)]


@pytest.fixture
def cantilever(drive: Drive) -> System:
    """A belt held at one end and bent to some 30 degrees by a moment at the other."""
    moment = 0.5 * drive.belt.bending_stiffness / drive.belt_length
    return belt_system(drive.belt, fixed=SECTION_HELD, moments=[(-1, moment)])


@pytest.mark.parametrize("method", ["globalized", "newton"])
def test_a_result_tells_its_way(cantilever: System, method: Literal["globalized", "newton"]) -> None:
    start = straight(cantilever)
    before = start.position.copy()
    found = find_equilibrium(cantilever, start, method=method)
    np.testing.assert_array_equal(start.position, before)
    np.testing.assert_array_equal(found.iterates[0], start.nodes(cantilever))
    np.testing.assert_array_equal(found.iterates[-1], found.state.nodes(cantilever))
    assert len(found.iterates) - 1 == len(found.norms) == found.iterations
    assert found.norms[-1] < 1e-11
    assert not found.state.velocity.any()


def test_a_positive_moment_turns_the_tip_counter_clockwise(cantilever: System) -> None:
    tip = find_equilibrium(cantilever, straight(cantilever)).state.nodes(cantilever)[-1]
    assert np.arctan2(tip[3], tip[2]) == pytest.approx(0.5, rel=1e-3)  # the belt is 1 % as thick as long
    assert tip[1] > 0.0


def test_a_pull_stretches_by_p_over_ea(drive: Drive) -> None:
    section = belt_section(drive.belt)
    system = belt_system(drive.belt, fixed=SECTION_HELD, forces=[(-1, (1e-5 * section.axial, 0.0))])
    tip = find_equilibrium(system, straight(system)).state.nodes(system)[-1]
    assert tip[0] / drive.belt_length - 1.0 == pytest.approx(1e-5, rel=1e-4)  # the strain is Green's


def test_fixed_coordinates_stay(drive: Drive) -> None:
    system = belt_system(drive.belt, fixed=SECTION_HELD, forces=[(-1, (0.0, 0.1))])
    found = find_equilibrium(system, straight(system))
    np.testing.assert_array_equal(found.iterates[:, 0, [0, 1, 4, 5]], [[0.0, 0.0, 0.0, 1.0]] * len(found.iterates))


def test_equilibrium_is_left_alone(cantilever: System) -> None:
    first = find_equilibrium(cantilever, straight(cantilever))
    again = find_equilibrium(cantilever, first.state)
    assert again.iterations == 1
    np.testing.assert_allclose(again.state.position, first.state.position, atol=1e-9)


def test_pulleys_stand_still(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    found = find_equilibrium(system, laid(system, drawn_in(prepare(drive), 1.0)))
    np.testing.assert_array_equal(found.state.position[-2:], 0.0)


def test_too_few_iterations_say_so(cantilever: System) -> None:
    with pytest.raises(
        ConvergenceError, match=r"no static equilibrium found: .* after 2 iterations.* increase belt.elements"
    ):
        find_equilibrium(cantilever, straight(cantilever), max_iterations=2)


def test_a_belt_on_the_loose_has_no_equilibrium(drive: Drive) -> None:
    system = belt_system(drive.belt, forces=[(-1, (1.0, 0.0))])
    with pytest.raises(ConvergenceError, match="no static equilibrium found"):
        find_equilibrium(system, straight(system), max_iterations=50)

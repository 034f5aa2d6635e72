from typing import Literal

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles.functions import profile_value
from beltdyn.model import Drive, prepare
from beltdyn.state.installation import drawn_in
from beltdyn.state.static import _Search, find_equilibrium, standing, tensioner_compliance
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.state import belt_section, laid, straight
from tests.unit.vibration.test_small_motions import loose

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


def test_forces_out_of_balance_are_measured_by_ea(drive: Drive) -> None:
    """All of the load at the beginning, and nothing in equilibrium."""
    section = belt_section(drive.belt)
    system = belt_system(drive.belt, fixed=SECTION_HELD, forces=[(-1, (1e-5 * section.axial, 0.0))])
    search = _Search(system, straight(system))
    search.linearise(0.0)
    assert search.force == pytest.approx(1e-5, rel=1e-9)
    still = _Search(system, find_equilibrium(system, straight(system)).state)
    still.linearise(0.0)
    assert still.force < 1e-11


@pytest.mark.parametrize("shift", [1e-3, 1e-2])
def test_a_shift_is_the_inertia_of_the_belt_over_that_of_axial_waves(drive: Drive, shift: float) -> None:
    """A free belt that is pulled moves as a whole by F L / (E A shift), beside its stretch."""
    section = belt_section(drive.belt)
    system = belt_system(drive.belt, forces=[(-1, (1e-6 * section.axial, 0.0))])
    search = _Search(system, straight(system))
    before = search.nodes.copy()
    assert np.isfinite(search.linearise(shift))
    search.step(1.0)
    moved = np.mean(search.nodes[:, 0] - before[:, 0])
    assert moved == pytest.approx(1e-6 * drive.belt_length / shift, rel=2.0 * shift)


def test_the_norm_of_a_step_is_the_work_of_forces_out_of_balance() -> None:
    """On nodes and tensioners together, over E A L; a step has no sense."""
    prepared = prepare(loose())
    system = drive_system(prepared)
    search = _Search(system, laid(system, drawn_in(prepared, 1.0)))
    norm, before = search.linearise(0.0), search.position.copy()
    nodes, tensioner = search._here.matrix.node_side.ravel().copy(), search._here.matrix.border_side.copy()
    search.step(1.0)
    moved = before - search.position
    work = np.array([nodes @ moved[: nodes.size], tensioner[0] * moved[-1]])
    assert np.abs(work).min() > 1e-3 * abs(work.sum())
    assert norm**2 * system.element.section.axial * system.length.sum() == pytest.approx(abs(work.sum()), rel=1e-9)
    search.step(-1.0)
    np.testing.assert_allclose(search.position, before, rtol=1e-12, atol=1e-15)


def test_compliance_is_how_far_tensioners_move_by_a_force() -> None:
    """By two equilibria with a little more preload, and less."""
    drive = loose()
    prepared = prepare(drive)
    system = drive_system(prepared)
    state = find_equilibrium(system, laid(system, drawn_in(prepared, 1.0))).state
    (compliance,) = tensioner_compliance(system, state)[0]
    places = []
    for push in (-0.1, 0.1):
        tensioners = system.tensioners.copy()
        tensioners["push"][0] += push
        places.append(find_equilibrium(system._replace(tensioners=tensioners), state).state.position[-1])
    assert np.diff(places).item() / 0.2 == pytest.approx(compliance, rel=1e-4)


def test_shafts_stand_still_at_rest(drive: Drive) -> None:
    """Prescribed ones at all instants; the torques of others stay."""
    driven = drive.pulleys[1].replace(torque=-3.0)
    system = drive_system(prepare(drive.replace(pulley=[drive.pulleys[0], driven])))
    for time in (0.0, 0.3, 9.0):
        speed, torque = (interpreted(profile_value)(standing(system).profiles, number, time)[0] for number in (0, 1))
        assert (speed, torque) == (0.0, -3.0)
    assert interpreted(profile_value)(system.profiles, 0, 9.0)[0] != 0.0

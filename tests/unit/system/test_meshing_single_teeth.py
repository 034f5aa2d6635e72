"""Single teeth of a travelling belt: their places and forces, and jumps."""

import numpy as np
import pytest

from beltdyn.arrays import Records
from beltdyn.contact.surface import ToothedRims
from beltdyn.kernel import interpreted
from beltdyn.model import Prepared, prepare
from beltdyn.system.arrays import System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build import drive_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.meshing import JumpWatch, fill_tooth_forces, fit_phases, tooth_coordinates, tooth_forces
from beltdyn.system.state import State, laid
from beltdyn.transient.checkpoint import packing
from tests.unit.model.test_toothing import drive


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return prepare(drive({"toothing": {"law": "discrete", "flank_angle": 0.0}}))


@pytest.fixture(scope="module")
def system(prepared: Prepared) -> System:
    return drive_system(prepared)


@pytest.fixture
def state(prepared: Prepared, system: System) -> State:
    made = laid(system, prepared.path)
    fit_phases(system, made)
    return made


def table_of(system: System) -> Records:
    assert isinstance(system.rims, ToothedRims)
    return system.rims.table


def test_a_tooth_to_a_pitch(system: System, prepared: Prepared) -> None:
    places = tooth_coordinates(system)
    assert places.size == 100
    np.testing.assert_allclose(np.diff(places), prepared.belt_length / 100)
    assert prepared.elements % 100 == 0
    spread = drive_system(prepare(drive().replace(simulation={"duration": 1.0, "frame": "travelling"})))
    assert tooth_coordinates(spread).size == 0


@pytest.mark.slow
def test_forces_of_teeth_make_the_moment_on_the_pulley(system: System, state: State) -> None:
    position = np.tile(state.position, (2, 1))
    position[1, system.first_body + 1] += 1e-3  # the driven pulley ahead
    before, after = tooth_forces(system, position, np.zeros_like(position))
    moment = body_forces_at(system, np.zeros(2), position, np.zeros_like(position)).moment[:, 1]
    held = np.flatnonzero(after != before)
    assert held.size >= 18  # half of its teeth, and those that reach into grooves beside the arc
    assert np.all(after[held] > before[held])
    # the belt lies on the pitch line; beside the arc it is up to a tooth's height farther from the shaft
    change = float((after - before).sum()) * table_of(system)[1].pitch_radius
    assert moment[0] - moment[1] == pytest.approx(change, rel=1e-2)


def test_teeth_pull_back_where_their_pulley_is_ahead(system: System, state: State) -> None:
    """By as much as the spread force of teeth holds the pulley; and forward where it is behind."""
    position = np.tile(state.position, (3, 1))
    position[:, system.first_body + 1] += [0.0, 1e-3, -1e-3]
    still, work = np.zeros_like(position), element_workspace(system)
    found = np.zeros((3, tooth_coordinates(system).size))
    interpreted(fill_tooth_forces)(system, position, still, work, found)
    moment = interpreted(body_forces_at)(system, np.zeros(3), position, still).moment[:, 1]
    change, pull = np.diff(found[[0, 1, 2, 0]], axis=0).sum(axis=1), np.diff(moment[[0, 1, 2, 0]])
    np.testing.assert_allclose(-pull, change * table_of(system)[1].pitch_radius, rtol=1e-2)
    assert change[0] > 0.0 > change[1]


def turned(system: System, state: State, angle: float, states: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions of states in which the driven pulley turns back under the belt, with points on its arc."""
    position = np.tile(state.position, (states, 1))
    position[:, system.first_body + 1] -= np.linspace(0.0, angle, states)
    row = table_of(system)[1]
    along = np.linspace(0.45, 0.5, 7)
    direction = row.phase + row.rate * along
    places = np.tile(0.0458 * np.stack([np.cos(direction), np.sin(direction)], axis=1), (states, 1, 1))
    centers = np.tile([[0.0, 0.0], [0.28, 0.0]], (states, 1, 1))
    return position, centers, places + centers[:, 1:]


def test_a_groove_that_passes_is_a_jump(system: System, state: State) -> None:
    groove = 2.0 * np.pi / 36
    watch = JumpWatch(system, np.linspace(0.45, 0.5, 7))
    states = turned(system, state, 2.2 * groove, 100)
    time = np.linspace(0.0, 1.0, 100)
    for part in (slice(50), slice(50, None)):
        watch.take(time[part], *(one[part] for one in states))
    assert [(pulley, teeth) for _, pulley, teeth in watch.events] == [(1, 1), (1, 1)]
    assert watch.events[0][0] == pytest.approx(0.7 / 2.2, abs=0.02)


def test_a_watch_goes_on_from_a_checkpoint(system: System, state: State) -> None:
    watch, time = JumpWatch(system, np.linspace(0.45, 0.5, 7)), np.linspace(0.0, 1.0, 100)
    states = turned(system, state, 2.2 * 2.0 * np.pi / 36, 100)
    watch.take(time[:50], *(one[:50] for one in states))
    kept = packing().unpack(packing().pack(watch))
    for one in (watch, kept):
        one.take(time[50:], *(part[50:] for part in states))
    assert kept.events == watch.events
    assert len(kept.events) == 2


def lift(places: np.ndarray, by: float) -> None:
    """Take points off the driven pulley, in place."""
    places[..., 0] -= 0.28
    places *= 1.0 + by
    places[..., 0] += 0.28


def test_windup_and_a_free_belt_are_no_jumps(system: System, state: State) -> None:
    watch = JumpWatch(system, np.linspace(0.45, 0.5, 7))
    position, centers, places = turned(system, state, 0.4 * 2.0 * np.pi / 36, 50)
    lift(places[20:25], 0.5)
    watch.take(np.linspace(0.0, 1.0, 50), position, centers, places)
    assert watch.events == []


def test_grooves_that_pass_under_a_belt_that_is_off_are_jumps(system: System, state: State) -> None:
    watch = JumpWatch(system, np.linspace(0.45, 0.5, 7))
    position, centers, places = turned(system, state, 2.2 * 2.0 * np.pi / 36, 100)
    lift(places[10:95], 0.2)
    watch.take(np.linspace(0.0, 1.0, 100), position, centers, places)
    assert [(pulley, teeth) for _, pulley, teeth in watch.events] == [(1, 1), (1, 1)]

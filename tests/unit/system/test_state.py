import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.state import at_rest, crossing_time, laid, straight

EXACT = 1e-12  # rounding of the path's arcs


def test_laid_belt_lies_on_its_path(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    state = laid(system, drive.path)
    nodes = state.nodes(system)
    stretch = drive.path.length / drive.belt_length
    along = stretch * drive.belt_length / system.nodes * np.arange(system.nodes)
    np.testing.assert_allclose(nodes[:, :2], drive.path.position(along), atol=EXACT)
    np.testing.assert_allclose(nodes[:, 2:4], stretch * drive.path.tangent(along), atol=EXACT)
    np.testing.assert_allclose(np.linalg.norm(nodes[:, 4:], axis=1), 1.0, atol=EXACT)
    np.testing.assert_allclose(nodes[:, 2] * nodes[:, 5] - nodes[:, 3] * nodes[:, 4], stretch, atol=EXACT)
    assert not state.velocity.any()
    assert not state.acceleration.any()
    np.testing.assert_array_equal(state.position[-2:], 0.0)


def test_a_belt_closed_by_multipliers_ends_where_it_begins(drive: Drive) -> None:
    system = belt_system(drive.belt, drive.pulleys, drive.contact, "multipliers")
    nodes = laid(system, drive.path).nodes(system)
    np.testing.assert_allclose(nodes[-1], nodes[0], atol=EXACT)


def test_straight_belt(drive: Drive) -> None:
    system = belt_system(drive.belt)
    nodes = straight(system).nodes(system)
    assert nodes[-1, 0] == pytest.approx(drive.belt_length)
    np.testing.assert_allclose(np.diff(nodes[:, 0]), system.length)
    np.testing.assert_array_equal(nodes[:, 1:], np.tile([0.0, 1.0, 0.0, 0.0, 1.0], (system.nodes, 1)))


def test_a_state_owns_its_coordinates(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    coordinates = np.ones((system.nodes, 6))
    state = at_rest(system, coordinates)
    coordinates[:] = 0.0
    assert state.nodes(system).all()
    assert state.position.shape == (6 * system.nodes + len(drive.pulleys),)


def test_crossing_time_is_length_over_wave_speed(drive: Drive) -> None:
    speed = np.sqrt(drive.belt.youngs_modulus * drive.belt.axial_factor / drive.belt.density)
    assert crossing_time(drive_system(prepare(drive))) == pytest.approx(drive.belt_length / speed)

"""Tension and speed of spans, and wrap angles, of a rectangle of four links on round pulleys, known by hand.

Each link has three sampling points, at its middle and near its ends: row 3 l + i of link l. A span has the mean of the
links that are free as a whole, or that of free points where none is.
"""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive, Pulley
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe

pytestmark = pytest.mark.slow  # kernels of points in fixed places

CORNERS = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 0.9), (0.0, 0.95)])
VELOCITIES = np.array([(1.0, 0.3), (1.2, 0.4), (-0.2, 1.5), (-1.1, -0.7)])
SHARES = np.array([5.0, 8.0, 5.0]) / 18.0
"""Weights of the points of a link (Gauss)."""
PLACES = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])


def rectangle(drive: Drive, *rims: tuple[tuple[float, float], float]) -> System:
    """Links around rims with these centers and radii."""
    belt = Belt(**drive.belt.model_dump() | {"length": 3.6, "elements": 4, "discretization": "truss"})
    pulleys = [
        Pulley(name=f"pulley {number}", center=center, radius=radius, inertia=0.1)
        for number, (center, radius) in enumerate(rims)
    ]
    contact = drive.contact.replace(quadrature_points=3)
    return belt_system(belt, pulleys, contact, "shared_node")


def see(system: System) -> Observations:
    rest = np.zeros(system.bodies.size)
    position, velocity = (np.append(array.ravel(), rest)[None] for array in (CORNERS, VELOCITIES))
    return observe(system, np.zeros(1), position, velocity)


def tensions(system: System) -> FloatArray:
    """Force in the link of each point, uniform within a link."""
    return np.repeat(see(system).belt_tension[0], 3)


def speeds() -> FloatArray:
    """Speed of the points along their links."""
    along = np.roll(CORNERS, -1, axis=0) - CORNERS
    unit = along / np.linalg.norm(along, axis=1)[:, None]
    after = np.roll(VELOCITIES, -1, axis=0)
    moving = (1.0 - PLACES[:, None]) * VELOCITIES[:, None] + PLACES[:, None] * after[:, None]
    return np.asarray(np.sum(moving * unit[:, None], axis=2)).ravel()


def assert_span(system: System, pulley: int, rows: list[int], weights: FloatArray | None = None) -> None:
    """The span behind a pulley is made of these points."""
    here, share = see(system), np.tile(SHARES, 4)[rows] if weights is None else weights
    assert here.span_tension[0, pulley] == pytest.approx(np.average(tensions(system)[rows], weights=share), rel=1e-12)
    assert here.belt_speed[0, pulley] == pytest.approx(np.average(speeds()[rows], weights=share), rel=1e-12)


def chord(height: float, radius: float) -> float:
    """Angle of the chord of a straight belt at this distance from the shaft."""
    return float(2.0 * np.arccos(height / radius))


def test_points_between_two_pulleys(drive: Drive) -> None:
    """Each pulley touches the middle of a link."""
    system = rectangle(drive, ((0.5, 0.09), 0.1), ((0.5, 0.86), 0.1))
    np.testing.assert_array_equal(np.flatnonzero(see(system).contact_pulley[0] >= 0), [1, 7])
    assert_span(system, 0, [3, 4, 5])
    assert_span(system, 1, [9, 10, 11])
    assert see(system).wrap_angle[0, 0] == pytest.approx(chord(0.09, 0.1), rel=1e-9)


def test_a_pulley_that_is_touched_between_points(drive: Drive) -> None:
    """The nearest point counts to it, whichever side of it that is."""
    system = rectangle(drive, ((0.96, 0.35 * 0.9), 0.05), ((0.96, 0.8 * 0.9), 0.05))
    assert np.all(see(system).contact_pulley[0] < 0)
    np.testing.assert_allclose(see(system).wrap_angle[0], chord(0.04, 0.05), rtol=1e-9)
    assert_span(system, 0, [4, 5], np.ones(2))
    assert_span(system, 1, [6, 7, 8, 9, 10, 11, 0, 1, 2])


def test_neighbouring_points_on_two_pulleys(drive: Drive) -> None:
    """A span without a point between them has the mean of both."""
    system = rectangle(drive, ((0.5, 0.04), 0.05), ((PLACES[2], 0.04), 0.05))
    np.testing.assert_array_equal(see(system).contact_pulley[0, :3], [-1, 0, 1])
    assert_span(system, 0, [1, 2], np.ones(2))
    assert_span(system, 1, list(range(3, 12)))


def test_neighbouring_points_where_the_belt_is_counted_from(drive: Drive) -> None:
    """The last point of the belt touches one pulley, its first the other."""
    system = rectangle(drive, ((PLACES[0], 0.04), 0.05), ((0.04, 0.95 * PLACES[0]), 0.05))
    np.testing.assert_array_equal(see(system).contact_pulley[0], [0, *[-1] * 10, 1])
    assert_span(system, 0, list(range(3, 9)))
    assert_span(system, 1, [11, 0], np.ones(2))


def test_a_link_that_a_pulley_touches_before_its_first_point_is_free(drive: Drive) -> None:
    """The pulley has a point of its own on the link before; the belt is free from the next one on."""
    system = rectangle(drive, ((0.93, 0.0), 0.075), ((0.5, 0.86), 0.1))
    np.testing.assert_array_equal(np.flatnonzero(see(system).contact_pulley[0] >= 0), [2, 7])
    assert_span(system, 0, [3, 4, 5])
    assert_span(system, 1, [9, 10, 11])


def test_a_belt_that_leaves_a_pulley_and_comes_back(drive: Drive) -> None:
    """What is free in between is no span: the corner of the rectangle lies outside the pulley that both links cut."""
    system = rectangle(drive, ((0.5, 0.87), 0.1), ((0.55, 0.45), 0.46))
    touched = see(system).contact_pulley[0]
    np.testing.assert_array_equal(touched[[1, 2, 3, 4]], [1, -1, -1, 1])
    assert_span(system, 1, [5, 6])
    assert_span(system, 0, [9, 10, 11])
    assert see(system).wrap_angle[0, 1] == pytest.approx(0.5 * np.pi + chord(0.45, 0.46), rel=1e-9)


def test_a_pulley_without_contact_has_no_span(drive: Drive) -> None:
    """Nor has the only one that the belt touches: it never goes from there to another."""
    here = see(rectangle(drive, ((0.5, 0.09), 0.1), ((5.0, 5.0), 0.1)))
    assert np.all(np.isnan(here.span_tension))
    assert np.all(np.isnan(here.belt_speed))
    np.testing.assert_array_equal(here.wrap_angle[0] > 0.0, [True, False])
    assert np.all(np.isnan(see(rectangle(drive, ((5.0, 5.0), 0.1))).span_tension))


def test_tension_of_links_by_their_stretch(drive: Drive) -> None:
    """The slope of the strain energy with respect to a link's length, which is uniform within it."""
    system = rectangle(drive, ((5.0, 5.0), 0.1))
    here = see(system)
    np.testing.assert_allclose(here.tension_variation, 0.0, atol=1e-6 * np.abs(here.belt_tension).max())
    step, moved = 1e-6, []
    for side in (step, -step):
        position = np.append(CORNERS.ravel(), 0.0)
        position[2:4] += side * np.array([1.0, 0.0])
        moved.append(float(observe(system, np.zeros(1), position[None], 0.0 * position[None]).strain_energy[0]))
    upright = (CORNERS[2] - CORNERS[1]) / np.linalg.norm(CORNERS[2] - CORNERS[1])
    force = here.belt_tension[0, 0] - here.belt_tension[0, 1] * upright[0]
    assert (moved[0] - moved[1]) / (2.0 * step) == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("corner", [(0.9, 0.1), (0.1, 0.1)], ids=["between links", "where the belt is closed"])
def test_the_wrap_reaches_over_a_place_where_the_belt_lifts_off(drive: Drive, corner: tuple[float, float]) -> None:
    """Two links at right angles touch, and their corner does not; the other way round the belt is free."""
    system = rectangle(drive, (corner, 0.11))
    assert see(system).wrap_angle[0, 0] == pytest.approx(0.5 * np.pi + chord(0.1, 0.11), rel=1e-9)


def test_the_wrap_ends_where_another_pulley_is_touched(drive: Drive) -> None:
    """A small one presses on the belt where it lifts off the large one."""
    one, other = ((0.9, 0.1), 0.11), ((1.0, -0.005), 0.01)
    between = rectangle(drive, one, other)
    assert see(between).wrap_angle[0, 0] == pytest.approx(2.0 * chord(0.1, 0.11), rel=1e-9)

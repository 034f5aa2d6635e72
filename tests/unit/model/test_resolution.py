"""Errors of the mesh: limits of their formulas, and meshes that keep to their limits."""

import numpy as np
import pytest

from beltdyn.model import ERROR_LIMITS, Drive, Running, elements_needed, install, mesh_errors, unresolved
from beltdyn.model.resolution import element_angles, shifts_at_nodes


@pytest.fixture(scope="module")
def running(drive: Drive) -> Running:
    return Running(install(drive).tension)


def with_belt(drive: Drive, **changes: object) -> Drive:
    return drive.replace(belt=drive.belt.replace(**changes))


@pytest.mark.parametrize("name", ERROR_LIMITS)
def test_the_named_mesh_has_twice_its_estimate_within_the_limit(drive: Drive, running: Running, name: str) -> None:
    needed = elements_needed(drive, running)[name]
    assert 2.0 * mesh_errors(drive, running, needed)[name] <= ERROR_LIMITS[name]
    assert 2.0 * mesh_errors(drive, running, needed - 1)[name] > ERROR_LIMITS[name]


def test_what_is_needed_does_not_depend_on_the_mesh(drive: Drive, running: Running) -> None:
    needs = [elements_needed(with_belt(drive, elements=elements), running) for elements in (12, 24, 60)]
    assert needs[0] == needs[1] == needs[2]


def test_errors_of_fine_meshes_fall_with_their_orders(drive: Drive, running: Running) -> None:
    coarse, fine = (mesh_errors(drive, running, elements) for elements in (4000, 8000))
    ratios = {name: coarse[name] / fine[name] for name in coarse}
    assert ratios["peak pressure"] == pytest.approx(8.0, rel=0.01)
    for name in ("tension", "slip", "losses"):
        assert ratios[name] == pytest.approx(32.0, rel=0.01)


def test_speed_takes_pressure_from_the_pulleys(drive: Drive, running: Running) -> None:
    """A belt that presses half as much and hardly bends sinks in over a length shorter by the root of two."""
    soft = with_belt(drive, bending_factor=1e-6)
    fast = Running(running.tension, 0.5 * running.tension)
    slow_error, fast_error = (mesh_errors(soft, one, 4000)["peak pressure"] for one in (running, fast))
    assert fast_error / slow_error == pytest.approx(2.0**1.5, rel=0.01)


def test_a_link_counts_as_the_element_that_misses_the_circle_as_much(drive: Drive) -> None:
    """R a^2 / 8 of a link over the angle a is R b^4 / 384 of an element over b."""
    trusses = with_belt(drive, elements=60, discretization="truss")
    beams = with_belt(drive, elements=30, discretization="three-node-beam")
    link = drive.belt_length / (60 * drive.radii)
    for links in (trusses, beams):
        angles = element_angles(links, links.elements)
        assert angles**4 / 384 == pytest.approx(link**2 / 8)


def test_said_are_errors_and_meshes_from_the_most_demanding_on(drive: Drive) -> None:
    errors = dict.fromkeys(ERROR_LIMITS, 0.0) | {"tension": 0.123, "peak pressure": 2.0, "losses": float("nan")}
    needed = dict.fromkeys(ERROR_LIMITS, 20) | {"tension": 47, "peak pressure": 90}
    (finding,) = unresolved(errors, needed, pressures=True)
    assert finding.fault == "the belt has too few elements for peak pressure (over 100%) and tension (12%)."
    assert finding.remedy == "Set belt.elements = 90 for all of these, or 47 for all but peak pressure."
    (of_tension,) = unresolved(errors, needed, pressures=False)
    assert of_tension.fault == "the belt has too few elements for tension (12%)."
    assert unresolved(dict.fromkeys(ERROR_LIMITS, 0.0), needed, pressures=True) == []


def test_shifts_at_nodes_are_those_of_the_arcs_beside_them() -> None:
    """At an arc its own, between two arcs by the share of the second, and none where nothing goes over."""
    before, after, share = np.array([-1, 0, 0, 1, 1]), np.array([0, 1, 1, -1, -1]), np.array([0.5, 0.0, 0.25, 0.0, 1.0])
    found = shifts_at_nodes(before, after, share, np.array([[2.0, 4.0], [0.0, 1.0j]]))
    np.testing.assert_array_equal(found, [[1.0, 2.0, 2.5, 4.0, 0.0], [0.0, 0.0, 0.25j, 1.0j, 0.0]])

"""Runs of belts of links: dimensions, coordinates and values of their results, and their figures."""

from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from beltdyn import equilibrium, simulate
from beltdyn.model import Drive
from beltdyn.results import Run, open_run
from beltdyn.show import plot

pytestmark = pytest.mark.slow  # kernels of their own
Change = Callable[..., Drive]
ELEMENTS = {"truss": 60, "three-node-beam": 30}
LINKS = 60
SAMPLING = {"distributed": 5, "nodal": 2}
"""Contact points of a link."""


@pytest.fixture(scope="module", params=ELEMENTS)
def kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module", params=SAMPLING)
def sampling(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def run(change: Change, kind: str, sampling: str) -> Run:
    belt = {"discretization": kind, "elements": ELEMENTS[kind]}
    return simulate(change(belt=belt, contact={"sampling": sampling}))


def test_dimensions(run: Run, sampling: str) -> None:
    sizes, data = run.dataset.sizes, run.dataset
    assert run.status == "completed"
    assert sizes["node"] == sizes["element"] == LINKS
    assert sizes["contact_point"] == SAMPLING[sampling] * LINKS
    assert list(data.coordinate.values) == ["r_x", "r_y"]
    np.testing.assert_array_equal(data.nodal_coordinates, data.node_position)
    assert data.nodal_velocities.shape == data.node_position.shape


def test_coordinates_along_the_belt(run: Run, sampling: str) -> None:
    length = run.drive.belt_length / LINKS
    data = run.dataset
    np.testing.assert_allclose(data.node_coordinate, length * np.arange(LINKS), atol=1e-12)
    np.testing.assert_allclose(data.element_coordinate, length * (np.arange(LINKS) + 0.5), atol=1e-12)
    assert np.all(np.diff(data.belt_coordinate) > -1e-12)
    if sampling == "nodal":
        both_ends = np.stack([np.arange(LINKS), np.arange(LINKS) + 1], axis=1).ravel()
        np.testing.assert_allclose(data.belt_coordinate, length * both_ends, atol=1e-12)


def test_tension_of_every_link_is_that_of_its_length(run: Run) -> None:
    place = run.dataset.node_position.values[-1]
    stretch = np.linalg.norm(np.roll(place, -1, axis=0) - place, axis=1) * LINKS / run.drive.belt_length
    expected = run.drive.belt.axial_stiffness * (stretch**2 - 1.0) * stretch / 2.0
    np.testing.assert_allclose(run.dataset.belt_tension[-1], expected, rtol=1e-9)


def test_contact_points_lie_on_the_links(run: Run, sampling: str) -> None:
    place = run.dataset.node_position.values[0]
    points = run.dataset.contact_position.values[0].reshape(LINKS, SAMPLING[sampling], 2)
    along = (run.dataset.belt_coordinate.values * LINKS / run.drive.belt_length).reshape(LINKS, -1, 1)
    along = along - np.arange(LINKS)[:, None, None]
    expected = place[:, None] + along * (np.roll(place, -1, axis=0) - place)[:, None]
    np.testing.assert_allclose(points, expected, atol=1e-12)


def test_equilibrium_is_the_start(run: Run) -> None:
    rest = equilibrium(run.drive).dataset
    np.testing.assert_array_equal(rest.nodal_coordinates, run.dataset.nodal_coordinates[0])
    np.testing.assert_allclose(rest.hub_force.sum("pulley"), 0.0, atol=1e-6)  # of 50 N; Newton's tolerance


def test_file_holds_links(run: Run, tmp_path: Path) -> None:
    simulate(run.drive, tmp_path / "run.nc")
    kept = open_run(tmp_path / "run.nc")
    assert kept.drive == run.drive
    np.testing.assert_array_equal(kept.dataset.node_position, run.dataset.node_position)


def test_the_belt_is_drawn_straight_from_node_to_node(run: Run) -> None:
    ax = Figure().add_subplot()
    plot.configuration(run, ax=ax)
    (belt,) = (artist for artist in ax.collections if isinstance(artist, LineCollection))
    place = run.dataset.node_position.values[-1]
    for segment, start, end in zip(belt.get_segments(), place, np.roll(place, -1, axis=0), strict=True):
        points = np.asarray(segment)
        along = np.linspace(0.0, 1.0, len(points))[:, None]
        np.testing.assert_allclose(points, start + along * (end - start), atol=1e-12)


@pytest.mark.slow
def test_every_figure_is_drawn(run: Run, tmp_path: Path) -> None:
    paths = plot.save_all(run, tmp_path)
    assert "contact_pressure" in [path.stem for path in paths]
    assert not plt.get_fignums()


def test_search_for_equilibrium_with_few_nodes_in_contact(drive: Drive) -> None:
    """With 20 elements of the paper some six nodes touch each pulley."""
    nodal = drive.replace(contact=drive.contact.replace(sampling="nodal"))
    rest = equilibrium(nodal).dataset
    assert float(rest.span_tension.min()) > 0.0
    np.testing.assert_allclose(rest.hub_force.sum("pulley"), 0.0, atol=1e-6)

"""The ribbon and the cylinders are where belt and pulleys are, and carry what was recorded."""

from collections.abc import Callable
from importlib.resources import files

import numpy as np
import pytest

from beltdyn.model import Drive, loads
from beltdyn.results import Run
from beltdyn.results.export import SECTORS, Cylinders, Ribbon, batches
from beltdyn.transient.simulate import simulate


def test_the_ribbon_is_as_wide_as_the_belt_and_passes_through_the_nodes(run: Run) -> None:
    ribbon = Ribbon(run)
    fields = run.fields.isel(time=[0, 40, 100])
    places = ribbon.frames(fields).places
    assert places.shape == (3, ribbon.surface.points, 3)
    np.testing.assert_array_equal(places[:, 0::2, :2], places[:, 1::2, :2])
    np.testing.assert_allclose(places[:, 1::2, 2] - places[:, 0::2, 2], run.drive.belt.width, rtol=1e-15)
    number = np.searchsorted(ribbon.coordinate, run.dataset["node_coordinate"].values - 1e-12)
    np.testing.assert_allclose(places[:, 2 * number, :2], fields["node_position"].values, atol=1e-15)


def test_values_at_contact_points_are_those_recorded(run: Run) -> None:
    ribbon = Ribbon(run)
    fields = run.fields.isel(time=[0, 40, 100])
    values = ribbon.frames(fields).on_points
    number = np.searchsorted(ribbon.coordinate, run.dataset["belt_coordinate"].values - 1e-9)
    for name in ("normal_force", "friction_force", "slip_velocity"):
        for side in (0, 1):
            np.testing.assert_allclose(values[name][:, 2 * number + side], fields[name].values, rtol=1e-6, atol=1e-12)
    pressure = values["normal_force"] / run.drive.belt.width
    np.testing.assert_allclose(values["contact_pressure"], pressure, rtol=1e-15)


def test_values_between_contact_points_are_linear_also_where_the_belt_closes(run: Run) -> None:
    """At the first node the belt coordinate starts anew: half way between the last and the first contact point."""
    normal = run.fields["normal_force"].isel(time=[70]).values
    at_start = Ribbon(run).frames(run.fields.isel(time=[70])).on_points["normal_force"][:, 0]
    np.testing.assert_allclose(at_start, 0.5 * (normal[:, 0] + normal[:, -1]), rtol=1e-6)


def test_polygons_lie_along_the_belt_with_the_tension_of_their_element(run: Run) -> None:
    ribbon = Ribbon(run)
    fields = run.fields.isel(time=[100])
    frames = ribbon.frames(fields)
    corners = np.array(ribbon.surface.corners)
    quads = frames.places[0][corners]
    sides = np.linalg.norm(quads[:, 1] - quads[:, 0], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]), axis=1)
    np.testing.assert_allclose(area, sides * run.drive.belt.width, rtol=1e-12)
    assert sides.sum() == pytest.approx(run.drive.path.length, rel=2e-3)  # chords, and the mesh of this drive is coarse
    ends = np.append(run.dataset["node_coordinate"].values[1:], run.drive.belt_length)
    element = np.searchsorted(ends, ribbon.coordinate + 1e-12)
    np.testing.assert_array_equal(frames.on_cells["belt_tension"][0], fields["belt_tension"].values[0, element])


def test_pulleys_turn_by_their_angle_about_their_centers(run: Run) -> None:
    cylinders = Cylinders(run)
    fields = run.fields.isel(time=[0, 40, 100])
    frames = cylinders.frames(fields)
    pulleys = frames.places.reshape(3, 2, 2, SECTORS + 1, 3)
    centers = fields["pulley_center"].values
    np.testing.assert_allclose(pulleys[:, :, :, 0, :2], np.stack([centers, centers], axis=2), atol=1e-15)
    arm = pulleys[:, :, 0, 1, :2] - centers
    radii = [pulley.radius - 0.5 * run.drive.belt.thickness for pulley in run.drive.pulleys]  # it has no offset
    np.testing.assert_allclose(np.linalg.norm(arm, axis=-1), np.tile(radii, (3, 1)), rtol=1e-12)
    turned = np.arctan2(arm[..., 1], arm[..., 0]) - fields["pulley_angle"].values
    np.testing.assert_allclose(np.exp(1j * turned), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.ptp(pulleys[..., 2]), run.drive.belt.width)


def test_polygons_of_pulleys_close_a_cylinder(run: Run) -> None:
    """Every edge belongs to two polygons that run through it in opposite ways: outside is the same side everywhere."""
    cylinders = Cylinders(run)
    edges = [
        (int(one), int(other))
        for corners in cylinders.surface.corners
        for one, other in zip(corners, np.roll(corners, -1), strict=True)
    ]
    assert len(set(edges)) == len(edges)
    assert {(other, one) for one, other in edges} == set(edges)
    frames = cylinders.frames(run.fields.isel(time=[100]))
    driven = frames.on_cells["pulley"][0] == 1
    speeds = frames.on_cells["pulley_speed"][0]
    assert set(speeds[driven]) == {float(run.dataset["pulley_speed"][-1, 1])}
    assert frames.on_cells["mark"][0].mean() == pytest.approx(30.0 / 360.0)


def test_batches_are_all_instants_once(make_run: Callable[..., Run]) -> None:
    for outputs in (2, 64, 65, 130):
        run = make_run(outputs)
        times = np.concatenate([part["time"].values for part in batches(run)])
        np.testing.assert_array_equal(times, run.dataset["field_time"].values)


def test_the_ribbon_of_an_open_belt_ends_at_its_ends(open_run: Run) -> None:
    ribbon = Ribbon(open_run)
    fields = open_run.fields.isel(time=[0])
    places = ribbon.frames(fields).places
    np.testing.assert_allclose(places[0, [0, -1], :2], fields["node_position"].values[0, [0, -1]], atol=1e-14)
    assert len(ribbon.surface.corners) == ribbon.surface.points // 2 - 1
    assert max(int(one.max()) for one in ribbon.surface.corners) == ribbon.surface.points - 1


@pytest.fixture(scope="module")
def open_run() -> Run:
    text = files("beltdyn.examples").joinpath("band_brake.toml").read_text(encoding="utf-8")
    drive: Drive = loads(text)
    return simulate(drive.replace(simulation=drive.simulation.replace(duration=1e-3)))

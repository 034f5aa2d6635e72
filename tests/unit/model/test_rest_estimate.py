"""The belt at rest by closed forms: moment about a pulley, weight, tensioners, and the length for a tension."""

import math

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import Drive, estimate_at_rest, install, prepare
from beltdyn.model.rest_estimate import tightening
from beltdyn.theory.static_tension import span_radius
from tests.lumped.drawn_layouts import layout_at_rest


def test_without_bending_and_with_hard_contact_it_is_the_simple_estimate() -> None:
    belt = {"installed_tension": 300.0, "width": 0.02, "thickness": 0.005, "mass_per_length": 0.1}
    pulleys = [
        {"name": "driver", "center": [0.0, 0.0], "radius": 0.05, "speed": 100.0},
        {"name": "driven", "center": [0.4, 0.0], "radius": 0.1, "inertia": 0.01},
    ]
    drive = Drive(
        belt=belt | {"axial_stiffness": 1e5, "bending_stiffness": 1e-9},
        pulley=pulleys,
        contact={"friction": 0.4, "stiffness": 1e13},
        simulation={"duration": 0.1},
    )
    prepared, found = estimate_at_rest(prepare(drive))
    simple = install(drive)
    np.testing.assert_allclose(found.hub_loads, simple.hub_loads, atol=1e-4)
    np.testing.assert_allclose(found.span_frequencies, simple.span_frequencies, rtol=1e-6)
    assert prepared.belt_length == pytest.approx(drive.belt_length, rel=1e-8)


def test_spans_touch_circles_that_the_moment_about_the_center_asks_for() -> None:
    """T R_s = T_a (R - d) + M to first order, with the tension and the moment in the middle of a long arc."""
    radius, depth, tension, bending = 0.05, 1e-5, 200.0, 2e-3
    arc = tension * (1.0 + 0.5 * depth / radius) - 0.5 * bending / radius**2
    expected = (arc * (radius - depth) + bending / radius) / tension
    assert span_radius(depth, radius, bending / tension, math.pi) == pytest.approx(expected, abs=1e-2 * depth)


def test_a_belt_that_touches_a_point_bends_over_it() -> None:
    """A string of tension T with EI under a point load: its asymptotes meet l tan(wrap / 2) beyond it."""
    radius, length, wrap = 0.05, 0.01, 0.02
    meeting = radius + length * math.tan(0.5 * wrap)
    found = span_radius(0.0, radius, length**2, wrap)
    assert found == pytest.approx(meeting * math.cos(0.5 * wrap), abs=radius * wrap**4)


def test_both_forms_meet_where_the_arc_is_as_long_as_its_layers() -> None:
    wrap = 2.0 * 0.01 / 0.05
    below, above = (span_radius(0.0, 0.05, 1e-4, wrap + side) for side in (-1e-9, 1e-9))
    assert below == pytest.approx(above, abs=1e-15)


def test_the_weight_of_a_belt_is_carried_by_its_pulleys() -> None:
    drive = bd.example("two_pulley").with_({"gravity": [0.0, -9.81]})
    _, found = estimate_at_rest(prepare(drive))
    weight = drive.belt.mass_per_length * drive.belt_length * 9.81
    assert found.hub_loads.sum(axis=0) == pytest.approx([0.0, -weight], abs=2e-3 * weight)


def test_tension_grows_with_height() -> None:
    drive = bd.example("two_pulley").with_({"gravity": [0.0, -9.81]})
    _, found = estimate_at_rest(prepare(drive))
    points = found.path.span_points.mean(axis=1)
    rise = (points[1, 1] - points[0, 1]) * drive.belt.mass_per_length * 9.81 / (1.0 + found.strain)
    assert np.diff(found.span_tensions)[0] == pytest.approx(rise, rel=0.01)
    assert found.span_tensions.mean() == pytest.approx(found.tension)


def test_a_tensioner_balances_the_lines_of_the_spans() -> None:
    drive = bd.example("alternator_drive")
    prepared, found = estimate_at_rest(prepare(drive))
    (carrier,), (position,) = prepared.carriers, found.tensioner_positions
    moment = -float(found.hub_loads[carrier.pulley] @ carrier.place(position)[1])
    assert carrier.force(position) == pytest.approx(moment, rel=1e-8)


def test_a_drive_is_tightened_to_its_tension_along_its_slope() -> None:
    """The slope tells the tension of a belt that is a little tighter; a tensioner that yields makes it small."""
    prepared = prepare(bd.example("alternator_drive"))
    found = tightening(prepared)
    assert found is not None
    estimated, _ = estimate_at_rest(prepared)
    assert estimated.belt_length == pytest.approx(prepared.belt_length - found.distance, rel=1e-12)
    _, tighter = estimate_at_rest(prepared.tightened(found.distance + 1.0 / found.slope))
    assert tighter.tension == pytest.approx(301.0, abs=0.02)


def test_where_lines_find_no_path_there_is_no_closed_form_with_bending() -> None:
    """Bent off its rims the belt of this layout has no common tangent between two pulleys."""
    prepared = prepare(Drive(**layout_at_rest(325)))
    assert tightening(prepared) is None
    assert estimate_at_rest(prepared)[1].path.length == pytest.approx(prepared.path.length)
    assert "no common tangent" in estimate_at_rest(prepared)[1].limitation


@pytest.mark.parametrize("thickness", [0.003, 0.01, 0.03, 0.1, 0.3])
def test_a_belt_too_stiff_to_bend_is_said_to_be_so(drive: Drive, thickness: float) -> None:
    """A thickness in the wrong unit: the arcs would be under compression."""
    prepared = prepare(drive.with_({"belt.thickness": thickness}))
    found = estimate_at_rest(prepared)[1]
    needed = 2.0 * prepared.belt.bending_stiffness / float(prepared.radii.min()) ** 2
    assert found.tension > 0.0
    assert (found.limitation != "") == (needed > 1.1 * found.tension)
    if found.limitation:
        assert "bending stiffness" in found.limitation
        assert found.tension == prepared.installation.tension

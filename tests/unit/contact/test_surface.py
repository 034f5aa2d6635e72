"""Surfaces of pulleys: gaps against geometry and differences, reach, and intervals of a belt on them."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, records
from beltdyn.contact.contact_zone import out_of_reach, touching_intervals, zone_scratch
from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import (
    KINDS,
    SHAPE,
    SHAPES,
    TEETH,
    Gap,
    MeshingRims,
    PolygonRims,
    Round,
    Shaped,
    ShapedRims,
    ToothedRims,
    outer_radius,
    shaped_gap,
    surface_at,
)
from beltdyn.contact.surface.polygon import polygon_seat

RADIUS, ECCENTRICITY, DIRECTION = 0.1, 4e-3, 0.3
POINTS = [(0.103, 0.02), (-0.06, 0.07), (0.01, -0.099), (-0.09, -0.05)]
TURNS = [0.0, 0.9, 4.0]
ROUNDING = 1e-15


@pytest.fixture(scope="module")
def rims() -> ShapedRims:
    """An eccentric pulley behind a round one."""
    table = records(SHAPE, reach=[0.0, ECCENTRICITY])
    SHAPES.fill(table[0], KINDS["circle"], {})
    SHAPES.fill(table[1], KINDS["eccentric"], {"eccentricity": ECCENTRICITY, "eccentric_angle": DIRECTION})
    return ShapedRims(np.array([0.05, RADIUS]), table)


@pytest.fixture
def eccentric_at(rims: ShapedRims) -> Callable[[float], Shaped]:
    return lambda turn: surface_at(rims, 1, turn)


def center(turn: float) -> FloatArray:
    return ECCENTRICITY * np.array([np.cos(turn + DIRECTION), np.sin(turn + DIRECTION)])


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("point", POINTS)
def test_a_circle_among_shapes(rims: ShapedRims, turn: float, point: tuple[float, float]) -> None:
    distance = float(np.hypot(*point))
    expected = Gap(0.05 - distance, point[0] / distance, point[1] / distance, 1.0 / distance)
    assert shaped_gap(surface_at(rims, 0, turn), *point) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("point", POINTS)
def test_depth_in_an_eccentric_rim(
    eccentric_at: Callable[[float], Shaped], turn: float, point: tuple[float, float]
) -> None:
    arm = np.array(point) - center(turn)
    gap = shaped_gap(eccentric_at(turn), *point)
    assert gap.penetration == pytest.approx(RADIUS - np.linalg.norm(arm), abs=ROUNDING)
    np.testing.assert_allclose([gap.normal_x, gap.normal_y], arm / np.linalg.norm(arm), atol=1e-13)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("point", POINTS)
def test_normal_is_the_way_out_and_turns_by_the_curvature(
    eccentric_at: Callable[[float], Shaped], turn: float, point: tuple[float, float]
) -> None:
    surface, here, step = eccentric_at(turn), np.array(point), 1e-6
    gap = shaped_gap(surface, *here)
    normal, tangent = np.array([gap.normal_x, gap.normal_y]), np.array([-gap.normal_y, gap.normal_x])
    deeper, less = (shaped_gap(surface, *(here + side * step * normal)) for side in (-1.0, 1.0))
    assert (deeper.penetration - less.penetration) / (2.0 * step) == pytest.approx(1.0, rel=1e-8)
    back, on = (shaped_gap(surface, *(here + side * step * tangent)) for side in (-1.0, 1.0))
    assert on.penetration == pytest.approx(back.penetration, abs=1e-14)
    turned = np.array([on.normal_x - back.normal_x, on.normal_y - back.normal_y]) / (2.0 * step)
    np.testing.assert_allclose(turned, gap.curvature * tangent, atol=1e-7)


@pytest.mark.parametrize("turn", TURNS)
def test_all_of_a_rim_lies_within_its_reach(eccentric_at: Callable[[float], Shaped], turn: float) -> None:
    surface = eccentric_at(turn)
    assert outer_radius(surface) == pytest.approx(RADIUS + ECCENTRICITY)
    farthest = center(turn) * (1.0 + RADIUS / ECCENTRICITY)
    assert shaped_gap(surface, *farthest).penetration == pytest.approx(0.0, abs=1e-15)
    assert np.linalg.norm(farthest) == pytest.approx(outer_radius(surface))


@pytest.mark.parametrize("turn", TURNS)
def test_quick_rejection_counts_with_the_reach(eccentric_at: Callable[[float], Shaped], turn: float) -> None:
    """A straight belt just within the farthest point of the rim is looked at, one beyond it is not."""
    pulley = PulleyState(0.0, 0.0, eccentric_at(turn), 0.0, 0.5)
    out, along = center(turn) / ECCENTRICITY, np.array([-center(turn)[1], center(turn)[0]]) / ECCENTRICITY
    for height, beyond in ((1.001, True), (0.999, False)):
        places = height * (RADIUS + ECCENTRICITY) * out + np.array([-0.03, 0.0, 0.03])[:, None] * along
        assert out_of_reach(places, pulley) == beyond


def intervals(control: FloatArray, pulley: PulleyState) -> FloatArray:
    zone = zone_scratch(len(control))
    zone.intervals[:] = 0.3
    return np.array(zone.intervals[: touching_intervals(control, pulley, zone)])


BELTS = {
    "through": np.array([(-2.0, 0.3), (1.5, 0.2)]),
    "in": np.array([(-2.0, 0.3), (0.3, 0.2)]),
    "out": np.array([(0.1, 0.3), (0.3, 2.0)]),
    "inside": np.array([(-0.5, 0.3), (0.3, 0.2)]),
    "away": np.array([(-0.5, 1.3), (0.3, 1.2)]),
    "around": np.array([(-1.2, 0.5), (-0.5, 1.2), (0.6, 0.95), (1.1, 0.3)]),
}
WAVES = {"waves from outside": 1.0, "waves from inside": -1.0}


@pytest.mark.parametrize("belt", [*BELTS, *WAVES])
@pytest.mark.parametrize("turn", TURNS)
def test_an_eccentric_rim_touches_where_a_circle_about_its_centre_does(
    eccentric_at: Callable[[float], Shaped], wave: Callable[[float], FloatArray], belt: str, turn: float
) -> None:
    shaft = np.array([0.3, -0.2])
    middle = shaft + center(turn)
    control = middle + RADIUS * (BELTS[belt] if belt in BELTS else wave(WAVES[belt]))
    shaped = intervals(control, PulleyState(shaft[0], shaft[1], eccentric_at(turn), 0.0, 0.5))
    circle = intervals(control, PulleyState(middle[0], middle[1], Round(RADIUS), 0.0, 0.5))
    assert len(circle) == (4 if belt in WAVES else 0 if belt == "away" else 1)
    np.testing.assert_allclose(shaped, circle, atol=1e-11)  # both to 1e-13, with cancellation in the squares


def test_a_polygon_reaches_to_its_lands_or_to_its_teeth() -> None:
    """Twelve lands of 0.8 of the radius: 0.2 R pi / (6 sin(pi / 12)) more than 0.8 R, and teeth of 10 mm."""
    groove, land = np.pi / 6.0, 0.8 * RADIUS
    for height in (0.0, 0.1 * RADIUS):
        row = records(TEETH, stiffness=[1.0], groove=[groove], land=[land], height=[height])
        surface = surface_at(PolygonRims(np.array([RADIUS]), row, np.zeros(1)), 0, 0.3)
        farthest = land + 0.1 * RADIUS * groove / np.sin(0.5 * groove)
        assert outer_radius(surface) == pytest.approx(max(farthest, RADIUS + height), rel=1e-12)
        middle = outer_radius(surface) * np.array([np.cos(0.3 + 0.5 * groove), np.sin(0.3 + 0.5 * groove)])
        assert shaped_gap(surface, *middle).penetration == pytest.approx(farthest - outer_radius(surface), abs=1e-15)


def test_in_steady_running_a_phase_is_unknown_where_there_are_teeth_and_elsewhere_a_speed() -> None:
    rows = records(TEETH, stiffness=[1.0, 0.0], groove=[0.1, 0.1])
    none = np.zeros(0)
    rims = MeshingRims(np.full(2, RADIUS), rows, none, np.array([0.4, 0.0]), none.astype(int), 0, np.zeros((3, 3)))
    toothed, smooth = (surface_at(rims, pulley, 9.0, 5.0) for pulley in (0, 1))
    assert (toothed.phase, toothed.by_flow, toothed.by_speed) == (0.4, 0.0, 0.0)
    assert (smooth.by_flow, smooth.by_speed) == (0.0, 1.0)


def test_over_time_teeth_turn_with_their_pulley_and_against_the_belt_that_passes() -> None:
    """A belt that passes at the pitch line of a pulley that turns leaves the phase as it is."""
    rows, turned = records(TEETH, stiffness=[1.0], groove=[0.1], phase=[0.02], rate=[1.0 / RADIUS]), 0.7
    surface = surface_at(ToothedRims(np.array([RADIUS]), rows, np.zeros(1)), 0, turned, RADIUS * turned)
    assert surface.phase == pytest.approx(0.02)
    assert (surface.by_flow, surface.by_speed) == (1.0, 1.0)


@pytest.mark.parametrize("teeth", [12, 20])
def test_the_ripple_of_a_belt_on_a_polygon(teeth: int) -> None:
    """A straight belt unwinds at the distance of its line from the shaft, times the speed of the pulley."""
    groove, phase = 2.0 * np.pi / teeth, 0.3
    row = records(TEETH, stiffness=[1.0], groove=[groove], land=[1e-7 * RADIUS])
    surface = surface_at(PolygonRims(np.array([RADIUS]), row, np.zeros(1)), 0, phase)

    def arm(turned: float) -> float:
        """Distance of the line that touches the surface, with the normal at an angle to the middle of a groove."""
        normal, near = np.array([np.cos(phase + turned), np.sin(phase + turned)]), []
        for angle in phase + turned + np.linspace(-0.6, 0.6, 13) * groove:
            place = 2.0 * RADIUS * np.array([np.cos(angle), np.sin(angle)])
            gap = shaped_gap(surface, *place)
            near.append(float(normal @ (place + gap.penetration * np.array([gap.normal_x, gap.normal_y]))))
        return max(near)

    speeds = [arm(part * groove) for part in (0.0, 0.25, 0.5)]
    assert 1.0 - speeds[0] / speeds[2] == pytest.approx(1.0 - np.cos(np.pi / teeth), rel=1e-6)
    assert speeds[1] / speeds[2] == pytest.approx(np.cos(0.5 * np.pi / teeth), rel=1e-9)
    edge = 2.0 * speeds[2] * np.sin(np.pi / teeth)
    assert polygon_seat(surface) == pytest.approx(arm(0.0), rel=1e-9)
    assert teeth * edge == pytest.approx(2.0 * np.pi * RADIUS, rel=1e-6)  # a turn is as long as that of the circle

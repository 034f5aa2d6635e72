"""Work of friction by place: powers that are known, on arcs and elements where they were done."""

import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.results.friction_work import ARC_PARTS, BEYOND, FrictionWork, Touch, arc_shares, part_of_arc
from beltdyn.results.mechanics import arc_ends

ELEMENTS, POINTS = 4, 8
CELL = np.full(POINTS, 0.05)


def touch(drive: Drive, times: list[float], power: np.ndarray, share: float = 0.5, pulley: int = 0) -> Touch:
    """The third point touches a pulley at a share of its arc; powers of shape (k,), W/m."""
    centers = np.broadcast_to(drive.centers, (len(times), 2, 2))
    inlet, wrap = arc_ends(prepare(drive), drive.centers)
    angle = inlet[pulley] + drive.pulleys[pulley].turning * share * wrap[pulley]
    place = np.zeros((len(times), POINTS, 2))
    place[:, 2] = drive.centers[pulley] + drive.radii[pulley] * np.array([np.cos(angle), np.sin(angle)])
    touched = np.full((len(times), POINTS), -1)
    touched[:, 2] = pulley
    powers = np.full((len(times), POINTS), 1e9)  # of points that are free: it does not count
    powers[:, 2] = power
    return Touch(np.array(times), centers, place, touched, powers)


def test_parts_of_an_arc_lie_evenly_about_its_middle() -> None:
    shares = arc_shares()
    width = (1.0 + 2.0 * BEYOND) / ARC_PARTS
    np.testing.assert_allclose(np.diff(shares), width, rtol=1e-12)
    np.testing.assert_allclose(shares + shares[::-1], 1.0, rtol=1e-12)
    assert shares[0] - 0.5 * width == pytest.approx(-BEYOND, rel=1e-12)


@pytest.mark.parametrize("wrap", [0.3, 2.0, 3.5])
@pytest.mark.parametrize("turning", [1.0, -1.0])
@pytest.mark.parametrize("inlet", [-2.0, 0.4, 3.0])
def test_a_point_is_in_the_part_around_it(wrap: float, turning: float, inlet: float) -> None:
    for part, share in enumerate(arc_shares()):
        assert part_of_arc(inlet + turning * share * wrap, inlet, wrap, turning) == part


def test_what_lies_further_off_counts_at_the_ends() -> None:
    assert part_of_arc(-0.9, 0.0, 1.0, 1.0) == 0
    assert part_of_arc(1.9, 0.0, 1.0, 1.0) == ARC_PARTS - 1
    assert 0 <= part_of_arc(0.1, 0.0, 0.0, 1.0) < ARC_PARTS  # a pulley that the path does not touch


@pytest.mark.parametrize("pulley", [0, 1])
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_a_steady_power_does_its_work_in_its_place(drive: Drive, share: float, pulley: int) -> None:
    """40 W/m on 0.05 m for half a second: 1 J, all in one part of an arc and in the second of four elements."""
    work = FrictionWork(prepare(drive), CELL, ELEMENTS)
    by_arc, by_belt = work.take(
        touch(drive, [0.0, 0.1, 0.5], np.full(3, 40.0), share + 1e-6, pulley), np.ones(3, dtype=bool)
    )
    np.testing.assert_allclose(by_arc.sum(axis=(1, 2)), [0.0, 0.2, 1.0], rtol=1e-12)
    np.testing.assert_allclose(by_belt[-1, pulley], [0.0, 1.0, 0.0, 0.0], rtol=1e-12)
    (part,) = np.nonzero(by_arc[-1, pulley])[0]
    assert arc_shares()[part] == pytest.approx(share, abs=1.5 / ARC_PARTS)
    assert not by_belt[:, 1 - pulley].any()


def test_a_power_that_grows_is_integrated_by_trapezoids(drive: Drive) -> None:
    times = np.array([0.0, 0.2, 0.3, 0.7])
    power = np.array([0.0, 10.0, 40.0, 20.0])
    by_arc, _ = FrictionWork(prepare(drive), CELL, ELEMENTS).take(
        touch(drive, list(times), power), np.ones(4, dtype=bool)
    )
    expected = 0.05 * np.append(0.0, np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(times)))
    np.testing.assert_allclose(by_arc.sum(axis=(1, 2)), expected, rtol=1e-12)


@pytest.mark.parametrize("cut", [1, 2, 3])
def test_how_states_are_handed_over_makes_no_difference(drive: Drive, cut: int) -> None:
    times, power = [0.3, 0.4, 0.7, 0.9], np.array([5.0, 10.0, 40.0, 20.0])
    shown = np.array([False, True, False, True])
    whole = FrictionWork(prepare(drive), CELL, ELEMENTS).take(touch(drive, times, power), shown)
    parts = FrictionWork(prepare(drive), CELL, ELEMENTS)
    pieces = [
        parts.take(touch(drive, times[some], power[some]), shown[some]) for some in (slice(cut), slice(cut, None))
    ]
    for one, each in zip(whole, zip(*pieces, strict=True), strict=True):
        np.testing.assert_allclose(np.concatenate(each), one, rtol=1e-12)

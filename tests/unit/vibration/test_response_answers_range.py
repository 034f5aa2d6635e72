"""The range of a linear response: measures in closed form."""

from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Drive, prepare
from beltdyn.results.mechanics import SpanTension
from beltdyn.vibration.response_answers import (
    RIPPLE_ERROR,
    SMALL_ERROR,
    Range,
    SteadyValues,
    friction_dashpots,
    instants,
    range_of,
)
from validation.published.cases import better, loaded_two_pulley

TIGHT, SLACK, SPEED = 500.0, 300.0, 5.0


@pytest.fixture(scope="module")
def drive() -> Drive:
    return better(loaded_two_pulley())


def looked_at(drive: Drive, tensions: Any, frequencies: Any = (100.0,), **others: Any) -> Range:
    """The range of vibrations of the two spans about 500 and 300 N."""
    still = SteadyValues(
        SpanTension.uniform(np.array([TIGHT, SLACK])), np.full(2, SPEED), drive.path.centers, np.zeros(0)
    )
    amplitudes: ComplexArray = np.atleast_2d(np.asarray(tensions, dtype=complex))
    rubbed: FloatArray = others.get("rubbed", np.abs(amplitudes).sum(axis=0))
    return range_of(prepare(drive), still, frequencies, amplitudes, np.zeros((len(amplitudes), 0), complex), rubbed)


def used_by(drive: Drive, tight: float | FloatArray, slack: float | FloatArray) -> FloatArray:
    """Share of friction used between two tensions, by Euler's formula."""
    lifted = drive.belt.mass_per_length * SPEED**2
    return np.asarray(np.log((tight - lifted) / (slack - lifted)) / (drive.frictions * drive.path.wrap_angles))


def test_small_vibrations_are_within_the_range(drive: Drive) -> None:
    found = looked_at(drive, [30.0, -30.0])
    np.testing.assert_allclose(found.ripple, [30.0 / TIGHT, 30.0 / SLACK])
    np.testing.assert_allclose(found.friction_used, used_by(drive, TIGHT + 30.0, SLACK - 30.0), rtol=1e-9)
    assert found.error == pytest.approx(RIPPLE_ERROR * 0.1**3)


def test_a_ripple_of_a_half_ends_the_range(drive: Drive) -> None:
    """A span that swings between half and one and a half of its mean, and no arc slides."""
    found = looked_at(drive, [0.0, 0.5 * SLACK])
    assert found.friction_used.max() < 1.0
    assert found.error == pytest.approx(SMALL_ERROR)


def test_a_drive_without_vibration_is_within_the_range(drive: Drive) -> None:
    found = looked_at(drive, [0.0, 0.0])
    assert found.error == found.friction_change == 0.0
    assert not found.ripple.any()


def test_orders_that_meet_are_added(drive: Drive) -> None:
    found = looked_at(drive, [[30.0, -30.0], [20.0, -20.0]], (100.0, 250.0))
    np.testing.assert_allclose(found.ripple, [50.0 / TIGHT, 50.0 / SLACK])
    np.testing.assert_allclose(found.friction_used, used_by(drive, TIGHT + 50.0, SLACK - 50.0), rtol=1e-9)


def test_an_arc_that_slides_bounds_the_amplitude(drive: Drive) -> None:
    """Between the amplitude at which Euler's ratio is met and that of the linear response."""
    weak = drive.replace(contact=drive.contact.replace(friction=0.3))
    tight = np.linspace(TIGHT, TIGHT + 150.0, 2001)
    begins = (
        tight[np.argmax(used_by(weak, tight[:, None], (SLACK + TIGHT - tight)[:, None]).max(axis=1) >= 1.0)] - TIGHT
    )
    assert 0.0 < begins < 150.0
    found = looked_at(weak, [150.0, -150.0])
    assert found.friction_used.max() > 1.0
    by_sliding = found.error - RIPPLE_ERROR * 0.5**3
    assert by_sliding == pytest.approx(150.0 / begins - 1.0, abs=0.06)


def test_sliding_counts_with_the_part_of_the_vibration_that_it_takes(drive: Drive) -> None:
    """Both spans swing alike but for a part, which the arcs take up: as much as that cannot be held is left out."""
    weak, largest, other = drive.replace(contact=drive.contact.replace(friction=0.19)), 150.0, 30.0
    swings = np.linspace(0.0, 1.0, 2001)
    used = used_by(weak, TIGHT + largest * swings[:, None], SLACK + other * swings[:, None]).max(axis=1)
    begins, part = float(swings[np.argmax(used >= 1.0)]), (largest - other) / largest
    assert 0.3 < begins < 0.8
    by_sliding = looked_at(weak, [largest, other]).error - RIPPLE_ERROR * (largest / TIGHT) ** 3
    assert part * (1.0 / (begins + 1.0 / 40.0) - 1.0) <= by_sliding <= part * (1.0 / begins - 1.0)  # in 40 steps


def test_a_pulley_counts_with_its_share(drive: Drive) -> None:
    """Where both spans swing alike its torque does not, and sliding leaves out nothing."""
    weak = drive.replace(contact=drive.contact.replace(friction=0.2))
    found = looked_at(weak, [40.0, 40.0])
    assert found.error < RIPPLE_ERROR * (40.0 / SLACK) ** 3 + 0.05


def test_a_slack_span(drive: Drive) -> None:
    found = looked_at(drive, [450.0, -450.0])
    np.testing.assert_allclose(found.ripple, [0.9, 1.5])
    assert np.isinf(found.friction_used).all()
    assert found.error > 0.5 + RIPPLE_ERROR * 1.5**3


def test_dry_friction_is_an_error_of_its_own(drive: Drive) -> None:
    found = looked_at(drive, [30.0, -30.0], rubbed=np.array([30.0, 24.0]))
    assert found.friction_change == pytest.approx(0.2)
    assert found.error == pytest.approx(0.2 + RIPPLE_ERROR * 0.1**3)


def test_dashpots_take_the_work_of_friction() -> None:
    """In a period with velocity V cos(w t): f |v| as c v^2; at rest the slope of friction over velocity."""
    friction, creep, velocity = np.array([3.0, 3.0, 0.0]), np.full(3, 1e-3), np.array([0.7, 0.0, 0.0])
    found = friction_dashpots(friction, creep, velocity)
    angle = np.linspace(0.0, 2.0 * np.pi, 100001)
    moved = velocity[0] * np.cos(angle)
    assert found[0] * np.trapezoid(moved**2, angle) == pytest.approx(np.trapezoid(3.0 * np.abs(moved), angle), rel=1e-6)
    np.testing.assert_allclose(found[1:], [3000.0, 0.0])


@pytest.mark.parametrize(
    ("frequencies", "window", "count"),
    [
        ((10.0,), 0.2 * np.pi, 24),
        ((10.0, 25.0), 0.4 * np.pi, 120),
        ((10.0, 25.0 * (1.0 - 0.9e-4)), 0.4 * np.pi, 120),
        ((10.0, 25.0 * (1.0 + 1.5e-4)), 2.4 * np.pi, 192),
        ((10.0, 10.0 * np.sqrt(2.0)), 2.4 * np.pi, 192),
    ],
)
def test_instants_meet_all_phases(frequencies: tuple[float, ...], window: float, count: int) -> None:
    times = instants(frequencies)
    assert times.size == count
    assert 0.95 * window < times.max() < window
    for frequency in frequencies:
        phases = np.sort(np.mod(frequency * times, 2.0 * np.pi))
        assert np.diff(phases).max(initial=0.0) < 0.3


def test_stops_of_a_tensioner() -> None:
    drive = bd.example("tensioner_stop")
    (tensioner,) = drive.moving_tensioners
    assert tensioner.stops is not None
    way = tensioner.stops[1] - 0.25 * tensioner.stops[1]
    spans, pulleys = len(drive.spans), len(drive.pulleys)
    tension = SpanTension.uniform(np.full(spans, 300.0))
    still = SteadyValues(tension, np.full(spans, SPEED), drive.path.centers, np.array([0.25 * tensioner.stops[1]]))
    tensions, places = np.full((1, spans), 3.0, complex), np.array([[2.0j * way]])
    found = range_of(prepare(drive), still, [100.0], tensions, places, np.full(spans, 3.0))
    nearer = min(way, 0.25 * tensioner.stops[1] - tensioner.stops[0])
    np.testing.assert_allclose(found.stop_used, [2.0 * way / nearer])
    assert found.friction_used.size == pulleys
    assert found.error == pytest.approx(2.0 * way / nearer - 1.0, abs=1e-4)

"""Springs with damper, dry friction and stops: closed forms, limits and the sense of their powers."""

from math import inf, tanh

import numpy as np
import pytest

from beltdyn.arrays import record, row
from beltdyn.machines.tensioners.tensioner import SPRING, TensionerForce, dry_friction, spring_force

HOLDER = record(spring=SPRING)
LINEAR = {"preload": 20.0, "rate": 30.0, "lower": -inf, "upper": inf, "creep_speed": 0.1}
STOPPED = LINEAR | {"lower": -0.2, "upper": 0.3, "stop_stiffness": 500.0, "stop_damping": 40.0}
STOPS = [(0.3, 1.0), (-0.2, -1.0)]
"""Places of the stops, and the senses in which they are approached."""


def force(q: float, velocity: float, **constants: float) -> TensionerForce:
    found = row(HOLDER)
    for name, value in constants.items():
        found.spring[name] = value
    result: TensionerForce = spring_force(found, q, velocity)
    return result


@pytest.mark.parametrize("q", [-0.4, 0.0, 0.1])
@pytest.mark.parametrize("velocity", [-2.0, 0.0, 3.0])
def test_spring_and_damper(q: float, velocity: float) -> None:
    """F = F_0 - k q - c v, stored k q^2 / 2 - F_0 q, lost c v^2."""
    found = force(q, velocity, **LINEAR | {"damping": 2.0})
    expected = 20.0 - 30.0 * q - 2.0 * velocity, -30.0, -2.0, 15.0 * q**2 - 20.0 * q, 2.0 * velocity**2
    assert found == pytest.approx(expected, rel=1e-14, abs=1e-15)


@pytest.mark.parametrize(("place", "side"), STOPS)
@pytest.mark.parametrize("depth", [1e-7, 1e-4, 0.05])
def test_a_stop_is_a_spring_of_its_own(place: float, side: float, depth: float) -> None:
    """It pushes back with k d from the first touch on, and stores k d^2 / 2."""
    q = place + side * depth
    free, found = force(q, 0.0, **LINEAR), force(q, 0.0, **STOPPED)
    assert found.force - free.force == pytest.approx(-side * 500.0 * depth, rel=1e-6)  # the difference of large ones
    assert found.energy - free.energy == pytest.approx(250.0 * depth**2, rel=1e-6, abs=1e-15)
    assert (found.by_position, found.by_velocity) == (-530.0, -40.0)
    assert found.loss == 0.0


@pytest.mark.parametrize("q", [-0.2, -0.1, 0.3])
@pytest.mark.parametrize("velocity", [-1.0, 0.0, 1.0])
def test_between_its_stops_a_spring_does_not_feel_them(q: float, velocity: float) -> None:
    assert force(q, velocity, **STOPPED) == force(q, velocity, **LINEAR)


@pytest.mark.parametrize(("place", "side"), STOPS)
def test_a_stop_loses_what_its_damper_takes_and_lets_go_where_it_would_pull(place: float, side: float) -> None:
    """At a depth of 0.05 m, 25 N are left for the damper: it pulls away at more than 25 / 40 m/s."""
    q = place + side * 0.05
    for velocity in (side * 2.0, -side * 0.6):
        found = force(q, velocity, **STOPPED)
        assert found.loss == pytest.approx(40.0 * velocity**2, rel=1e-14)
        assert found.by_velocity == -40.0
    left = force(q, -side * 0.7, **STOPPED)
    assert (left.force, left.by_velocity) == (force(q, 0.0, **LINEAR).force, 0.0)
    assert left.loss == pytest.approx(25.0 * 0.7, rel=1e-12)  # what the stop had stored


@pytest.mark.parametrize(("sense", "largest"), [(1.0, 1.5), (-1.0, 5.0)])
def test_dry_friction_opposes_the_motion_and_is_full_at_many_times_its_creep_speed(
    sense: float, largest: float
) -> None:
    spring = row(SPRING, tensioning_friction=1.5, yielding_friction=5.0, creep_speed=0.1)
    friction, slope = dry_friction(spring, sense * 0.1)
    assert friction == pytest.approx(sense * largest * tanh(1.0), rel=1e-15)
    assert slope == pytest.approx(largest * (1.0 - tanh(1.0) ** 2) / 0.1, rel=1e-14)
    assert dry_friction(spring, sense * 1e3) == (sense * largest, 0.0)
    found = force(0.0, sense * 1e3, tensioning_friction=1.5, yielding_friction=5.0, creep_speed=0.1, upper=inf)
    assert (found.force, found.loss) == (-sense * largest, largest * 1e3)


def test_at_rest_dry_friction_is_ready_to_resist_tensioning() -> None:
    spring = row(SPRING, tensioning_friction=1.5, yielding_friction=5.0, creep_speed=0.1)
    assert dry_friction(spring, 0.0) == pytest.approx((0.0, 15.0), rel=1e-15)
    assert dry_friction(spring, np.nextafter(0.0, -1.0))[1] == pytest.approx(50.0, rel=1e-15)

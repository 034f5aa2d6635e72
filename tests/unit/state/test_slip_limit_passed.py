"""What ends the increase of the loads, told from solutions on the way that are written down."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive, Prepared, prepare
from beltdyn.state.search import SteadySearch
from beltdyn.state.slip_limit import GROSS, Passed, Refusal, Setting, Tensions, gross_slips, slip_limit
from beltdyn.state.staying import _lying
from beltdyn.system.build import staying_system

SPEED, RADIUS = 100.0, 0.05
"""Of all rims, rad/s, and their radius, m."""
SPRING = {"kind": "sliding", "pulley": "idler", "direction": [0.0, 1.0], "mass": 0.5, "preload": 400.0, "rate": 2e4}


def drive(*tensioners: Any, **driven: Any) -> Drive:
    """A motor, a load and an idler."""
    pulleys: list[dict[str, Any]] = [
        {"name": "motor", "center": (0.0, 0.0), "speed": {"kind": "constant", "value": SPEED}},
        {"name": "fan", "center": (0.4, 0.0), "inertia": 0.01, "torque": -20.0} | driven,
        {"name": "idler", "center": (0.2, 0.25), "inertia": 0.001},
    ]
    return Drive(
        belt={"profile": "PK", "ribs": 4, "installed_tension": 200.0},
        pulley=[{"radius": RADIUS} | each for each in pulleys],
        tensioner=tensioners,
        simulation={"duration": 1.0, "output_interval": 1e-2},
    )


class Loading:
    """Solutions on the way to the loads of a drive."""

    def __init__(self, *tensioners: Any, **driven: Any) -> None:
        self.prepared: Prepared = prepare(drive(*tensioners, **driven))
        self.system = staying_system(self.prepared, self.prepared.equal_lengths(12))
        self.state = _lying(self.prepared, self.system, 1.0)
        self.state.velocity[self.system.first_body :][:3] = SPEED
        self.search = SteadySearch(self.prepared, self.system, self.state, 0.0)

    def passed(self, load: float, torques: list[float], used: list[float], slips: list[float]) -> Passed:
        """A solution, with tensions that fall by 1 N from span to span."""
        tensions = 200.0 - np.arange(3.0)
        arrays = (np.array(values) for values in (torques, used, slips))
        return Passed(Setting(load=load), self.state, SPEED * RADIUS, tensions, *arrays)

    def limit(self, *passed: Passed) -> Refusal:
        return slip_limit(self.prepared, self.search.constant, self.search.at(Setting()), passed)


@pytest.fixture(scope="module")
def loading() -> Loading:
    return Loading()


def test_a_belt_that_does_not_run_without_loads_has_no_limit(loading: Loading) -> None:
    refusal = loading.limit()
    assert not refusal.is_limit
    assert "does not get from the belt at rest to one that runs without loads" in refusal.reason


@pytest.mark.parametrize(("slip", "torque"), [(0.02, 10.0 + 2.0 / 3.0), (0.0101, 10.0 + 2.0 * 50.0 / 51.0)])
def test_the_torque_is_that_where_slip_becomes_gross(loading: Loading, slip: float, torque: float) -> None:
    """Between the solutions before and behind, in proportion to slip."""
    before, behind = [-10.0, 10.0, 0.0], [-12.0, 12.0, 0.0]
    refusal = loading.limit(
        loading.passed(0.0, [0.0] * 3, [0.0] * 3, [0.0] * 3),
        loading.passed(0.5, before, [0.5, 0.5, 0.0], [0.0, 0.5 * GROSS, 0.0]),
        loading.passed(0.6, behind, [0.9, 1.0, 0.0], [0.0, slip, 0.0]),
        loading.passed(0.7, [-9.0, 9.0, 0.0], [0.9, 1.0, 0.0], [0.0, 0.5, 0.0])._replace(tensions=np.arange(3.0)),
    )
    assert "slack" not in refusal.reason  # as it is beyond that
    assert refusal.is_limit
    assert f"slips on `fan`, which transmits at most {torque:.4g} N m of the 20 N m required" in refusal.reason


def test_a_first_solution_that_slips_is_no_limit_by_itself(loading: Loading) -> None:
    """What slips without loads counts no more."""
    slips = gross_slips([loading.passed(0.0, [0.0] * 3, [0.0] * 3, [0.0, 0.3, GROSS])] * 2)
    np.testing.assert_array_equal(slips, [[0.0, 0.0, GROSS]] * 2)


@pytest.mark.parametrize(("shares", "named"), [((0.985, 1.0), "motor"), ((1.0, 0.985), "fan"), ((0.9, 1.0), "fan")])
def test_of_pulleys_that_use_their_friction_alike_the_one_that_takes_most_power_is_named(
    loading: Loading, shares: tuple[float, float], named: str
) -> None:
    """Without gross slip; the one that is not named takes half as much, or uses a tenth less."""
    torques = [14.0, 7.0, 0.0] if named == "motor" or shares[0] < 0.95 else [7.0, 14.0, 0.0]
    refusal = loading.limit(
        loading.passed(0.0, [0.0] * 3, [0.0] * 3, [0.0] * 3), loading.passed(0.6, torques, [*shares, 0.0], [0.0] * 3)
    )
    assert f"slips on `{named}`" in refusal.reason
    assert "N m of the 20 N m required" in refusal.reason  # by the fan, whose load is all that the motor drives


def test_power_counts_and_not_torque(loading: Loading) -> None:
    """A shaft at half the speed needs more than twice the torque to take more."""
    slow = loading.state.velocity.copy()
    slow[loading.system.first_body + 1] *= 0.5
    first = loading.passed(0.0, [0.0] * 3, [0.0] * 3, [0.0] * 3)
    for torque, named in ((18.0, "motor"), (22.0, "fan")):
        last = loading.passed(0.6, [10.0, torque, 0.0], [1.0, 1.0, 0.0], [0.0] * 3)
        refusal = loading.limit(first, last._replace(state=replace(last.state, velocity=slow)))
        assert f"slips on `{named}`" in refusal.reason


def test_an_idler_limits_nothing(loading: Loading) -> None:
    """It has no load; all of its friction is used by its own bearing."""
    refusal = loading.limit(
        loading.passed(0.0, [0.0] * 3, [0.0] * 3, [0.0] * 3),
        loading.passed(0.6, [-5.0, 5.0, 30.0], [0.5, 0.4, 1.0], [GROSS] * 3),  # no slip beyond what counts as such
    )
    assert not refusal.is_limit
    assert "ends at 60.0% of the loads, where `motor` uses 50% of its friction" in refusal.reason


def test_a_motor_whose_speed_is_prescribed_is_no_idler() -> None:
    """Nor is it where the load has none of its own."""
    loading = Loading(torque=0.0)
    refusal = loading.limit(loading.passed(0.6, [5.0, 0.0, 0.0], [0.95, 0.9, 0.9], [0.0] * 3))
    assert "slips on `motor`" in refusal.reason


@pytest.mark.parametrize("turns", [True, False])
def test_a_tensioner_that_gives_way_is_named_where_the_loads_fall_again(turns: bool) -> None:
    loading = Loading(SPRING)
    loads = [0.0, 0.5, 0.4] if turns else [0.0, 0.4, 0.5]
    solutions = [loading.passed(load, [-5.0, 5.0, 0.0], [0.5, 0.5, 0.0], [0.0] * 3) for load in loads]
    for solution in solutions:
        solution.state.position[-1] = 3e-3
    refusal = loading.limit(*solutions)
    assert refusal.is_limit is turns
    message = "the tensioner of `idler` balances the belt up to 50.0% of the loads, where it stands at 0.003 m"
    assert (message in refusal.reason) is turns, refusal.reason
    assert ("the search ends at 50.0%" in refusal.reason) is not turns


def test_without_tensioners_loads_that_fall_again_are_the_end_of_the_search(loading: Loading) -> None:
    solutions = [loading.passed(load, [-5.0, 5.0, 0.0], [0.5, 0.5, 0.0], [0.0] * 3) for load in (0.0, 0.5, 0.4)]
    assert "the search ends at 50.0%" in loading.limit(*solutions).reason


@pytest.mark.parametrize(("first", "sets"), [(0.0, True), (0.05, False)])
def test_the_tension_that_is_needed_is_told_where_the_first_solution_has_no_loads(
    loading: Loading, first: float, sets: bool
) -> None:
    """12 of 20 N m by 199 N on average, less m v^2 of 25 m^2/s^2: 20/12 times as much."""
    refusal = loading.limit(
        loading.passed(first, [0.0] * 3, [0.0] * 3, [0.0] * 3),
        loading.passed(0.6, [-12.0, 12.0, 0.0], [0.9, 1.0, 0.0], [0.0, GROSS + 1e-9, 0.0]),
    )
    inertia = loading.prepared.belt.mass_per_length * (SPEED * RADIUS) ** 2
    least = 20.0 / 12.0 * (199.0 - inertia) + inertia
    assert (f"Raise the tension without loads from 199 N to at least {least:.4g} N, the" in refusal.reason) is sets
    assert ("Raise the tension, the friction" in refusal.reason) is not sets


def test_a_pulley_that_transmits_nothing_has_no_tension_with_which_it_does(loading: Loading) -> None:
    refusal = loading.limit(loading.passed(0.0, [0.0] * 3, [0.95] * 3, [0.0] * 3))
    assert "at most 0 N m of the 20 N m required" in refusal.reason
    assert "Raise the tension, the friction" in refusal.reason


def test_a_span_is_slack_below_two_per_cent_of_the_tightest(loading: Loading) -> None:
    for least, span in ((1.9, 2), (2.1, None)):
        tensions = Tensions(10.0, np.full(3, 50.0), np.array([100.0, 60.0, least]), True)
        assert tensions.slack_span == span


def test_solutions_are_observed(loading: Loading) -> None:
    """A rim faster than the belt slips by that part, and uses all of its friction, if it has any."""
    frame = loading.search.constant.frame
    frame.speed[0] = SPEED * float(loading.prepared.rolling_radii[0])
    for factor in (1.0, 1.1, 0.8):
        loading.state.velocity[loading.system.first_body + 1] = factor * SPEED
        refusal = Passed.at(Setting(), loading.prepared, loading.search.constant, loading.state)
        slip = abs(factor - 1.0) / max(factor, 1.0)
        assert refusal.slips[1] == pytest.approx(slip, abs=0.01)
        assert refusal.slips[0] == pytest.approx(0.0, abs=0.01)
        assert np.all((refusal.used >= 0.0) & (refusal.used <= 1.0 + 1e-9))
        if factor != 1.0:
            assert refusal.used[1] == pytest.approx(1.0, abs=1e-3)
    loading.state.velocity[loading.system.first_body + 1] = SPEED


def test_without_friction_none_is_used(loading: Loading) -> None:
    pulleys = loading.search.constant.pulleys.copy()
    pulleys["friction"][1] = 0.0
    loading.search.constant.frame.speed[0] = 0.9 * SPEED * RADIUS
    used = Passed.at(Setting(), loading.prepared, loading.search.constant._replace(pulleys=pulleys), loading.state).used
    assert used[1] == 0.0
    assert used[0] == pytest.approx(1.0, abs=1e-3)

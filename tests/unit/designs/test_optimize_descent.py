"""The search for the best design, on designs by formulas whose optimum is known."""

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import Watched
from beltdyn.designs.designs import Design, Free
from beltdyn.designs.optimization_history import Aims, History, Limit
from beltdyn.designs.optimize import Descent
from beltdyn.model import Drive

Results = Callable[[FloatArray], FloatArray]


def watched(name: str, at: tuple[float, ...] = (1.0,)) -> Watched:
    return Watched(name, "", lambda state: 0.0, np.array(at))


class Formulas:
    """Designs whose results, shape (points, results), are formulas of their numbers; beyond a number none runs."""

    def __init__(self, numbers: tuple[Free, ...], results: Results, runs_to: float = np.inf) -> None:
        self.numbers, self.results, self.runs_to, self.failed = numbers, results, runs_to, list[str]()

    def find(self, changes: Mapping[str, float], near: Design | None = None) -> Design:
        place = np.array([changes[one.path] for one in self.numbers])
        fails = near is not None and place[0] > self.runs_to
        return Design(changes, "the belt slips" if fails else "", self.results(place) * (np.nan if fails else 1.0))

    def derivatives(self, design: Design) -> FloatArray:
        place = np.array([design.changes[one.path] for one in self.numbers])
        steps = np.diag([1e-6 * (one.largest - one.least) for one in self.numbers])
        changes = [self.results(place + step) - self.results(place - step) for step in steps]
        return np.stack([change / (2.0 * step.sum()) for change, step in zip(changes, steps, strict=True)], axis=2)


def searched(formulas: Formulas, aims: Aims, most: int = 100) -> tuple[list[FloatArray], str]:
    """Places of the designs that are tried, in parts of the ways between bounds, and why the search ended."""
    tried = list[Design]()
    descent = Descent(formulas, aims, most, tried.append)  # type: ignore[arg-type]
    ended = descent.run(formulas.find({one.path: one.start for one in formulas.numbers}))
    return [
        np.array([(each.changes[one.path] - one.least) / (one.largest - one.least) for one in formulas.numbers])
        for each in tried
    ], ended


def corner(unit: float) -> tuple[Formulas, Aims]:
    """The lowest sum of two numbers with a product of at least 0.25 and a difference of 0.3; one is in another unit."""
    numbers = Free("x", "", 0.1, 1.1, 0.9), Free("y", "", 0.1 * unit, 2.1 * unit, 0.8 * unit)
    limits, names = (Limit("", 1, 1.0, 0.25), Limit("", 2, -1.0, -0.3)), ("sum", "product", "difference")
    aims = Aims(tuple(map(watched, names)), (0,), "", 1.0, False, limits, np.ones(1))

    def results(place: FloatArray) -> FloatArray:
        x, y = place[0], place[1] / unit
        return np.array([[x + y, x * y, x - y]])

    return Formulas(numbers, results), aims


def test_the_lowest_goal_between_limits_is_found_in_any_units() -> None:
    """Where both limits meet; designs do not depend on the unit of a number, and steps on the ways between bounds."""
    (tried, ended), (others, _) = (searched(*corner(unit)) for unit in (1.0, 1000.0))
    x = 0.5 * (np.sqrt(1.09) - 0.3)
    np.testing.assert_allclose(tried[-1], [x - 0.1, 0.5 * (x + 0.2)], atol=1e-4)
    assert ended == "no better design nearby"
    assert len(tried) < 25
    np.testing.assert_allclose(tried, others, atol=1e-3)
    starts = [np.array([0.8, 0.35]), *tried[:-1]]
    assert np.max(np.abs(tried[0] - starts[0])) == pytest.approx(0.15, abs=1e-3)
    assert all(np.max(np.abs(place - start)) < 0.51 for place, start in zip(tried, starts, strict=True))
    assert searched(*corner(1.0), most=3)[1] == "3 designs were tried"


def test_the_worst_of_several_results_is_lowered() -> None:
    """The maximum of falling and rising results has its least value where they are equal."""
    numbers = (Free("x", "", 0.0, 10.0, 9.0),)
    aims = Aims((watched("a"), watched("b")), (0, 1), "", 1.0, False, (), np.ones(1))
    tried, _ = searched(Formulas(numbers, lambda x: np.array([[3.0 * x[0], 40.0 - x[0] ** 2]])), aims)
    assert 10.0 * tried[-1][0] == pytest.approx(0.5 * (np.sqrt(169.0) - 3.0), abs=0.01)


def test_where_no_neighbor_runs_steps_are_quartered_down_to_a_ten_thousandth() -> None:
    numbers = (Free("x", "", 0.0, 1.0, 0.5),)
    aims = Aims((watched("a"),), (0,), "", -1.0, False, (), np.ones(1))
    tried, ended = searched(Formulas(numbers, lambda x: np.array([x]), runs_to=0.5), aims)
    np.testing.assert_allclose(np.ravel(tried) - 0.5, 0.15 / 4.0 ** np.arange(6), atol=1e-4)
    assert ended == "no better design nearby"
    within, _ = searched(Formulas(numbers, lambda x: np.array([x]), runs_to=0.8), aims)
    assert max(place[0] for place in within if place[0] <= 0.8) == pytest.approx(0.8, abs=1e-3)


def test_limits_count_at_their_operating_points() -> None:
    """Drawn at random: distances and their derivatives are of as many places, and the worst is the violation."""
    chance = np.random.default_rng(6)
    for _ in range(30):
        points, results = int(chance.integers(1, 5)), int(chance.integers(1, 4))
        at = chance.integers(0, 2, size=(results, points)).astype(float)
        at[:, 0] = 1.0
        limits = tuple(
            Limit("", number, float(chance.choice([-1.0, 1.0])), float(chance.uniform(0.5, 2.0)))
            for number in range(results)
        )
        named = tuple(watched(f"{number}", tuple(row)) for number, row in enumerate(at))
        aims = Aims(named, (0,), "", 1.0, False, limits, np.ones(points))
        values, slopes = chance.normal(size=(points, results)), chance.normal(size=(points, results, 2))
        values[at.T == 0.0] = np.nan
        distances = aims.distances(values)
        assert distances.size == at.sum() == sum(map(aims.places, limits))
        step = np.array([0.3, -0.2])
        changed = aims.distances(values + slopes @ step) - distances
        np.testing.assert_allclose(aims.distances(slopes) @ step, changed, atol=1e-12)
        bounds = np.concatenate([np.full(aims.places(one), one.value) for one in limits])
        assert aims.violation(values) == pytest.approx(float(np.max(-distances / bounds)))


@pytest.mark.parametrize(
    ("failures", "words"), [(0, ""), (1, "1 design failed and is"), (2, "2 designs failed and are")]
)
def test_designs_that_failed_are_counted(drive: Drive, failures: int, words: str) -> None:
    numbers, values = (Free("x", "", 0.0, 1.0, 0.5),), np.zeros((1, 1))
    history = History(drive, numbers, [], Aims((watched("a"),), (0,), "", 1.0, False, (), np.ones(1)))
    best = Design({"x": 0.5}, "", values)
    history.tried = [best, *(Design({"x": 0.1 * k}, f"slip {k}", values) for k in range(1, failures + 1)), best]
    told = [text for text in history._warnings(best) if "failed" in text]
    assert told == ([f"{words} excluded. The last failure: slip {failures}"] if failures else [])

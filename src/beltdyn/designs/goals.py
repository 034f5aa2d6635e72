"""Goal and limits of a study as functions of its watched results."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import OperatingPoint, Watched, clearance, distance_from_order, named
from beltdyn.designs.named_results import names_in, names_of
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.parameter_study import Bound, Goal, OptimizationStudy
from beltdyn.parts.quantity import to_si


@dataclass(frozen=True)
class Limit:
    """What a watched result must keep to at every operating point at which it counts."""

    name: str
    """In words; that of a requirement is the same for all pulleys."""
    result: int
    """Number of the watched result."""
    sign: float
    """1 for a least value, -1 for a largest one."""
    value: float


@dataclass(frozen=True)
class Aims:
    """What a study wants of the results that it watches."""

    watched: tuple[Watched, ...]
    goal: tuple[int, ...]
    """Numbers of the watched results of the goal."""
    words: str
    """The goal in words."""
    sign: float
    """1 where less is better, -1 where more is."""
    mean: bool
    """Whether the mean counts, not the worst."""
    limits: tuple[Limit, ...]
    weights: FloatArray
    """Of the operating points in means."""

    def places(self, limit: Limit) -> int:
        """At how many operating points a limit counts."""
        return int(self.watched[limit.result].at.sum())

    def goal_values(self, values: FloatArray) -> FloatArray:
        """The values whose maximum is the goal, from results of shape (points, results, ...), with their sign."""
        chosen = self.sign * values[:, list(self.goal)]
        if self.mean:
            return np.tensordot(self.weights, chosen.mean(axis=1), 1)[None]
        return chosen.reshape(-1, *chosen.shape[2:])

    def goal_of(self, values: FloatArray) -> float:
        """The goal of a design, in the unit of the result, from results of shape (points, results)."""
        return float(self.sign * np.max(self.goal_values(values)))

    def distances(self, values: FloatArray) -> FloatArray:
        """Distances of results within limits, for each limit and operating point at which it counts.

        Derivatives, shape (points, results, numbers), give derivatives.
        """
        found = []
        for limit in self.limits:
            chosen = values[self.watched[limit.result].at > 0.0, limit.result]
            found.append(limit.sign * (chosen - (limit.value if values.ndim == 2 else 0.0)))
        return np.concatenate(found) if found else np.zeros((0, *values.shape[2:]))

    def violation(self, values: FloatArray) -> float:
        """By how much the worst limit is violated, over the limit; zero or less where all are kept."""
        worst = -np.inf
        for limit in self.limits:
            beyond = limit.sign * (limit.value - values[self.watched[limit.result].at > 0.0, limit.result])
            worst = max(worst, float(np.max(np.nan_to_num(beyond, nan=-np.inf))) / (abs(limit.value) or 1.0))
        return worst


def aims_of(study: OptimizationStudy, drive: Drive, points: Sequence[OperatingPoint]) -> Aims:
    """Read goal and limits of a study."""
    watched: dict[str, Watched] = {}
    known, limits = names_of(drive), list[Limit]()

    def number_of(one: Watched) -> int:
        watched.setdefault(one.name, one)
        return list(watched).index(one.name)

    def numbers_of(names: str, key: str) -> list[int]:
        return [number_of(named(name, drive, len(points))) for name in names_in(known, names, key)]

    goal = numbers_of(study.goal.result, "goal.result")
    for place, one in enumerate(study.requirements, 1):
        for number in numbers_of(one.result, f"requirement[{place}].result"):
            for key, sign in (("at_least", 1.0), ("at_most", -1.0)):
                bound, unit = getattr(one, key), list(watched.values())[number].unit
                if bound is not None:
                    value = _limit(bound, unit, f"requirement[{place}].{key}")
                    words = f"{one.result} {key.replace('_', ' ')} {value:.5g} {unit}".rstrip()
                    limits.append(Limit(words, number, sign, value))
    for order in study.orders:
        away = distance_from_order(order, drive, points)
        limits.append(Limit(f"{away.name} at least {order.distance:g}", number_of(away), 1.0, order.distance))
    for obstacle in study.obstacles:
        near = clearance(obstacle, len(points))
        words = f"{near.name} at least {obstacle.clearance:g} m"
        limits.append(Limit(words, number_of(near), 1.0, obstacle.clearance))
    return Aims(
        tuple(watched.values()),
        tuple(goal),
        _words(study.goal),
        1.0 if study.goal.sense == "minimize" else -1.0,
        study.goal.over == "mean",
        tuple(limits),
        np.array([point.weight for point in points]),
    )


def _words(goal: Goal) -> str:
    """A goal in words."""
    which = {("minimize", "worst"): "largest ", ("maximize", "worst"): "least "}.get((goal.sense, goal.over), "mean ")
    said = goal.result.startswith(which.strip())  # such as largest_tension
    return f"{goal.sense} {'' if said else which}{goal.result}"


def _limit(bound: Bound, unit: str, key: str) -> float:
    """A limit in SI units."""
    try:
        return to_si(bound, unit) if isinstance(bound, str) else float(bound)
    except ValueError as error:
        raise ModelError(f"{key} = {bound!r} {error}.") from error

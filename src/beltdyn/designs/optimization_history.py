"""Goal and limits of an optimization, and the designs that it has tried: a result, and the best drive file."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import OperatingPoint, Watched, clearance, distance_from_order, named
from beltdyn.designs.designs import Design, Free
from beltdyn.designs.named_results import names_in, names_of, variable_and_label
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.parameter_study import Bound, Goal, OptimizationStudy
from beltdyn.model.toml import edited, loads
from beltdyn.parts.quantity import to_si
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.atomic import atomic_path, locked_output, require_replaceable, target_of
from beltdyn.results.dataset import is_result
from beltdyn.results.recorder import status_after
from beltdyn.results.schema import VARIOUS
from beltdyn.signals import closing, uninterrupted


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
        """The values whose maximum is the goal, with their sign, from results of shape (points, results).

        What has no value, such as the tooth load of a pulley without teeth, does not count; without any it is infinite.
        """
        found = self._goals(values, values[..., None])[:, 0]
        return found if found.size else np.full(1, np.inf)

    def goal_slopes(self, values: FloatArray, derivatives: FloatArray) -> FloatArray:
        """Derivatives of `goal_values`, shape (values, numbers), from those of shape (points, results, numbers)."""
        return self._goals(values, derivatives)

    def _goals(self, values: FloatArray, chosen: FloatArray) -> FloatArray:
        """What is chosen of results, shape (points, results, n), for a goal, where they have a value."""
        goal = list(self.goal)
        counted, signed = np.isfinite(values[:, goal]), self.sign * chosen[:, goal]
        if not self.mean:
            return np.asarray(signed[counted])
        weights = self.weights[:, None] * counted
        return (
            np.asarray(weights[counted] @ signed[counted] / weights.sum())[None] if counted.any() else signed[counted]
        )

    def require_values(self, values: FloatArray) -> None:
        """Make sure that some result of the goal has a value at some operating point."""
        if not np.isfinite(values[:, list(self.goal)]).any():
            names = ", ".join(self.watched[number].name for number in self.goal)
            raise ModelError(
                f"the goal has no value: {names} cannot be computed for this drive at any operating point. Choose "
                "another result."
            )

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


# The drive file that a study has found, beside its result file

_MARK = "# Found by `beltdyn "


def headed(text: str, analysis: str) -> str:
    """The text of a drive with its origin in the first line."""
    return f"{_MARK}{analysis}`.\n{text.removeprefix(_first_line(text))}"


def found_file(output: Path) -> Path:
    """The drive file beside a result file."""
    return output.with_suffix(".toml")


def require_free(output: Path, overwrite: bool, study: object) -> None:
    """Make sure that a result file and the drive file beside it would replace nothing but such."""
    if isinstance(study, Path | str) and target_of(found_file(output)) == target_of(Path(study)):
        raise ModelError(
            f"the optimized drive would be written to {found_file(output)}, which is the study file. Choose "
            "another result file."
        )
    require_replaceable(output, is_result, overwrite)
    require_replaceable(found_file(output), _is_found, overwrite)


def write_found(output: Path, text: str, overwrite: bool) -> None:
    """Write the drive file beside a result file."""
    with atomic_path(found_file(output), _is_found, overwrite) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _first_line(text: str) -> str:
    """The first line if it is ours."""
    line = text.partition("\n")[0]
    return f"{line}\n" if line.startswith(_MARK) else ""


def _is_found(path: Path) -> bool:
    """Tell whether a drive file was written by a study."""
    with path.open("rb") as file:
        return file.read(len(_MARK)) == _MARK.encode()


_KEPT = 1e-4
"""Permitted violation of a limit, relative."""

_NUMBER, _REQUIREMENT, _DESIGN = ("number",), ("requirement",), ("design",)
_BOTH = ("point", "result")

_VARIABLES = {
    "goal_at_start": Variable((), VARIOUS, "Goal at the start"),
    "goal_found": Variable((), VARIOUS, "Goal of the best design"),
    "designs": Variable((), "1", "Designs tried", "int64"),
    "ended": Variable((), "1", "Reason for ending the search", "str"),
    "best_file": Variable((), "1", "Best drive file", "str"),
    "least": Variable(_NUMBER, VARIOUS, "Least"),
    "start": Variable(_NUMBER, VARIOUS, "Start"),
    "best": Variable(_NUMBER, VARIOUS, "Best"),
    "largest": Variable(_NUMBER, VARIOUS, "Largest"),
    "number_unit": Variable(_NUMBER, "1", "Unit", "str"),
    "worst_at_start": Variable(_REQUIREMENT, VARIOUS, "Start"),
    "worst": Variable(_REQUIREMENT, VARIOUS, "Best"),
    "requirement_unit": Variable(_REQUIREMENT, "1", "Unit", "str"),
    "worst_at": Variable(_REQUIREMENT, "1", "At", "str"),
    "design_number": Variable((*_DESIGN, "number"), "1", "Parameter of the design, in its unit"),
    "design_goal": Variable(_DESIGN, VARIOUS, "Goal of the design"),
    "design_violation": Variable(_DESIGN, "1", "Violation of limits, over the limit"),
    "failure": Variable(_DESIGN, "1", "Why the design failed", "str"),
    "start_result": Variable(_BOTH, VARIOUS, "Result at the start, in its unit"),
    "best_result": Variable(_BOTH, VARIOUS, "Result of the best design, in its unit"),
}
"""What is known of an optimization; the unit of goals is that of the result."""

_COORDINATES = {
    "number": Variable(_NUMBER, "1", "Number", "str"),
    "requirement": Variable(_REQUIREMENT, "1", "Goal and limits", "str"),
    "point": Variable(("point",), "1", "Operating point", "str"),
    "result": Variable(("result",), "1", "Result", "str"),
    "result_unit": Variable(("result",), "1", "Unit", "str"),
}


class History:
    """Designs as they are tried; an interruption keeps them."""

    def __init__(
        self,
        drive: Drive,
        numbers: Sequence[Free],
        points: Sequence[OperatingPoint],
        aims: Aims,
        output: Path | str | None = None,
        overwrite: bool = False,
        study: object = None,
    ) -> None:
        self._drive, self._numbers, self._points, self._aims = drive, numbers, points, aims
        self._path, self._overwrite = None if output is None else Path(output), overwrite
        if self._path is not None:
            require_free(self._path, overwrite, study)
        self._held = ExitStack()
        self.tried: list[Design] = []
        self._final: Design | None = None
        self._status, self._ended, self._warned = "running", "interrupted", list[str]()

    def __enter__(self) -> Self:
        """Begin."""
        if self._path is not None:
            self._held.enter_context(locked_output(self._path))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        """End with a status, and write what there is."""
        self._status = status_after(kind)
        with closing(), self._held:
            self._save()
        return self._status == "interrupted"

    def note(self, design: Design) -> None:
        """Keep a design that was tried."""
        self.tried.append(design)
        self._save()

    def end(self, reason: str, best: Design, warnings: Sequence[str]) -> None:
        """Keep the best design as it is found anew, on a mesh of its own, and why the search ended."""
        self._final, self._ended, self._warned = best, reason, list(dict.fromkeys(warnings))

    @property
    def best(self) -> Design:
        """The design with the best goal among those that keep to all limits, or else with the least violation."""
        running = [one for one in self.tried if not one.failure]
        kept = [one for one in running if self._aims.violation(one.values) <= _KEPT]
        if kept:
            return min(kept, key=lambda one: float(np.max(self._aims.goal_values(one.values))))
        return min(running, key=lambda one: self._aims.violation(one.values))

    def result(self) -> Result:
        """What was found until now."""
        start, best = self.tried[0], self._final or self.best
        text = headed(edited(self._drive, best.changes), "optimize")
        arrays = self._singles(start, best) | self._of_numbers(best) | self._of_designs()
        arrays |= self._of_requirements(start, best) | {"start_result": start.values, "best_result": best.values}
        watched, numbers = self._aims.watched, [one.path for one in self._numbers]
        labels: dict[str, ArrayLike] = {
            "number": numbers,
            "requirement": list(self._groups()),
            "point": [one.label for one in self._points],
            "result": [one.name for one in watched],
            "result_unit": [one.unit for one in watched],
        }
        result = build_result(
            "optimize",
            loads(text),
            {name: (_VARIABLES[name], values) for name, values in arrays.items()},
            {name: (one, labels[name]) for name, one in _COORDINATES.items()},
            list(self._warnings(best)),
        )
        more = {"status": self._status, "drive_as_given": self._drive.text, "best_drive": text}
        more["title"] = f"{self._drive.title}: {self._aims.words}"
        return Result(result.dataset.assign_attrs(more), result.drive)

    def _singles(self, start: Design, best: Design) -> dict[str, ArrayLike]:
        named = {} if self._path is None else {"best_file": str(found_file(self._path))}
        return {
            "goal_at_start": self._aims.goal_of(start.values),
            "goal_found": self._aims.goal_of(best.values),
            "designs": len(self.tried),
            "ended": self._ended + self._within_tolerance(best),
            **named,
        }

    def _within_tolerance(self, best: Design) -> str:
        """Violation of a limit by the best design, within the tolerance."""
        beyond = self._aims.violation(best.values)
        if not 0.0 < beyond <= _KEPT:
            return ""
        return f"; a limit is violated by {beyond:.2g} (relative), within the tolerance of {_KEPT:g}"

    def _of_numbers(self, best: Design) -> dict[str, ArrayLike]:
        return {
            "least": [one.least for one in self._numbers],
            "start": [one.start for one in self._numbers],
            "best": [best.changes[one.path] for one in self._numbers],
            "largest": [one.largest for one in self._numbers],
            "number_unit": [one.unit for one in self._numbers],
        }

    def _of_designs(self) -> dict[str, ArrayLike]:
        found = [not one.failure for one in self.tried]
        goals = [self._aims.goal_of(one.values) if ok else np.nan for one, ok in zip(self.tried, found, strict=True)]
        beyond = [self._aims.violation(one.values) if ok else np.nan for one, ok in zip(self.tried, found, strict=True)]
        return {
            "design_number": [[one.changes[number.path] for number in self._numbers] for one in self.tried],
            "design_goal": goals,
            "design_violation": np.maximum(beyond, 0.0),
            "failure": [one.failure for one in self.tried],
        }

    def _groups(self) -> dict[str, list[Limit]]:
        """The goal as a limit without a value, and the limits, by their names."""
        aims, groups = self._aims, dict[str, list[Limit]]()
        groups[aims.words] = [Limit(aims.words, number, -aims.sign, 0.0) for number in aims.goal]
        for limit in aims.limits:
            groups.setdefault(limit.name, []).append(limit)
        return groups

    def _of_requirements(self, start: Design, best: Design) -> dict[str, ArrayLike]:
        groups = self._groups()
        before, after = ([self._worst(design.values, group) for group in groups.values()] for design in (start, best))
        firsts = [self._aims.watched[group[0].result] for group in groups.values()]
        return {
            "worst_at_start": [value for value, _ in before],
            "worst": [value for value, _ in after],
            "requirement_unit": [one.unit for one in firsts],
            "worst_at": [where for _, where in after],
        }

    def _worst(self, values: FloatArray, group: Sequence[Limit]) -> tuple[float, str]:
        """The worst value of results, and where it is."""
        signed = np.array([limit.sign * values[:, limit.result] for limit in group])
        if not np.isfinite(signed).any():
            return np.nan, ""
        place, point = map(int, np.unravel_index(int(np.nanargmin(signed)), signed.shape))
        _, label = variable_and_label(self._aims.watched[group[place].result].name)
        where = self._points[point].label if len(self._points) > 1 else ""
        return group[place].sign * float(signed[place, point]), ", ".join(filter(None, (label, where)))

    def _has_value(self, best: Design, group: Sequence[Limit]) -> bool:
        return not np.isnan(best.values[:, [limit.result for limit in group]]).all()

    def _warnings(self, best: Design) -> list[str]:
        """Warnings about the best design."""
        found, beyond = list(self._warned), self._aims.violation(best.values)
        if beyond > _KEPT:
            found.append(
                f"no design satisfies all limits: the best one violates them by {beyond:.2%}. Widen the bounds, "
                "vary more parameters, or relax the limits."
            )
        empty = [name for name, group in self._groups().items() if not self._has_value(best, group)]
        if empty:
            found.append(f"{', '.join(empty)}: no result has a value at any operating point, so nothing is limited.")
        at_bounds = [one.path for one in self._numbers if best.changes[one.path] in (one.least, one.largest)]
        if at_bounds:
            found.append(f"{', '.join(at_bounds)}: the best value lies at a bound. Widen it if possible.")
        failed = [one for one in self.tried if one.failure]
        if failed:
            count = f"{len(failed)} designs" if failed[1:] else "1 design"
            found.append(
                f"{count} failed and {'are' if failed[1:] else 'is'} excluded. The last failure: {failed[-1].failure}"
            )
        return found

    def _save(self) -> None:
        """Write the files, if they are named."""
        if self._path is None or not self.tried:
            return
        with uninterrupted():
            result = self.result()
            result.save(self._path, self._overwrite)
            write_found(self._path, str(result.dataset.attrs["best_drive"]), self._overwrite)

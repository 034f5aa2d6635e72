"""The search for the best design: sequential quadratic programming (SLSQP of SciPy) on goal and limits of a study.

The worst of several numbers has kinks, so that the goal becomes one more unknown t, of which every number is a limit:
the least t with t >= g_k(x), and with all limits of the study.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.solve.designs import Design, Designs
from beltdyn.solve.goals import Aims

_SETTLED = 1e-5
"""Change of the goal at which the search ends, over the scale of the goal."""
_CAUTION = 3.0
"""The scale of the goal over its change along the whole way between bounds: the first step is a third of a way."""
_REFUSED = 10.0
"""How much worse than any limit a design without steady running counts, over the scale of the goal and of limits."""
_UNBOUND = 1e3
"""Distance from a limit of a result that has no value there, such as the slip safety of a pulley without load."""


class Enough(Exception):
    """As many designs as were asked for have been tried."""


class Descent:
    """Tries designs, each from the states of the last one, until none is better.

    Parameters
    ----------
    designs
        Finds their results.
    aims
        Goal and limits.
    most
        How many designs to try.
    note
        Called with each design that was tried.
    """

    def __init__(self, designs: Designs, aims: Aims, most: int, note: Callable[[Design], None]) -> None:
        self._designs, self._aims, self._most, self._note = designs, aims, most, note
        self._count = 1
        self._known: dict[bytes, Design] = {}
        self._slopes: dict[bytes, FloatArray] = {}
        self._near: Design | None = None
        self._ranges = np.array([one.largest - one.least for one in designs.numbers])
        self._goal_scale, self._scales = 1.0, np.ones(0)

    def run(self, start: Design) -> str:
        """Search from a design that runs.

        Returns
        -------
        str
            Why it ended.
        """
        from scipy.optimize import Bounds, NonlinearConstraint, minimize

        numbers = self._designs.numbers
        first = np.array([(one.start - one.least) / (one.largest - one.least) for one in numbers])
        self._near = start
        self._known[self._key(first)] = start
        goals, slack = self._aims.goal_values(start.values), self._aims.distances(start.values)
        derivatives = self._designs.derivatives(start)
        steepest = np.abs(self._aims.goal_values(derivatives)[int(np.argmax(goals))] * self._ranges).max()
        self._goal_scale = _CAUTION * float(steepest) or 1.0
        limits = np.array([limit.value for limit in self._aims.limits for _ in range(self._aims.places(limit))])
        self._scales = np.maximum(np.abs(np.nan_to_num(slack)), np.maximum(np.abs(limits), 1e-12))
        self._slopes[self._key(first)] = self._scaled_slopes(derivatives)
        unknowns = np.append(first, float(np.max(goals)) / self._goal_scale)
        downhill = np.append(np.zeros(len(numbers)), 1.0)
        search: Callable[..., Any] = minimize
        constraint = NonlinearConstraint(self._distances, 0.0, np.inf, self._distance_slopes)
        try:
            found = search(
                lambda z: float(z[-1]) + _REFUSED * bool(self._at(z[:-1]).failure),
                unknowns,
                jac=lambda _: downhill,
                method="SLSQP",
                bounds=Bounds(np.append(0.0 * first, -np.inf), np.append(0.0 * first + 1.0, np.inf)),
                constraints=constraint,
                options={"ftol": _SETTLED, "maxiter": self._most},
            )
        except Enough:
            return f"{self._most} designs were tried"
        return "no better design was found nearby" if found.status in (0, 8) else str(found.message)

    def _key(self, parts: FloatArray) -> bytes:
        return np.array([one.at(part) for one, part in zip(self._designs.numbers, parts, strict=True)]).tobytes()

    def _at(self, parts: FloatArray) -> Design:
        """The design at parts of the ways between bounds."""
        key = self._key(parts)
        if key not in self._known:
            if self._count >= self._most:
                raise Enough
            changes = {one.path: one.at(part) for one, part in zip(self._designs.numbers, parts, strict=True)}
            design = self._designs.find(changes, self._near)
            self._known[key] = design
            self._count += 1
            self._note(design)
        return self._known[key]

    def _distances(self, z: FloatArray) -> FloatArray:
        """Distances of t from the numbers of the goal, and from limits; far beyond all without steady running."""
        design = self._at(z[:-1])
        if design.failure:
            count = self._aims.goal_values(design.values).size + self._scales.size
            return np.full(count, -_REFUSED)
        goals = z[-1] - self._aims.goal_values(design.values) / self._goal_scale
        limits = np.nan_to_num(self._aims.distances(design.values) / self._scales, nan=_UNBOUND, posinf=_UNBOUND)
        return np.asarray(np.nan_to_num(np.concatenate([goals, limits]), nan=_UNBOUND))

    def _distance_slopes(self, z: FloatArray) -> FloatArray:
        """Their derivatives by the unknowns."""
        key = self._key(z[:-1])
        if key not in self._slopes:
            design = self._at(z[:-1])
            if design.failure:
                return np.zeros((self._distances(z).size, z.size))
            self._near = design
            self._slopes[key] = self._scaled_slopes(self._designs.derivatives(design))
        return self._slopes[key]

    def _scaled_slopes(self, derivatives: FloatArray) -> FloatArray:
        goals = -self._aims.goal_values(derivatives) / self._goal_scale
        rows = np.concatenate([goals, self._aims.distances(derivatives) / self._scales[:, None]]) * self._ranges
        last = np.concatenate([np.ones(len(goals)), np.zeros(self._scales.size)])
        return np.column_stack([rows, last])

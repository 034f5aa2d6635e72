"""Work of friction by place on the arcs and by place on the belt, integrated over the steps of a run."""

from math import atan2, pi
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.model import Prepared
from beltdyn.results.mechanics import arc_ends

# Work of friction by place on the belt, where the belt flows through the mesh

_LEAST = 1e-9
"""Shortest way of a belt that counts, over its length."""


class MaterialWork:
    """Transfers work in pieces of a mesh to the pieces of belt that were there, by their lengths (m)."""

    def __init__(self, lengths: FloatArray) -> None:
        self._ends = np.concatenate([[0.0], np.cumsum(lengths)])
        self._before: FloatArray | None = None
        self._passed = np.zeros(lengths.size)

    def take(self, by_mesh: FloatArray, passed: FloatArray) -> FloatArray:
        """Work on each piece of the belt since the beginning, J, from that in each piece of the mesh, shape (m, P, E).

        `passed` is the length of belt that has passed each of these by then, m, shape (m, E).
        """
        if self._before is None:
            self._before, self._total = np.zeros(by_mesh.shape[1:]), np.zeros(by_mesh.shape[1:])
        grown = np.diff(by_mesh, axis=0, prepend=self._before[None])
        ways = np.concatenate([self._passed[None], passed])
        work = np.empty_like(by_mesh)
        spread_on_belt(grown, ways, self._ends, self._total, work)
        self._before, self._passed = by_mesh[-1].copy(), passed[-1].copy()
        return work


@kernel
def spread_on_belt(grown: FloatArray, ways: FloatArray, ends: FloatArray, total: FloatArray, work: FloatArray) -> None:
    """Spread what work grows by from state to state on the belt that has passed.

    `grown`: by piece of the mesh, J, shape (m, P, E); `ways`: length of belt that has passed each piece, m, in the
    state before and in each of these, shape (m + 1, E); `ends`: of the pieces, from zero, m, shape (E + 1,); `total`:
    work on each piece of the belt up to the state before, J; afterwards up to the last, shape (P, E); `work`:
    overwritten by the work up to each state, J, shape (m, P, E).
    """
    states, pulleys, pieces = grown.shape
    length = ends[pieces]
    for k in range(states):
        for pulley in range(pulleys):
            for piece in range(pieces):
                done = grown[k, pulley, piece]
                if done == 0.0:
                    continue
                p, q = min(ways[k, piece], ways[k + 1, piece]), max(ways[k, piece], ways[k + 1, piece])
                turns = np.floor((q - p) / length)
                even = turns * length / (q - p) if turns > 0.0 else 0.0
                q = max(q - turns * length, p + _LEAST * length)
                a, b = ends[piece], ends[piece + 1]
                if even > 0.0:
                    for other in range(pieces):
                        total[pulley, other] += even * done * (ends[other + 1] - ends[other]) / length
                first = np.floor((a - q) / length) * length
                other = np.searchsorted(ends, a - q - first, side="right") - 1
                other, before = min(other, pieces - 1), 0.0
                while before < 1.0:
                    x = first + ends[other + 1]
                    part = 1.0 if x >= b - p else _before(x, a, b, p, q)
                    total[pulley, other] += (1.0 - even) * done * (part - before)
                    before, other = part, other + 1
                    if other == pieces:
                        other, first = 0, first + length
        for pulley in range(pulleys):
            for piece in range(pieces):
                work[k, pulley, piece] = total[pulley, piece]


@kernel(inline=True)
def _before(x: float, a: float, b: float, p: float, q: float) -> float:
    """Part of the work in [a, b] that falls on belt before x while p to q passes."""
    at = (max(x - a + q, 0.0), max(x - a + p, 0.0), max(x - b + q, 0.0), max(x - b + p, 0.0))
    square = at[0] * at[0] - at[1] * at[1] - at[2] * at[2] + at[3] * at[3]
    return 0.5 * square / ((b - a) * (q - p))


ARC_PARTS = 60
"""Equal parts of an arc in which work is summed up."""

BEYOND = 0.25
"""Share of the arc between the tangent points by which these parts reach further at both of its ends."""


def arc_shares() -> FloatArray:
    """Middles of the parts of an arc as shares of it: 0 where the belt's path reaches the pulley, 1 where it leaves."""
    return (1.0 + 2.0 * BEYOND) * (np.arange(ARC_PARTS) + 0.5) / ARC_PARTS - BEYOND


class Touch(NamedTuple):
    """Where a belt touches pulleys in k states, and what friction does there."""

    time: FloatArray
    """s, shape (k,)."""
    center: FloatArray
    """Of the pulleys, m, shape (k, P, 2)."""
    place: FloatArray
    """Of the contact points, m, shape (k, points, 2)."""
    pulley: IntArray
    """Number of the pulley that each point touches, -1 where it is free, shape (k, points)."""
    power: FloatArray
    """|f_t v_t|, W/m, shape (k, points)."""


class WorkSoFar(NamedTuple):
    """Work of friction up to a state, by part of an arc, then by piece of the belt; changed in place."""

    power: FloatArray
    """Powers at the state before and at this one, W, shape (2, P, ARC_PARTS + elements)."""
    total: FloatArray
    """J, shape (P, ARC_PARTS + elements)."""


class FrictionWork:
    """Integrals over time of the power |f_t v_t|, by the trapezoidal rule over successive states.

    `cell` is the length of belt of each contact point, m; each of the `elements` has as many points.
    """

    def __init__(self, prepared: Prepared, cell: FloatArray, elements: int) -> None:
        pulleys = len(prepared.pulleys)
        self._prepared, self._cell, self._elements = prepared, np.ascontiguousarray(cell, dtype=float), elements
        self._turning = np.array([float(pulley.turning) for pulley in prepared.pulleys])
        self._time = np.inf
        parts = pulleys, ARC_PARTS + elements
        self._done = WorkSoFar(np.zeros((2, *parts)), np.zeros(parts))

    def take(self, touch: Touch, shown: BoolArray) -> tuple[FloatArray, FloatArray]:
        """Work since the first state, J, for the m shown of k further states.

        By place on the arc, shape (m, pulleys, ARC_PARTS), and on the belt, shape (m, pulleys, elements).
        """
        inlet, wrap = arc_ends(self._prepared, touch.center)
        arcs = np.stack([inlet, wrap, np.broadcast_to(self._turning, wrap.shape)], axis=-1)
        work = np.empty((np.count_nonzero(shown), *self._done.total.shape))
        passed = np.diff(touch.time, prepend=min(self._time, touch.time[0]))
        add_friction_work(touch, arcs, passed, self._cell, shown, self._done, work)
        self._time = float(touch.time[-1])
        return work[..., :ARC_PARTS], work[..., ARC_PARTS:]


@kernel
def add_friction_work(
    touch: Touch,
    arcs: FloatArray,
    passed: FloatArray,
    cell: FloatArray,
    shown: BoolArray,
    done: WorkSoFar,
    work: FloatArray,
) -> None:
    """Integrate the work of friction over the steps to k states.

    `touch`: contact in these states; `arcs`: of each pulley: angle of the inlet and wrap angle, rad; 1, or -1 for a
    pulley at the belt's back, shape (k, P, 3); `passed`: lengths of the steps, s, shape (k,); `cell`: length of belt
    that each contact point stands for, m, shape (points,); `shown`: after which steps the work is kept, shape (k,);
    `done`: up to the state before them, and afterwards up to the last of them; `work`: overwritten by the work in the
    states that are shown, shape (m, P, ARC_PARTS + elements).
    """
    power, total = done.power, done.total
    pulleys, parts = total.shape
    points = cell.size // (parts - ARC_PARTS)
    show = 0
    for k in range(passed.size):
        for p in range(pulleys):
            for part in range(parts):
                power[0, p, part], power[1, p, part] = power[1, p, part], 0.0
        for point in range(cell.size):
            p = touch.pulley[k, point]
            if p >= 0:
                x = touch.place[k, point, 0] - touch.center[k, p, 0]
                y = touch.place[k, point, 1] - touch.center[k, p, 1]
                part = part_of_arc(atan2(y, x), arcs[k, p, 0], arcs[k, p, 1], arcs[k, p, 2])
                lost = touch.power[k, point] * cell[point]
                power[1, p, part] += lost
                power[1, p, ARC_PARTS + point // points] += lost
        for p in range(pulleys):
            for part in range(parts):
                total[p, part] += 0.5 * passed[k] * (power[0, p, part] + power[1, p, part])
                if shown[k]:
                    work[show, p, part] = total[p, part]
        show += shown[k]


@kernel(inline=True)
def part_of_arc(angle: float, inlet: float, wrap: float, turning: float) -> int:
    """Part of an arc in which a point at an angle about the pulley (rad) lies; see `arc.angle_from_inlet`."""
    free = 0.5 * (2.0 * pi - wrap)
    along = (turning * (angle - inlet) + free) % (2.0 * pi) - free
    share = along / wrap if wrap > 0.0 else 0.0
    return min(max(int((share + BEYOND) / (1.0 + 2.0 * BEYOND) * ARC_PARTS), 0), ARC_PARTS - 1)

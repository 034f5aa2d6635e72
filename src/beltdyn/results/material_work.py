"""Work of friction by place on the belt, where the belt flows through the mesh.

Work done in a piece [a, b] of the mesh while the length of belt that has passed grows from p to q falls on the belt
from a - q to b - p.  With a power that is even over the piece and the time, the part of it on belt before x is

    (Q(x - a + q) - Q(x - a + p) - Q(x - b + q) + Q(x - b + p)) / ((b - a) (q - p)),    Q(y) = max(y, 0)^2 / 2.

Whole turns of the belt spread it evenly.
"""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel

_LEAST = 1e-9
"""Shortest way of a belt that counts, over its length."""


class MaterialWork:
    """Hands on work by pieces of a mesh to the belt that was there.

    Parameters
    ----------
    lengths : ndarray, shape (E,)
        Of the pieces, m. Pieces of the belt are those that were there at the beginning.
    """

    def __init__(self, lengths: FloatArray) -> None:
        self._ends = np.concatenate([[0.0], np.cumsum(lengths)])
        self._before: FloatArray | None = None
        self._passed = 0.0

    def take(self, by_mesh: FloatArray, passed: FloatArray) -> FloatArray:
        """Go on to further states.

        Parameters
        ----------
        by_mesh : ndarray, shape (m, P, E)
            Work since the beginning in each piece of the mesh, J.
        passed : ndarray, shape (m,)
            Length of belt that has passed since the beginning, m.

        Returns
        -------
        ndarray, shape (m, P, E)
            Work since the beginning on each piece of the belt, J.
        """
        if self._before is None:
            self._before, self._total = np.zeros(by_mesh.shape[1:]), np.zeros(by_mesh.shape[1:])
        grown = np.diff(by_mesh, axis=0, prepend=self._before[None])
        ways = np.concatenate([[self._passed], passed])
        work = np.empty_like(by_mesh)
        spread_on_belt(grown, ways, self._ends, self._total, work)
        self._before, self._passed = by_mesh[-1].copy(), float(passed[-1])
        return work


@kernel
def spread_on_belt(grown: FloatArray, ways: FloatArray, ends: FloatArray, total: FloatArray, work: FloatArray) -> None:
    """Spread what work grows by from state to state on the belt that has passed.

    Parameters
    ----------
    grown : ndarray, shape (m, P, E)
        By piece of the mesh, J.
    ways : ndarray, shape (m + 1,)
        Length of belt that has passed, m, in the state before and in each of these.
    ends : ndarray, shape (E + 1,)
        Of the pieces, from zero, m.
    total : ndarray, shape (P, E)
        Work on each piece of the belt up to the state before, J; afterwards up to the last.
    work : ndarray, shape (m, P, E)
        Overwritten by the work up to each state, J.
    """
    states, pulleys, pieces = grown.shape
    length = ends[pieces]
    for k in range(states):
        p, q = min(ways[k], ways[k + 1]), max(ways[k], ways[k + 1])
        turns = np.floor((q - p) / length)
        even = turns * length / (q - p) if turns > 0.0 else 0.0
        q = max(q - turns * length, p + _LEAST * length)
        for pulley in range(pulleys):
            for piece in range(pieces):
                done = grown[k, pulley, piece]
                if done == 0.0:
                    continue
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

"""Steady running on the way from one setting of a drive to another one, as equations along a parameter from 0 to 1."""

from typing import Protocol

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.solvers.continuation import Linearized, Solution
from beltdyn.state.newton import SINGULAR, SteadyWork, find_steady, make_step
from beltdyn.state.slip_limit import Setting
from beltdyn.system.arc_mesh import arc_count
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import controllers, drive_shafts
from beltdyn.system.meshing import mesh_speeds
from beltdyn.system.ring_matrix import substitute
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import anchor_at, assemble_steady
from beltdyn.system.web import content

_DIFFERENCE = 1e-4
"""Change of the parameter by which the residual is differentiated."""


class Search(Protocol):
    """What a way needs of a search for steady running."""

    state: State
    system: System
    work: SteadyWork

    def unknowns(self) -> FloatArray:
        """All that steady running consists of."""

    def place(self, unknowns: FloatArray) -> None:
        """Put the search in its place."""

    def at(self, setting: Setting) -> System:
        """The system at a setting."""

    def solve(self, setting: Setting, guess: FloatArray, part: float) -> FloatArray | None:
        """Steady running at a part of a way, from a guess; None, and all as it was, if it is not found."""


class Way:
    """Equations of a search between two settings, at its state, which is changed in place.

    Increments are those of Newton's method: of the nodes, shape (N, n), then of the unknowns of the border.
    """

    def __init__(self, search: Search, begin: Setting, end: Setting) -> None:
        self._search, self._begin, self._end = search, begin, end
        self.solutions = [Solution(0.0, search.unknowns())]

    def at(self, place: float) -> Setting:
        """The setting at a place."""
        return between(self._begin, self._end, place)

    def solve(self, place: float, guess: FloatArray) -> FloatArray | None:
        """The solution at a place from a guess; None, and the search as it was, if it is not found."""
        found = self._search.solve(self.at(place), guess, place)
        if found is not None:
            self.solutions.append(Solution(place, found))
        return found

    def unknowns(self) -> FloatArray:
        """All that steady running consists of."""
        return self._search.unknowns()

    def place(self, unknowns: FloatArray) -> None:
        """Put the search in its place."""
        self._search.place(unknowns)

    @property
    def weights(self) -> FloatArray:
        """Ways of nodes, as a root mean square, and of bodies, m, over increments, of a belt without teeth."""
        system = self._search.system
        nodes, border = np.zeros((system.nodes, len(system.scale))), np.zeros(self._search.work.ahead_border.size)
        nodes[:, :2] = system.nodes**-0.5
        rims = set(range(system.bodies.size - system.tensioners.size)) - set(controllers(system).tolist())
        speed = abs(float(system.frame.speed[0]))
        for body, row in enumerate(system.bodies):
            if row.unknown >= 0:
                reach = row.reach**2 / speed if body in rims else row.reach
                border[row.unknown] = max(border[row.unknown], reach)
        last, shifts = border.size - 1 - content(system).size, arc_count(system.frame)
        border[last - shifts : last] = 1.0
        border[-1] = float(np.min(system.rims.radius)) / speed  # all rims may be prescribed, and the belt slow down
        if content(system).size:
            border[last] = float(np.sum(system.length))
        return np.concatenate([nodes.ravel(), border])

    def linearize(self, place: float) -> Linearized | None:
        """Newton's method at the state and a place; None where the tangent is singular."""
        search, (nodes, border) = self._search, (self._search.work.ahead_node, self._search.work.ahead_border)
        matrix, sides = search.work.equations.matrix, []
        motion, anchor = search.state.at(0.0), anchor_at(search.state, False)
        for ahead in (_DIFFERENCE, 0.0):
            system = search.at(self.at(place + ahead))
            drive_shafts(system, search.state.velocity)
            mesh_speeds(system, search.state.velocity)
            if ahead:
                assemble_steady(system, motion, anchor, False, search.work.equations)
            elif find_steady(system, motion, anchor, 0.0, 0, False, search.work)[0] == SINGULAR:
                return None
            sides.append((matrix.node_side.copy(), matrix.border_side.copy()))
        (node_ahead, border_ahead), (node_side, border_side) = sides
        changes = (node_ahead - node_side) / _DIFFERENCE, (border_ahead - border_side) / _DIFFERENCE
        increments = []
        for side in ((node_side, border_side), changes):
            matrix.node_side[:], matrix.border_side[:] = side
            substitute(matrix, True, nodes, border)
            increments.append(-np.concatenate([nodes.ravel(), border]))
        return Linearized(*increments)

    def add(self, increment: FloatArray) -> None:
        """Add an increment to the state."""
        system, border = self._search.system, self._search.work.ahead_border.size
        nodes = np.ascontiguousarray(increment[:-border].reshape(system.nodes, -1))
        make_step(system, self._search.state.at(0.0), False, 1.0, nodes, increment[-border:].copy())

    def tangent(self, place: float) -> FloatArray | None:
        """Derivative of the unknowns at the state, which stays."""
        found, here = self.linearize(place), self.unknowns()
        if found is None:
            return None
        self.add(found.tangent)
        ahead = self.unknowns()
        self.place(here)
        return np.asarray(ahead - here)


def between(begin: Setting, end: Setting, part: float) -> Setting:
    """A setting on the way from one to another, on which what smoothes changes by equal factors."""
    if part == 1.0:
        return end
    even = Setting(*(a + part * (b - a) for a, b in zip(begin, end, strict=True)))
    smooth = {
        name: getattr(begin, name) ** (1.0 - part) * getattr(end, name) ** part
        for name in ("smoothing", "stretch_length")
    }
    return even._replace(**smooth)

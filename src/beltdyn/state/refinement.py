"""Meshes finer and finer, until contact forces, tensions and slip no longer depend on them."""

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Prepared
from beltdyn.model.resolution import Arc, graded_mesh
from beltdyn.state.search import SteadySearch
from beltdyn.state.staying import (
    FINER,
    MOST_ELEMENTS,
    Sampled,
    Standing,
    bring_to_stand,
    depths,
    first_fineness,
    found_arcs,
    require_one_pulley_at_a_time,
    sampled,
    stand,
)
from beltdyn.system.arc_mesh import base_coordinates
from beltdyn.system.arrays import System
from beltdyn.system.frame import centreline_places
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe_contact
from beltdyn.system.state import State

_FINER = FINER, 0.9 * FINER, 1.15 * FINER
"""Elements of a finer mesh over those of the one before; the others where the first one finds nothing."""
_MOST_STARTS = 4
"""Meshes at rest from which steady running is sought."""
_OF_TENSION = 0.3
"""Change of tensions that is small enough, over that of contact forces."""
_POINTS = 200
"""Points of an arc at which two meshes are compared."""
_LEAST_SLIP = 1e-4
"""Slip against which differences of slip are measured, at least."""
_COMPARED = 1e-6
"""Tolerance of a search on a coarser mesh, only to be compared: the error of a mesh of 0.9 % changes by 0.002 %."""


@dataclass(frozen=True)
class Solution:
    """Steady running on a mesh, or rest."""

    system: System
    state: State
    seen: Observations
    """Contact and tensions there, one instant."""
    slips: FloatArray
    """Of the rims behind the fastest one, relative."""

    @cached_property
    def places(self) -> Sampled:
        """Where the belt lies."""
        return sampled(self.system, self.state.position, self.seen.pulley_center[0])

    @cached_property
    def arcs(self) -> list[Arc]:
        """Where the belt touches pulleys."""
        return found_arcs(self.system, self.places)


class MeshRule(NamedTuple):
    """How a mesh follows from where the belt touches."""

    layer: float
    """Length of the layers at the ends of arcs, m."""
    fineness: float = 1.0
    """Factor on the number of elements."""
    elements: int = 0
    """Number of equal elements in place of graded ones, at a fineness of 1; zero for graded ones."""

    def finer(self, factor: float = FINER) -> "MeshRule":
        """The rule of a mesh with so many times the elements."""
        return self._replace(fineness=factor * self.fineness)


class Refined(NamedTuple):
    """Steady running on a mesh that was refined."""

    search: SteadySearch
    rest: Standing
    """The same drive at rest, on the mesh from which the search has begun."""
    band: Mapping[str, FloatArray]
    """Where dry friction holds tensioners, on that mesh, on which forces as a whole are known."""
    errors: Mapping[str, float]
    """Of the mesh, relative; as from `refine`."""
    rule: MeshRule


def steady_from_rest(
    rest: Standing, time: float, rule: Callable[[Standing], MeshRule], tolerance: float, *, bands: bool
) -> Refined:
    """Find steady running from a belt at rest, on a finer mesh where that on a coarse one leads to no other."""
    ran = False
    for trial in range(1, _MOST_STARTS + 1):
        search, given = SteadySearch(rest.prepared, rest.system, rest.state, time), rule(rest)
        try:
            search.run(rest)
            ran = True
            band = search.friction_band() if bands else {}
            errors, found = refine(search, given, tolerance)
            break
        except ConvergenceError:  # what runs on one mesh is there; or the search has lost its way on this one
            has_limit = search.is_limited and not (ran or rest.prepared.path.nips)
            if has_limit or given.elements or trial == _MOST_STARTS:
                raise
            rest = stand(rest.prepared, fineness=FINER * rest.fineness)
    return Refined(search, rest, band, errors, found)


def refine(search: SteadySearch, rule: MeshRule, tolerance: float) -> tuple[dict[str, float], MeshRule]:
    """Refine the mesh of a drive in steady running, which is changed in place."""
    before, errors = _solution(search), dict[str, float]()
    if not (np.any(before.seen.normal_force) or any(arc.nips for arc in before.arcs)):  # arcs may meet in a point
        raise ConvergenceError(
            "the belt has lifted off all pulleys, which can no longer drive it. Reduce the speed, or increase the "
            "installed tension."
        )
    while True:
        finer = _moved(search, before, rule)
        if finer is None:
            if errors:
                return errors, rule
            raise ConvergenceError(
                f"steady running was found with {before.system.nodes} elements but on no finer mesh, so its "
                "errors are unknown. Give the number of elements, or simulate the drive over time with "
                "`beltdyn simulate`."
            )
        rule, after = finer, _solution(search)
        errors = _differences(before, after)
        if is_fine(errors, tolerance) or rule.elements or after.system.nodes > MOST_ELEMENTS:
            return errors, rule
        before = after


def _moved(search: SteadySearch, now: Solution, rule: MeshRule) -> MeshRule | None:
    """Move a search to a finer mesh and give its rule; None, and the search as it was, if none of some is found."""
    for factor in _FINER:
        finer, trial = rule.finer(factor), copy(search)
        try:
            trial.move_to(_mesh(search.prepared, now, finer))
        except ConvergenceError:
            search.iterations = trial.iterations
            continue
        vars(search).update(vars(trial))
        return finer
    return None


def against_coarser(search: SteadySearch, rule: MeshRule) -> tuple[dict[str, float], SteadySearch]:
    """Compare steady running with that on a coarser mesh."""
    here, coarser = _solution(search), copy(search)
    coarser.tolerance = _COMPARED
    coarser.move_to(_mesh(search.prepared, here, rule.finer(1.0 / FINER)))
    coarser.tolerance = search.tolerance
    search.iterations = coarser.iterations
    return _differences(_solution(coarser), here), coarser


def is_fine(errors: Mapping[str, float], tolerance: float) -> bool:
    """Whether a mesh is fine enough."""
    return errors["peak pressure"] <= tolerance and errors["tension"] <= _OF_TENSION * tolerance


def _mesh(prepared: Prepared, now: Solution, rule: MeshRule) -> FloatArray:
    """Lengths of elements by a rule, m, with nodes where the belt touches and slides as it does now."""
    if rule.elements:
        return prepared.equal_lengths(round(rule.elements * rule.fineness))
    kinks = base_coordinates(now.system, np.array(_kinks(now))).tolist()
    arcs = [
        arc._replace(start=start, end=end, nips=tuple(zip(nips[::2], nips[1::2], strict=True)))
        for arc in now.arcs
        for start, end, *nips in [
            base_coordinates(now.system, np.array([arc.start, arc.end, *chain(*arc.nips)])).tolist()
        ]
    ]
    within = [arc._replace(kinks=tuple(k for k in kinks if arc.start < k < arc.end)) for arc in arcs]
    return graded_mesh(prepared.belt_length, within, rule.layer, rule.fineness, prepared.elements_per_span)


def _kinks(now: Solution) -> list[float]:
    """Where friction begins or ends to be fully used, in ascending order along the belt, m."""
    system, seen, found = now.system, now.seen, list[float]()
    starts = np.cumsum(system.length) - system.length
    along = (starts[:, None] + system.length[:, None] * system.contact.points).ravel()
    rims = now.state.velocity[system.first_body :][: system.pulleys.size] * system.rims.radius
    for p, rim in enumerate(rims):
        here = np.flatnonzero(seen.contact_pulley[0] == p)
        limit = system.law.friction.saturation(seen.normal_force[0, here], system.pulleys.friction[p], rim)
        beyond, places = np.abs(seen.slip_velocity[0, here]) - limit, along[here]
        last = np.flatnonzero((beyond[1:] > 0.0) != (beyond[:-1] > 0.0))
        part = beyond[last] / (beyond[last] - beyond[last + 1])
        found += (places[last] + part * (places[last + 1] - places[last])).tolist()
    return sorted(found)


def _solution(search: SteadySearch) -> Solution:
    """Steady running where the search is."""
    system, state = search.constant, search.state
    speeds = np.abs(state.velocity[system.first_body :][: system.pulleys.size] * system.rims.radius)
    found = Solution(system, state, _seen(system, state), 1.0 - speeds / np.max(speeds))
    require_one_pulley_at_a_time(search.prepared, system, found.places)
    return found


def _seen(system: System, state: State) -> Observations:
    return observe_contact(system, state.position[None], state.velocity[None])


def errors_at_rest(rest: Standing, elements: int | None = None) -> dict[str, float]:
    """Errors of a mesh in tension and contact pressures at rest, relative, by a finer one."""
    try:
        return errors_between(rest, _finer(rest, elements))
    except ConvergenceError:
        return {}


def refine_at_rest(prepared: Prepared, tolerance: float) -> tuple[Standing, dict[str, float]]:
    """Bring a drive to rest on a graded mesh, from one with at least the specified number of elements on."""
    rest = stand(bring_to_stand(prepared).prepared, fineness=first_fineness(prepared))
    while True:
        finer = _finer(rest, None)
        errors = errors_between(rest, finer)
        if is_fine(errors, tolerance) or rest.system.nodes > MOST_ELEMENTS:
            return rest, errors
        rest = finer


def _finer(rest: Standing, elements: int | None) -> Standing:
    """The same drive at rest on a finer mesh, of equal elements where their number is given."""
    if elements is None:
        return stand(rest.prepared, fineness=FINER * rest.fineness)
    return stand(rest.prepared, round(FINER * elements))


def errors_between(rest: Standing, finer: Standing) -> dict[str, float]:
    """Differences of a drive at rest on two meshes, relative."""
    none = np.zeros(rest.system.pulleys.size)
    before, after = (Solution(one.system, one.state, _seen(one.system, one.state), none) for one in (rest, finer))
    found = _differences(before, after)
    return {name: found[name] for name in ("tension", "mean pressure", "peak pressure")}


def _differences(before: Solution, after: Solution) -> dict[str, float]:
    """Differences of two solutions, relative."""
    along = np.concatenate([np.linspace(arc.start, arc.end, _POINTS) for arc in after.arcs] or [np.zeros(0)])
    one, other = (np.maximum(_depth(solution, along), 0.0).reshape(-1, _POINTS) for solution in (before, after))
    peaks = np.max(np.abs(other - one), axis=1) / np.max(other, axis=1)
    means = np.abs(np.sum(other - one, axis=1)) / np.sum(other, axis=1)
    slip = float(np.max(np.abs(after.slips - before.slips)))
    tensions, other = after.seen.span_tension[0], before.seen.span_tension[0]
    return {
        "tension": float(np.max(np.abs(tensions - other)) / np.max(np.abs(tensions))),
        "mean pressure": float(np.max(means, initial=0.0)),
        "peak pressure": float(np.max(peaks, initial=0.0)),
        "slip": slip / max(_LEAST_SLIP, float(np.max(np.abs(after.slips)))),
    }


def _depth(solution: Solution, along: FloatArray) -> FloatArray:
    """Depth of points of the belt in whatever pulley is deepest, m; negative outside."""
    places = centreline_places(solution.system, solution.state.position, along)
    return np.asarray(depths(solution.system, solution.seen.pulley_center[0], places).max(axis=0))

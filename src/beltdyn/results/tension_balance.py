"""The balance that holds the tensions of a belt: its unstretched length, and its tensioners.

Pulleys at fixed centers keep the belt's unstretched length on its path: spans at T_i, arcs at the tension with which
the belt reaches them up to where it slides, and penetration. A tensioner moves until spring and stops balance the
belt; an end of an open belt that is pulled keeps its tension. All are taken as changes of a state that is known: what
else holds a tensioner there, as weight and dry friction, goes on holding it.
"""

from copy import copy
from typing import NamedTuple, Self

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, span_points, wrap_angles
from beltdyn.results.mechanics import SpanTension, across
from beltdyn.results.sag import Sag, sag_of, turned, weight_of_meter, wrap_with_sag

_MAX_NEWTON_STEPS = 25
"""Steps of Newton's method; beyond, tensions are NaN unless the last step is within 1000 times `_CONVERGED`."""
_CONVERGED = 1e-9
"""Step of Newton's method, over the scale of each unknown."""
_DIFFERENCE = 1e-6
"""Step of difference quotients, over the scale of each unknown."""
_MAX_STEP = 0.2
"""Step of Newton's method for the place of a tensioner, over the way on which it moves by the smallest radius."""
_PRESSED = 0.1
"""Least tension that presses the belt on, over that before a step of Newton's method."""


class Loads(NamedTuple):
    """Loads on known states, a row for each."""

    state: IntArray
    """Number of the state, shape (n,)."""
    start: FloatArray
    """Derivative of the tension where each span starts by the factor on the load, N, shape (n, spans)."""
    end: FloatArray
    """The same where it ends."""

    def of(self, rows: IntArray | BoolArray) -> "Loads":
        """Some of them."""
        return Loads(self.state[rows], self.start[rows], self.end[rows])


class States(NamedTuple):
    """States in balance, a row for each."""

    tension: SpanTension
    """N, shape (n, spans)."""
    positions: FloatArray
    """Of tensioners, m or rad, shape (n, K)."""
    centers: FloatArray
    """Of pulleys, m, shape (n, pulleys, 2)."""
    wrap: FloatArray
    """rad, shape (n, pulleys)."""


class _Geometry(NamedTuple):
    """The path with tensioners at some places, a row for each state."""

    centers: FloatArray
    """Of pulleys, m, shape (n, pulleys, 2)."""
    directions: FloatArray
    """Unit vectors along spans, shape (n, spans, 2)."""
    points: FloatArray
    """Start and end of spans, m, shape (n, spans, 2, 2)."""
    lengths: FloatArray
    """Of spans, m."""
    wrap: FloatArray
    """rad, shape (n, pulleys)."""
    slopes: FloatArray
    """Derivatives of the centers of carried pulleys with respect to the places of their tensioners, shape (n, K, 2)."""


class TensionBalance:
    """The balance that determines the tension of a belt, as a change of n known states.

    Unknowns are the rise of all tensions and the displacements of tensioners; both are zero in the known states.
    Tensions and speeds have shape (n, spans); frictions, shape (n, pulleys), replace those of the drive.
    """

    def __init__(
        self,
        prepared: Prepared,
        tension: SpanTension,
        speed: FloatArray,
        centers: FloatArray,
        frictions: FloatArray | None = None,
    ) -> None:
        self._prepared, self._centers, self.tension = prepared, centers, tension
        count = len(tension.mean)
        self._frictions = np.tile(prepared.frictions, (count, 1)) if frictions is None else frictions
        with np.errstate(under="ignore"):  # of a belt that has come to rest
            self._lifted = prepared.belt.mass_per_length * speed**2
        self._backward = speed.mean(axis=1) < 0.0
        self._carriers = prepared.carriers
        self._pulled = _pulled_span(prepared)
        smallest = float(np.min(prepared.radii))
        reaches = [float(np.linalg.norm(one.place(0.0)[1])) for one in self._carriers]
        largest = max(float(np.nanmax(np.abs(tension.mean), initial=0.0)), 1e-9)
        self.scales = np.array([largest, *(smallest / one for one in reaches)])
        self._along = [one.place(0.0) for one in self._carriers]
        self._places = _places(prepared, centers)
        self._weight = weight_of_meter(prepared, tension)
        self._known: _Geometry | None = None
        self._known = self._geometry(np.arange(count), self.start)
        self._held = self._off(self.tension, np.arange(count), self._known, self.start)
        self._sense = np.where(self.jumps() < 0.0, -1.0, 1.0)

    def under(self, differences: FloatArray, speed: float | FloatArray, longer: float | FloatArray = 0.0) -> Self:
        """The balance about its one known state, for another speed, a longer belt (m) and further tensions.

        `differences`: of the tensions of spans from those of the known state, N, shape (n, spans).
        """
        other, count = copy(self), len(differences)
        for name in ("_centers", "_places", "_held", "_frictions", "_weight"):
            setattr(other, name, np.repeat(getattr(self, name)[:1], count, axis=0))
        other.tension = self.tension.each(lambda values: values[:1] + differences)
        other._held[:, 0] += longer
        flowing = np.broadcast_to(np.asarray(speed, dtype=float), count)
        other._lifted = self._prepared.belt.mass_per_length * np.repeat(flowing[:, None] ** 2, differences.shape[1], 1)
        other._backward, other._known = flowing < 0.0, None
        other._known = other._geometry(np.arange(count), other.start)
        return other

    def states(self) -> States:
        """The states that are in balance; NaN where there is none."""
        still = self._no_loads()
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            unknowns = self.solve(still, np.ones(len(still.state)), self.start)
            shape = self._geometry(still.state, unknowns)
        tension = self.tension.each(lambda values: values + unknowns[:, :1])
        return States(tension, self._places + unknowns[:, 1:], shape.centers, shape.wrap)

    def path_at(self, positions: FloatArray) -> FloatArray:
        """Unit vectors along spans, shape (spans, 2), with tensioners at positions, shape (K,); NaN without a path."""
        unknowns = np.concatenate([[0.0], positions - self._places[0]])[None]
        with np.errstate(invalid="ignore"):  # a free arm may be where no belt can run
            return np.asarray(self._geometry(np.zeros(1, dtype=int), unknowns).directions[0])

    def held_at(self, number: int, position: float) -> tuple[float, float]:
        """The belt at rest that holds a tensioner at a position, with the others where they are in the known state.

        `number`: the tensioner; `position`: m or rad. Returns longer, tension: unstretched length less that of the
        known state, m, and mean tension, N.
        """
        still = self.under(np.zeros((1, self.tension.mean.shape[1])), 0.0)
        unknowns, row = still.start, np.zeros(1, dtype=int)
        unknowns[:, 1 + number] = position - self._places[0, number]
        shape = still._geometry(row, unknowns)

        def off(rise: float) -> FloatArray:
            tension = still.tension.each(lambda values: values + rise)
            return np.asarray(still._off(tension, row, shape, unknowns)[0] - still._held[0])

        none, some = off(0.0)[1 + number], off(self.scales[0])[1 + number]
        rise = float(self.scales[0] * none / (none - some))
        return float(off(rise)[0]), float(self.tension.mean[0].mean()) + rise

    @property
    def start(self) -> FloatArray:
        """The unknowns in the known states."""
        return np.zeros((len(self.tension.mean), self.scales.size))

    # Loads and the edge of slip

    def all_loads(self, rise: FloatArray) -> Loads:
        """All loads of each state: what arcs, and spans with supports or goods, add to the tension, about the mean.

        `rise`: of the tension over each arc by friction, N, shape (n, pulleys); that over the driver closes the path.
        """
        path, prepared = self._prepared.path, self._prepared
        carrying = {one.span for one in (*prepared.supports, *prepared.goods)}
        start, end = self._levels()
        along = np.where([span in carrying for span in prepared.spans], end - start, 0.0)
        order, leaves = path.order.tolist(), dict(zip(path.leaving[path.on].tolist(), path.on.tolist(), strict=True))
        driver = int(path.leaving[prepared.reference])
        if path.ends is None:
            first = order.index(driver)
            order = order[first:] + order[:first]
        level, starts = np.zeros(len(start)), np.zeros_like(start)
        for span in order:
            level = level + (0.0 if span == order[0] or span not in leaves else rise[:, leaves[span]])
            starts[:, span] = level
            level = level + along[:, span]
        mean = (starts + 0.5 * along).mean(axis=1, keepdims=True)
        return Loads(np.arange(len(start)), starts - mean, starts + along - mean)

    def own_loads(self, rise: FloatArray) -> Loads:
        """The load of each pulley, taken up by the driver: rows are those of all pulleys of a state, then the next.

        `rise`: as for `all_loads`.
        """
        path, driver = self._prepared.path, self._prepared.reference
        spans, place = np.arange(path.spans), path.leaving
        between = np.zeros((path.count, path.spans))
        for pulley in path.on.tolist():
            first, last, sign = place[pulley], place[driver], 1.0
            if last < first:
                first, last, sign = last, first, -1.0
            between[pulley] = np.where((spans >= first) & (spans < last), sign, 0.0)
        slopes = rise[:, :, None] * between
        everything = self.all_loads(rise)
        start, end = slopes.copy(), slopes.copy()
        start[:, driver], end[:, driver] = everything.start, everything.end
        states = np.repeat(everything.state, path.count)
        return Loads(states, start.reshape(-1, path.spans), end.reshape(-1, path.spans))

    def jumps(self) -> FloatArray:
        """Rise of the tension over each arc by friction, without the weight of its belt, N, shape (n, pulleys)."""
        start, end = self._levels()
        path = self._prepared.path
        return np.asarray(start[:, path.leaving] - end[:, path.reaching])

    def edge(self, loads: Loads, factor: FloatArray, unknowns: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What friction carries at each pulley, and the most that it can carry, N, shape (n, pulleys).

        With T' = T - m v^2, and the weight of the belt on the arc in P, T' - P grows by exp(mu theta) where all of it
        slides: the difference of both ends is their sum times tanh(mu theta / 2).
        """
        return self._edge(self._tension(loads, factor, unknowns), loads, self._geometry(loads.state, unknowns))

    def pressing(self, loads: Loads, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        """Least tension less m v^2 of each span, N, shape (n, spans)."""
        tension = self._tension(loads, factor, unknowns)
        return np.asarray(np.minimum(tension.start, tension.end) - self._lifted[loads.state])

    def solve(self, loads: Loads, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        """The unknowns with a factor on loads, by Newton's method from a guess; NaN where there is no balance."""
        found, left = unknowns.copy(), np.arange(len(factor))
        for _ in range(_MAX_NEWTON_STEPS):
            some = loads.of(left)
            step, _ = self.newton_step(some, factor[left], found[left])
            found[left] += self.limited(some, factor[left], found[left], step)
            away = np.max(np.abs(step) / self.scales, axis=1)
            left, away = left[~(away <= _CONVERGED)], away[~(away <= _CONVERGED)]
            if not np.isfinite(away).any():
                break
        else:
            left = left[away > 1e3 * _CONVERGED]
        found[left] = np.nan
        return found

    def limited(self, loads: Loads, factor: FloatArray, unknowns: FloatArray, step: FloatArray) -> FloatArray:
        """A step of the unknowns, shortened where a tensioner moves far or a span loses most of what presses it on."""
        part = np.ones(len(step))
        if len(self._carriers):
            moves = np.abs(step[:, 1 : self.scales.size] / self.scales[1:]).max(axis=1)
            part = np.minimum(part, _MAX_STEP / np.maximum(moves, _MAX_STEP))
        before = self.pressing(loads, factor, unknowns).min(axis=1)
        most = (1.0 - _PRESSED) * before
        falls = -step[:, 0] * part
        part *= np.where((before > 0.0) & (falls > most), most / np.where(falls > 0.0, falls, 1.0), 1.0)
        return np.asarray(part[:, None] * step)

    def newton_step(
        self, loads: Loads, factor: FloatArray, unknowns: FloatArray, pulley: IntArray | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Step of Newton's method for the unknowns, and the determinant of their balance.

        With `pulley`, shape (n,), the factor is the last unknown: the belt is to slide there. By difference quotients.
        """
        count, size = unknowns.shape
        steps = _DIFFERENCE * np.vstack([np.zeros(size), np.diag(self.scales)])
        changes = np.ones(size + 1)
        if pulley is not None:
            steps, changes = np.vstack([steps, steps[0]]), np.append(changes, 1.0 + _DIFFERENCE)
        # all differences at once: each costs little beside the calls
        every = loads.of(np.tile(np.arange(count), len(steps)))
        moved = (unknowns + steps[:, None]).reshape(-1, size)
        shape = self._geometry(every.state, moved)
        tension = self._tension(every, (changes[:, None] * factor).ravel(), moved)
        missing = self._off(tension, every.state, shape, moved) - self._held[every.state]
        if pulley is not None:
            carried, held = self._edge(tension, every, shape)
            lacking = (carried - held)[np.arange(len(moved)), np.tile(pulley, len(steps))]
            missing = np.column_stack([missing, lacking / self.scales[0]])
        here, *there = missing.reshape(len(steps), count, missing.shape[1])
        widths = [np.full(count, _DIFFERENCE * scale) for scale in self.scales.tolist()]
        widths += [_DIFFERENCE * factor] * (pulley is not None)
        matrix = np.stack(
            [(values - here) / width[:, None] for values, width in zip(there, widths, strict=True)], axis=2
        )
        return -_solved(matrix, here), np.linalg.det(matrix[:, :size, :size])

    # Parts

    def _no_loads(self) -> Loads:
        none = np.zeros_like(self.tension.mean)
        return Loads(np.arange(len(none)), none, none)

    def _levels(self) -> tuple[FloatArray, FloatArray]:
        """Tensions at start and end of spans less the weight of the belt below, N: T + m g . r."""
        assert self._known is not None
        start, end = self._touching(self.tension, self._lifted, self._known)
        weight = self._weight[:, None]
        return self.tension.start + np.sum(start * weight, -1), self.tension.end + np.sum(end * weight, -1)

    def _tension(self, loads: Loads, factor: FloatArray, unknowns: FloatArray) -> SpanTension:
        more, rise = (factor - 1.0)[:, None], unknowns[:, :1]
        start, end, mean = self.tension.each(lambda values: values[loads.state] + rise)
        return SpanTension(start + more * loads.start, end + more * loads.end, mean + 0.5 * more * sum(loads[1:]))

    def _edge(self, tension: SpanTension, loads: Loads, shape: _Geometry) -> tuple[FloatArray, FloatArray]:
        rows, path = loads.state, self._prepared.path
        friction, gravity = self._frictions[rows], self._weight[rows]
        lifted = across(self._lifted[rows], self._prepared)
        ends = tension.at_arcs(self._prepared)
        sign = self._sense[rows]
        if np.any(gravity):
            turns = -np.sign(path.radii)[:, None]
            starts, stops = self._touching(tension, self._lifted[rows], shape)
            places = stops[:, path.reaching], starts[:, path.leaving]
            size, signed = np.abs(path.radii), sign * friction
            along, inwards = 2.0 * signed / (1.0 + friction**2), (1.0 - friction**2) / (1.0 + friction**2)
            lifted = tuple(
                lifted[end]
                + size
                * (
                    along * np.sum(turns * turned(ways) * gravity[:, None], axis=-1)
                    + inwards * np.sum(ways * gravity[:, None], axis=-1)
                )
                for end, ways in enumerate((shape.centers - place) / size[:, None] for place in places)
            )
        before, after = ends[0] - lifted[0], ends[1] - lifted[1]
        wrap = wrap_with_sag(self._prepared, tension, self._lifted[rows], shape.directions)
        return sign * (after - before), (after + before) * np.tanh(0.5 * friction * wrap)

    def _touching(self, tension: SpanTension, lifted: FloatArray, shape: _Geometry) -> tuple[FloatArray, FloatArray]:
        """Where spans that sag leave and reach pulleys, m, shape (n, spans, 2)."""
        sag, pulleys = sag_of(self._prepared, tension, lifted, shape.directions), self._prepared.path.span_pulleys
        points = [shape.points[:, :, end] for end in (0, 1)]
        if sag is None:
            return points[0], points[1]
        for end, angle in enumerate((sag.start, sag.end)):
            on = np.flatnonzero(pulleys[:, end] >= 0)
            center = shape.centers[:, pulleys[on, end]]
            arm, turn = points[end][:, on] - center, angle[:, on, None]
            points[end] = points[end].copy()
            points[end][:, on] = center + np.cos(turn) * arm + np.sin(turn) * turned(arm)
        return points[0], points[1]

    def _off(self, tension: SpanTension, rows: IntArray, shape: _Geometry, unknowns: FloatArray) -> FloatArray:
        """Unstretched length of the belt, m, or the tension of a pulled span, N, then the force on each tensioner."""
        path, lifted = self._prepared.path, self._lifted[rows]
        sag = sag_of(self._prepared, tension, lifted, shape.directions)
        first = self._belt_on(rows, tension, shape, sag) if self._pulled is None else tension.mean[:, self._pulled]
        missing = [first]
        if not self._carriers:
            return first[:, None]
        starting, ending = _pulls(tension, lifted, shape, sag)
        for number, one in enumerate(self._carriers):
            before, after = path.reaching[one.pulley], path.leaving[one.pulley]
            pull = starting[:, after] - ending[:, before]
            place = self._places[rows, number] + unknowns[:, 1 + number]
            missing.append(np.sum(pull * shape.slopes[:, number], axis=1) + one.forces(place))
        return np.column_stack(missing)

    def _belt_on(self, rows: IntArray, tension: SpanTension, shape: _Geometry, sag: Sag | None) -> FloatArray:
        """Unstretched length of the belt on its path, m."""
        prepared = self._prepared
        law, radii, friction = prepared.belt.stretch_parameters, np.abs(prepared.path.radii), self._frictions[rows]
        before, after = tension.at_arcs(prepared)
        lifted_before, lifted_after = across(self._lifted[rows], prepared)
        backward, least = self._backward[rows, None], 1e-9 * self.scales[0]
        reaching, lifted = np.where(backward, after, before), np.where(backward, lifted_after, lifted_before)
        pressing = before - lifted_before, after - lifted_after
        tight, slack = (np.maximum(choice(*pressing), least) for choice in (np.maximum, np.minimum))
        ratio = np.log(tight / slack)
        slid = np.minimum(ratio / np.maximum(friction, 1e-12), shape.wrap)
        sliding = lifted + np.where(ratio > 1e-9, (tight - slack) / np.maximum(ratio, 1e-9), tight)
        part = np.divide(slid, shape.wrap, out=np.zeros_like(slid), where=shape.wrap > 0.0)
        mean = (1.0 - part) * reaching + part * sliding
        sunk = np.maximum(mean - lifted, 0.0) / (radii * prepared.contact_stiffness)
        arcs = shape.wrap * (radii - sunk) * ((1.0 - part) / law.stretch(reaching) + part / law.stretch(sliding))
        spans = (shape.lengths + (0.0 if sag is None else sag.longer)) / law.stretch(tension.mean)
        return np.asarray(spans.sum(axis=1) + arcs.sum(axis=1))

    def _geometry(self, rows: IntArray, unknowns: FloatArray) -> _Geometry:
        """The path with the tensioners where the unknowns have them."""
        if not self._carriers and self._known is not None:
            return _Geometry(*(values[rows] for values in self._known))
        centers, slopes = self._centers[rows].copy(), np.empty((len(rows), len(self._carriers), 2))
        for number, one in enumerate(self._carriers):
            way, along = unknowns[:, 1 + number], self._along[number]
            pivot = one.tensioner.anchor
            if pivot is None:
                slopes[:, number] = along[1]
                centers[:, one.pulley] += way[:, None] * along[1]
                continue
            arm = centers[:, one.pulley] - np.array(pivot)
            sense = np.sign(turned(along[0] - np.array(pivot)) @ along[1])
            cosine, sine = np.cos(way)[:, None], sense * np.sin(way)[:, None]
            arm = cosine * arm + sine * turned(arm)
            centers[:, one.pulley] = pivot + arm
            slopes[:, number] = sense * turned(arm)
        shape = self._prepared.path.shape
        directions, points = span_directions(centers, *shape), span_points(centers, *shape)
        lengths = np.linalg.norm(points[:, :, 1] - points[:, :, 0], axis=-1)
        return _Geometry(centers, directions, points, lengths, wrap_angles(directions, *shape), slopes)


def _pulls(
    tension: SpanTension, lifted: FloatArray, shape: _Geometry, sag: Sag | None
) -> tuple[FloatArray, FloatArray]:
    """Forces with which spans pull at their starts and ends, N, shape (n, spans, 2)."""
    start, end = ((values - lifted)[..., None] * shape.directions for values in tension[:2])
    if sag is None:
        return start, end
    left = turned(shape.directions)
    first, last = (
        pull * (1.0 - 0.5 * slope**2)[..., None] + (slope * (values - lifted))[..., None] * left
        for pull, values, slope in ((start, tension.start, sag.start), (end, tension.end, sag.end))
    )
    return first, last


def _pulled_span(prepared: Prepared) -> int | None:
    """Number of a span at an end that is pulled; None where nothing pulls."""
    spans = (-1, -2)  # the last span comes from the first end, and the one before reaches the second one
    return next((span for span, end in zip(spans, prepared.ends, strict=False) if not end.held), None)


def _places(prepared: Prepared, centers: FloatArray) -> FloatArray:
    """Where tensioners stand that carry pulleys, m or rad, shape (n, K)."""
    found = np.empty((len(centers), len(prepared.carriers)))
    for number, one in enumerate(prepared.carriers):
        (nominal, along), pivot = one.place(0.0), one.tensioner.anchor
        if pivot is None:
            found[:, number] = (centers[:, one.pulley] - nominal) @ along
        else:
            arm, here = nominal - np.array(pivot), centers[:, one.pulley] - np.array(pivot)
            sense = np.sign(turned(arm) @ along)
            found[:, number] = sense * np.arctan2(here @ turned(arm), here @ arm)
    return found


def _solved(slopes: FloatArray, off: FloatArray) -> FloatArray:
    """Solutions of many small systems; those of singular ones are the shortest."""
    try:
        return np.asarray(np.linalg.solve(slopes, off[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        known = np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(off).all(axis=1)
        found = np.full_like(off, np.nan)
        found[known] = (np.linalg.pinv(slopes[known]) @ off[known, :, None])[:, :, 0]
        return found

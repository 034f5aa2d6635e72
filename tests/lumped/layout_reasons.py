"""Whether what a refusal of a layout at rest says is so, by geometry and statics apart from the package."""

import re
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from beltdyn.arrays import BoolArray, FloatArray
from tests.lumped.lumped_balance import Route

_NUMBER = r"(-?[\d.]+(?:e[-+]\d+)?)"
_STEP, _MOST_STEPS = 0.02, 500
"""Of the way of a fixed tensioner, over the least radius."""
_ALIKE = 1e-3
_MOST_ROUNDS = 50
_SAID = 0.85, 1.15
"""Of the tension at which a belt is said to leave a pulley: it is extrapolated."""
_MOST_WRAP = 1.8 * np.pi


def is_true(drive: dict[str, Any], reason: str) -> bool:
    """Tell whether a reason holds for what makes a drive; of one that is not known, it does not."""
    return _holds(_Place.of(drive), reason)


class _Place(NamedTuple):
    """A layout as it is given; radii are signed, m."""

    centers: FloatArray
    radii: FloatArray
    belt: dict[str, Any]
    stiffness: float | None
    """Of contact, N/m^2."""
    tensioner: dict[str, Any]
    weights: FloatArray
    """Of the pulleys, that of a slide with its pulley, N, shape (pulleys, 2)."""

    @classmethod
    def of(cls, drive: dict[str, Any]) -> "_Place":
        pulleys, springs = drive["pulley"], drive.get("tensioner") or [{}]
        radii = [one["radius"] if one["side"] == "inside" else -one["radius"] for one in pulleys]
        centers = np.array([one["center"] for one in pulleys])
        masses = [
            one["mass"] + (springs[0].get("pulley") == one["name"]) * springs[0].get("mass", 0.0) for one in pulleys
        ]
        weights = np.outer(masses, drive["gravity"])
        return cls(centers, np.array(radii), drive["belt"], drive["contact"].get("stiffness"), springs[0], weights)

    @property
    def route(self) -> Route:
        return Route.around(self.centers, self.radii)

    @property
    def lines(self) -> "_Lines":
        """The lines of force of the spans, whose mean tension is the one that is asked for.

        A span is an elastica about its line, from the angle a at the rim: T (1 - cos a) = EI / (2 R^2), of half the
        wrap where a pulley is touched at one point. Its tension is T cos of its own angle, of which a layer of length
        sqrt(EI / T) lacks 2 T (1 - cos (a / 2)) on the mean.
        """
        pull, lines = self.tension, _Lines.along(self, self.tension)
        for _ in range(_MOST_ROUNDS):
            pull, before = self.tension / (1.0 - lines.lacking), pull
            if abs(pull / before - 1.0) < _ALIKE**2:
                break
            lines = _Lines.along(self, pull)
        return lines

    @property
    def tension(self) -> float:
        return float(self.belt["installed_tension"])

    @property
    def bending(self) -> float:
        """Moment over curvature of the stretched belt, N m^2.

        With the strain e the energy of the belt, a solid of St. Venant and Kirchhoff, has EI (3 (1 + e)^2 - 1) / 2 for
        EI, and the square of the turn of an unstretched meter, which is (1 + e) of the curvature.
        """
        strain = self.tension / float(self.belt["axial_stiffness"])
        return float(self.belt["bending_stiffness"]) * (1.0 + 4.0 * strain)

    @property
    def unstretched(self) -> float:
        """Length of a belt with the tension that is asked for, m."""
        stretch, route = 1.0 + self.tension / self.belt["axial_stiffness"], self.route
        depths = 0.0 if self.stiffness is None else self.tension * stretch / (np.abs(self.radii) * self.stiffness)
        return float((route.length - np.sum(route.wraps * depths)) / stretch)

    @property
    def taken_up(self) -> "_Place":
        """Where a fixed tensioner gives the tension that is asked for with the length that is given, if both are."""
        if "length" not in self.belt:
            return self
        number, way = self.carried, np.array(self.tensioner["direction"])
        reach = _STEP * _MOST_STEPS * float(np.abs(self.radii).min())

        def missing(q: float) -> float:
            return float(self.belt["length"]) - self.moved(number, q * way).unstretched

        if missing(-reach) * missing(reach) > 0.0:
            return self
        return self.moved(number, brentq(missing, -reach, reach) * way)

    @property
    def carried(self) -> int:
        """Pulley of the tensioner."""
        return int(self.tensioner["pulley"].split()[1])

    def others(self, number: int) -> list[int]:
        return [k for k in range(self.radii.size) if k != number]

    def arm(self, number: int) -> FloatArray:
        return np.asarray(self.centers[number] - np.array(self.tensioner["pivot"]))

    def swung(self, number: int) -> Callable[[float], FloatArray]:
        """Center of the pulley at a position of its tensioner, positive where the path gets longer."""
        given, center = self.tensioner, self.centers[number]
        if given["kind"] == "sliding":
            return lambda q: np.asarray(center + q * np.array(given["direction"]))
        (x, y), pivot = self.arm(number), np.array(given["pivot"])
        small = np.array([-y, x]) * 1e-6
        sense = np.sign(self.moved(number, small).route.length - self.moved(number, -small).route.length)
        return lambda q: np.asarray(pivot + np.cos(q) * np.array([x, y]) + sense * np.sin(q) * np.array([-y, x]))

    def span(self, number: int) -> FloatArray:
        """Its ends, shape (2, 2)."""
        x, y = self.route.directions[number]
        ends = [number, (number + 1) % self.radii.size]
        return np.asarray(self.centers[ends] + self.radii[ends, None] * np.array([y, -x]))

    def without(self, number: int) -> "_Place":
        kept = np.arange(self.radii.size) != number
        return self._replace(centers=self.centers[kept], radii=self.radii[kept])

    def moved(self, number: int, way: FloatArray) -> "_Place":
        centers = self.centers.copy()
        centers[number] += way
        return self._replace(centers=centers)


def _left(route: Route) -> BoolArray:
    """Which pulleys the path leaves: their wrap angles are a little less than none, and a turn is added to these."""
    return np.asarray(route.wraps > _MOST_WRAP)


class _Lines(NamedTuple):
    """Tangents of circles that bending makes larger, and penetration smaller."""

    pull: float
    """Along them, N."""
    route: Route
    angles: FloatArray
    """Between the lines and the belt where it meets the rims, rad."""
    lacking: float
    """Part that the mean tension of the spans lacks."""

    @classmethod
    def along(cls, place: _Place, pull: float) -> "_Lines":
        sizes, bending = np.abs(place.radii), place.bending
        depths = np.zeros(sizes.size)
        if place.stiffness is not None:
            depths = 0.5 * (sizes - np.sqrt(np.maximum(sizes**2 - 4.0 * pull / place.stiffness, 0.0)))
        layer, long = np.sqrt(bending / pull), np.arccos(np.clip(1.0 - 0.5 * bending / (pull * sizes**2), -1.0, 1.0))
        angles, route = long, place.route
        for _ in range(_MOST_ROUNDS):
            lifts = 2.0 * layer * np.sin(0.5 * angles) - sizes * (1.0 - np.cos(angles)) - 0.5 * depths
            route = Route.around(place.centers, place.radii + np.sign(place.radii) * lifts)
            angles, before = np.minimum(long, 0.5 * np.where(_left(route), 0.0, route.wraps)), angles
            if np.all(np.abs(angles - before) < _ALIKE**2):
                break
        lacks = 2.0 * layer * (1.0 - np.cos(0.5 * angles))
        ends = sizes * np.sin(angles)
        free = route.spans + ends + np.roll(ends, -1)
        return cls(pull, route, angles, float(np.mean((lacks + np.roll(lacks, -1)) / free)))


def _holds(place: _Place, reason: str) -> bool:
    for said, check in _REASONS.items():
        found = re.search(said, reason)
        if found is not None:
            return bool(check(place, [int(one) for one in re.findall(r'"pulley (\d)"', reason)], found))
    return False


def _overlap(place: _Place, named: list[int], _: re.Match[str]) -> bool:
    return _away(place, *named[:2]) < sum(np.abs(place.radii[named[:2]]))


def _away(place: _Place, one: int, other: int) -> float:
    return float(np.hypot(*(place.centers[one] - place.centers[other])))


def _cross(place: _Place, named: list[int], _: re.Match[str]) -> bool:
    """The ends of either span lie on both sides of the other one."""
    one, other = place.span(named[0]), place.span(named[2])

    def sides(line: FloatArray, points: FloatArray) -> float:
        (x, y), ways = line[1] - line[0], points - line[0]
        return float(np.prod(x * ways[:, 1] - y * ways[:, 0]))

    return sides(one, other) < 0.0 and sides(other, one) < 0.0


def _missed(place: _Place, named: list[int], _: re.Match[str]) -> bool:
    """The span of the belt around the others passes the pulley on the side that does not touch."""
    rest, before = place.without(named[0]), (named[0] - 1) % (place.radii.size - 1)
    for number in np.flatnonzero(_left(rest.route))[::-1].tolist():  # it misses these as well
        rest, before = rest.without(number), before - (number <= before)
    start, stop = rest.span(before % rest.radii.size)
    (x, y), (a, b) = (stop - start) / np.hypot(*(stop - start)), place.centers[named[0]] - start
    radius = float(place.radii[named[0]])
    return float((x * b - y * a) * np.sign(radius)) > abs(radius)


def _through(place: _Place, named: list[int], _: re.Match[str]) -> bool:
    """A span comes nearer to the center of the pulley than its rim."""
    start, stop = place.span(named[0])
    length = float(np.hypot(*(stop - start)))
    along = (stop - start) / length
    nearest = start + np.clip((place.centers[named[2]] - start) @ along, 0.0, length) * along
    return float(np.hypot(*(place.centers[named[2]] - nearest))) < abs(float(place.radii[named[2]]))


def _turns(place: _Place, _: list[int], said: re.Match[str]) -> bool:
    turned = float(np.sign(place.radii) @ place.route.wraps) / (2.0 * np.pi)
    return round(turned) == int(said[1]) != 1


def _no_line(place: _Place, named: list[int], _: re.Match[str]) -> bool:
    one, other = named[:2]
    return place.radii[one] * place.radii[other] < 0.0 and _overlap(place, named, _)


def _overstretched(place: _Place, _: list[int], said: re.Match[str]) -> bool:
    return not 0.0 < place.route.length <= 1.5 * place.unstretched


def _not_held(place: _Place, named: list[int], said: re.Match[str]) -> bool:
    """What the spring gives and what the tension takes at the nominal place, by differences of the length."""
    takes = place.tension * _longer(place, named[0])
    told = [float(one) for one in said.groups()]
    return bool(
        np.allclose(told, [place.tensioner["preload"], takes], rtol=_ALIKE) and abs(told[0] / takes - 1.0) > _ALIKE
    )


def _longer(place: _Place, pulley: int) -> float:
    """By how much the path gets longer with the way of a spring, m/m or m/rad, positive."""
    center, given = place.centers[pulley], place.tensioner
    if given["kind"] == "sliding":
        way = np.array(given["direction"])
    else:
        arm = center - np.array(given["pivot"])
        way = np.array([-arm[1], arm[0]])
    step = 1e-6 * float(np.abs(place.radii).min() / np.hypot(*way))
    ahead, behind = (place.moved(pulley, sign * step * way).route.length for sign in (1.0, -1.0))
    change = (ahead - behind) / (2.0 * step)
    return float(change if given["kind"] == "sliding" else abs(change))


class _Travel(NamedTuple):
    """The way of a spring with its pulley, at the tension that is asked for."""

    place: _Place
    pulley: int
    swung: Callable[[float], FloatArray]
    step: float

    @classmethod
    def of(cls, place: _Place) -> "_Travel":
        pulley, size = place.carried, _STEP * float(np.abs(place.radii).min())
        arm = 1.0 if place.tensioner["kind"] == "sliding" else float(np.hypot(*place.arm(pulley)))
        return cls(place, pulley, place.swung(pulley), size / arm)

    def at(self, q: float) -> _Place:
        return self.place.moved(self.pulley, self.swung(q) - self.place.centers[self.pulley])

    def force(self, q: float) -> float:
        """Of spring and weight, N or N m."""
        small, given = 1e-4 * self.step, self.place.tensioner
        weight = (self.swung(q + small) - self.swung(q - small)) @ self.place.weights[self.pulley]
        return float(given["preload"] - given["rate"] * q + weight / (2.0 * small))

    def excess(self, q: float, pull: float) -> float:
        """Of that force over the one of the belt."""
        small = 1e-4 * self.step
        ahead, behind = (_Lines.along(self.at(end), pull).route.length for end in (q + small, q - small))
        return self.force(q) - pull * (ahead - behind) / (2.0 * small)

    def is_stable(self, q: float, pull: float) -> bool:
        """Whether the excess falls along the way at a constant length of the belt."""
        ends = (q - 0.1 * self.step, q + 0.1 * self.step)
        middle, stiffness = self.at(q).route.length, self.place.belt["axial_stiffness"] / self.place.unstretched
        low, high = (self.excess(end, pull + stiffness * (self.at(end).route.length - middle)) for end in ends)
        return high < low

    def balances(self) -> Iterator[float]:
        """Stable ones on either side, the nearer ones first, up to where the pulley meets another or its force ends."""
        for sign in (1.0, -1.0):
            before = self.excess(0.0, self.place.lines.pull)
            for q in sign * self.step * np.arange(1, _MOST_STEPS):
                there, pulley = self.at(q), self.pulley
                others, sizes = self.place.others(pulley), np.abs(self.place.radii)
                met = any(_away(there, pulley, k) <= sizes[pulley] + sizes[k] for k in others)
                if met or self.force(q) <= 0.0:
                    break
                here = self.excess(q, there.lines.pull)
                if here * before <= 0.0 and self.is_stable(q - 0.5 * sign * self.step, there.lines.pull):
                    yield float(q)
                before = here

    def nearest(self) -> float | None:
        return min(self.balances(), key=abs, default=None)


def _unbalanced(place: _Place, _: list[int], __: re.Match[str]) -> bool:
    """Nowhere on the way of the spring is a stable balance in which the belt touches all pulleys."""
    travel = _Travel.of(place)
    return all(np.any(_left(travel.at(q).lines.route)) for q in travel.balances())


def _pushed_out(place: _Place, _: list[int], __: re.Match[str]) -> bool:
    """On the side to which spring and belt push the pulley is no stable balance in which the belt touches all."""
    travel = _Travel.of(place)
    pushed = np.sign(travel.excess(0.0, place.lines.pull))
    return all(np.any(_left(travel.at(q).lines.route)) for q in travel.balances() if q * pushed > 0.0)


def _too_heavy(place: _Place, named: list[int], said: re.Match[str]) -> bool:
    """The weight pulls the pulley from the belt with that force, and with more than the spring pushes."""
    travel = _Travel.of(place)
    small, preload = 1e-4 * travel.step, place.tensioner["preload"]
    weight = preload - 0.5 * (travel.force(small) + travel.force(-small))
    weight_told, pushed = (float(text) for text in said.groups())
    return named == [travel.pulley] and weight > pushed and bool(np.isclose(weight_told, weight, rtol=_ALIKE))


def _slack(place: _Place, _: list[int], __: re.Match[str]) -> bool:
    """Where the spring has lost its force, the belt that has its tension farther away is longer than the path."""
    travel, given = _Travel.of(place), place.tensioner
    q, lost = travel.nearest(), given["preload"] / given["rate"]
    return q is not None and lost < abs(q) and travel.at(lost).route.length < travel.at(q).unstretched


def _no_take_up(place: _Place, named: list[int], said: re.Match[str]) -> bool:
    """On the way to where the reason holds, the length for the tension never is the one that is given."""
    way = np.array(place.tensioner["direction"]) * _STEP * float(np.abs(place.radii).min())
    missing = float(place.belt["length"]) - place.unstretched
    for step in range(_MOST_STEPS):
        there = place.moved(named[0], step * np.sign(missing) * way)
        if _holds(there, said[1]):
            return True
        if (float(place.belt["length"]) - there.unstretched) * missing <= 0.0:
            return False
    return False


def _leaves(place: _Place, named: list[int], _: re.Match[str]) -> bool:
    """Where the belt has its tension, the lines of force about the others pass beside the pulley.

    On a pulley of small wrap beside a span of few layers the belt bends more than at a point, and at most as on an arc.
    A layer at the far end of a span holds the belt off its line by exp(-l / layer) of what it does there.
    """
    there, pulley = _where_balanced(place), named[-1]
    lines, arcs = there.lines, place.bending / (2.0 * there.lines.pull * place.radii)
    layer, count = np.sqrt(place.bending / lines.pull), place.radii.size
    lifted = arcs.copy()
    arcs[pulley], lifted[pulley] = 0.0, 0.0
    for neighbor, span in ((pulley - 1, pulley - 1), ((pulley + 1) % count, pulley)):
        lift = 2.0 * layer * np.sin(0.5 * lines.angles[neighbor]) * np.sign(place.radii[neighbor])
        lifted[pulley] -= lift * np.exp(-lines.route.spans[span] / layer)
    bounds = lines.route, *(Route.around(there.centers, place.radii + bent) for bent in (arcs, lifted))
    return any(bool(_left(route)[pulley]) for route in bounds)


def _where_balanced(place: _Place) -> _Place:
    """With the tensioner where it gives the tension that is asked for."""
    if "preload" not in place.tensioner:
        return place.taken_up
    travel = _Travel.of(place)
    return travel.at(travel.nearest() or 0.0)


def _lifts_off(place: _Place, named: list[int], said: re.Match[str]) -> bool:
    """At that tension, but not a little before it, the belt leaves the pulley."""
    ends = (place._replace(belt=place.belt | {"installed_tension": part * float(said[1])}) for part in _SAID)
    before, beyond = (bool(_left(_where_balanced(one).lines.route)[named[-1]]) for one in ends)
    return before != beyond


_REASONS: dict[str, Callable[[_Place, list[int], re.Match[str]], bool]] = {
    r"equilibrium of the tensioner of .* is unstable": _unbalanced,
    rf"the weight of the tensioner of .*? with {_NUMBER} N.*, its spring pushes with {_NUMBER} N": _too_heavy,
    r"push the tensioners to where no belt can run": _pushed_out,
    r"reaches the end of its travel without balancing": _unbalanced,
    r"pushes the tensioner of .* back without losing": _unbalanced,
    r"the tensioner force gives \S+ N with a belt length of": _unbalanced,
    r"the balance of the tensioner of .* ends": _unbalanced,
    r"no take-up of .* a tension of \S+ N: (.*)": _no_take_up,
    r"overlap: their centers are": _overlap,
    r"would cross itself: the span": _cross,
    r"the belt does not touch pulley": _missed,
    r"the belt between .* would run through pulley": _through,
    r"would turn (-?\d) times": _turns,
    r"the belt cannot pass between": _no_line,
    r"would stretch the belt and press it": _overstretched,
    rf"its spring gives {_NUMBER} N.*, that tension needs {_NUMBER} N": _not_held,
    r"at rest the belt does not touch": _leaves,
    rf"at {_NUMBER} N the belt leaves": _lifts_off,
    r"its tensioners let it hang slack": _slack,
}

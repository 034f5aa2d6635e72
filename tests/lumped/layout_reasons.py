"""Whether what a refusal of a layout at rest says is so, by geometry and statics apart from the package."""

import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from tests.lumped.lumped_balance import Route

_NUMBER = r"(-?[\d.]+(?:e[-+]\d+)?)"
_STEP, _MOST_STEPS = 0.02, 500
"""Of the way of a fixed tensioner, over the least radius."""
_ALIKE = 1e-3


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
    """Of the pulleys, N, shape (pulleys, 2)."""

    @classmethod
    def of(cls, drive: dict[str, Any]) -> "_Place":
        pulleys, springs = drive["pulley"], drive.get("tensioner") or [{}]
        radii = [one["radius"] if one["side"] == "inside" else -one["radius"] for one in pulleys]
        centers = np.array([one["center"] for one in pulleys])
        weights = np.array([[one["mass"]] for one in pulleys]) * np.array(drive["gravity"])
        return cls(centers, np.array(radii), drive["belt"], drive["contact"].get("stiffness"), springs[0], weights)

    @property
    def route(self) -> Route:
        return Route.around(self.centers, self.radii)

    @property
    def route_of_force(self) -> Route:
        """The lines of force: tangents of circles that bending makes larger, and penetration smaller."""
        sizes, softness = np.abs(self.radii), 0.0 if self.stiffness is None else 1.0 / self.stiffness
        depths = 0.5 * (sizes - np.sqrt(np.maximum(sizes**2 - 4.0 * self.tension * softness, 0.0)))
        lifts = self.belt["bending_stiffness"] / (2.0 * self.tension * sizes) - 0.5 * depths
        return Route.around(self.centers, self.radii + np.sign(self.radii) * lifts)

    @property
    def tension(self) -> float:
        return float(self.belt["installed_tension"])

    @property
    def unstretched(self) -> float:
        """Length of a belt with the tension that is asked for, m."""
        stretch, route = 1.0 + self.tension / self.belt["axial_stiffness"], self.route
        depths = 0.0 if self.stiffness is None else self.tension * stretch / (np.abs(self.radii) * self.stiffness)
        return float((route.length - np.sum(route.wraps * depths)) / stretch)

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
    rest = place.without(named[0])
    start, stop = rest.span((named[0] - 1) % rest.radii.size)
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


def _unbalanced(place: _Place, _: list[int], __: re.Match[str]) -> bool:
    """Nowhere on the way of the spring, up to where its pulley meets another one, is a stable balance."""
    pulley = place.carried
    swung = place.swung(pulley)
    return not any(_stable_balance(place, pulley, swung, sign) for sign in (1.0, -1.0))


def _stable_balance(place: _Place, pulley: int, swung: Callable[[float], FloatArray], sign: float) -> bool:
    """Whether the excess of the spring over the belt changes sign, falling along its way at a constant length."""
    given, size = place.tensioner, float(np.abs(place.radii).min())
    step = sign * _STEP * size / (1.0 if given["kind"] == "sliding" else float(np.hypot(*(place.arm(pulley)))))

    def at(q: float) -> _Place:
        return place.moved(pulley, swung(q) - place.centers[pulley])

    def longer(q: float) -> float:
        small = 1e-4 * abs(step)
        return float((at(q + small).route_of_force.length - at(q - small).route_of_force.length) / (2.0 * small))

    def excess(q: float, tension: float) -> float:
        small = 1e-4 * abs(step)
        weight = float((swung(q + small) - swung(q - small)) @ place.weights[pulley]) / (2.0 * small)
        return float(given["preload"] - given["rate"] * q + weight - tension * longer(q))

    def is_stable(q: float) -> bool:
        ends = (q - 0.1 * abs(step), q + 0.1 * abs(step))
        middle, stiffness = at(q).route.length, place.belt["axial_stiffness"] / place.unstretched
        low, high = (excess(end, place.tension + stiffness * (at(end).route.length - middle)) for end in ends)
        return high < low

    before = excess(0.0, place.tension)
    for number in range(1, _MOST_STEPS):
        q = number * step
        away = [_away(at(q), pulley, k) - abs(place.radii[pulley]) - abs(place.radii[k]) for k in place.others(pulley)]
        if min(away) <= 0.0 or not 0.0 < at(q).route.wraps[pulley] < np.pi:
            return False
        here = excess(q, place.tension)
        if here * before <= 0.0 and is_stable(q - 0.5 * step):
            return True
        before = here
    return False


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
    """The lines of force about the others, which bending holds off their rims, pass beside the pulley."""
    lifts = place.belt["bending_stiffness"] / (2.0 * place.tension * place.radii)
    lifts[named[-1]] = 0.0
    return float(Route.around(place.centers, place.radii + lifts).wraps[named[-1]]) > np.pi


_REASONS: dict[str, Callable[[_Place, list[int], re.Match[str]], bool]] = {
    r"equilibrium of the tensioner of .* is unstable": _unbalanced,
    r"the tensioners are in equilibrium only where no belt can run": _unbalanced,
    r"reaches the end of its travel without balancing": _unbalanced,
    r"pushes the tensioner of .* back without losing": _unbalanced,
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
}

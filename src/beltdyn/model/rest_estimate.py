"""The belt at rest in closed form, with bending stiffness, penetration and weight.

Spans pull along tangents of circles of `theory.static_tension.span_radius`, so that hub loads on pulleys of small wrap
differ from those of a path without penetration. The length of the belt is that of `theory.static_tension`; sag adds
(w l)^2 l / 24 T^2 to a span of length l with the weight w across it. Between heights the tension differs by the weight
of the belt between them. Neglected are the weight of tensioners, and what arcs miss that are shorter than the layers at
their ends.

Goods on slopes are held at the arc of the driver, as in static equilibrium. Of their weight only the part along a span
counts.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model.carrier import moved
from beltdyn.model.carrying import hanging_lengths
from beltdyn.model.installation import Installation
from beltdyn.model.path import Path
from beltdyn.model.prepared import Prepared
from beltdyn.theory.static_tension import ArcAtRest, Section, arc_at_rest, end_of_contact, span_radius

_TOLERANCE = 1e-9
"""Relative change of the radii of spans, and scaled residual of the balance, at which iterations have converged: far
below what closed forms neglect."""
_DIFFERENCE_STEP = 1e-5
"""Change of the scaled unknowns for slopes of the residual by forward differences; also the least strain that scales
the residual of the length. An error of the slopes costs iterations only."""
_CHANGE = 1e-3
"""Of the tension, for the slope of tightening, relative."""
_MAX_RADIUS_ITERATIONS = 20
"""Fixed-point iterations for the radii of spans; beyond, the last radii are taken."""
_MAX_NEWTON_STEPS = 20
"""Steps of Newton's method for the balance; beyond, there is none, an error."""
_MAX_STEP_LENGTHS = 10
"""Lengths of a step of Newton's method, each half the one before, tried until closed forms hold; beyond, the whole step
is tried again, whose error tells the reason."""
_NO_BALANCE = "no tension and no places of tensioners balance the belt with its bending stiffness and weight."


def estimate_at_rest(prepared: Prepared) -> tuple[Prepared, Installation]:
    """Estimate the belt at rest, without compiled code.

    Parameters
    ----------
    prepared : Prepared
        The drive.

    Returns
    -------
    prepared : Prepared
        With the belt length, or the take-up, that gives the installed tension, if given.
    installation : Installation
        Within 1 % of static equilibrium where arcs are several times as long as the layers at their ends, penetrations
        excepted. A slack belt, and one for which closed forms of bending and weight do not hold, have the estimate
        without them, with its `limitation`.

    Raises
    ------
    ModelError
        If no belt or no take-up gives the installed tension.

    Examples
    --------
    >>> prepared, installation = bd.model.estimate_at_rest(bd.model.prepare(drive))
    >>> print(f"{installation.tension:.2f} N")
    26.74 N
    """
    if not prepared.installation.tension > 0.0:
        return prepared, prepared.installation
    try:
        belt = _balanced(prepared)
    except ModelError as error:
        return prepared, replace(prepared.installation, limitation=str(error))
    if prepared.installed_tension is not None:
        prepared = prepared.tightened(_distance(prepared, belt))
    depths = belt.tension * belt.stretch / (prepared.radii * prepared.contact_stiffness)
    return prepared, prepared.installed(belt.span_tensions, depths, belt.hub_loads, belt.positions, belt.end_tensions)


class Tightening(NamedTuple):
    """How a drive gets its installed tension, in closed form."""

    distance: float
    """See `Prepared.tightened`, m."""
    slope: float
    """Tension over that distance, N/m: negative where a spring presses the harder the longer the belt is."""


def tightening(prepared: Prepared) -> Tightening | None:
    """Estimate by how much to tighten a drive with an installed tension; None where no balance is found nearby."""
    tension = prepared.installed_tension
    if tension is None:
        return None
    if not prepared.installation.tension > 0.0:
        return None
    try:
        distances = [_distance(prepared, _balanced(prepared, tension * part)) for part in (1.0, 1.0 + _CHANGE)]
    except ModelError:
        return None
    if distances[0] == distances[1]:
        return None
    return Tightening(distances[0], _CHANGE * tension / (distances[1] - distances[0]))


def _distance(prepared: Prepared, belt: "_Belt") -> float:
    """By how much to tighten a drive until its belt is that one; see `Prepared.tightened`, m."""
    missing = prepared.belt_length - belt.length
    return missing if prepared.drive.belt.length is None else missing * belt.stretch


@dataclass(frozen=True)
class _Belt:
    """A belt at rest under a tension of its spans, with the spring-loaded tensioners at some positions."""

    prepared: Prepared
    tension: float
    positions: FloatArray

    @cached_property
    def arcs(self) -> list[ArcAtRest]:
        """The middle of each arc."""
        belt = self.prepared.belt
        section = Section(belt.stretch_parameters, self.prepared.contact_stiffness, belt.bending_stiffness)
        return [arc_at_rest(section, self.tension, radius) for radius in self.prepared.radii.tolist()]

    @cached_property
    def spans(self) -> Path:
        """The path whose spans are the lines of the spans."""
        path = self.prepared.path
        for _ in range(_MAX_RADIUS_ITERATIONS):
            wraps, before = path.wrap_angles.tolist(), path.radii
            path = self._around(
                [span_radius(arc.depth, r, self._bend, wrap) for (arc, r), wrap in zip(self._rims, wraps, strict=True)]
            )
            if np.all(np.abs(path.radii - before) <= _TOLERANCE * np.abs(before)):
                break
        return path

    @property
    def stretch(self) -> float:
        """Of the spans."""
        return float(self.prepared.belt.stretch_parameters.stretch(self.tension))

    @property
    def length(self) -> float:
        """Unstretched length, m."""
        inner = [radius - arc.depth for arc, radius in self._rims]
        path = self._around(inner)
        sag = sum(
            float(np.sum((across * parts / self.tension) ** 2 * parts))
            for across, parts in zip(self._across.tolist(), self._hanging(path), strict=True)
        )
        sag /= 24.0
        ends = sum(
            2.0 * end_of_contact(arc.depth, r, self._bend) for (arc, _), r in zip(self._rims, inner, strict=True)
        )
        on_arcs = sum(
            wrap * r / arc.stretch for wrap, r, arc in zip(path.wrap_angles.tolist(), inner, self.arcs, strict=True)
        )
        along = path.span_lengths / self.prepared.belt.stretch_parameters.stretch(self.span_tensions)
        return float(along.sum() + (sag + ends) / self.stretch + on_arcs)

    @property
    def excess(self) -> FloatArray:
        """Force of each spring and its stops over that of the belt, N or N m; see `balance_tensioners`."""
        loads = self.hub_loads
        excess = [
            q if one.presses else one.force(q) + float(loads[one.pulley] @ one.place(q)[1])
            for one, q in zip(self.prepared.carriers, self.positions.tolist(), strict=True)
        ]
        return np.array(excess)

    @property
    def span_tensions(self) -> FloatArray:
        """In the middle of the spans, N; the mean of a closed belt, and that at a pulled end, is the tension."""
        lifted = -(self.spans.span_points.mean(axis=1) @ self._weight)
        before, behind = self._goods
        first = int(self.spans.leaving[self.prepared.reference])
        passed = np.roll(np.cumsum(np.roll(before + behind, -first)), first)
        lifted = lifted + passed - behind
        pulled = [number for number, end in enumerate(self.prepared.path_ends) if end.pull is not None]
        if self.spans.ends is None or not pulled:
            return np.asarray(self.tension + lifted - lifted.mean())
        return np.asarray(self.tension + lifted + self.spans.ends[pulled[0]] @ self._weight)

    @property
    def end_tensions(self) -> FloatArray:
        """At start and end of the spans, N, shape (s, 2)."""
        points, (before, behind) = self.spans.span_points, self._goods
        below = (points.mean(axis=1, keepdims=True) - points) @ self._weight
        return np.asarray(self.span_tensions[:, None] + below + np.stack([-before, behind], axis=1))

    @property
    def hub_loads(self) -> FloatArray:
        """Of the spans, and of the weight of the belt up to their middles, N, shape (n, 2).

        Supports carry the weight across a span.
        """
        path, pulls = self.spans, self.span_tensions[:, None] * self.spans.span_directions
        before, after, along = path.reaching, path.leaving, path.span_directions
        free = np.array([parts.sum() for parts in self._hanging(path)])[:, None]
        carried = 0.5 * (path.span_lengths[:, None] - free) * (along @ self._weight)[:, None] * along
        carried += 0.5 * free * self._weight
        of_goods = [-part[:, None] * along for part in self._goods]
        arcs = (path.wrap_angles * np.abs(path.radii))[:, None] * self._weight
        own = (carried + of_goods[0])[after] + (carried + of_goods[1])[before]
        return np.asarray(pulls[after] - pulls[before] + arcs + own)

    @cached_property
    def _goods(self) -> tuple[FloatArray, FloatArray]:
        """By how much goods at rest raise the tension of each span before and behind its middle, N, shape (s,)."""
        path, found = self.spans, np.zeros((2, self.spans.spans))
        for one in self.prepared.goods:
            stretch, share = self.prepared.stretch(one), 1.0
            if one.schedule is not None:
                share = float(one.schedule.at([0.0])[0])
            rear, front = one.batch or (-np.inf, np.inf)
            middle = 0.5 * float(path.span_lengths[stretch.span])
            uphill = -float(path.span_directions[stretch.span] @ np.array(self.prepared.gravity))
            for half, (start, stop) in enumerate(((-np.inf, middle), (middle, np.inf))):
                length = max(0.0, min(stretch.end, front, stop) - max(stretch.start, rear, start))
                found[half, stretch.span] += share * one.mass_per_length * uphill * length
        return found[0], found[1]

    def _hanging(self, path: Path) -> list[FloatArray]:
        """Lengths of the parts of each span of a path that no support carries, m."""
        return hanging_lengths(self.prepared.supports, self.prepared.spans, path)

    @property
    def _bend(self) -> float:
        return self.prepared.belt.bending_stiffness / self.tension

    @property
    def _rims(self) -> list[tuple[ArcAtRest, float]]:
        return list(zip(self.arcs, self.prepared.radii.tolist(), strict=True))

    @property
    def _weight(self) -> FloatArray:
        """Of a meter of the stretched belt, N/m, shape (2,)."""
        return self.prepared.belt.mass_per_length / self.stretch * np.array(self.prepared.gravity)

    @property
    def _across(self) -> FloatArray:
        x, y = self._weight
        return np.asarray(self.spans.span_directions @ np.array([-y, x]))

    def _around(self, radii: list[float]) -> Path:
        path = self.prepared.path
        return moved(
            Path(path.centers, np.sign(path.radii) * radii, path.ends, path.nips),
            self.prepared.carriers,
            self.positions,
        )


def _balanced(prepared: Prepared, given: float | None = None) -> _Belt:
    """The belt with its tension, tensioners in balance, by Newton's method; ModelError where closed forms end."""
    first = prepared.installation
    if given is None:
        given = prepared.installed_tension or prepared.loaded_belt.installed_tension

    def belt_at(unknown: FloatArray) -> _Belt:
        tension = given if given is not None else first.tension * float(unknown[-1])
        return _Belt(prepared, tension, first.tensioner_positions + travel * unknown[: len(travel)])

    def residual(unknown: FloatArray) -> FloatArray:
        belt = belt_at(unknown)
        forces = belt.excess * travel / (first.tension * size)
        return forces if given is not None else np.append(forces, (belt.length / prepared.belt_length - 1.0) / strain)

    size = float(prepared.radii.min())
    travel = np.array([size / np.linalg.norm(one.place(0.0)[1]) for one in prepared.carriers])
    strain = max(first.strain, _DIFFERENCE_STEP)
    unknown = np.append(np.zeros(len(travel)), [1.0] * (given is None))
    try:
        missing = residual(unknown)
        for _ in range(_MAX_NEWTON_STEPS):
            if np.all(np.abs(missing) < _TOLERANCE):
                return belt_at(unknown)
            slopes = [
                (residual(unknown + _DIFFERENCE_STEP * way) - missing) / _DIFFERENCE_STEP
                for way in np.eye(len(unknown))
            ]
            increment = np.asarray(np.linalg.solve(np.transpose(slopes), -missing), float)
            unknown, missing = _stepped(residual, unknown, increment)
    except np.linalg.LinAlgError as error:
        raise ModelError(_NO_BALANCE) from error
    except ValueError as error:  # no path around the pulleys
        raise ModelError(f"{str(error).rstrip('.')}.") from error
    raise ModelError(_NO_BALANCE)


def _stepped(
    residual: Callable[[FloatArray], FloatArray], unknown: FloatArray, increment: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The unknowns after a step of Newton's method, shortened to where closed forms hold, and their residual."""
    for halvings in range(_MAX_STEP_LENGTHS):
        ahead = unknown + 0.5**halvings * increment
        with suppress(ValueError):
            return ahead, residual(ahead)
    ahead = unknown + increment
    return ahead, residual(ahead)

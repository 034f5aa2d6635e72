"""Steady running by a balance of lumped spans: tensions, the places of tensioners, and the load at which a belt slips.

A model of its own, which shares nothing with the package but the numbers of a drive.  Spans are straight and elastic;
on an arc the belt sticks with the tension of its entry and then slides, up to its exit, with the exponential of Euler
and Eytelwein for T' = T - m v^2.  Tensioners move until spring and belt balance.

Bending (exact for a long span): the span is an elastica about its line of force, with EI / R = T' y where it meets the
rim, at the angle a to that line, T' (1 - cos a) = EI / (2 R^2).  So the line passes the center at R + EI / (2 T' R),
and the rim presses with T' sin a on the end of the arc.  An idler of small wrap is touched at one point, with
a = wrap / 2.  Weight, hysteresis and the regularization of friction are left out.

    balance = LumpedBalance.of(drive)          # constant torques, one pulley with a prescribed speed
    state = balance.at(1.0)                    # under the loads of the drive: tensions, positions, use of friction
    limit = balance.limit()                    # factor on all loads at which a pulley slips, which one, its torque
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cos, log, sin
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, root

from beltdyn.arrays import FloatArray
from beltdyn.machines import Load, RotaryTensioner, SlidingTensioner
from beltdyn.model import Drive

_STEP = 0.05
"""Of the load factor on the way to the limit, over the factor at which the tension at rest would be used up."""
_NEAR = 0.1
"""Longest movement of a tensioner in a step on the way to a load, over the radius of its pulley."""
_ROUNDING = 1e-9
_TURN = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
"""Angles of a shaft over which a load is averaged, rad."""


def mean_torque(load: Load, speed: float, time: float) -> float:
    """Mean torque of a load over the angle at a speed (rad/s) and an instant (s), N m."""
    factor = 1.0 if load.factor is None else float(load.factor.at([time])[0])
    return factor * float(np.mean(load.torque_over(_TURN, speed, time)))


class Spring(NamedTuple):
    """A tensioner: where it holds its pulley, and with what force it presses it."""

    pulley: int
    place: Callable[[float], FloatArray]
    """Center of the pulley at a position, m."""
    way: Callable[[float], FloatArray]
    """Its derivative with respect to the position."""
    force: Callable[[float], float]
    """N, or N m, positive where the position grows."""
    scale: float
    """Position at which the pulley has moved by about its radius."""


class Balanced(NamedTuple):
    """Steady running."""

    tensions: FloatArray
    """Of the spans, span i behind pulley i, N."""
    positions: FloatArray
    """Of the tensioners, m or rad."""
    wraps: FloatArray
    """Angles of wrap, rad."""
    use: FloatArray
    """Used part of the grip of each pulley, |ln(T'/T')| over its largest value; infinite where a span is slack."""


class Limit(NamedTuple):
    """Where a pulley begins to slip as a whole, a span has no more tension, or the arm does not balance the belt."""

    factor: float
    """On the torques of the drive."""
    pulley: int
    """The one that slips, or else the one that uses most of its grip."""
    torque: float
    """That the pulley transmits there, N m, without sign."""
    state: Balanced
    cause: str = "friction"
    """"friction", "slack" or "arm"."""


@dataclass(frozen=True)
class LumpedBalance:
    """A drive of lumped spans; radii are signed, negative where the belt's back touches. SI units."""

    centers: FloatArray
    radii: FloatArray
    friction: FloatArray
    torques: FloatArray
    """On the shafts, counter-clockwise positive, N m; that of the driver follows."""
    driver: int
    speed: float
    """Of the belt, m/s, without sign."""
    axial: float
    """E A, N."""
    bending: float
    """E I, N m^2."""
    mass: float
    """kg/m."""
    length: float
    """Unstretched, m."""
    contact: float
    """Stiffness of contact, N/m^2."""
    springs: Sequence[Spring] = ()
    sense: float = 1.0
    """1 where the belt runs in the order of its pulleys, -1 against it."""

    @classmethod
    def of(cls, drive: Drive) -> "LumpedBalance":
        """A drive with constant torques, of which one pulley has a prescribed speed."""
        signs = np.sign(drive.path.radii)
        end = drive.simulation.end
        driver = next(k for k, one in enumerate(drive.pulleys) if one.speed is not None)
        speed = float(drive.pulleys[driver].speed.at([end])[0]) * drive.path.radii[driver]  # type: ignore[union-attr]
        torques = [
            (0.0 if one.torque is None else float(one.torque.at([end])[0]))
            + sum(mean_torque(load, speed / radius, end) for load in one.load)
            for one, radius in zip(drive.pulleys, drive.path.radii, strict=True)
        ]
        return cls(
            centers=np.array(drive.centers),
            radii=drive.radii * signs,
            friction=np.array(drive.frictions),
            torques=np.array(torques),
            driver=driver,
            speed=abs(speed),
            axial=drive.belt.axial_stiffness,
            bending=drive.belt.bending_stiffness,
            mass=drive.belt.mass_per_length,
            length=drive.belt_length,
            contact=drive.contact_stiffness,
            springs=tuple(spring_of(drive, number) for number in range(len(drive.moving_tensioners))),
            sense=float(np.sign(speed)) or 1.0,
        )

    @property
    def lifted(self) -> float:
        """m v^2, N."""
        return self.mass * self.speed**2

    def at(self, factor: float, near: Balanced | None = None) -> Balanced:
        """Steady running under a multiple of the loads, from a state nearby; `ArithmeticError` where there is none."""
        if near is None:
            near = self._begin()
            return near if factor == 0.0 else self._follow(near, factor)
        return self._solve(factor, near)

    def limit(self) -> Limit:
        """Load at which the first pulley slips, a span is slack, or no place of the tensioner is a balance."""
        here, factor = self._begin(), 0.0
        step = _STEP * float(here.tensions.min()) / float(np.max(np.abs(self._differences(1.0))))
        smallest = _ROUNDING * step
        while True:
            try:
                ahead = self._solve(factor + step, here)
            except ArithmeticError:
                ahead = None
            if ahead is None or self._is_far(here, ahead):
                step *= 0.5
                if step < smallest:
                    return self._limit_at(factor, here, "arm")
            elif ahead.use.max() < 1.0:
                here, factor, step = ahead, factor + step, 1.1 * step
            else:
                break

        def beyond(part: float) -> float:
            try:
                return float(self._solve(factor + part * step, here).use.max()) - 1.0
            except ArithmeticError:  # no balance is beyond what the drive transmits
                return 1.0

        slack = not np.isfinite(ahead.use.max())
        part = self._bisect(beyond) if slack else brentq(beyond, 0.0, 1.0, xtol=1e-9)
        part *= 1.0 - 1e-6
        there = self._solve(factor + part * step, here)
        return self._limit_at(factor + part * step, there, "slack" if slack else "friction")

    def _limit_at(self, factor: float, state: Balanced, cause: str) -> Limit:
        pulley = int(np.argmax(state.use))
        before = np.roll(state.tensions, 1)
        torque = abs(float(state.tensions[pulley] - before[pulley]) * float(self.radii[pulley]))
        return Limit(factor, pulley, torque, state, cause)

    def _is_far(self, here: Balanced, ahead: Balanced) -> bool:
        """Whether a tensioner has moved so far that the balance may be another one."""
        return any(np.abs(ahead.positions - here.positions) > [_NEAR * spring.scale for spring in self.springs])

    @staticmethod
    def _bisect(beyond: Callable[[float], float]) -> float:
        low, high = 0.0, 1.0
        while high - low > _ROUNDING:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if beyond(middle) > 0.0 else (middle, high)
        return low

    def _differences(self, factor: float) -> FloatArray:
        """Tensions of the spans over that of the last one, N."""
        pull = factor * self.torques / self.radii
        pull[self.driver] = 0.0
        pull[self.driver] = -float(pull.sum())
        return -np.cumsum(pull)

    def _begin(self) -> Balanced:
        """Without loads, from the belt laid on its path."""
        none, count = np.zeros(len(self.springs)), self.radii.size
        path = self._path(none, np.full(count, self.axial))
        tension = self.axial * (path.length / self.length - 1.0)
        if self.springs:
            spring = self.springs[0]
            before, behind = (path.directions[k] for k in (spring.pulley - 1, spring.pulley))
            tension = spring.force(0.0) / float((before - behind) @ spring.way(0.0)) + self.lifted
        start = max(tension, 2.0 * self.lifted + 1e-6 * self.axial)
        return self._solve(0.0, Balanced(np.full(count, start), none, path.wraps, np.zeros(count)))

    def _follow(self, near: Balanced, factor: float) -> Balanced:
        done, step = 0.0, 1.0
        while done < 1.0:
            ahead = min(done + step, 1.0)
            try:
                there = self._solve(ahead * factor, near)
                if self._is_far(near, there):
                    raise ArithmeticError("another balance, far away")
                near, done = there, ahead
            except ArithmeticError:
                step *= 0.5
                if step < 1e-3:
                    raise
        return near

    def _solve(self, factor: float, near: Balanced) -> Balanced:
        """Find the tension of the last span and the positions: the belt has its length, and springs are in balance."""
        differences = self._differences(factor)
        size = float(near.tensions.mean())
        scales = np.array([size, *(spring.scale for spring in self.springs)])

        def residual(unknowns: FloatArray) -> FloatArray:
            unknowns = unknowns * scales
            tensions, positions = unknowns[0] + differences, unknowns[1:]
            path = self._path(positions, tensions)
            left = [(self._unstretched(path, tensions) / self.length - 1.0) * self.axial / size]
            for spring, q in zip(self.springs, positions.tolist(), strict=True):
                pressed, p, way = tensions - self.lifted, spring.pulley, spring.way(q)
                force = pressed[p - 1] * path.directions[p - 1] - pressed[p] * path.directions[p]
                left.append(float(spring.force(q) - force @ way) / (size * float(np.linalg.norm(way))))
            return np.array(left)

        found = root(residual, np.array([near.tensions[-1], *near.positions]) / scales, tol=1e-12)
        if not np.max(np.abs(residual(found.x))) < 1e-8:
            raise ArithmeticError(f"no lumped balance at {factor:g} times the loads")
        values = found.x * scales
        tensions, positions = values[0] + differences, values[1:]
        path = self._path(positions, tensions)
        return Balanced(tensions, positions, path.wraps, self._use(tensions, path.wraps))

    def _use(self, tensions: FloatArray, wraps: FloatArray) -> FloatArray:
        pressed = tensions - self.lifted
        before = np.roll(pressed, 1)
        if min(pressed) <= 0.0:
            return np.where(np.minimum(pressed, before) <= 0.0, np.inf, 0.0)
        tight, slack = np.maximum(pressed, before), np.minimum(pressed, before)
        changed = np.log(tight / slack)
        at_tight, at_slack = (self._contact_angle(one, wraps) for one in (tight, slack))
        grip = self.friction * (wraps - at_tight - at_slack)
        grip -= np.log(np.maximum(np.cos(at_tight) - self.friction * np.sin(at_tight), 1e-9))
        grip += np.log(np.cos(at_slack) + self.friction * np.sin(at_slack))
        return np.asarray(np.divide(changed, grip, out=np.zeros(changed.size), where=changed > _ROUNDING))

    def _contact_angle(self, pressed: FloatArray, wraps: FloatArray) -> FloatArray:
        """Angle between the line of force of a span and the belt where it meets the rim, rad."""
        cosine = 1.0 - 0.5 * self.bending / (np.maximum(pressed, 1e-9 * self.axial) * self.radii**2)
        return np.minimum(np.arccos(np.clip(cosine, 0.0, 1.0)), 0.5 * wraps)

    def _unstretched(self, path: "Route", tensions: FloatArray) -> float:
        """Unstretched length of a belt with these tensions, m."""
        total = float(np.sum(path.spans / (1.0 + tensions / self.axial)))
        pressed = np.maximum(tensions - self.lifted, 1e-9 * self.axial)
        layers = self._longer(np.roll(pressed, 1), path.wraps) + self._longer(pressed, path.wraps)
        total += float(np.sum(layers / (1.0 + tensions / self.axial)))
        for p, (radius, wrap) in enumerate(zip(np.abs(self.radii).tolist(), path.wraps.tolist(), strict=True)):
            ends = tensions[p - 1], tensions[p]
            entry, leaving = (one - self.lifted for one in (ends if self.sense > 0.0 else ends[::-1]))
            mean = entry
            if entry > 0.0 and leaving > 0.0 and abs(leaving / entry - 1.0) > _ROUNDING:
                slide = min(abs(log(leaving / entry)) / (self.friction[p] * wrap), 1.0)
                mean = (1.0 - slide) * entry + slide * (leaving - entry) / log(leaving / entry)
            depth = max(mean, 0.0) / (radius * self.contact)
            axial = mean + self.lifted - 0.5 * self.bending / radius**2  # an elastica keeps N + EI kappa^2 / 2
            total += (radius - depth) * wrap / (1.0 + axial / self.axial)
        return total

    def _path(self, positions: FloatArray, tensions: FloatArray) -> "Route":
        """The lines of force of the spans and the arcs between them."""
        centers = self.centers.copy()
        for spring, q in zip(self.springs, positions.tolist(), strict=True):
            centers[spring.pulley] = spring.place(q)
        rigid = Route.around(centers, self.radii)
        if self.bending == 0.0:
            return rigid
        pressed = np.maximum(tensions - self.lifted, 1e-9 * self.axial)
        lifts = [self._lift(one, rigid.wraps) for one in (np.roll(pressed, 1), pressed)]
        return Route.around(centers, self.radii + 0.5 * np.sign(self.radii) * (lifts[0] + lifts[1]))

    def _lift(self, pressed: FloatArray, wraps: FloatArray) -> FloatArray:
        """How much farther than the rim the line of force of a span passes the center, m."""
        angle, layer = self._contact_angle(pressed, wraps), np.sqrt(self.bending / pressed)
        return np.asarray(2.0 * layer * np.sin(0.5 * angle) - np.abs(self.radii) * (1.0 - np.cos(angle)))

    def _longer(self, pressed: FloatArray, wraps: FloatArray) -> FloatArray:
        """How much longer than the line of force up to its foot, and the rim, a belt is at the end of an arc, m."""
        angle, layer = self._contact_angle(pressed, wraps), np.sqrt(self.bending / pressed)
        return np.asarray(np.abs(self.radii) * (np.sin(angle) - angle) + 2.0 * layer * (1.0 - np.cos(0.5 * angle)))


class Route(NamedTuple):
    """Straight spans and arcs about circles."""

    radii: FloatArray
    """Signed, m."""
    directions: FloatArray
    """Unit vectors along the spans, shape (n, 2)."""
    spans: FloatArray
    """Their lengths, m."""
    wraps: FloatArray
    """rad."""

    @classmethod
    def around(cls, centers: FloatArray, radii: FloatArray) -> "Route":
        """The belt around circles."""
        between, steps = np.roll(centers, -1, axis=0) - centers, np.roll(radii, -1) - radii
        distances = np.hypot(*between.T)
        angle = np.arctan2(between[:, 1], between[:, 0]) - np.arcsin(np.clip(steps / distances, -1.0, 1.0))
        turned = (angle - np.roll(angle, 1)) * np.sign(radii)
        spans = np.sqrt(np.maximum(distances**2 - steps**2, 0.0))
        directions = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return cls(radii, directions, spans, (turned + 1e-9) % (2.0 * np.pi) - 1e-9)

    @property
    def length(self) -> float:
        """m."""
        return float(np.sum(self.spans) + np.abs(self.radii) @ self.wraps)


def spring_of(drive: Drive, number: int) -> Spring:
    """A spring tensioner of a drive, with its stops, without dry friction."""
    one = drive.moving_tensioners[number]
    spring = one.spring
    pulley = drive.carried(one)
    center = np.array(drive.centers[pulley])
    reach = float(drive.radii[pulley])

    lower, upper = one.stops or (-np.inf, np.inf)
    stiffness = one.stop_stiffness or 0.0

    def force(q: float) -> float:
        return spring["preload"] - spring["rate"] * q + stiffness * (max(lower - q, 0.0) - max(q - upper, 0.0))

    if isinstance(one, SlidingTensioner):
        along = np.array(one.direction)
        return Spring(pulley, lambda q: center + q * along, lambda q: along, force, reach)
    assert isinstance(one, RotaryTensioner)
    pivot = np.array(one.pivot)
    arm = center - pivot
    normal = np.array([-arm[1], arm[0]])
    before, behind = (drive.path.span_directions[k] for k in (pulley - 1, pulley))
    sense = float(np.sign((before - behind) @ normal))

    def place(q: float) -> FloatArray:
        return np.asarray(pivot + cos(q) * arm + sense * sin(q) * normal)

    def way(q: float) -> FloatArray:
        return np.asarray(-sin(q) * arm + sense * cos(q) * normal)

    return Spring(pulley, place, way, force, reach / float(np.linalg.norm(arm)))

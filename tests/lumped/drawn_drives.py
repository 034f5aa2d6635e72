"""Drives drawn at random: 2 to 9 pulleys, idlers of small wrap, spring tensioners, both senses."""

from collections.abc import Callable, Sequence
from math import cos, pi, radians, sin
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError
from beltdyn.machines import Constant
from beltdyn.model import Drive, Path
from tests.lumped.lumped_balance import Limit, LumpedBalance, Route

SEED = 34
_MOST_SWING = 0.6
"""Way of a tensioner's pulley up to the limit, over its radius, at most."""


class Drawn(NamedTuple):
    """A drive, and what it transmits."""

    drive: Drive
    """Under all the load that it transmits by the lumped balance."""
    limit: Limit
    """Of that drive: its factor is 1."""
    balance: LumpedBalance

    def under(self, factor: float) -> Drive:
        """The drive under a part of that load."""
        pulleys = [
            one if one.torque is None else one.replace(torque=Constant(value=factor * float(one.torque.at([0.0])[0])))
            for one in self.drive.pulleys
        ]
        return self.drive.replace(pulley=pulleys)


class Ring(NamedTuple):
    """Pulleys in the order of the belt."""

    centers: FloatArray
    radii: FloatArray
    """Signed, m."""
    idle: list[bool]
    wraps: FloatArray

    @classmethod
    def of(
        cls, centers: Sequence[FloatArray] | FloatArray, radii: Sequence[float] | FloatArray, idle: list[bool]
    ) -> "Ring":
        """With the wraps of its path."""
        path = Path(np.array(centers), np.array(radii))
        return cls(path.centers, path.radii, idle, path.wrap_angles)


def drawn_drive(seed: int) -> Drawn:
    """The drive of a seed; draws that do not fit are thrown away."""
    rng, count = np.random.default_rng([SEED, seed]), 2 + seed % 8
    return _first_that_fits(lambda: _draw(rng, count, None))


def drawn_arm_drive(seed: int) -> Drawn:
    """The drive of a seed whose tensioner moves far, up to where it loses its balance, with dry friction and stops."""
    rng, count = np.random.default_rng([SEED, 3, seed]), 3 + seed % 6
    return _first_that_fits(lambda: _draw(rng, count, _as_arm))


def _first_that_fits(draw: Callable[[], Drawn | None]) -> Drawn:
    while True:
        try:
            found = draw()
        except (BeltdynError, ValueError, ArithmeticError):
            continue
        if found is not None:
            return found


def drawn_layout(rng: np.random.Generator, count: int, small: float) -> tuple[Ring, int | None]:
    """Pulleys, of which the first drives, and the number of the one on a tensioner, if there is one."""
    base = int(rng.integers(2, min(count, 5) + 1))
    radii = small * np.exp(rng.uniform(0.0, np.log(3.5), base))
    size = rng.uniform(1.2, 2.2) * np.sort(radii)[-2:].sum() / (2.0 * sin(pi / base))
    angles = 2.0 * pi * np.arange(base) / base + rng.uniform(-0.3, 0.3, base)
    ring = Ring.of(size * np.stack([np.cos(angles), np.sin(angles)], axis=1), radii, [False] * base)
    order = list(range(base))
    carried = None
    for number in range(count - base):
        span = int(rng.integers(0, len(order)))
        tensioning = number == 0 and rng.random() < 0.75
        wrap = radians(rng.uniform(25.0, 80.0) if tensioning else np.exp(rng.uniform(0.0, np.log(20.0))))
        if not tensioning and rng.random() < 0.15:
            wrap = radians(rng.uniform(20.0, 70.0))
        sign = 1.0 if rng.random() < 0.35 else -1.0
        if tensioning and rng.random() < 0.6:
            span = 0 if rng.random() < 0.5 else len(order) - 1  # beside the driver
        ring = _inserted(ring, span, sign * small * rng.uniform(0.7, 1.5), wrap, rng.uniform(0.25, 0.75))
        order.insert(span + 1, base + number)
        if tensioning:
            carried = base + number
    return ring, None if carried is None else order.index(carried)


def idler_between(radius: float, wrap: float) -> Ring:
    """Pulleys of 80 and 30 mm, 300 mm apart, with an idler of a signed radius (m) and wrap (rad) before the second."""
    two = Ring.of(np.array([[0.0, 0.0], [0.3, 0.0]]), [0.08, 0.03], [False, False])
    return _inserted(two, 0, radius, wrap, 0.5)


def _inserted(ring: Ring, span: int, radius: float, wrap: float, part: float) -> Ring:
    """A further pulley that turns a span by an angle."""
    path = Path(ring.centers, ring.radii)
    start, stop = path.span_points[span]
    along = path.span_directions[span]
    left = np.array([-along[1], along[0]])
    foot = start + part * (stop - start)

    def at(deep: float) -> Ring:
        center = foot + (radius - deep * np.sign(radius)) * left
        centers, radii, idle = list(ring.centers), list(ring.radii), list(ring.idle)
        centers.insert(span + 1, center)
        radii.insert(span + 1, radius)
        idle.insert(span + 1, True)
        return Ring.of(centers, radii, idle)

    def missing(deep: float) -> float:
        angle = float(at(deep).wraps[span + 1])
        return (angle if angle < pi else angle - 2.0 * pi) - wrap

    about = wrap * part * (1.0 - part) * float(path.span_lengths[span])
    return at(brentq(missing, 0.0, 1.3 * about, xtol=1e-12))


Moved = Callable[[np.random.Generator, dict[str, Any], float], dict[str, Any]]
"""From a tensioner, and the radius of its pulley (m), to one that moves far."""


def _draw(rng: np.random.Generator, count: int, moved: Moved | None) -> Drawn | None:
    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    small = between(0.015, 0.08)
    ring, carried = drawn_layout(rng, count, small)
    working = [k for k in range(count) if not ring.idle[k]]
    path = Path(ring.centers, ring.radii)
    if abs(path.total_turning - 2.0 * pi) > 1e-6 or min(path.span_lengths) < 0.15 * small:
        return None
    if any(path.wrap_angles[k] < 0.6 for k in working) or not are_clear(path.centers, path.radii):
        return None
    tension = 300.0 * (small / 0.03) ** 1.5 * between(0.4, 2.5)
    strain, friction = between(1e-3, 8e-3), rng.uniform(0.25, 0.9)
    if moved is not None:  # grooves that wedge the belt, and belts that stretch, let tensioners move far
        strain, friction = 1.5 * strain, 2.0 * friction
    least = float(np.min(np.abs(ring.radii)))
    thickness = rng.uniform(0.03, 0.12) * least
    mass = 1200.0 * 5.0 * thickness**2
    speed = np.sqrt(between(1e-3, 0.15) * tension / mass) * rng.choice([-1.0, 1.0])
    driver = working[0]
    shares = {k: between(0.1, 1.0) for k in working[1:]}
    shares |= {k: 0.05 for k in range(count) if ring.idle[k] and k != carried and ring.wraps[k] > 0.5}
    shares = {k: share for k, share in shares.items() if rng.random() < 0.8 or k == working[-1]}
    belt = {
        "width": 5.0 * thickness,
        "thickness": thickness,
        "poissons_ratio": 0.3,
        "axial_stiffness": tension / strain,
        "bending_stiffness": tension * (between(0.02, 0.2) * least) ** 2,
        "mass_per_length": mass,
        "bending_loss_factor": 0.0 if rng.random() < 0.5 else 0.1,
        "length": path.length / (1.0 + strain),
    }
    tensioner = [] if carried is None else [tensioner_for(rng, path, carried, tension)]
    if moved is not None:
        if carried is None:
            return None
        tensioner = [moved(rng, tensioner[0], abs(float(ring.radii[carried])))]

    def drive(force: float) -> Drive:
        pulleys: list[dict[str, Any]] = [
            {
                "name": f"pulley {k}",
                "center": tuple(ring.centers[k].tolist()),
                "radius": abs(float(ring.radii[k])),
                "side": "inside" if ring.radii[k] > 0.0 else "outside",
                "inertia": 2.0 * mass * abs(float(ring.radii[k])) ** 3,
                "mass": 0.1,
            }
            for k in range(count)
        ]
        pulleys[driver]["speed"] = {"kind": "constant", "value": float(speed / ring.radii[driver])}
        del pulleys[driver]["inertia"]
        for k, share in shares.items():
            pulleys[k]["torque"] = {"kind": "constant", "value": float(-np.sign(speed) * share * force * ring.radii[k])}
        return Drive(
            belt=belt,
            pulley=pulleys,
            tensioner=tensioner,
            contact={"friction": friction},
            simulation={"duration": 1.0, "output_interval": 0.01},
        )

    once = drive(0.1 * tension)
    limit = LumpedBalance.of(once).limit()
    if not (_fits(limit, once) if moved is None else _is_clear_up_to(limit, once)):
        return None
    found = drive(0.1 * tension * limit.factor)
    balance = LumpedBalance.of(found)
    return Drawn(found, limit._replace(factor=1.0), balance)


def tensioner_for(rng: np.random.Generator, path: Path, carried: int, tension: float) -> dict[str, Any]:
    """A tensioner that holds a tension at its nominal place."""
    gradient = path.gradient(carried)
    reach = abs(float(path.radii[carried]))
    size = float(np.linalg.norm(gradient))
    turn = rng.uniform(-0.8, 0.8)
    along = np.array([[cos(turn), -sin(turn)], [sin(turn), cos(turn)]]) @ gradient / size
    force = tension * float(gradient @ along)
    name = f"pulley {carried}"
    rate = force / (reach * rng.uniform(1.0, 8.0))
    if rng.random() < 0.4:
        return {
            "kind": "sliding",
            "pulley": name,
            "direction": along.tolist(),
            "preload": force,
            "rate": rate,
            "mass": 0.3,
        }
    arm = reach * rng.uniform(1.5, 4.0)
    normal = np.array([-along[1], along[0]]) * rng.choice([-1.0, 1.0])
    pivot = path.centers[carried] + arm * normal
    return {
        "kind": "rotary",
        "pulley": name,
        "pivot": pivot.tolist(),
        "preload": force * arm,
        "rate": rate * arm**2,
        "inertia": 0.3 * arm**2,
    }


def _as_arm(rng: np.random.Generator, tensioner: dict[str, Any], reach: float) -> dict[str, Any]:
    """A tensioner of a softer or stiffer spring, in three of five with dry friction, in two of five with stops."""
    scale = reach if tensioner["kind"] == "sliding" else reach / np.sqrt(tensioner["inertia"] / 0.3)
    arm = dict(tensioner, rate=tensioner["rate"] * float(np.exp(rng.uniform(np.log(0.3), np.log(3.0)))))
    if rng.random() < 0.6:
        arm["tensioning_friction"], arm["yielding_friction"] = (arm["preload"] * rng.uniform(0.0, 0.4, 2)).tolist()
    if rng.random() < 0.4:
        arm["stops"] = (scale * np.array([-rng.uniform(0.1, 0.8), rng.uniform(0.05, 0.8)])).tolist()
        arm["stop_stiffness"] = 100.0 * arm["preload"] / scale
    return arm


def are_clear(centers: FloatArray, radii: FloatArray) -> bool:
    """Whether no two pulleys meet; radii may be signed."""
    between = np.linalg.norm(centers - centers[:, None], axis=-1) - np.abs(radii) - np.abs(radii)[:, None]
    return bool(np.all(between[~np.eye(radii.size, dtype=bool)] > 0.0))


_MOST_BENDING = 0.2
"""EI / (T' R^2) of the slackest span on the smallest pulley at the limit, at most; its tension may be 0.4 % of that of
the tightest one.  The balance knows bending to first order: with 0.26 a limit is 7 % off, with 0.5 tensions 2 %."""
_CHECKED = 6
"""Loads up to the limit at which the belt must be clear of other pulleys."""


def _is_clear_up_to(limit: Limit, drive: Drive) -> bool:
    """Whether pulleys and spans keep clear of each other up to the limit."""
    balance, near = LumpedBalance.of(drive), None
    pressed = limit.state.tensions - balance.lifted
    if balance.bending > _MOST_BENDING * min(pressed) * float(np.min(balance.radii**2)):
        return False
    for factor in np.linspace(0.0, limit.factor, _CHECKED):
        near = balance.at(float(factor), near) if factor < limit.factor else limit.state
        centers = np.array(drive.centers)
        for q, spring in zip(near.positions, balance.springs, strict=True):
            centers[spring.pulley] = spring.place(float(q))
        route = Route.around(centers, balance.radii)
        small = radians(0.8)
        if not (are_clear(centers, drive.radii) and small < min(near.wraps) and max(near.wraps) < 1.6 * pi):
            return False
        if not (min(route.spans) > 0.1 * min(drive.radii) and spans_clear(centers, route)):
            return False
    return True


def spans_clear(centers: FloatArray, route: Route) -> bool:
    """Whether no span of a route meets a pulley that is not at one of its ends."""
    count, radii = len(centers), np.abs(route.radii)
    left = np.stack([-route.directions[:, 1], route.directions[:, 0]], axis=1)
    starts = centers - route.radii[:, None] * left
    for k in range(count):
        for p in set(range(count)) - {k, (k + 1) % count}:
            along = float(np.clip((centers[p] - starts[k]) @ route.directions[k], 0.0, route.spans[k]))
            if np.linalg.norm(starts[k] + along * route.directions[k] - centers[p]) < radii[p]:
                return False
    return True


def _fits(limit: Limit, drive: Drive) -> bool:
    """Whether a pulley limits, with the tensioner where it may be, and all spans and idlers as they should."""
    state = limit.state
    if not np.isfinite(state.use).all():
        return False
    rest = LumpedBalance.of(drive).at(0.0)
    centers = np.array(drive.centers)
    for q, spring in zip(state.positions, LumpedBalance.of(drive).springs, strict=True):
        if abs(q) > _MOST_SWING * spring.scale:
            return False
        centers[spring.pulley] = spring.place(float(q))
    if not are_clear(centers, drive.radii):
        return False
    small = radians(0.8)
    return bool(min(state.wraps) > small and min(rest.wraps) > small and np.ptp(state.wraps - rest.wraps) < 1.0)

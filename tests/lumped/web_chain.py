"""Tensions of a web line by a chain of capstans, and lines drawn at random.

The same unstretched length c passes every place in a unit of time.  A driven roller of rim speed v that grips has the
web arrive at its speed, so that the tension before it is W = N(v / c); it grips as long as T' = T - m v^2 changes by no
more than the factor exp(mu theta).  Otherwise it slides, and the tension before it is that behind it times or over this
factor, whichever is nearer to W:

    T_before = clip(W, T_behind exp(-mu theta), T_behind exp(mu theta)).

From the winder backwards the tension at the unwinder follows, which falls as c grows; c is where it is the one given.
A held roller has W = 0, an idle one T_before = T_behind.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from beltdyn.model import Drive

SEED = 57
AXIAL, MASS = 2e4, 0.05
WEB = {"axial_stiffness": AXIAL, "bending_stiffness": 1e-4, "mass_per_length": MASS, "thickness": 1e-4, "width": 0.2}
_GRIPPING = 0.97
"""Used part of the grip up to which a roller is taken to grip for sure, and over which to slide for sure, inverse."""


class Roller(NamedTuple):
    """A roller of a line."""

    speed: float | None
    """Of its rim, m/s; zero where it is held, None where it is idle."""
    grip: float
    """mu theta."""


class Chain(NamedTuple):
    """A line in steady running."""

    passed: float
    """Unstretched length that passes in a unit of time, m/s."""
    tensions: list[float]
    """From the unwinder to the winder, N."""


def backwards(rollers: Sequence[Roller], winder: float, passed: float) -> list[float]:
    """Tensions from the unwinder to the winder of a web of which a length passes in a unit of time (m/s), N."""
    tensions = [winder]
    for roller in reversed(rollers):
        behind = tensions[0]
        lifted = MASS * (passed * (1.0 + behind / AXIAL)) ** 2
        wanted = behind if roller.speed is None else AXIAL * (roller.speed / passed - 1.0)
        least, most = ((behind - lifted) * np.exp(sense * roller.grip) + lifted for sense in (-1.0, 1.0))
        tensions.insert(0, float(np.clip(wanted, least, most)))
    return tensions


def bracket(rollers: Sequence[Roller]) -> tuple[float, float]:
    """Lengths in a unit of time at which all driven rollers slide, ahead of the web and behind it, m/s."""
    speeds = [roller.speed for roller in rollers if roller.speed]
    return 0.9 * min(speeds), max(speeds)


def chain(rollers: Sequence[Roller], unwinder: float, winder: float) -> Chain | None:
    """Tensions of a line; None where no speed of the web gives both tensions (N)."""

    def missing(passed: float) -> float:
        return backwards(rollers, winder, passed)[0] - unwinder

    low, high = bracket(rollers)
    if not (missing(low) > 0.0 > missing(high)):
        return None
    passed = brentq(missing, low, high, xtol=1e-14, rtol=1e-14)
    return Chain(passed, backwards(rollers, winder, passed))


class DrawnLine(NamedTuple):
    """A web line, and what the chain of capstans says of it."""

    drive: Drive
    chain: Chain


def drawn_line(seed: int) -> DrawnLine:
    """The line of a seed: two to five rollers, at least one of them driven, in a third of the lines one held."""
    rng = np.random.default_rng([SEED, seed])
    while True:
        found = _draw(rng)
        if found is not None:
            return found


def _draw(rng: np.random.Generator) -> DrawnLine | None:
    drawn = _draw_line(rng)
    if drawn is None:
        return None
    drive, rollers, ends = drawn
    found = chain(rollers, *ends)
    return None if found is None or not _is_clear(rollers, found) else DrawnLine(drive, found)


class RefusedLine(NamedTuple):
    """A web line that cannot run, and what the chain of capstans says of it."""

    drive: Drive
    sliding: list[str]
    """Names of the driven rollers, all of which slide."""
    allowed: tuple[float, float]
    """Least and largest ratio of T - m v^2 at the winder to that at the unwinder that the rollers hold."""
    required: float
    """That of the ends."""


def refused_line(seed: int) -> RefusedLine:
    """The line of a seed whose tensions differ by 10 % more than its rollers hold."""
    rng = np.random.default_rng([SEED, 3, seed])
    while True:
        drawn = _draw_line(rng)
        if drawn is None:
            continue
        drive, rollers, (unwinder, winder) = drawn
        lifted = MASS * 2.0**2
        most, least = (backwards(rollers, winder, passed)[0] for passed in bracket(rollers))
        allowed = (winder - lifted) / (most - lifted), (winder - lifted) / (least - lifted)
        required = (winder - lifted) / (unwinder - lifted)
        if not 0.9 * allowed[0] < required < 1.1 * allowed[1]:
            names = [pulley.name for pulley, roller in zip(drive.pulleys, rollers, strict=True) if roller.speed]
            return RefusedLine(drive, names, allowed, required)


def _draw_line(rng: np.random.Generator) -> tuple[Drive, list[Roller], tuple[float, float]] | None:
    """A line, its rollers, and the tensions of unwinder and winder, N; None where no roller is driven."""
    count, speed = int(rng.integers(2, 6)), 2.0
    kinds = rng.choice(["driven", "idle", "held"], count, p=[0.6, 0.25, 0.15])
    if "driven" not in kinds:
        return None
    unwinder, winder = np.exp(rng.uniform(np.log(60.0), np.log(250.0), 2)).tolist()
    frictions = np.exp(rng.uniform(np.log(0.1), np.log(1.0), count)).tolist()
    speeds = (
        speed
        * (1.0 + np.where(rng.random(count) < 0.3, rng.uniform(-0.03, 0.03, count), rng.uniform(-0.003, 0.003, count)))
    ).tolist()
    pulleys = [_pulley(k, str(kind), frictions[k], speeds[k]) for k, kind in enumerate(kinds)]
    drive = Drive(
        belt=WEB,
        unwinder={"point": [0.0, 0.3], "tension": unwinder},
        pulley=pulleys,
        winder={"point": [0.5 * (count + 1), 0.3 if count % 2 else 0.0], "tension": winder},
        simulation={"duration": 1.0},
    )
    wraps = drive.path.wrap_angles
    rollers = [
        Roller({"driven": speeds[k], "idle": None, "held": 0.0}[str(kind)], frictions[k] * float(wraps[k]))
        for k, kind in enumerate(kinds)
    ]
    return drive, rollers, (unwinder, winder)


def _pulley(k: int, kind: str, friction: float, speed: float) -> dict[str, Any]:
    """A roller on one side of the web or the other."""
    sense = 1.0 if k % 2 == 0 else -1.0
    pulley = {
        "name": f"roller {k}",
        "center": [0.5 * (k + 1), 0.0 if k % 2 == 0 else 0.3],
        "radius": 0.05,
        "side": "inside" if k % 2 == 0 else "outside",
        "friction": friction,
    }
    motion: dict[str, dict[str, Any]] = {
        "driven": {"speed": sense * speed / 0.05},
        "held": {"speed": 0.0},
        "idle": {"inertia": 1e-3},
    }
    return pulley | motion[kind]


def _is_clear(rollers: Sequence[Roller], found: Chain) -> bool:
    """Whether a driven roller grips for sure, and no tension is so small that it may vanish."""
    used = [
        abs(np.log(behind / before)) / roller.grip
        for roller, before, behind in zip(rollers, found.tensions[:-1], found.tensions[1:], strict=True)
        if roller.speed
    ]
    return min(used) < _GRIPPING and min(found.tensions) > 5.0


class ControlledLine(NamedTuple):
    """A web line with control of tension, and what follows from its set value."""

    drive: Drive
    tensions: list[float]
    """Of the spans in the order of results, N."""
    trim: float
    """That holds the set value."""


def controlled_line(seed: int) -> ControlledLine:
    """The line of a seed: a driven roller, a load cell or a dancer, and a roller that it trims; spans of 0.3 to 3 m."""
    rng = np.random.default_rng([SEED, 7, seed])
    while True:
        found = _draw_controlled(rng)
        if found is not None:
            return found


_BARE: dict[str, Any] = {"kind": "resistance", "constant": 1.0}
"""Load of the trimmed roller while only the path is asked for."""


def _draw_controlled(rng: np.random.Generator) -> ControlledLine | None:
    """All idle rollers pass their tension on, so that the first roller and the set value give those of the spans."""
    speed, length = 2.0, float(np.exp(rng.uniform(np.log(0.3), np.log(3.0))))
    before, behind, further = (rng.random(3) < [0.5, 0.5, 0.3]).tolist()
    kinds = ["driven", *["idle"] * before, "sensor", *["idle"] * behind, "trimmed", *["driven"] * further]
    enters, held, leaves = np.exp(rng.uniform(np.log(60.0), np.log(250.0), 3)).tolist()
    friction, draw = float(np.exp(rng.uniform(np.log(0.2), 0.0))), float(rng.uniform(-0.003, 0.003))
    sensor, last = kinds.index("sensor"), kinds.index("trimmed")
    is_dancer, is_speed = bool(rng.random() < 0.4), bool(rng.random() < 0.5)

    def drive(force: float, load: dict[str, Any]) -> Drive:
        pulleys = [
            _pulley(k, "driven" if kind == "driven" else "idle", friction, speed * (1.0 + (draw if k else 0.0)))
            for k, kind in enumerate(kinds)
        ]
        for k, pulley in enumerate(pulleys):
            pulley["center"] = [length * (k + 1), pulley["center"][1]]
        pulleys[sensor]["mass"], pulleys[last]["load"] = 1.0, [load]
        cell = {"kind": "sliding", "pulley": f"roller {sensor}", "preload": force, "damping": 100.0}
        return Drive(
            belt=WEB,
            unwinder={"point": [0.0, 0.3], "tension": enters},
            pulley=pulleys,
            winder={"point": [length * (len(kinds) + 1), 0.3 if len(kinds) % 2 else 0.0], "tension": leaves},
            tensioner=[cell | {"direction": [0, -1 if sensor % 2 == 0 else 1], "rate": 500.0 if is_dancer else 1e6}],
            simulation={"duration": 1.0},
        )

    path, passed = drive(100.0, _BARE).path, speed / (1.0 + enters / AXIAL)
    grips = friction * path.wrap_angles
    after = AXIAL * (speed * (1.0 + draw) / passed - 1.0) if further else leaves
    if after < 30.0 or (further and abs(np.log(leaves / after)) > 0.9 * grips[-1]):
        return None
    if abs(np.log(held / enters)) > 0.9 * grips[0] or abs(np.log(after / held)) > 0.9 * grips[last]:
        return None
    force = (held - MASS * speed**2) * float(np.linalg.norm(path.gradient(sensor)[1]))
    torque, sense = 0.05 * (held - after), 1.0 if last % 2 == 0 else -1.0
    if is_speed:
        gain, command = float(np.exp(rng.uniform(np.log(0.5), np.log(50.0)))), speed / 0.05 * rng.uniform(0.98, 1.02)
        trim = (torque / gain + passed * (1.0 + held / AXIAL) / 0.05) / command - 1.0
        load: dict[str, Any] = {"kind": "speed_trim", "speed": sense * command, "speed_gain": gain}
    else:
        command = torque * rng.uniform(0.6, 1.8)
        trim = torque / command - 1.0
        load = {"kind": "torque_trim", "torque": sense * command}
    if abs(trim) > (0.09 if is_speed else 0.9) or abs(torque) < 0.1:
        return None
    set_value = {"position_gain": 0.1} if is_dancer else {"set_force": force, "force_gain": 1e-5}
    load |= set_value | {"sensor": f"roller {sensor}", "integral_time": 2.0}
    tensions = [held] * last + [after] + [leaves] * further + [enters]
    return ControlledLine(drive(force, load), tensions, trim)

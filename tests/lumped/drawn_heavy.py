"""Heavy belts drawn at random: lifts, slopes and conveyors, with supports, guides, goods, speed and take-ups."""

from typing import Any

import numpy as np

from beltdyn.machines import Guide, Idlers
from beltdyn.model import Drive
from beltdyn.points.changed_drive import with_load

GRAVITY = 9.81


def drawn_heavy(seed: int) -> Drive:
    """Two pulleys on a slope of -90 to 90 degrees, and half of the time an idler that presses on the lower strand.

    The belt weighs 5 to 80 % of its tension over the length of a span; the driver is above or below. Slopes of less
    than 50 degrees may have idlers or a guide below the upper strand, with goods. Screws or a weight hold the tension.
    """
    random = np.random.default_rng(seed)
    slope = random.uniform(-np.pi / 2.0, np.pi / 2.0)
    length, tension = float(np.exp(random.uniform(np.log(2.0), np.log(40.0)))), 10.0 ** random.uniform(2.5, 4.0)
    heaviness = float(np.exp(random.uniform(np.log(0.05), np.log(0.8))))
    mass = heaviness * tension / (GRAVITY * length)
    head, tail = random.uniform(0.03, 0.06, 2) * length
    along = np.array([np.cos(slope), np.sin(slope)])
    friction = random.uniform(0.25, 0.6)
    speed = np.sqrt(random.uniform(0.0, 0.1) * tension / mass)
    pull = random.uniform(0.25, 0.6) * tension * np.tanh(0.5 * np.pi * friction)
    supported = abs(slope) < np.radians(50.0) and random.random() < 0.7
    held = random.random() < 0.5 and np.cos(slope) > 0.3
    pulleys: list[dict[str, Any]] = [
        {"name": "head", "center": (length * along).tolist(), "radius": head, "speed": speed / head},
        {"name": "tail", "center": [0.0, 0.0], "radius": tail, "inertia": 0.1, "mass": 1.0},
    ]
    if not supported:
        pulleys[1]["torque"] = {"kind": "constant", "value": -pull * tail}
    given: dict[str, Any] = {
        "gravity": [0.0, -GRAVITY],
        "belt": {
            "width": 0.3,
            "thickness": 0.02 * min(head, tail),
            "axial_stiffness": tension / random.uniform(1e-3, 5e-3),
            "bending_stiffness": 1e-4 * tension * min(head, tail) ** 2,
            "mass_per_length": mass,
            "friction": friction,
        },
        "pulley": pulleys,
        "simulation": {"duration": 1.0},
    }
    if held:
        weight = 2.0 * tension + mass * GRAVITY * length * np.sin(slope)
        slide = {"kind": "sliding", "pulley": "tail", "direction": (-along).tolist(), "mass": 10.0, "preload": weight}
        given["tensioner"] = [slide]
        given["belt"]["length"] = 2.0 * length + np.pi * (head + tail)
    else:
        given["belt"]["installed_tension"] = tension
    if supported:
        upper = ["tail", "head"]
        share = pull / (2.0 * mass * GRAVITY * length)
        kind: dict[str, Any] = {"kind": "guide", "span": upper, "friction": min(share, 0.5)}
        if random.random() < 0.5:
            idler = {"idler_mass": 0.2 * mass, "spacing": 0.05 * length, "friction": min(share, 0.5)}
            kind = {"kind": "idlers", "span": upper, **idler}
        given["support"] = [kind]
        if random.random() < 0.7:
            given["goods"] = [{"span": upper, "mass_per_length": random.uniform(0.1, 1.0) * mass}]
    return Drive(**given)


def scaled(drive: Drive, factor: float) -> Drive:
    """The drive with a factor on all loads: torques, goods, and what supports resist; the belt keeps its weight.

    Resistances grow with the weight across the slope, and that of rollers, so that their coefficients grow by less than
    goods do.
    """
    other = with_load(drive, factor) if any(one.torque for one in drive.pulleys) else drive
    goods = [one.replace(mass_per_length=factor * one.mass_per_length) for one in drive.goods]
    if not drive.supports:
        return other.replace(goods=goods)
    first, second = (np.array(pulley.center) for pulley in drive.pulleys)
    cosine = abs(float(first[0] - second[0])) / float(np.linalg.norm(first - second))
    before, after = (
        (drive.belt.mass_per_length + sum(one.mass_per_length for one in some)) * cosine + _rotating(drive)
        for some in (drive.goods, goods)
    )
    supports = [
        one.replace(friction=factor * one.friction * before / after)
        for one in drive.supports
        if isinstance(one, Guide | Idlers)
    ]
    return other.replace(goods=goods, support=supports)


def _rotating(drive: Drive) -> float:
    """Mass of the rollers of idlers, which count in what they resist, kg/m."""
    return float(sum(one.rotating_mass for one in drive.supports if isinstance(one, Idlers)))


def tension_of_a_belt_as_long_as_its_path(drive: Drive) -> float:
    """Tension N of a belt at rest whose stretch is what its free strands sag, N: a shorter one has more, none has less.

    A strand of length L on a slope is longer than its chord by (w cos)^2 L^3 / (24 N^2), so that
    N^3 = EA sum((w cos)^2 L^3) / (24 l).  Supported strands do not sag.
    """
    first, second = (np.array(pulley.center) for pulley in drive.pulleys)
    length = float(np.linalg.norm(second - first))
    normal = drive.belt.mass_per_length * GRAVITY * abs(float(first[0] - second[0])) / length
    free = 2 - len(drive.supports)
    sags = free * normal**2 * length**3 / 24.0
    return float(np.cbrt(drive.belt.axial_stiffness * sags / drive.path.length))

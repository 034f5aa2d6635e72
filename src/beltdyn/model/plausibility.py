"""What is valid and looks mistaken, as a supplier asks back: tension, pulleys, sides, tensioners, the start."""

import math
from collections.abc import Iterator

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError
from beltdyn.machines.loads.load import Load
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation, install
from beltdyn.model.pulley import Pulley
from beltdyn.parts.finding import Finding, listing
from beltdyn.parts.quantity import RPM

_DIAMETER_POWER = 5.6
"""Power of the diameter with which the ribs of a belt live longer: published fits have 5.6 and 5.65."""
_SLIGHT = math.radians(20.0)
"""Wrap angle below which a pulley may be meant to touch the other side, where the belt would touch more of it."""
_MORE = 2.0
"""How many times more it would touch there."""
_BLOW = 0.05
"""Change of tension by a sudden start, over the tension at rest, that is worth a warning."""
_ANGLES = 64
"""Angles over which the torque of a load is taken."""
_TAKES = 1e-3
"""Power of a load over that of all from which on it counts."""


def judge_plausibility(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Find what a supplier would ask back.

    Parameters
    ----------
    drive : Drive
        As it is given.
    installation : Installation
        The estimates for this drive.
    """
    yield from _tension(drive, installation)
    yield from _small_pulleys(drive)
    yield from _sides(drive)
    yield from _tight_side(drive, installation)
    yield from _sudden_start(drive, installation)


def _tension(drive: Drive, installation: Installation) -> Iterator[Finding]:
    belt, tension = drive.belt, installation.tension
    most, ribs = belt.largest_tension, belt.value_of("ribs")
    if most is None or tension < most:
        return
    each = (lambda force: f"{force:.4g} N, {force / ribs:.3g} N a rib or belt") if ribs else "{:.4g} N".format
    more = f"Take {math.ceil(ribs * tension / most)} or more of them, lower" if ribs else "Take a larger belt, lower"
    readings = _other_readings(drive) if belt.length is not None else []
    yield Finding(
        f"the tension at rest is {each(tension)}, and belts like this one are used below {each(most)}.",
        "Cords stretch for good, and belt and bearings live a fraction of their time.",
        f"{more} the tension, or correct what sets it{f': {listing(readings)}' if readings else ''}.",
    )


def _other_readings(drive: Drive) -> list[str]:
    """What the tension would be with another side of a pulley, or other diameters, where it would be less."""
    changes = {
        f'with side = "{_other_side(one)}" of {one.name}': _flipped(drive, number)
        for number, one in enumerate(drive.pulleys)
    } | {"with the diameters as those of the tension line": with_pitch_diameters(drive)}
    most = drive.belt.largest_tension or math.inf
    tensions = {words: install(changed).tension for words, changed in changes.items() if changed is not None}
    return [f"{tension:.4g} N {words}" for words, tension in tensions.items() if 0.0 < tension < most]


def _other_side(pulley: Pulley) -> str:
    return "inside" if pulley.side == "outside" else "outside"


def _flipped(drive: Drive, number: int) -> Drive | None:
    """The drive with a pulley on the other side of its belt; None where no belt can run so."""
    changed = [
        one.replace(side=_other_side(one)) if place == number else one for place, one in enumerate(drive.pulleys)
    ]
    try:
        return drive.replace(pulley=changed)
    except BeltdynError:
        return None


def with_pitch_diameters(drive: Drive) -> Drive | None:
    """The drive whose diameters are those on which the tension line runs; None where it is the same, or cannot run."""
    offsets = [drive.belt.offset(one.side) for one in drive.pulleys]
    if not any(offsets):
        return None
    try:
        smaller = [one.replace(radius=one.radius - offset) for one, offset in zip(drive.pulleys, offsets, strict=True)]
        return drive.replace(pulley=smaller)
    except BeltdynError:
        return None


def other_diameters(drive: Drive) -> str:
    """What is different if the diameters are meant as those of the tension line, in words; empty where nothing is.

    Parameters
    ----------
    drive : Drive
        As it is given.
    """
    meant = None if drive.ends else with_pitch_diameters(drive)
    if meant is None:
        return ""
    if drive.belt.length is None:
        return f"{meant.belt_length:.5g} m of belt, not {drive.belt_length:.5g}"
    try:
        return f"{meant.tension_at_rest:.5g} N at rest, not {drive.tension_at_rest:.5g}"
    except BeltdynError:
        return ""


def _small_pulleys(drive: Drive) -> Iterator[Finding]:
    least = drive.belt.smallest_diameter
    small = {one.name: 2.0 * one.radius for one in drive.pulleys if least and 2.0 * one.radius < (1.0 - 1e-9) * least}
    if least is None or not small:
        return
    lasting = (min(small.values()) / least) ** _DIAMETER_POWER
    sizes = [f"{name} has {1e3 * diameter:.4g} mm" for name, diameter in small.items()]
    yield Finding(
        f"the smallest pulley for this belt has {1e3 * least:.4g} mm, and {listing(sizes)}.",
        f"The belt lives about {lasting:.0%} as long as on the smallest, by published fits of its fatigue, and bending "
        "takes more power.",
        "Take a larger pulley, or a belt of a smaller profile.",
    )


def _sides(drive: Drive) -> Iterator[Finding]:
    """Pulleys that the belt hardly touches where they are given, and would touch on more of the other side."""
    if drive.ends or drive.belt.crossed:
        return
    for number, pulley in enumerate(drive.pulleys):
        wrap = float(drive.path.wrap_angles[number])
        other = _flipped(drive, number) if wrap < _SLIGHT else None
        if other is None or other.path.wrap_angles[number] < _MORE * wrap:
            continue
        longer = 1e3 * (other.path.length - drive.path.length)
        yield Finding(
            f"the belt's {pulley.side} touches {pulley.name} on {math.degrees(wrap):.3g}°, and its "
            f"{_other_side(pulley)} would on {math.degrees(other.path.wrap_angles[number]):.3g}°.",
            f"Its path would be {abs(longer):.3g} mm {'longer' if longer > 0 else 'shorter'} than "
            f"{drive.path.length:.5g} m then; both are layouts that run, with other tensions.",
            f'If that is meant, set side = "{_other_side(pulley)}" for {pulley.name}.',
        )


def _tight_side(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Spring-loaded tensioners between the last load and the driver, where the belt is tightest."""
    driver = drive.driver
    if driver is None or drive.ends or not drive.moving_tensioners:
        return
    powers, speed = _powers(drive, driver, installation)
    others, step = len(drive.pulleys) - 1, drive.running_sense
    behind = [(driver + step * place) % len(drive.pulleys) for place in range(1, 1 + others)]
    total = float(powers[behind].sum())
    if not speed > 0.0 or not total > 0.0 or powers[behind].min() < -_TAKES * total:
        return
    loaded = [place for place, number in enumerate(behind) if powers[number] > _TAKES * total]
    held, name = installation.tension, drive.pulleys[driver].name
    for tensioner in drive.moving_tensioners:
        number = drive.carried(tensioner)
        if number == driver or behind.index(number) < loaded[-1] or number == behind[loaded[-1]]:
            continue
        yield Finding(
            f"the tensioner of {tensioner.pulley} is on the tight side: as the belt runs, no load lies between it and "
            f"{name}.",
            f"Its spring holds about {held:.4g} N there, and the loads take {total / speed:.4g} N, so that "
            f"{max(held - total / speed, 0.0):.4g} N are left where the belt leaves {name}, not {held:.4g} N.",
            f"Put it where the belt leaves {name}, or turn the sense of {name}: speeds are positive counter-clockwise.",
        )


def _powers(drive: Drive, driver: int, installation: Installation) -> tuple[FloatArray, float]:
    """Power that each pulley takes from the belt, W, and the belt's speed, m/s, when the driver runs fastest."""
    pulley, radii = drive.pulleys[driver], installation.path.radii
    time = drive.simulation.end
    if pulley.speed is None:
        speed = pulley.driven_speed() * pulley.turning
    else:
        times = np.linspace(drive.simulation.begin, time, 1001)
        values = pulley.speed.at(times)
        time, speed = float(times[np.argmax(np.abs(values))]), float(values[np.argmax(np.abs(values))])
    taken = np.zeros(len(drive.pulleys))
    for number, one in enumerate(drive.pulleys):
        if number == driver:
            continue
        turning = speed * float(radii[driver] / radii[number])
        given = 0.0 if one.torque is None else float(one.torque.at([drive.simulation.end])[0])
        loads = sum(_torque(load, turning, drive.simulation.end) for load in one.load if load.has_mean)
        taken[number] = -(given + loads) * turning
    return taken, abs(speed * float(radii[driver]))


def _torque(load: Load, speed: float, time: float) -> float:
    """Torque of a load at a speed and an instant, N m, in the mean over its angle."""
    factor = 1.0 if load.factor is None else float(load.factor.at([time])[0])
    return factor * float(load.torque_over(np.linspace(0.0, 4.0 * math.pi, _ANGLES), speed, time).mean())


def _sudden_start(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Prescribed speeds that are there when a run begins from rest."""
    settings, belt = drive.simulation, drive.belt
    if settings.start not in ("equilibrium", "laid"):
        return
    radii = np.abs(drive.radii)
    speeds = {
        one.name: (float(one.speed.at([settings.begin])[0]), float(radii[number]))
        for number, one in enumerate(drive.pulleys)
        if one.speed is not None
    }
    blow = {
        name: math.sqrt(belt.axial_stiffness * belt.mass_per_length) * abs(w * r) for name, (w, r) in speeds.items()
    }
    sudden = [name for name, change in blow.items() if change > _BLOW * installation.tension]
    if not sudden:
        return
    told = [f"{name} at {RPM * speeds[name][0]:.4g} rpm" for name in sudden]
    gentle = 'let the speed rise, as { kind = "cosine_ramp", ... } does'
    steady = f'Set simulation.start = "steady", which begins at these speeds, or {gentle}.'
    yield Finding(
        f"the run begins with a blow: {listing(told)} from the first instant on, and the belt at rest.",
        f"The belt slides, or its tension changes by up to {max(blow.values()):.3g} N from {installation.tension:.4g} "
        "N; time steps are short until all pulleys turn, so that the first part of a run is slow.",
        f"{gentle[0].upper()}{gentle[1:]}." if drive.ends else steady,
    )

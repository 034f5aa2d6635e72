"""Plausibility checks of a valid drive: tension, pulleys, sides, tensioners, start."""

import math
from collections.abc import Iterator

import numpy as np

from beltdyn.errors import BeltdynError
from beltdyn.model.alignment import judge_alignment
from beltdyn.model.belt_loads import MAKERS, torque_of_file
from beltdyn.model.demand import required_tension
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation
from beltdyn.model.layout import mesh_misfit, teeth_in_mesh
from beltdyn.model.prepared import install, prepare
from beltdyn.model.pulley import Pulley, fastest_rim
from beltdyn.model.toothing import RatedTeeth
from beltdyn.parts.messages import NOTABLE, Finding, beyond, listing, plain
from beltdyn.parts.quantity import RPM
from beltdyn.theory.conveyor import smallest_pulley
from beltdyn.theory.rating import REST_SHARE, RUN_IN

_DIAMETER_POWER = 5.6
"""Exponent of belt life over pulley diameter: published fits have 5.6 and 5.65."""
_SLIGHT = math.radians(20.0)
"""Wrap angle below which the other side of the belt may have been intended, if it gives more wrap."""
_MORE = 2.0
"""Least ratio of the wrap angles for that."""
_BLOW = 0.05
"""Change of tension by a sudden start, over the tension at rest, that gives a warning."""
_OFF_NOMINAL = 0.2
"""Change of a spring's force from its preload, over it, from which the given center is not the nominal position."""
_LIGHT = 0.2
"""Tension by a preload over that of the measured length below which the preload is doubtful."""
_HEAVIER = 0.9
"""Inertia of a tensioner without its pulley, over that with it, below which the mass of the pulley counts."""
_FEW_TEETH = 6.0
"""Teeth in mesh from which on a pulley carries all that the profile allows, by the rules of makers."""
_FACES = 2
"""Of a belt in a nip, on which it creeps."""
_TAKES = 1e-3
"""Least share of a load in the total power."""


def judge_plausibility(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Check the plausibility of a drive."""
    yield from _tension(drive, installation)
    yield from _small_pulleys(drive)
    yield from _sides(drive)
    yield from _tight_side(drive, installation)
    yield from _off_nominal(drive, installation)
    yield from _light_preload(drive, installation)
    yield from _massless(drive)
    yield from _driving_loads(drive, installation)
    yield from _sudden_start(drive, installation)
    yield from _few_teeth(drive, installation)
    yield from _stretched_teeth(drive, installation)
    yield from _slack_teeth(drive, installation)
    yield from _loose_belt(drive, installation)
    yield from _loose_axis(drive, installation)
    yield from _narrow_teeth(drive, installation)
    yield from _sliding_nips(drive)
    yield from judge_alignment(drive, installation.path)


def _tension(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Compare the tension with the rating, at rest or with the m v^2 that adds to it under a sprung tensioner."""
    belt, tension = drive.belt, installation.tension
    most, ribs = belt.largest_tension, belt.rib_count
    piece = "rib" if belt.entry is None else belt.entry.piece
    speed = fastest_rim(drive.pulleys, drive.radii)
    sprung = bool(drive.layout.given.springs)
    running = tension + sprung * belt.mass_per_length * speed**2
    if most is None or running < most:
        return
    each = (lambda force: f"{force:.4g} N ({force / ribs:.3g} N per {piece})") if ribs else "{:.4g} N".format
    more = f"Use at least {math.ceil(ribs * tension / most)} {piece}s, reduce" if ribs else "Use a larger belt, reduce"
    if tension < most:
        limit = math.sqrt((most - tension) / belt.mass_per_length)
        yield Finding(
            f"at {speed:.4g} m/s, the largest belt speed, the tension is {each(running)}, of which "
            f"{running - tension:.4g} N are centrifugal; the belt is rated for {each(most)}.",
            "The cords stretch permanently, and belt and bearings fail early.",
            f"Reduce the speed below {beyond(speed, limit, 3):.3g} m/s, or use a lighter belt.",
        )
        return
    readings = _other_readings(drive) if belt.length is not None else []
    yield Finding(
        f"the tension at rest is {each(tension)}, but the belt is rated for {each(most)}.",
        "The cords stretch permanently, and belt and bearings fail early; coefficients of compression losses are those "
        "of the rated tension, where their data end.",
        f"{more} the tension, or correct its cause{f': {listing(readings)}' if readings else ''}.",
    )


def _other_readings(drive: Drive) -> list[str]:
    """The tension with another side of a pulley, or with other diameters, if it is lower."""
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
    """The drive with a pulley on the other side of its belt; None if no belt can run so."""
    if drive.pulleys[number].teeth is not None:
        return None
    changed = [
        one.replace(side=_other_side(one)) if place == number else one for place, one in enumerate(drive.pulleys)
    ]
    try:
        return drive.replace(pulley=changed)
    except BeltdynError:
        return None


def with_pitch_diameters(drive: Drive) -> Drive | None:
    """The drive with its diameters as those of the tension line; None if it is the same, impossible or not meant.

    A pulley whose kind of diameter the file names keeps it; with one of them, those on the back have surfaces.
    """
    named = any(one.diameter_kind is not None for one in drive.pulleys)
    kept = [one.diameter_kind is not None or (named and one.side == "outside") for one in drive.pulleys]
    offsets = [0.0 if fixed else drive.belt.offset(one.side) for one, fixed in zip(drive.pulleys, kept, strict=True)]
    if not any(offsets) or drive.belt.teeth is not None:
        return None
    try:
        smaller = [one.replace(radius=one.radius - offset) for one, offset in zip(drive.pulleys, offsets, strict=True)]
        return drive.replace(pulley=smaller)
    except BeltdynError:
        return None


def other_diameters(drive: Drive) -> str:
    """The difference if the diameters are those of the tension line, in words; empty if there is none."""
    meant = None if drive.ends else with_pitch_diameters(drive)
    if meant is None:
        return ""
    if drive.belt.length is None:
        return f"belt length {meant.belt_length:.5g} m instead of {drive.belt_length:.5g} m"
    try:
        return f"tension at rest {install(meant).tension:.5g} N instead of {install(drive).tension:.5g} N"
    except BeltdynError:
        return ""


def _small_pulleys(drive: Drive) -> Iterator[Finding]:
    least = drive.belt.smallest_diameter
    if drive.belt.strength is not None:
        yield from _small_conveyor_pulleys(drive)
        return
    small = {one.name: 2.0 * one.radius for one in drive.pulleys if least and 2.0 * one.radius < (1.0 - 1e-9) * least}
    if least is None or not small:
        return
    lasting = (min(small.values()) / least) ** _DIAMETER_POWER
    sizes = [f"that of {name} is {1e3 * diameter:.4g} mm" for name, diameter in small.items()]
    yield Finding(
        f"the smallest recommended pulley diameter of this belt is {1e3 * least:.4g} mm, but {listing(sizes)}.",
        f"Belt life is about {lasting:.0%} of that on the smallest recommended pulley, by published fatigue fits, and "
        "bending losses are higher.",
        "Use a larger pulley, or a belt of a smaller profile.",
    )


def _small_conveyor_pulleys(drive: Drive) -> Iterator[Finding]:
    """Pulleys that are too small for a conveyor belt at any tension."""
    largest = drive.belt.smallest_diameter
    for pulley, wrap in zip(drive.pulleys, drive.path.wrap_angles.tolist(), strict=True):
        least = 0.0 if largest is None else smallest_pulley(largest, 0.0, wrap, high_tension=False)
        if 2.0 * pulley.radius < (1.0 - 1e-9) * least:
            yield Finding(
                f"the diameter of {pulley.name} is {2e3 * pulley.radius:.4g} mm, but at least {1e3 * least:.4g} mm are "
                "recommended for this belt at little tension (DIN 22101).",
                "Carcass and joints of the belt fail early by bending.",
                "Use a larger pulley, or a belt with a thinner carcass; the sheet shows what each pulley needs.",
            )


def _sides(drive: Drive) -> Iterator[Finding]:
    """Pulleys with a small wrap angle that would be larger on the other side of the belt."""
    if drive.ends or drive.belt.crossed:
        return
    for number, pulley in enumerate(drive.pulleys):
        wrap = float(drive.path.wrap_angles[number])
        other = _flipped(drive, number) if wrap < _SLIGHT else None
        if other is None or other.path.wrap_angles[number] < _MORE * wrap:
            continue
        longer = 1e3 * (other.path.length - drive.path.length)
        yield Finding(
            f"the belt's {pulley.side} wraps {pulley.name} by {math.degrees(wrap):.3g}°, its {_other_side(pulley)} "
            f"would wrap it by {math.degrees(other.path.wrap_angles[number]):.3g}°.",
            f"The path would then be {abs(longer):.3g} mm {'longer' if longer > 0 else 'shorter'} than "
            f"{drive.path.length:.5g} m; both layouts are possible, with different tensions.",
            f'If the other is intended, set side = "{_other_side(pulley)}" for {pulley.name}.',
        )


def _tight_side(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Spring-loaded tensioners between the last load and the driver, where the belt is tightest."""
    driver = drive.driver
    if driver is None or drive.ends or not drive.layout.given.springs:
        return
    powers, speed = drive.belt_loads(driver).powers_drawn(installation.path)
    others, step = len(drive.pulleys) - 1, drive.running_sense
    behind = [(driver + step * place) % len(drive.pulleys) for place in range(1, 1 + others)]
    total = float(powers[behind].sum())
    if not speed > 0.0 or not total > 0.0 or powers[behind].min() < -_TAKES * total:
        return
    loaded = [place for place, number in enumerate(behind) if powers[number] > _TAKES * total]
    held, name = installation.tension, drive.pulleys[driver].name
    for tensioner in drive.layout.given.springs:
        number = drive.carried(tensioner)
        if number == driver or behind.index(number) < loaded[-1] or number == behind[loaded[-1]]:
            continue
        yield Finding(
            f"the tensioner of {tensioner.pulley} is on the tight side: in running direction no load lies between it "
            f"and {name}.",
            f"Its spring holds about {held:.4g} N there, and the loads need {total / speed:.4g} N, which leaves a "
            f"slack-side tension of {max(held - total / speed, 0.0):.4g} N behind {name}, not {held:.4g} N.",
            f"Move it to the span where the belt leaves {name}, or reverse {name}: speeds are positive "
            f"{drive.rotation}.",
        )


def _sliding_nips(drive: Drive) -> Iterator[Finding]:
    """Nips whose rollers have prescribed speeds that differ by more than friction on both faces takes up."""
    ratio = prepare(drive).contact.value_of("creep_ratio") if drive.nips else None
    for pair in drive.path.nips:
        roller, pulley = (drive.pulleys[one] for one in pair)
        if roller.speed is None or pulley.speed is None or ratio is None:
            continue
        ends = [float(one.at([drive.simulation.duration])[0]) for one in (roller.speed, pulley.speed)]
        together = -1.0 if ends[0] * ends[1] > 0.0 else 1.0  # rollers of a nip turn against each other
        radii = drive.rolling_radii[list(pair)]
        speeds = np.array([together * roller.driven_speed(), pulley.driven_speed()]) * radii
        fastest, apart = float(np.abs(speeds).max()), abs(float(speeds[0] - speeds[1]))
        if apart <= _FACES * ratio * fastest:
            continue
        right = -math.copysign(float(speeds[1] / radii[0]), ends[1])
        yield Finding(
            f"the surface of {roller.name} is to run at {speeds[0]:.5g} m/s and that of {pulley.name} at "
            f"{speeds[1]:.5g} m/s; creep on both faces takes up {_FACES * ratio:.2%}, and they differ by "
            f"{apart / fastest:.2%}.",
            f"The nip slips as a whole and wears the belt: each newton of its friction loses {apart:.2g} W.",
            f"Give {roller.name} a torque in place of a speed, or a speed of {right * RPM:.5g} rpm.",
        )


def _few_teeth(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Pulleys with few teeth in mesh."""
    if drive.belt.teeth is None:
        return
    meshes = teeth_in_mesh(drive.belt, installation.path).tolist()
    few = {one.name: mesh for one, mesh in zip(drive.pulleys, meshes, strict=True) if one.teeth and mesh < _FEW_TEETH}
    if few:
        yield Finding(
            f"few teeth are in mesh: {listing([f'{mesh:.1f} on {name}' for name, mesh in few.items()])}.",
            f"With less than {_FEW_TEETH:g} each tooth carries more, makers allow a fifth less for each one missing, "
            "and the forces of spread teeth are less exact.",
            "Use a pulley with more teeth, a smaller pitch, or an idler that increases the wrap angle.",
        )


def _stretched_teeth(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Belts of a given number of teeth that are stretched by more than one of them to fixed centers."""
    belt = drive.belt
    if belt.teeth is None or belt.installed_tension is not None or drive.moving_tensioners:
        return
    pitches = installation.path.length / belt.given_pitch
    if pitches <= belt.teeth + 1:
        return
    off = mesh_misfit(belt, installation.path, prepare(drive).toothed)
    yield Finding(
        f"the path has {pitches:.2f} pitches, but the belt {belt.teeth} teeth: it is stretched by "
        f"{pitches / belt.teeth - 1.0:.2%}, to {plain(installation.tension)} N.",
        f"At the ends of arcs its teeth are up to {1e3 * off:.2g} mm off their grooves.",
        f"Give {int(pitches)} teeth, or move the pulleys closer together.",
    )


def _slack_teeth(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Belts with teeth whose slack side would be slack under the load."""
    driver = drive.driver
    if drive.belt.teeth is None or driver is None or drive.moving_tensioners:
        return
    powers, speed = drive.belt_loads(driver).powers_drawn(installation.path)
    pull = float(powers[powers > 0.0].sum()) / speed if speed > 0.0 else 0.0
    least = REST_SHARE * pull
    if not installation.tension < least:
        return
    yield Finding(
        f"the tension at rest is {installation.tension:.4g} N, but the loads pull by {pull:.4g} N.",
        "The slack side loses its tension, teeth are no longer pressed into their grooves, and the belt may jump.",
        f"Raise the tension to at least {beyond(installation.tension, least, 4):.4g} N, {REST_SHARE:.0%} of the pull.",
    )


def _loose_axis(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Axes whose moves take the tension of a span."""
    needed = required_tension(drive, installation) if drive.carriage is not None else None
    if needed is None or not installation.tension < (1.0 - NOTABLE) * needed.tension:
        return
    jumps = "the belt may slip" if drive.belt.teeth is None else "teeth may jump"
    yield Finding(
        f"the tension at rest is {installation.tension:.4g} N, but the moves pull by {needed.load}.",
        f"A span becomes slack at an end of the stroke: the carriage is late, and {jumps}.",
        f"Raise the tension to at least {beyond(installation.tension, needed.tension, 3):.3g} N, or accelerate less.",
    )


def _loose_belt(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """V- and V-ribbed belts between fixed centers with less tension than their load needs by the rules of makers."""
    other = drive.belt.teeth is not None or drive.carriage is not None
    needed = None if other else required_tension(drive, installation)
    if needed is None or not installation.tension < (1.0 - NOTABLE) * needed.tension:
        return
    low, high = needed.by_formula.values()
    yield Finding(
        f"the tension at rest is {plain(installation.tension)} N, but a pull of {plain(needed.pull)} N with the "
        f"service factor needs {plain(low)} N ({MAKERS[0]}) to {plain(high)} N ({MAKERS[1]}).",
        "A belt that is looser slips when it starts, wears and overheats; its rated power holds with that tension.",
        f"Increase the tension to {plain(needed.tension)} N, of a run-in belt to {plain(RUN_IN * needed.tension)} N.",
    )


def _narrow_teeth(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Toothed belts whose teeth in mesh are not rated for the pull of a pulley."""
    driver, belt = drive.driver, drive.rated_belt
    if driver is None or not isinstance(belt, RatedTeeth):
        return
    powers, speed = drive.belt_loads(driver).powers_drawn(installation.path)
    if not speed > 0.0:
        return
    powers[driver] = -powers.sum()
    path, toothed = installation.path, prepare(drive).toothed
    rated = belt.on(2.0 * np.abs(path.radii), path.wrap_angles, speed, toothed).on(toothed)
    pulls = (drive.limits.service_factor or 1.0) * np.abs(powers) / speed
    used = np.divide(pulls, rated.pull, out=np.where(pulls > 0.0, np.inf, 0.0), where=rated.pull > 0.0)
    used[~toothed] = 0.0
    worst = int(np.argmax(used))
    if not used[worst] > 1.0:
        return
    wanted = belt.rating.next_width(used[worst] * belt.width)
    width = f"a belt of {1e3 * wanted:.4g} mm, the next standard width" if np.isfinite(wanted) else "a larger profile"
    yield Finding(
        f"the pull of {drive.pulleys[worst].name} is {pulls[worst]:.4g} N with the service factor, but "
        f"{rated.in_mesh[worst]:.1f} teeth in mesh are rated for {rated.pull[worst]:.4g} N.",
        f"The belt of {1e3 * belt.width:.4g} mm is used by {used[worst]:.0%}, and its teeth or cords fail early.",
        f"Use {width}, or pulleys with more teeth.",
    )


def _off_nominal(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Spring-loaded tensioners that rest far from the center that is given, where the preload is not that at rest."""
    for carrier, position in zip(prepare(drive).carriers, installation.tensioner_positions.tolist(), strict=True):
        one, there, nominal = carrier.tensioner, carrier.force(position), carrier.force(0.0)
        if not abs(there - nominal) > _OFF_NOMINAL * abs(nominal):
            continue
        unit = one.force_unit
        leverage = abs(float(drive.path.gradient(carrier.pulley) @ carrier.place(0.0)[1]))
        yield Finding(
            f"the tensioner of {one.pulley} rests {one.written(position)} from the given center of its pulley, where "
            f"its spring gives {there:.4g} {unit}, not preload = {nominal:.4g} {unit}.",
            f"If the center is the nominal position, its tension is {nominal / leverage:.4g} N, not "
            f"{installation.tension:.4g} N at rest. preload is the force at the given center, not that of the free "
            "arm.",
            "Give center and preload of the same position, for an arm by free_angle; or omit the length of the belt, "
            "which then sets the tensioner to its nominal position.",
        )


def _light_preload(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """A preload that sets the tension far below that under which such belts are measured."""
    name, force = drive.layout.nominal, drive.belt.value_of("measuring_force")
    if name is None or force is None or not installation.tension < _LIGHT * 0.5 * force:
        return
    carrier = next(one for one in prepare(drive).carriers if one.tensioner.pulley == name)
    unit, usual, preload = carrier.tensioner.force_unit, 0.5 * force, carrier.force(0.0)
    yield Finding(
        f"preload = {preload:.4g} {unit} of the tensioner of {name} gives {installation.tension:.4g} N, but the "
        f"length of this belt is measured under {usual:.4g} N.",
        f"That tension takes {preload * usual / installation.tension:.4g} {unit}; a light belt slips under load.",
        'Check the preload and its unit: "12 N m" is 12,000 N mm.',
    )


def _massless(drive: Drive) -> Iterator[Finding]:
    """Spring-loaded tensioners without the mass of their pulleys, whose inertia shows that they have some."""
    for one in drive.moving_tensioners:
        number = drive.carried(one)
        pulley, center = drive.pulleys[number], drive.centers[number]
        least = pulley.inertia / pulley.radius**2
        own = one.moved_inertia(center, 0.0)
        whole = one.moved_inertia(center, least)
        if pulley.mass > 0.0 or not own < _HEAVIER * whole:
            continue
        unit = "kg m^2" if one.turns else "kg"
        yield Finding(
            f"the pulley of the tensioner {one.pulley} has no mass, but its moment of inertia needs at least "
            f"{least:.3g} kg at a radius of {1e3 * pulley.radius:.4g} mm.",
            f"The tensioner moves {own:.3g} {unit} instead of {whole:.3g} {unit} or more, so its natural frequencies "
            f"are up to {math.sqrt(whole / own) - 1.0:.0%} too high.",
            f"Give pulley[{one.pulley}].mass.",
        )


def _driving_loads(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Constant torques that turn a closed belt, which its driver brakes, as a load of the wrong sign does."""
    driver = drive.driver
    if driver is None or drive.pulleys[driver].speed is None or drive.ends or drive.nips:
        return
    powers = drive.belt_loads(driver).powers_drawn(installation.path)[0]
    if powers.sum() >= 0.0:
        return
    for number in np.flatnonzero(powers < 0.0).tolist():
        torque = torque_of_file(drive.pulleys[number], drive.simulation.end)
        if torque:
            yield Finding(
                f"the torque of {drive.pulleys[number].name}, {torque:.4g} N m, acts in its sense of rotation and "
                f"drives the belt, so that {drive.pulleys[driver].name} brakes.",
                "The tight and the slack span are exchanged if it is a load.",
                f"Give a load the opposite sign: {-torque:.4g} N m.",
            )


def _sudden_start(drive: Drive, installation: Installation) -> Iterator[Finding]:
    """Prescribed speeds above zero at the start of a run from rest."""
    settings, belt = drive.simulation, drive.belt
    if settings.given_duration is None or settings.start not in ("equilibrium", "laid"):
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
    gentle = 'ramp the speed up, for example with { kind = "cosine_ramp", ... }'
    steady = f'Set simulation.start = "steady", which starts at these speeds, or {gentle}.'
    yield Finding(
        f"the run starts with a shock: {listing(told)} from the first instant, with the belt at rest.",
        f"The belt slides, or its tension changes by up to {max(blow.values()):.3g} N from {installation.tension:.4g} "
        "N; time steps are short until all pulleys turn, so the first part of the run is slow.",
        f"{gentle[0].upper()}{gentle[1:]}." if drive.ends else steady,
    )

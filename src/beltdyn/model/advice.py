"""Warnings about a drive that is valid but probably not intended."""

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from beltdyn.contact.friction import LAWS
from beltdyn.model.contact import Contact
from beltdyn.model.defaults import CREEP_LENGTHS, DAMPING_RATIO
from beltdyn.model.drive import Drive
from beltdyn.model.heavy_parts import slack_strands
from beltdyn.model.installation import Installation
from beltdyn.model.plausibility import judge_plausibility
from beltdyn.model.prepared import Prepared, prepare, tensioner_balances
from beltdyn.model.pulley import fastest_rim
from beltdyn.model.resolution import Running, elements_needed, mesh_errors, unresolved
from beltdyn.parts.messages import Finding, beyond, listing
from beltdyn.parts.quantity import RPM

# Contact parameters set by hand that spoil results or cost time, compared with the default choice

_SOFT, _HARD = 10.0, 30.0
"""Limits of softer or harder contact, as multiples of the default."""
_STEADIES = 0.2
"""Damping ratio below which sliding belts flutter."""
_TAKES = 4.0
"""Damping ratio above which contact damping distorts losses: it dissipated 3% of a fast drive's small load."""
_GENTLE, _STEEP = 4.0, 30.0
"""Limits of the slip at full friction, as multiples of the default."""
_ADDED, _AT, _POWER = 0.14, 3.0, 1.75
"""Share of slip added by friction with three creep lengths on an arc, and its decay with their number."""
_ARM = 0.005
"""Largest penetration over the radius if friction acts at the belt's point."""


def judge_contact(drive: Drive, installation: Installation, *, soft: bool = False) -> Iterator[Finding]:
    """Check given contact parameters, and the results that they spoil."""
    without = _without_numbers(drive.contact)
    if without == drive.contact or not installation.tension > 0:
        return
    chosen = drive.replace(contact=without)
    yield from () if soft else _stiffness(drive, chosen, installation)
    yield from _damping(drive)
    yield from _friction(drive, chosen, installation)
    yield from _moment_arm(drive, installation)
    yield from _slip_radius(drive, installation)


def _without_numbers(contact: Contact) -> Contact:
    """The same contact with all numbers left open that a drive chooses."""
    kept = {key: getattr(contact, key) for key in ("friction", "sampling", "integration", "quadrature_points")}
    return Contact(**kept)


def _stiffness(drive: Drive, chosen: Drive, installation: Installation) -> Iterator[Finding]:
    given, usual = drive.contact_stiffness, chosen.contact_stiffness
    key = "allowed_penetration" if drive.contact.stiffness is None else "stiffness"
    if getattr(drive.contact, key) is None:
        return
    deepest = int(np.argmax(installation.penetrations / drive.radii))
    depth, name = float(installation.penetrations[deepest]), drive.pulleys[deepest].name
    said = f"contact.{key} = {getattr(drive.contact, key):.3g}"
    if given < usual / _SOFT:
        yield Finding(
            f"{said} makes contact {usual / given:.0f} times softer than the default of {usual:.2g} N/m^2: at rest the "
            f"belt sinks {1e3 * depth:.2g} mm into {name}, {depth / drive.radii[deepest]:.2%} of the radius.",
            "Slip has a relative error of up to 20%, and contact damping dissipates power that no belt loses.",
            f"Omit contact.{key}.",
        )
    elif given > usual * _HARD:
        yield Finding(
            f"{said} makes contact {given / usual:.0f} times harder than the default of {usual:.2g} N/m^2.",
            "No result improves; boundary layers at the ends of arcs become short and need fine meshes and steps, or "
            "no equilibrium is found.",
            f"Omit contact.{key}.",
        )


def _damping(drive: Drive) -> Iterator[Finding]:
    given, critical = drive.contact.damping, prepare(drive).critical_damping
    if given is None:
        return
    remedy = f"Omit contact.damping: the default is {DAMPING_RATIO:.0%} of critical, {DAMPING_RATIO * critical:.2g}."
    if given < _STEADIES * critical:
        yield Finding(
            f"contact.damping = {given:.3g} N s/m^2 is {given / critical:.1%} of critical: the belt may flutter "
            "where it slides.",
            "Contact forces, losses and slip then vibrate; mean tensions are not affected.",
            remedy,
        )
    elif given > _TAKES * critical:
        yield Finding(
            f"contact.damping = {given:.3g} N s/m^2 is {given / critical:.3g} times critical.",
            "It dissipates power where the belt enters and leaves pulleys, which no belt loses, most in fast drives "
            "under little load. The energy balance of a run shows how much.",
            remedy,
        )


def _friction(drive: Drive, chosen: Drive, installation: Installation) -> Iterator[Finding]:
    """Compare the relative slip at full friction with the default."""
    law = LAWS[drive.contact.friction_law]
    keys = [one.name for one in law.parameters if getattr(drive.contact, one.name) is not None]
    speed, rough = fastest_rim(drive.pulleys, drive.radii), drive.frictions > 0.0
    if not keys or not speed or not rough.any():
        return
    pressures = installation.tension / drive.radii[rough]
    slips, usual = (
        one.friction_parameters.saturation(pressures, drive.frictions[rough], speed) for one in (drive, chosen)
    )
    factor = float(np.max(slips / usual))
    said = " and ".join(f"contact.{key} = {getattr(drive.contact, key):.3g}" for key in keys)
    remedy = f"Omit {'contact.friction_law, ' * (law.name != chosen.contact.friction_law)}" + ", ".join(
        f"contact.{key}" for key in keys
    )
    if factor > _GENTLE:
        lengths = CREEP_LENGTHS / factor
        added = _ADDED * (_AT / lengths) ** _POWER
        how = f"by up to {added:.0%}" if added < 1.0 else "by a multiple"
        yield Finding(
            f"{said}: friction builds up {factor:.0f} times more slowly with slip than by default.",
            f"Under load slip is too large, {how}, as are friction losses; tensions change little.",
            f"{remedy}.",
        )
    elif factor < 1.0 / _STEEP:
        yield Finding(
            f"{said}: friction builds up {1.0 / factor:.0f} times more steeply with slip than by default.",
            "No result improves by 3%; time steps become short, and steady running may not be found.",
            f"{remedy}.",
        )


def _moment_arm(drive: Drive, installation: Installation) -> Iterator[Finding]:
    share = float(np.max(installation.penetrations / drive.radii))
    if drive.contact.moment_arm == "point" and share > _ARM:
        yield Finding(
            f'contact.moment_arm = "point": friction acts at the belt, which has sunk in by {share:.1%} of a radius.',
            f"Friction torques are too small by that share, and friction may generate power: losses are wrong by up "
            f"to {share:.1%} of the power.",
            'Set contact.moment_arm = "rim", or increase contact.stiffness.',
        )


def _slip_radius(drive: Drive, installation: Installation) -> Iterator[Finding]:
    contact, share = drive.contact, float(np.max(installation.penetrations / drive.radii))
    rubber = drive.belt.contact_stiffness or contact.stiffness or contact.allowed_penetration
    if contact.slip_radius == "cord" and rubber is None:
        yield Finding(
            f'contact.slip_radius = "cord", but the stiffness of the rubber under the cord is unknown: contact of the '
            f"numerical stiffness {drive.contact_stiffness:.2g} N/m^2 lets it sink by {share:.2%} of a radius.",
            f"Slip is wrong by up to {share:.2%}.",
            'Give belt.contact_stiffness, or set contact.slip_radius = "rim".',
        )


_MOST_TENSION_LOST = 0.02
"""Part of the tension lost by soft contact above which a finding says so: tensions and hub loads err by that part."""
_DEEPEST_PENETRATION = 0.1
"""Penetration at rest over the radius above which a finding says so: torque arms and wrap angles are those of pulleys
smaller by that part."""
_LARGEST_STRAIN = 0.1
"""Strain at rest above which a finding says so: few belts have a constant axial stiffness up to there."""
_LONG_RUN = 60.0
"""Computing time above which the cause is named, s."""
_DEFAULT_RTOL = 1e-4
"""Relative tolerance of a time step, the default of `simulation.rtol`, to which `_ELEMENTS_PER_STEP` refers."""
_ELEMENTS_PER_STEP = 1.7
"""Elements passed by an axial wave per step at the default tolerance: 0.5 to 5 in the examples."""
_ELEMENT_TIME = 6e-6
"""Computing time per step and element, s: 4.4e-6 to 7.5e-6 in the examples, on one core at 3 GHz."""


def advise(drive: Drive, installation: Installation) -> list[str]:
    """Warn of problems of a drive before it is simulated.

    Parameters
    ----------
    drive : Drive
    installation : Installation
        The estimates for this drive.

    Returns
    -------
    list of str
        Warnings: what is wrong, which numbers it spoils and by how much, and what to do.

    Examples
    --------
    >>> estimate = bd.model.install(drive)
    >>> len(bd.model.advise(drive, estimate))  # contact, its damping, friction and mesh are those of the paper
    4
    """
    lost, sunk = _tension(drive, installation), _penetration(drive, installation)
    found = [
        *_strain(drive, installation),
        *_lift_off(drive, installation),
        *_slack(drive, installation),
        *lost,
        *_stops(drive, installation),
        *_other_balances(drive, installation),
        *sunk,
        *judge_contact(drive, installation, soft=bool(lost or sunk)),
        *judge_plausibility(drive, installation),
        *_mesh(drive, installation),
    ]
    return [str(finding) for finding in found]


def unstable_balance(names: Sequence[str]) -> Finding:
    """Tensioners at rest in an unstable equilibrium."""
    return Finding(
        f"at rest the equilibrium of the tensioner of {listing(names)} is unstable: a small disturbance moves it away.",
        "A real drive does not stay there: tensions and positions at rest, and the start of a run, are meaningless.",
        "Turn its arm or direction away from the dead center, increase its spring rate, or give stops.",
    )


def off_the_stop(stop: str) -> str:
    """Remedies against a tensioner on its lower or upper stop; a change of tension comes last."""
    belt, side, preload = ("Shorten", "towards", "reduce") if stop == "upper" else ("Lengthen", "away from", "increase")
    return (
        f"{belt} the belt, move the tensioner {side} the belt, or widen the range between its stops; for "
        f"{'less' if stop == 'upper' else 'more'} tension, {preload} its preload."
    )


def _strain(drive: Drive, installation: Installation) -> list[Finding]:
    strain, tension = installation.strain, installation.tension
    if drive.belt.stretch_curve is not None:
        measured = drive.belt.stretch_curve.strains[-1]
        finding = Finding(
            f"the belt at rest is stretched by {strain:.2%}, but belt.stretch_curve ends at {measured:.2%}.",
            f"Its tension of {tension:.4g} N is extrapolated by a straight line from the last point of the curve.",
            "Extend the measured curve, lengthen the belt, or reduce the installed tension.",
        )
        return [finding] if strain > measured else []
    finding = Finding(
        f"the belt at rest is stretched by {strain:.1%}, more than {_LARGEST_STRAIN:.0%}.",
        f"Its tension of {tension:.4g} N assumes a constant axial stiffness, which few belts have at this strain.",
        "Lengthen the belt, move the pulleys closer together, reduce the installed tension, or give a measured "
        "belt.stretch_curve.",
    )
    return [finding] if strain > _LARGEST_STRAIN else []


def _slack(drive: Drive, installation: Installation) -> list[Finding]:
    """Strands heavier than their tension at rest."""
    finding = slack_strands(prepare(drive), installation.path, installation.span_tensions)
    return [] if finding is None else [finding]


def _lift_off(drive: Drive, installation: Installation) -> list[Finding]:
    """Compare the largest prescribed speed with the speed of lift-off of a belt on fixed centers.

    Its length between them stays, and so does its tension T, of which m v^2 is taken to bend the moving belt. A spring
    follows the belt and keeps up its pressure.
    """
    if drive.ends or installation.tensioner_positions.size or not installation.laid_tension > 0.0:
        return []
    tension, mass = installation.laid_tension, drive.belt.mass_per_length / (1.0 + installation.strain)
    speeds = drive.radii * np.array([abs(pulley.driven_speed(drive.simulation.end)) for pulley in drive.pulleys])
    driver, limit = int(np.argmax(speeds)), math.sqrt(tension / mass)
    fastest, rpm, name = float(speeds[driver]), RPM * limit / drive.radii[driver], drive.pulleys[driver].name
    if fastest <= limit:
        return []
    return [
        Finding(
            f"at {fastest:.4g} m/s, the largest speed of {name}, the belt lifts off all pulleys: "
            f"its centrifugal tension is {mass * fastest**2:.4g} N, its tension only {tension:.4g} N.",
            f"From {limit:.4g} m/s on ({rpm:.4g} rpm of {name}) it transmits almost no torque; at half of that speed "
            "it transmits 75% of the torque at low speed.",
            f"Increase the installed tension above {mass * fastest**2:.3g} N plus what the load needs, reduce the "
            "speed, choose a lighter belt, or add a spring-loaded tensioner, which keeps the belt on.",
        )
    ]


def _tension(drive: Drive, installation: Installation) -> list[Finding]:
    """Compare the tension with that on rigid pulleys, without a spring to compensate the loss."""
    lost = 1 - installation.tension / installation.laid_tension
    if lost <= _MOST_TENSION_LOST or installation.tensioner_positions.size:
        return []
    tension, laid = installation.tension, installation.laid_tension
    if drive.belt.installed_tension is None:
        return [
            Finding(
                f"the contact between belt and pulleys is so soft that it reduces the belt tension by {lost:.1%}, more "
                f"than {_MOST_TENSION_LOST:.0%}.",
                f"Tensions and hub loads are too low by that share: about {tension:.4g} N instead of {laid:.4g} N on "
                "rigid pulleys.",
                f"Increase {_remedy(drive, installation, (1 - _MOST_TENSION_LOST) * laid, laid)}.",
            )
        ]
    remedy = _remedy(drive, installation, tension, tension / (1 - _MOST_TENSION_LOST))
    shorter = installation.path.length / float(drive.belt.stretch_parameters.stretch(tension)) - drive.belt_length
    return [
        Finding(
            f"the contact between belt and pulleys is so soft that the belt must be {1e3 * shorter:.3g} mm shorter for "
            f"{tension:.4g} N than on rigid pulleys.",
            f"Its length of {drive.belt_length:.5g} m is too short by that amount; the tension is correct, after a "
            f"loss of {lost:.1%}.",
            f"If the length matters, increase {remedy}.",
        )
    ]


def _remedy(drive: Drive, installation: Installation, tension: float, laid: float) -> str:
    """The contact that leaves a given tension, N, of the tension as laid; rounded to two digits, on the safe side.

    The stiffness is that with which the penetration, T g / (R k_p) along each arc, shortens the path by as much as the
    belt is stretched less.
    """
    path, law = installation.path, drive.belt.stretch_parameters
    stretched, most = float(law.stretch(tension)), float(law.stretch(laid))
    room = path.length * (most - stretched) / most
    stiffness = tension * stretched * float(np.sum(path.wrap_angles / drive.radii)) / room
    depth = tension * stretched / (stiffness * float(drive.radii.min()))
    return (
        f"contact.stiffness to {_two_digits(stiffness, math.ceil):.1e} N/m^2 or more "
        f"(contact.allowed_penetration = {_two_digits(depth, math.floor):.1e} m)"
    )


def _two_digits(value: float, rounded: Callable[[float], int]) -> float:
    """Round up or down to two digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return rounded(value / digit) * digit


def _stops(drive: Drive, installation: Installation) -> list[Finding]:
    found = []
    for tensioner, position in zip(drive.moving_tensioners, installation.tensioner_positions.tolist(), strict=True):
        if tensioner.stops is not None and not tensioner.stops[0] < position < tensioner.stops[1]:
            which = "upper" if position > 0 else "lower"
            found.append(
                Finding(
                    f"the tensioner of {tensioner.pulley} rests on its {which} stop, at {tensioner.written(position)}.",
                    f"On the stop the belt length, not the spring, sets the tension ({installation.tension:.4g} N).",
                    off_the_stop(which),
                )
            )
    return found


def _other_balances(drive: Drive, installation: Installation) -> list[Finding]:
    """Other stable equilibria, to which a shock may move a tensioner."""
    found = []
    for tensioner, balances in zip(drive.moving_tensioners, tensioner_balances(drive, installation), strict=True):
        others = [tensioner.written(balance.position) for balance in balances if balance.stable and not balance.here]
        if others:
            found.append(
                Finding(
                    f"the tensioner of {tensioner.pulley} has other stable equilibria, at {listing(others)}.",
                    "A shock may move it there, with different tensions.",
                    "Give stops that exclude these positions.",
                )
            )
    return found


def _penetration(drive: Drive, installation: Installation) -> list[Finding]:
    shares = installation.penetrations / drive.radii
    deep = shares > _DEEPEST_PENETRATION
    if not deep.any():
        return []
    sinks = [
        f"into {pulley.name} by {share:.0%} of its radius"
        for pulley, share, is_deep in zip(drive.pulleys, shares, deep, strict=True)
        if is_deep
    ]
    return [
        Finding(
            f"at rest the belt sinks {listing(sinks)}, more than {_DEEPEST_PENETRATION:.0%}.",
            f"Torque arms, wrap angles and tensions are those of pulleys smaller by up to {shares.max():.0%}.",
            "Increase contact.stiffness.",
        )
    ]


def _mesh(drive: Drive, installation: Installation) -> list[Finding]:
    """Assess the mesh for slow running with the tension at rest."""
    if not installation.tension > 0 or drive.frame.stays:
        return []
    running = Running(installation.tension)
    errors, needed = mesh_errors(drive, running, drive.elements), elements_needed(drive, running)
    return unresolved(errors, needed, pressures=drive.belt.elements is not None)


def other_creep(prepared: Prepared, factor: float) -> str:
    """The setting for friction that saturates at a slip velocity larger or smaller by a factor."""
    chosen = LAWS[prepared.contact.friction_law]
    if any(parameter.found for parameter in chosen.parameters):
        ratio = prepared.contact.given("creep_ratio")
        verb = "increase" if factor > 1.0 else "reduce"
        return f"{verb} contact.creep_ratio from {ratio:.1e} to {beyond(ratio, factor * ratio, 1):.0e}"
    keys = " and ".join(f"contact.{key}" for key in ("friction_law", *(one.name for one in chosen.parameters)))
    return f"omit {keys}: the default friction law scales its creep with the belt speed"


def describe_time(drive: Drive) -> str:
    """Estimate the computing time of a run, and the cause if it is long; empty if unknown."""
    settings, belt = drive.simulation, drive.belt
    if settings.integrator != "generalized_alpha" or drive.frame.stays:
        return ""
    element = drive.belt_length / drive.elements
    passage = element / belt.wave_speed
    rates = {
        f"simulation.rtol = {settings.rtol:g}": 1.0
        / (_ELEMENTS_PER_STEP * math.sqrt(settings.rtol / _DEFAULT_RTOL) * passage),
        f"simulation.output_interval = {settings.output_interval:g} s": 1.0 / settings.output_interval,
    }
    if settings.max_step:
        rates[f"simulation.max_step = {settings.max_step:g} s"] = 1.0 / settings.max_step
    cause = max(rates, key=rates.__getitem__)
    steps = settings.duration * rates[cause]
    seconds = steps * drive.elements * _ELEMENT_TIME
    size, unit = (1.0, "s") if seconds < _LONG_RUN else (60.0, "min") if seconds < 120 * 60 else (3600.0, "h")
    middle, least, most = (f"{float(f'{factor * seconds / size:.2g}'):g}" for factor in (1.0, 0.2, 4.0))
    about = f"about {middle} {unit} ({least} to {most} {unit})"
    if seconds < _LONG_RUN:
        return about
    return f"{about}: {settings.duration:g} s in {float(f'{steps:.1g}'):,.0f} steps, limited by {cause}"

"""Warnings about a drive that is valid, but perhaps not meant."""

import math
from collections.abc import Callable

import numpy as np

from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation, tensioner_balances
from beltdyn.model.resolution import Running, elements_needed, mesh_errors, unresolved
from beltdyn.theory.stretch import stretch

_MOST_TENSION_LOST = 0.02
_DEEPEST_PENETRATION = 0.1
_LARGEST_STRAIN = 0.1
_LONG = 60.0
"""Computing time that is told of, s."""
_DEFAULT_RTOL = 1e-4
_STEP = 1.7
"""Elements that an axial wave passes in a step at the default tolerance: 0.5 to 5 in the examples."""
_ELEMENT_TIME = 6e-6
"""Computing time of a step for each element, s: 4.4e-6 to 7.5e-6 in the examples, on one core of 3 GHz."""
_SLOWEST_CREEP = 1e-4
"""Least slip velocity for full friction that does not make time steps much shorter, m/s."""


def advise(drive: Drive, installation: Installation) -> list[str]:
    """Say what a user should know before simulating a drive.

    Parameters
    ----------
    drive : Drive
    installation : Installation
        The estimates for this drive.

    Returns
    -------
    list of str
        Warnings, each with the number, the limit and the remedy.
    """
    return [
        *_strain_warnings(installation),
        *_tension_warnings(drive, installation),
        *_tensioner_warnings(drive, installation),
        *_other_balances(drive, installation),
        *_penetration_warnings(drive, installation),
        *_creep_warnings(drive, installation),
        *_mesh_warnings(drive, installation),
        *_time_warnings(drive),
    ]


def unstable_balance(name: str) -> str:
    """Say that the tensioner of a pulley is not in stable balance at rest."""
    return (
        f'at rest the balance of the tensioner of "{name}" is not stable: what moves it a little drives it away, and '
        "no real drive stays there. Turn its arm or direction away from its dead centre, raise the rate of its spring, "
        "or give stops."
    )


def _strain_warnings(installation: Installation) -> list[str]:
    if installation.strain <= _LARGEST_STRAIN:
        return []
    return [
        f"the installed strain is {installation.strain:.1%}, more than {_LARGEST_STRAIN:.0%}: the belt's material "
        "law is linear. Lengthen the belt, or move the pulleys together."
    ]


def _tension_warnings(drive: Drive, installation: Installation) -> list[str]:
    """Compare the tension with that on hard pulleys, where no spring makes up for what is lost."""
    lost = 1 - installation.tension / installation.laid_tension
    if lost <= _MOST_TENSION_LOST or installation.tensioner_positions.size:
        return []
    tension, laid = installation.tension, installation.laid_tension
    if drive.belt.installed_tension is None:
        return [
            f"penetration into the pulleys takes {lost:.1%} of the belt's tension, more than {_MOST_TENSION_LOST:.0%}: "
            f"{_remedy(drive, installation, (1 - _MOST_TENSION_LOST) * laid, laid)}."
        ]
    shorter = installation.path.length / float(stretch(tension, drive.belt.axial_stiffness)) - drive.belt_length
    return [
        f"the belt is {shorter:.1e} m shorter than hard pulleys would need for {tension:.4g} N, since penetration "
        f"takes {lost:.1%} of what it is laid with, more than {_MOST_TENSION_LOST:.0%}: where its length matters, "
        f"{_remedy(drive, installation, tension, tension / (1 - _MOST_TENSION_LOST))}."
    ]


def _remedy(drive: Drive, installation: Installation, tension: float, laid: float) -> str:
    """Say which contact leaves a tension, N, of what the belt is laid with; rounded to two digits, to the safe side.

    The stiffness is that with which the penetration, T g / (R k_p) along each arc, shortens the path by as much as the
    belt is stretched less.
    """
    path, axial = installation.path, drive.belt.axial_stiffness
    stretched, most = float(stretch(tension, axial)), float(stretch(laid, axial))
    less = 2 * (laid - tension) / (axial * (most**2 + most * stretched + stretched**2 - 1))  # most - stretched
    room = path.length * less / most
    stiffness = tension * stretched * float(np.sum(path.wrap_angles / drive.radii)) / room
    depth = tension * stretched / (stiffness * float(drive.radii.min()))
    return (
        f"raise contact.stiffness to {_two_digits(stiffness, math.ceil):.1e} N/m^2 or more "
        f"(contact.allowed_penetration = {_two_digits(depth, math.floor):.1e} m)"
    )


def _two_digits(value: float, rounded: Callable[[float], int]) -> float:
    """Round up or down to two digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return rounded(value / digit) * digit


def _tensioner_warnings(drive: Drive, installation: Installation) -> list[str]:
    warnings = []
    for tensioner, position in zip(drive.moving_tensioners, installation.tensioner_positions, strict=True):
        if tensioner.stops is not None and not tensioner.stops[0] < position < tensioner.stops[1]:
            which, remedy = (
                ("upper", "shorten the belt or raise its installed tension, or lower the preload")
                if position > 0
                else ("lower", "lengthen the belt or lower its installed tension, or raise the preload")
            )
            warnings.append(
                f'the tensioner of "{tensioner.pulley}" rests on its {which} stop, where its spring does not set the '
                f"tension: {remedy}, or move the stops."
            )
    return warnings


def _other_balances(drive: Drive, installation: Installation) -> list[str]:
    """Tell of other stable balances, to which a blow may drive a tensioner."""
    warnings = []
    for tensioner, balances in zip(drive.moving_tensioners, tensioner_balances(drive, installation), strict=True):
        others = [tensioner.written(balance.position) for balance in balances if balance.stable and not balance.here]
        if others:
            warnings.append(
                f'the tensioner of "{tensioner.pulley}" is in stable balance at {" and ".join(others)} too, and a run '
                "may end there: give stops that keep it from there."
            )
    return warnings


def _penetration_warnings(drive: Drive, installation: Installation) -> list[str]:
    warnings = []
    for pulley, radius, depth in zip(drive.pulleys, drive.radii, installation.penetrations, strict=True):
        if depth > _DEEPEST_PENETRATION * radius:
            warnings.append(
                f'the belt is expected to sink {depth / radius:.0%} of the radius into "{pulley.name}", '
                f"more than {_DEEPEST_PENETRATION:.0%}: raise contact.stiffness."
            )
    return warnings


def _creep_warnings(drive: Drive, installation: Installation) -> list[str]:
    """Compare the slip velocity at which friction is fully used with one that time steps can follow."""
    law, pressures = drive.contact.friction_parameters, installation.tension / drive.radii
    fastest = float(np.max(law.saturation(pressures, drive.frictions)))
    if not 0 < fastest < _SLOWEST_CREEP:
        return []
    remedy = law.softened(float(np.max(drive.frictions * pressures)), _SLOWEST_CREEP)
    return [
        f"friction is fully used at a slip velocity of {fastest:.1e} m/s, less than {_SLOWEST_CREEP:g} m/s: time steps "
        f"follow it, and a run takes long. For a fast one, {remedy}."
    ]


def _mesh_warnings(drive: Drive, installation: Installation) -> list[str]:
    """Judge the mesh as that of a drive that runs slowly with the tension at rest."""
    if not installation.tension > 0:
        return []
    running = Running(installation.tension)
    said = unresolved(mesh_errors(drive, running), elements_needed(drive, running))
    return [" ".join(said).removesuffix(".") + "; speeds and torques need fewer."] if said else []


def _time_warnings(drive: Drive) -> list[str]:
    """Say beforehand that a run will take long, and what makes it so."""
    settings, belt = drive.simulation, drive.belt
    element = drive.belt_length / belt.elements
    passage = element / math.sqrt(belt.axial_stiffness / belt.mass_per_length)
    rates = {
        f"simulation.rtol = {settings.rtol:g} with elements that an axial wave passes in {passage:.1e} s": 1.0
        / (_STEP * math.sqrt(settings.rtol / _DEFAULT_RTOL) * passage),
        f"simulation.output_interval = {settings.output_interval:g} s": 1.0 / settings.output_interval,
    }
    if settings.max_step:
        rates[f"simulation.max_step = {settings.max_step:g} s"] = 1.0 / settings.max_step
    cause = max(rates, key=rates.__getitem__)
    steps = settings.duration * rates[cause]
    seconds = steps * belt.elements * _ELEMENT_TIME
    if settings.integrator != "generalized_alpha" or seconds < _LONG:
        return []
    time = f"{seconds / 60:.2g} minutes" if seconds < 120 * 60 else f"{seconds / 3600:.2g} hours"
    return [
        f"a run will take about {steps:.1g} steps and {time} of computing, a third or three times as much: "
        f"{settings.duration:g} s with {belt.elements} elements, and steps as short as {cause} asks for."
    ]

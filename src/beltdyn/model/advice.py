"""Warnings about a drive that is valid, but perhaps not meant."""

import math

from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation
from beltdyn.model.resolution import arc_angle, arc_error, elements_needed

_MOST_TENSION_LOST = 0.1
_DEEPEST_PENETRATION = 0.1
_LARGEST_STRAIN = 0.1


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
        *_tension_warnings(installation),
        *_penetration_warnings(drive, installation),
        *_mesh_warnings(drive, installation),
    ]


def _strain_warnings(installation: Installation) -> list[str]:
    if installation.strain <= _LARGEST_STRAIN:
        return []
    return [
        f"the installed strain is {installation.strain:.0%}, more than {_LARGEST_STRAIN:.0%}: the belt's material "
        "law is linear. Lengthen the belt, or move the pulleys together."
    ]


def _tension_warnings(installation: Installation) -> list[str]:
    lost = 1 - installation.tension / installation.laid_tension
    if lost <= _MOST_TENSION_LOST:
        return []
    return [
        f"sinking into the pulleys takes {lost:.0%} of the belt's tension, more than {_MOST_TENSION_LOST:.0%}: "
        "raise contact.stiffness."
    ]


def _penetration_warnings(drive: Drive, installation: Installation) -> list[str]:
    warnings = []
    for pulley, depth in zip(drive.pulleys, installation.penetrations, strict=True):
        if depth > _DEEPEST_PENETRATION * pulley.radius:
            warnings.append(
                f'the belt is expected to sink {depth / pulley.radius:.0%} of the radius into "{pulley.name}", '
                f"more than {_DEEPEST_PENETRATION:.0%}: raise contact.stiffness."
            )
    return warnings


def _mesh_warnings(drive: Drive, installation: Installation) -> list[str]:
    """Compare the penetration with what an element misses the circle by; nodes alone do not miss it."""
    if not installation.tension > 0 or drive.contact.sampling == "nodal":
        return []
    needs = [
        (elements_needed(drive.belt, pulley.radius, float(depth)), pulley, depth)
        for pulley, depth in zip(drive.pulleys, installation.penetrations, strict=True)
    ]
    needed, pulley, depth = max(needs, key=lambda need: need[0])
    if needed <= drive.belt.elements:
        return []
    return [
        f'an element covers {math.degrees(arc_angle(drive.belt, pulley.radius)):.0f}° of "{pulley.name}" and misses '
        f"its circle by {arc_error(drive.belt, pulley.radius):.1e} m, where the belt sinks in by {depth:.1e} m: "
        f"contact forces will be uneven along the arc. For smooth ones, set belt.elements = {needed} or more; "
        "speeds and torques need fewer."
    ]

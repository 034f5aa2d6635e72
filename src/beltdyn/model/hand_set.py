"""Numbers of contact that are set by hand, and spoil results or cost time: judged by those that a drive chooses."""

from collections.abc import Iterator

import numpy as np

from beltdyn.contact.friction import LAWS
from beltdyn.model.contact import Contact
from beltdyn.model.defaults import CREEP_LENGTHS, DAMPING_RATIO
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation
from beltdyn.model.pulley import fastest_rim
from beltdyn.parts.finding import Finding

_SOFT, _HARD = 10.0, 30.0
"""How many times softer or harder than chosen contact may be."""
_STEADIES = 0.2
"""Damping over the critical one below which belts flutter where they slide."""
_TAKES = 4.0
"""Damping over the critical one from which on its own losses show: it took 3% of a fast drive's small load."""
_GENTLE, _STEEP = 4.0, 30.0
"""How many times the slip at full friction may be larger or smaller than chosen."""
_ADDED, _AT, _POWER = 0.14, 3.0, 1.75
"""Part of slip that friction adds with three creep lengths on an arc, and how it falls with their number."""
_ARM = 0.005
"""Part of the radius that the belt may sink in where friction acts at its point."""


def judge_contact(drive: Drive, installation: Installation, *, soft: bool = False) -> Iterator[Finding]:
    """Find what is wrong with numbers of contact that are given, and which results that spoils.

    Parameters
    ----------
    drive : Drive
        As it is given.
    installation : Installation
        The estimates for this drive.
    soft : bool
        Whether it is told already that contact is soft.
    """
    without = _without_numbers(drive.contact)
    if without == drive.contact or not installation.tension > 0:
        return
    chosen = drive.replace(contact=without)
    yield from () if soft else _stiffness(drive, chosen, installation)
    yield from _damping(drive)
    yield from _friction(drive, chosen, installation)
    yield from _moment_arm(drive, installation)


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
            f"{said} makes contact {usual / given:.0f} times softer than what the drive chooses, {usual:.2g} N/m^2: at "
            f"rest the belt sinks {1e3 * depth:.2g} mm into {name}, {depth / drive.radii[deepest]:.2%} of the radius.",
            "Slip is wrong by up to 20% of itself, and contact damping takes power that no belt loses.",
            f"Leave out contact.{key}.",
        )
    elif given > usual * _HARD:
        yield Finding(
            f"{said} makes contact {given / usual:.0f} times harder than what the drive chooses, {usual:.2g} N/m^2.",
            "No result gets better; layers at the ends of arcs get short, so that meshes and steps must be fine, or no "
            "equilibrium is found.",
            f"Leave out contact.{key}.",
        )


def _damping(drive: Drive) -> Iterator[Finding]:
    given, critical = drive.contact.damping, drive.critical_damping
    if given is None:
        return
    remedy = f"Leave out contact.damping: {DAMPING_RATIO:.0%} of critical is chosen, {DAMPING_RATIO * critical:.2g}."
    if given < _STEADIES * critical:
        yield Finding(
            f"contact.damping = {given:.3g} N s/m^2 is {given / critical:.1%} of critical: the belt may flutter "
            "where it slides.",
            "Contact forces vibrate then, and losses and slip with them; tensions in the mean are not concerned.",
            remedy,
        )
    elif given > _TAKES * critical:
        yield Finding(
            f"contact.damping = {given:.3g} N s/m^2 is {given / critical:.3g} times critical.",
            "It takes power where the belt meets and leaves pulleys, which no belt loses: most in fast drives under "
            "little load. A run tells how much.",
            remedy,
        )


def _friction(drive: Drive, chosen: Drive, installation: Installation) -> Iterator[Finding]:
    """Judge at which slip, over the speed, friction is fully used, next to what is chosen."""
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
    remedy = f"Leave out {'contact.friction_law, ' * (law.name != chosen.contact.friction_law)}" + ", ".join(
        f"contact.{key}" for key in keys
    )
    if factor > _GENTLE:
        lengths = CREEP_LENGTHS / factor
        added = _ADDED * (_AT / lengths) ** _POWER
        how = f"by up to {added:.0%}" if added < 1.0 else "several times"
        yield Finding(
            f"{said} lets friction build up {factor:.0f} times more slowly with slip than what the drive chooses.",
            f"Under load slip is too large, {how}, and friction loses more; tensions change little.",
            f"{remedy}.",
        )
    elif factor < 1.0 / _STEEP:
        yield Finding(
            f"{said} lets friction build up {1.0 / factor:.0f} times more steeply with slip than what the drive "
            "chooses.",
            "No result gets better by 3%; steps get short, and steady running may not be found.",
            f"{remedy}.",
        )


def _moment_arm(drive: Drive, installation: Installation) -> Iterator[Finding]:
    share = float(np.max(installation.penetrations / drive.radii))
    if drive.contact.moment_arm == "point" and share > _ARM:
        yield Finding(
            'contact.moment_arm = "point" lets friction act where the belt is, and it has sunk in by '
            f"{share:.1%} of a radius.",
            f"Torques of friction are too small by as much, and friction may give power: losses are wrong by up to "
            f"{share:.1%} of the power.",
            'Set contact.moment_arm = "rim", or raise contact.stiffness.',
        )

"""Contact parameters set by hand that spoil results or cost time, compared with the default choice."""

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
    """Check given contact parameters, and the results that they spoil.

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
    given, critical = drive.contact.damping, drive.critical_damping
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

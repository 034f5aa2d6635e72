"""Contact and tension that are lost, and belts that sink in or stretch more than belts do."""

from collections.abc import Iterator

import numpy as np

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.recorded import names
from beltdyn.theory.stretch import stretch

STRAIN_LIMIT = 0.05
"""Largest strain of a span that passes without a warning; belts with cords work below 0.02, elastic ones below 0.05."""

DEEPEST_OF_RADIUS, DEEPEST_OF_THICKNESS = 0.1, 0.5
"""Largest penetrations over the radius and over the belt's thickness that pass without a warning."""

_INSTANTS = 40
"""Outputs of fields at which places of contact are looked at, at most."""


def slack_spans(evidence: Evidence) -> Iterator[Finding]:
    """Spans whose tension falls to zero at any time."""
    tensions = np.asarray(evidence.recorded["span_tension"])
    for name, tension in zip(names(evidence.recorded, "span"), tensions.T, strict=True):
        known = np.where(np.isfinite(tension), tension, np.inf)
        lowest = float(known.min())
        if lowest <= 0.0:
            time = float(evidence.time[int(known.argmin())])
            yield Finding(
                f"the span {name} is slack: its tension falls to {lowest:.4g} N at t = {time:.4g} s.",
                remedy="Shorten the belt, or reduce the load.",
            )


def leaves_pulley(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys that the belt leaves, of those it is laid on."""
    free = np.asarray(evidence.recorded["wrap_angle"]) <= 0.0
    drive = evidence.drive
    for pulley, laid, left in zip(drive.pulleys, drive.path.wrap_angles, free.T, strict=True):
        if laid > 0.0 and left.any():
            time = float(evidence.time[int(left.argmax())])
            yield Finding(
                f"the belt leaves the pulley {pulley.name} at t = {time:.4g} s.",
                "The spans before and behind it have no tension and no speed as long.",
                "Raise the tension.",
            )


def deep_penetration(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys into which the belt sinks so far that the softness of the contact shapes the result."""
    drive, recorded = evidence.drive, evidence.recorded
    instants = np.asarray(recorded["field_time"])
    rows = np.unique(np.linspace(0, len(instants) - 1, _INSTANTS).round().astype(int))
    place, touched = (np.asarray(recorded[name][rows]) for name in ("contact_position", "contact_pulley"))
    centers = np.asarray(recorded["pulley_center"][np.searchsorted(evidence.time, instants[rows])])
    for number, (pulley, radius) in enumerate(zip(drive.pulleys, drive.radii.tolist(), strict=True)):
        away = np.hypot(*np.moveaxis(place - centers[:, number, None], -1, 0))
        depths = np.where(touched == number, radius - away, 0.0)
        depth, time = float(depths.max()), float(instants[rows[int(depths.max(axis=1).argmax())]])
        most = min(DEEPEST_OF_RADIUS * radius, DEEPEST_OF_THICKNESS * drive.belt.thickness)
        if depth > most:
            yield Finding(
                f"the belt sinks {depth:.2g} m into {pulley.name} at t = {time:.4g} s: {depth / radius:.1%} of its "
                f"radius, {depth / drive.belt.thickness:.0%} of the belt's thickness.",
                "Tensions, arms of torques and wrap angles are those of a pulley smaller by as much.",
                f"Raise contact.stiffness = {drive.contact_stiffness:g} N/m^2 to "
                f"{drive.contact_stiffness * depth / most:.1e}.",
            )


def large_strain(evidence: Evidence) -> Iterator[Finding]:
    """Spans that stretch more than belts do."""
    tension = np.nan_to_num(np.asarray(evidence.recorded["span_tension"]))
    row, span = np.unravel_index(int(tension.argmax()), tension.shape)
    strain = float(stretch(tension[row, span], evidence.drive.belt.axial_stiffness)) - 1.0
    if strain > STRAIN_LIMIT:
        yield Finding(
            f"the span {names(evidence.recorded, 'span')[span]} is stretched by {strain:.1%} at t = "
            f"{evidence.time[row]:.4g} s, more than {STRAIN_LIMIT:.0%}: few belts bear that.",
            "The law of the material is linear in a strain that real belts do not follow so far.",
            f"Raise the axial stiffness of {evidence.drive.belt.axial_stiffness:.4g} N, or lower the tension.",
        )

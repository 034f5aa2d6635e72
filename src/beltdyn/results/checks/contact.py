"""Lost contact, slack spans, and excessive penetration, tension or strain."""

import math
from collections.abc import Iterator

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.heavy_parts import slack_strands
from beltdyn.parts.messages import NOTABLE, Finding, beyond, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.mechanics import SpanTension, across
from beltdyn.results.schema import names

STRAIN_LIMIT = 0.05
"""Largest strain of a span that passes without a warning; belts with cords work below 0.02, elastic ones below 0.05."""

DEEPEST_OF_RADIUS, DEEPEST_OF_THICKNESS = 0.1, 0.5
"""Largest penetrations over the radius and over the belt's thickness that pass without a warning."""

LIFTED = 0.95
"""Share of the tension that m v^2 may reach before the belt counts as lifted off."""

_INSTANTS = 40
"""Largest number of field outputs examined for contact."""


def slack_spans(evidence: Evidence) -> Iterator[Finding]:
    """Spans whose tension falls to zero at any time."""
    tensions = np.asarray(evidence.recorded["least_span_tension"])
    known = np.where(np.isfinite(tensions), tensions, np.inf)
    spans = np.flatnonzero(known.min(axis=0) <= 0.0).tolist()
    if not spans:
        return
    lowest, slack = known.min(axis=0), (known <= 0.0).any(axis=1)
    names_, times = names(evidence.recorded, "span"), evidence.time[known.argmin(axis=0)]
    falls = [f"{names_[span]} to {lowest[span]:.3g} N at t = {times[span]:.4g} s" for span in spans]
    missing = -float(lowest.min())
    by = f" by more than {missing:.2g} N" if missing > 0.0 else ""
    yield Finding(
        f"the belt goes slack (tension zero or negative): {listing(falls)}.",
        "A real belt would sag and flap; the model carries compression. Tensions, hub loads and slip are wrong in "
        f"{np.mean(slack):.0%} of the run.",
        f"Raise the installed tension{by}, start more gently, or reduce the load.",
    )


def heavy_strands(evidence: Evidence) -> Iterator[Finding]:
    """Strands that weigh more than their mean tension, which hang slack."""
    prepared = evidence.prepared
    finding = slack_strands(prepared, prepared.path, np.array([one.tension for one in evidence.spans]))
    if finding is not None:
        yield finding


def leaves_pulley(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys that lose all contact with the belt."""
    free = np.asarray(evidence.recorded["wrap_angle"]) <= 0.0
    left = free & (evidence.prepared.path.wrap_angles > 0.0)
    lost = [
        f"{pulley.name} at t = {evidence.time[int(when.argmax())]:.4g} s"
        for pulley, when in zip(evidence.prepared.pulleys, left.T, strict=True)
        if when.any()
    ]
    if lost:
        yield Finding(
            f"the belt lifts off {listing(lost)}.",
            f"The spans beside a pulley without contact have no tension or speed: values are missing in "
            f"{left.any(axis=1).mean():.0%} of the run.",
            "Raise the installed tension, or lower the speed.",
        )


def lifted_by_speed(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys on which the moving belt barely presses because m v^2 approaches the tension of the adjacent spans."""
    prepared = evidence.prepared
    if prepared.ends:
        return
    tension, speed = SpanTension.of(lambda name: np.asarray(evidence.recorded[name])), evidence.recorded["belt_speed"]
    with np.errstate(invalid="ignore"):
        stretch = np.asarray(prepared.belt.stretch_parameters.stretch(tension.mean))
        bending = prepared.belt.mass_per_length * np.asarray(speed) ** 2 / stretch
        mean, taken = (np.mean(ends, axis=0) for ends in (tension.at_arcs(prepared), across(bending, prepared)))
        lifted = (mean > 0.0) & (taken > LIFTED * mean)
    times = [
        f"{pulley.name} at t = {evidence.time[int(when.argmax())]:.4g} s"
        for pulley, when in zip(prepared.pulleys, lifted.T, strict=True)
        if when.any()
    ]
    if times:
        row, number = np.argwhere(lifted)[0]
        fastest, held = float(np.nanmax(np.abs(speed[row]))), float(mean[row, number])
        yield Finding(
            f"centrifugal force lifts the belt off {listing(times)}: at {fastest:.4g} m/s it is "
            f"{taken[row, number]:.4g} N on {prepared.pulleys[number].name}, of a tension of {held:.4g} N.",
            f"Less than {1.0 - LIFTED:.0%} of the tension presses the belt on the pulley, so it transmits almost no "
            f"torque: torques and slip are affected in {lifted.any(axis=1).mean():.0%} of the results.",
            "Raise the installed tension, reduce the speed, choose a lighter belt, or add a spring-loaded tensioner, "
            "which keeps the belt on.",
        )


def deep_penetration(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys into which the belt sinks so far that the contact stiffness affects the result."""
    prepared = evidence.prepared
    depths, times = _deepest(evidence)
    most = np.minimum(DEEPEST_OF_RADIUS * prepared.radii, DEEPEST_OF_THICKNESS * prepared.belt.thickness)
    deep = [
        f"{1e3 * depth:.2g} mm into {pulley.name} at t = {time:.4g} s ({depth / radius:.1%} of its radius, "
        f"{depth / prepared.belt.thickness:.0%} of the belt's thickness)"
        for pulley, radius, depth, time, limit in zip(
            prepared.pulleys, prepared.radii, depths, times, most, strict=True
        )
        if depth > (1.0 + NOTABLE) * limit
    ]
    if deep:
        yield Finding(
            f"the belt sinks {listing(deep)}.",
            "Torque arms, wrap angles and tensions are those of pulleys up to "
            f"{(depths / prepared.radii).max():.1%} smaller.",
            f"Increase contact.stiffness from {prepared.contact_stiffness:.3g} N/m^2 to "
            f"{beyond(prepared.contact_stiffness, prepared.contact_stiffness * (depths / most).max()):.2g}.",
        )


def _deepest(evidence: Evidence) -> tuple[FloatArray, FloatArray]:
    """Largest penetration into each pulley, m, and when that was, s."""
    prepared, recorded = evidence.prepared, evidence.recorded
    instants = np.asarray(recorded["field_time"])
    rows = np.unique(np.linspace(0, len(instants) - 1, _INSTANTS).round().astype(int))
    place, touched = (np.asarray(recorded[name][rows]) for name in ("contact_position", "contact_pulley"))
    centers = np.asarray(recorded["pulley_center"][np.searchsorted(evidence.time, instants[rows])])
    away = np.hypot(*np.moveaxis(place[:, None] - centers[:, :, None], -1, 0))
    on = touched[:, None] == np.arange(len(prepared.radii))[:, None]
    depths = np.where(on, prepared.radii[:, None] - away, 0.0).max(axis=2)
    return depths.max(axis=0), instants[rows][depths.argmax(axis=0)]


def _largest(evidence: Evidence) -> FloatArray:
    """Largest tension of each span, N, zero where the belt has left a pulley, shape (outputs, spans)."""
    return np.asarray(np.nan_to_num(np.asarray(evidence.recorded["largest_span_tension"])))


def large_tension(evidence: Evidence) -> Iterator[Finding]:
    """Spans whose tension exceeds the rating of the belt."""
    most, tension = evidence.prepared.belt.largest_tension, _largest(evidence)
    if most is not None and tension.max() >= most:
        row, span = np.unravel_index(int(tension.argmax()), tension.shape)
        wider = math.ceil(100.0 * tension.max() / most) / 100.0
        yield Finding(
            f"the span {names(evidence.recorded, 'span')[span]} carries {tension[row, span]:.4g} N at t = "
            f"{evidence.time[row]:.4g} s; the belt is rated for {most:.4g} N.",
            "The cords stretch permanently, and belt and bearings fail early; coefficients of compression losses are "
            "at most those of the rated tension, where their data end.",
            f"Choose a belt at least {wider:.4g} times as wide, or reduce the tension or the load.",
        )


def large_strain(evidence: Evidence) -> Iterator[Finding]:
    """Spans with an unrealistic strain."""
    tension = _largest(evidence)
    row, span = np.unravel_index(int(tension.argmax()), tension.shape)
    belt, most = evidence.prepared.belt, float(tension[row, span])
    strain = float(belt.stretch_parameters.stretch(most)) - 1.0
    where = f"the span {names(evidence.recorded, 'span')[span]} at t = {evidence.time[row]:.4g} s"
    if belt.stretch_curve is not None:
        if strain > belt.stretch_curve.strains[-1]:
            yield Finding(
                f"{where} is stretched by {strain:.2%}, but belt.stretch_curve ends at "
                f"{belt.stretch_curve.strains[-1]:.2%}.",
                f"Tensions up to {most:.4g} N are extrapolated by a straight line from the last point of the curve.",
                "Extend the measured curve, or reduce the tension.",
            )
    elif strain > STRAIN_LIMIT:
        yield Finding(
            f"{where} is stretched by {strain:.1%}, more than the {STRAIN_LIMIT:.0%} that most belts withstand.",
            f"Tensions up to {most:.4g} N assume a constant axial stiffness, which few belts have at this strain.",
            f"Reduce the tension, check the axial stiffness of {belt.axial_stiffness:.4g} N, or give a measured "
            "belt.stretch_curve.",
        )

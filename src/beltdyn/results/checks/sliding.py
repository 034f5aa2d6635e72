"""Pulleys in gross slip, or near it."""

from collections.abc import Iterator
from functools import partial
from math import ceil, floor

import numpy as np

from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.incidents import SLIDING_LIMIT, slides_through
from beltdyn.results.mechanics import pressing_at_arcs, rim_speeds
from beltdyn.results.slip_safety import STATE, friction_used

SWEEP_REMEDY = "Raise the tension or the wrap angle, reduce the load, or sweep more slowly or to a lower speed."
"""Remedy for gross slip in a run-up."""

LEAST_SLIP_SAFETY = 1.5
"""Smallest slip safety that passes without a warning."""


def gross_slip(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys in gross slip at the end of the run; a belt held at an end slides by design."""
    prepared, numbers = evidence.prepared, _sliding(evidence)
    if not numbers:
        return
    speeds, heats = [], []
    for number in numbers:
        pulley = evidence.pulleys[number]
        speed = abs(pulley.sliding_speed)
        speeds.append(f"{speed:.3g} m/s on {pulley.name}")
        heats.append(f"{speed * abs(pulley.belt_torque) / prepared.radii[number]:.3g} W on {pulley.name}")
    names = [evidence.pulleys[number].name for number in numbers]
    yield Finding(
        f"gross slip: the belt slides on the whole arc of {listing(names)}, at {listing(speeds)}.",
        f"Friction heats the belt with {listing(heats)}; speeds and torques depend directly on the coefficient of "
        f"friction ({_frictions(evidence, numbers)}).",
        "Raise the tension or the wrap angle, or reduce the load.",
    )


def near_gross_slip(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys near gross slip at the end of the run."""
    sliding = _sliding(evidence)
    near = [
        (pulley, number)
        for number, pulley in enumerate(evidence.pulleys)
        if number not in sliding and 0.0 < pulley.slip_safety < LEAST_SLIP_SAFETY
    ]
    if evidence.prepared.ends or not near or not _driving_rim(evidence) > 0.0:
        return
    worst, number = min(near, key=lambda one: one[0].slip_safety)
    prepared = evidence.prepared
    tension, speed, centers = (evidence.window.mean(evidence.recorded, name) for name in STATE)
    at_arcs = pressing_at_arcs(partial(evidence.window.mean, evidence.recorded), prepared)
    least = float(friction_used(tension, speed, centers, prepared, at_arcs)[number])
    pressing = 1.0 - prepared.belt.mass_per_length * float(np.mean(speed**2)) / float(np.mean(tension))
    missing = LEAST_SLIP_SAFETY / worst.slip_safety - 1.0
    held = listing([f"the tensioner of {one.pulley}" for one in prepared.moving_tensioners] or ["the belt"])
    safeties = [f"{floor(100.0 * one.slip_safety) / 100.0:.2f} on {one.name}" for one, _ in near]
    yield Finding(
        f"{listing([pulley.name for pulley, _ in near])} {'are' if near[1:] else 'is'} near gross slip: the slip "
        f"safety is {listing(safeties)}, less than {LEAST_SLIP_SAFETY:g}.",
        f"If friction drops by more than {max(1.0 - least, 0.0):.0%}, for example through water or oil, "
        f"{worst.name} loses its grip and these numbers no longer hold.",
        f"Raise the tension of {held} by about {_percent(missing * pressing)}, reduce the loads by "
        f"{_percent(missing / (1.0 + missing))}, or increase the wrap angle of {worst.name}.",
        weight=1.0 / worst.slip_safety,
    )


def _percent(part: float) -> str:
    """A relative change in whole per cent, at least one."""
    return f"{max(ceil(100.0 * part - 1e-9), 1)}%"


def gross_slip_before(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys in gross slip before the end of the run, for more than a single output at a time."""
    first, prepared = evidence.window.first, evidence.prepared
    if prepared.ends or first < 2:
        return
    torque, times = np.asarray(evidence.recorded["pulley_torque"]), evidence.time[:first]
    reached = slides_through(evidence.recorded, prepared)[:first]
    durations, found, longest = np.gradient(times), [], 0.0
    for number in np.flatnonzero(reached.any(axis=0)).tolist():
        when = reached[:, number]
        load = abs(torque[:first][when, number][0])
        found.append(
            f"{prepared.pulleys[number].name} from t = {times[when][0]:.4g} to {times[when][-1]:.4g} s, starting at "
            f"{load:.4g} N m"
        )
        longest = max(longest, float(durations[when].sum()))
    if found:
        yield Finding(
            f"the belt was in gross slip on {listing(found)}: the torque exceeded what friction can transmit.",
            f"Driven pulleys fell behind in speed and angle for {longest:.2g} s in total; means are taken from "
            f"{evidence.window.start:.4g} s on.",
            "Raise the tension or the wrap angle, or start and load more gently.",
        )


def _sliding(evidence: Evidence) -> list[int]:
    """Numbers of the pulleys in gross slip at the end of the run."""
    limit = SLIDING_LIMIT * _driving_rim(evidence)
    sliding = (abs(pulley.sliding_speed) > limit for pulley in evidence.pulleys)
    found = np.flatnonzero(np.array(list(sliding)) & ~evidence.prepared.drive.guides).tolist()
    return [] if evidence.prepared.ends else found


def _driving_rim(evidence: Evidence) -> float:
    """Mean speed of the driver's rim, m/s."""
    speeds = np.array([pulley.speed for pulley in evidence.pulleys])
    return float(abs(rim_speeds(speeds, evidence.prepared)[evidence.prepared.reference]))


def _frictions(evidence: Evidence, numbers: list[int]) -> str:
    """Coefficients of friction of some pulleys, with the wedge factor."""
    return listing(sorted({f"{evidence.prepared.frictions[number]:.3g}" for number in numbers}))


def ended_by_slip(evidence: Evidence) -> Iterator[Finding]:
    """A pulley in gross slip during a run-up, which ended there."""
    fault = str(evidence.recorded.attrs["slips_through"])
    yield Finding(fault, "Results end there; the last ones are those of a sliding belt.", SWEEP_REMEDY)

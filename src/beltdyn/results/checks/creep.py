"""Slip of pulleys: gross slip, slip below the elastic creep, and slip due to the slope of the friction law."""

from collections.abc import Iterator
from functools import partial
from math import ceil, floor

import numpy as np

from beltdyn.model.advice import other_creep
from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.cycles import SHORTEST
from beltdyn.results.incidents import SLIDING_LIMIT, slides_through
from beltdyn.results.mechanics import SpanTension, rim_speeds
from beltdyn.results.slip_safety import Grip
from beltdyn.theory.creep import entry_creep

SLIP_DEFECT = 5e-4
"""Share of the speed by which slip may fall short of elastic creep without a warning."""

LEAST_SLIP = 1e-3
"""Slip below which its cause does not matter."""

LOSS_LIMIT = 0.02
"""Relative error of the losses without a warning."""

_LEAST = 0.01
"""Least friction loss without the part due to the slope, over that part."""

_TRANSMITS = 0.01
"""Share of the power input above which a pulley counts as loaded."""


_STOPS = 0.01
"""Speed of the driver at the end of a run, over its largest, below which it comes to rest and has no slip."""
_STANDS = 1e-6
"""Motion of the rim, over the stretch of the belt, below which it is rounding."""


def unknown_slip(evidence: Evidence) -> Iterator[Finding]:
    """A run in which the driver moves less than the belt stretches while means are taken, so that there is no slip."""
    number, window = evidence.prepared.reference, evidence.window
    driver, speeds = evidence.pulleys[number], np.abs(np.asarray(evidence.recorded["pulley_speed"])[:, number])
    if not np.isnan(driver.slip) or abs(driver.speed) <= _STOPS * speeds.max() or len(window.time) == 1:
        return
    tension = np.fmax.reduce([one.tension for one in evidence.spans])  # a span that the belt has left has none
    if np.isnan(tension):
        yield Finding(
            "slip has no value: while means are taken the belt has left a pulley of each span.",
            "Slip and creep have no values.",
            "Increase the tension, or simulate longer.",
        )
        return
    stretch = evidence.prepared.belt.stretch_parameters.stretch(float(tension)) - 1.0
    stretched = float(stretch) * evidence.prepared.belt_length
    rim = abs(driver.speed * evidence.prepared.radii[number])
    moved = rim * (window.end - window.start)
    if moved <= _STANDS * stretched:
        return
    yield Finding(
        f"the run is too short for slip: while means are taken the rim of {driver.name} moves {1e3 * moved:.3g} mm, "
        f"and the belt stretches by {1e3 * stretched:.3g} mm.",
        "Slip and creep have no values.",
        f"Simulate {stretched / (SHORTEST * rim):.2g} s or more.",
    )


def impossible_slip(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys whose slip behind the driver is below the elastic creep, over whole turns of the belt."""
    driver = max(evidence.pulleys, key=lambda pulley: pulley.power)
    if not (driver.power > 0.0 and evidence.window.turns and np.isfinite(driver.slip)):
        return
    faults, worst = [], 0.0
    for pulley, given in zip(evidence.pulleys, evidence.prepared.pulleys, strict=True):
        if given.teeth is not None:
            continue
        slip, elastic, slid = (
            1.0 - (1.0 - own) / (1.0 - others)
            for own, others in (
                (pulley.slip, driver.slip),
                (pulley.elastic_creep, driver.elastic_creep),
                (pulley.sliding, driver.sliding),
            )
        )
        defect = elastic + slid - slip
        if pulley.power < -_TRANSMITS * driver.power and defect > SLIP_DEFECT:
            worst = max(worst, defect)
            faults.append(
                f"{pulley.name} runs {-slip:.3%} faster than its driver {driver.name}"
                if slip < 0.0
                else f"the slip of {pulley.name} behind {driver.name} is {slip:.3%}, less than its elastic creep"
                f"{' and sliding' if slid else ''} of {elastic + slid:.3%}"
            )
    if faults:
        yield Finding(
            f"{listing(faults)}, which is physically impossible.",
            f"Speeds, speed ratios and slip are wrong by at least {worst:.2%} of the speed; tensions and torques are "
            "not affected.",
            f"The mesh is too coarse: set belt.elements = {2 * evidence.prepared.elements} and compare.",
        )


def regularized_slip(evidence: Evidence) -> Iterator[Finding]:
    """Slip that is due more to the slope of the friction law than to elastic creep."""
    led = [
        pulley
        for pulley in evidence.pulleys
        if abs(pulley.slip) > LEAST_SLIP
        and pulley.wrap_angle > 0.0
        and pulley.sliding == 0.0
        and pulley.slip * pulley.elastic_creep >= 0.0
        and pulley.slip * pulley.regularization > 0.0
        and abs(pulley.regularization) > abs(pulley.elastic_creep)
    ]
    worst = max(led, key=lambda pulley: abs(pulley.regularization), default=None)
    if worst is not None and (evidence.window.turns or _exceeds_stretch(evidence, worst.regularization)):
        radii = dict(zip((one.name for one in evidence.pulleys), evidence.prepared.radii.tolist(), strict=True))
        driver = evidence.prepared.reference
        rim = abs(evidence.pulleys[driver].speed) * float(evidence.prepared.radii[driver])
        parts = [f"{one.regularization:.2%} of {one.slip:.2%} on {one.name}" for one in led]
        losses = sum(abs(one.regularization * one.belt_torque) / radii[one.name] for one in led) * rim
        yield Finding(
            "friction builds up too slowly with slip velocity: the slope of the friction law causes more slip than "
            f"elastic creep, {listing(parts)}.",
            f"Slip is too large by as much, and friction losses by about {losses:.2g} W.",
            f"To resolve elastic creep, {other_creep(evidence.prepared, 0.1)}.",
        )


def smoothed_friction(evidence: Evidence) -> Iterator[Finding]:
    """Friction losses added by the slope of the friction law, from the creep at arc entries (`entry_creep`)."""
    window, lost = evidence.window, evidence.balance.lost
    if evidence.prepared.ends or not window.turns or any(regularized_slip(evidence)):
        return
    added = [_added_by_slope(evidence, number) for number in range(len(evidence.pulleys))]
    power = sum(added)
    if lost > power and power > LOSS_LIMIT * (lost - power):
        worst = evidence.pulleys[int(np.argmax(added))]
        yield Finding(
            f"friction builds up too slowly with slip velocity: it dissipates about {power:.2g} W more than elastic "
            f"creep, most of it on {worst.name}.",
            f"Losses are too large by {power / (lost - power):.1%}, those in friction by "
            f"{power / max(evidence.balance.losses['friction'] - power, _LEAST * power):.0%}.",
            f"To resolve the losses of elastic creep, {other_creep(evidence.prepared, 0.1)}.",
        )


def _added_by_slope(evidence: Evidence, number: int) -> float:
    """Friction loss on a pulley in excess of Coulomb friction, W."""
    prepared, pulley = evidence.prepared, evidence.pulleys[number]
    radius, friction = float(prepared.radii[number]), float(prepared.frictions[number])
    ends = SpanTension.of(partial(evidence.window.mean, evidence.recorded)).at_arcs(prepared)
    tension, rim = 0.5 * float(ends[0][number] + ends[1][number]), abs(pulley.speed) * radius
    pressing, pull = tension - prepared.belt.mass_per_length * rim**2, abs(pulley.belt_torque) / radius
    if not all(one > 0.0 for one in (rim, pressing, pull, friction)):
        return 0.0
    by_strain = rim / prepared.belt.local_stiffness(tension)
    saturation = float(prepared.friction_parameters.saturation(pressing / radius, friction, rim))
    lengths = pulley.wrap_angle * friction * pressing * by_strain / saturation
    return entry_creep(by_strain * pull, saturation, lengths) * pull


def _exceeds_stretch(evidence: Evidence, slip: float) -> bool:
    """Whether rims drift apart within the window by more than the belt's stretch changes with its tension."""
    prepared, window = evidence.prepared, evidence.window
    speed, radius = evidence.pulleys[prepared.reference].speed, float(prepared.rolling_radii[prepared.reference])
    passed = abs(speed) * radius * (window.end - window.start)
    stretch = prepared.belt.stretch_parameters.stretch(evidence.recorded["span_tension"][window.first :])
    return abs(slip) * passed > float(np.ptp(stretch, axis=0).max()) * prepared.belt_length


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
        if number not in sliding and 0.0 < pulley.least_safety < LEAST_SLIP_SAFETY
    ]
    if evidence.prepared.ends or not near or not _driving_rim(evidence) > 0.0:
        return
    worst, _ = min(near, key=lambda one: one[0].least_safety)
    prepared = evidence.prepared
    tension, speed = (evidence.window.mean(evidence.recorded, name) for name in ("span_tension", "belt_speed"))
    least = float(Grip(np.array(worst.tension_ratio), np.array(worst.allowed_tension_ratio)).used)
    pressing = 1.0 - prepared.belt.mass_per_length * float(np.mean(speed**2)) / float(np.mean(tension))
    missing = LEAST_SLIP_SAFETY / worst.least_safety - 1.0
    held = listing([f"the tensioner of {one.pulley}" for one in prepared.moving_tensioners] or ["the belt"])
    safeties = [f"{floor(100.0 * one.least_safety) / 100.0:.2f} on {one.name}" for one, _ in near]
    yield Finding(
        f"{listing([pulley.name for pulley, _ in near])} {'are' if near[1:] else 'is'} near gross slip: the slip "
        f"safety is {listing(safeties)}, less than {LEAST_SLIP_SAFETY:g}.",
        f"If friction drops by more than {max(1.0 - least, 0.0):.0%}, for example through water or oil, "
        f"{worst.name} loses its grip and these numbers no longer hold.",
        f"Raise the tension of {held} by about {_percent(missing * pressing)}, reduce the loads by "
        f"{_percent(missing / (1.0 + missing))}, or increase the wrap angle of {worst.name}.",
        weight=1.0 / worst.least_safety,
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

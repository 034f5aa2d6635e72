"""Slip below the elastic creep, and slip due to the slope of the friction law."""

from collections.abc import Iterator

import numpy as np

from beltdyn.model.advice import other_creep
from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.evidence import Evidence
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
                else f"the slip of {pulley.name} behind {driver.name} is {slip:.3%}, less than its elastic creep of "
                f"{elastic:.3%}"
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
    tensions = np.asarray(evidence.recorded["span_tension"][evidence.window.first :]).mean(axis=0)
    tension, rim = 0.5 * float(tensions[number - 1] + tensions[number]), abs(pulley.speed) * radius
    pressing, pull = tension - prepared.belt.mass_per_length * rim**2, abs(pulley.belt_torque) / radius
    if not min(rim, pressing, pull, friction) > 0.0:
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

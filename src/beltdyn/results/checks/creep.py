"""Slip that creep cannot make, and slip that the slope of the friction law makes."""

from collections.abc import Iterator

import numpy as np

from beltdyn.results.checks.finding import Evidence, Finding

SLIP_DEFECT = 5e-4
"""Part of the speed by which slip may fall short of elastic creep without a warning."""

LEAST_SLIP = 1e-3
"""Slip up to which it does not matter what makes it."""

_LAYERS = 3.0
"""Lengths over which a slip velocity grows e-fold that an arc should have: regularisation adds a tenth then."""

_TRANSMITS = 0.01
"""Part of the power put in above which a pulley counts as one that transmits power."""


def impossible_slip(evidence: Evidence) -> Iterator[Finding]:
    """Pulleys that lose less speed against the driver than elastic creep alone takes, over whole turns of the belt."""
    driver = max(evidence.pulleys, key=lambda pulley: pulley.power)
    if not (driver.power > 0.0 and evidence.window.turns and np.isfinite(driver.slip)):
        return
    for pulley in evidence.pulleys:
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
            yield Finding(
                f"{pulley.name} turns faster than {driver.name}, by {-slip:.3%} of the rim's speed, though it takes "
                f"{-pulley.power:.4g} W from it: creep cannot do that."
                if slip < 0.0
                else f"{pulley.name} slips {slip:.3%} behind {driver.name}, less than the {elastic:.3%} that elastic "
                "creep alone takes: impossible.",
                f"Slip, and what is told from it, is wrong by {defect:.2%} of the speed or more; tensions and torques "
                "are not concerned.",
                _finer(evidence),
            )


def _finer(evidence: Evidence) -> str:
    """Say how coarse the mesh is, which is to blame: what bending does to slip is in the rolling radii."""
    drive = evidence.drive
    covered = float(np.degrees(drive.belt_length / drive.belt.elements / drive.radii.min()))
    return (
        f"The mesh is to blame: compare a run with belt.elements = {2 * drive.belt.elements} (an element covers "
        f"{covered:.0f}° of {drive.pulleys[int(drive.radii.argmin())].name})."
    )


def regularised_slip(evidence: Evidence) -> Iterator[Finding]:
    """Slip of which the slope of the friction law makes more than elastic creep does."""
    led = [
        pulley
        for pulley in evidence.pulleys
        if abs(pulley.slip) > LEAST_SLIP
        and pulley.sliding == 0.0
        and pulley.slip * pulley.elastic_creep >= 0.0
        and pulley.slip * pulley.regularisation > 0.0
        and abs(pulley.regularisation) > abs(pulley.elastic_creep)
    ]
    worst = max(led, key=lambda pulley: abs(pulley.regularisation), default=None)
    if worst is not None and (evidence.window.turns or _exceeds_stretch(evidence, worst.regularisation)):
        others = f" (so on {', '.join(one.name for one in led if one is not worst)} too)" if led[1:] else ""
        yield Finding(
            f"of the slip of {worst.name}, {worst.slip:.2%}, elastic creep makes {worst.elastic_creep:.2%}, and the "
            f"slope of the friction law {worst.regularisation:.2%}{others}.",
            "Slip and friction losses are those of that slope rather than of the belt.",
            f"For slip near that of Coulomb's friction {_steeper(evidence)}.",
        )


def _exceeds_stretch(evidence: Evidence, slip: float) -> bool:
    """Whether rims come apart by more, within the window, than the belt's stretch changes with its tension."""
    drive, window = evidence.drive, evidence.window
    passed = abs(evidence.pulleys[0].speed) * float(drive.rolling_radii[0]) * (window.end - window.start)
    change = float(np.ptp(np.asarray(evidence.recorded["span_tension"][window.first :]), axis=0).max())
    return abs(slip) * passed > change / drive.belt.axial_stiffness * drive.belt_length


def _steeper(evidence: Evidence) -> str:
    """Say which slope makes arcs several layers long; see `theory.creep.layer_length`."""
    drive, pulleys = evidence.drive, evidence.pulleys
    tension, speed = (
        float(np.mean(evidence.window.mean(evidence.recorded, name))) for name in ("span_tension", "belt_speed")
    )
    most = max(abs(pulley.power) for pulley in pulleys)
    loaded = np.array([abs(pulley.power) > _TRANSMITS * most and pulley.wrap_angle > 0.0 for pulley in pulleys])
    arcs = (drive.radii * np.array([pulley.wrap_angle for pulley in pulleys]))[loaded]
    slopes = _LAYERS * drive.belt.axial_stiffness / (abs(speed) * arcs)
    pressing = (tension - drive.belt.mass_per_length * speed**2) / drive.radii[loaded]
    return drive.contact.friction_parameters.steepened(slopes, drive.frictions[loaded] * pressing)

"""Quantities that the mesh does not resolve, and the mesh that would."""

import math
import tomllib
from collections.abc import Iterator

import numpy as np

from beltdyn.machines.loads.load import Load
from beltdyn.model import ERROR_LIMITS, Prepared, unresolved
from beltdyn.model.resolution import PRESSURES
from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.creep import LOSS_LIMIT
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.energy_balance import OF_TEETH, causes_of
from beltdyn.results.provenance import found_errors
from beltdyn.results.schema import runs_steadily


def unresolved_by_mesh(evidence: Evidence) -> Iterator[Finding]:
    """Quantities whose mesh error, estimated or found with a finer mesh, exceeds its limit.

    Pressures at the ends of arcs need not be resolved by a number of elements that is chosen for a run over time.
    """
    found, settings = found_errors(evidence.recorded), evidence.prepared.simulation
    chosen = found and math.isnan(found["slip"]) and not _given(evidence) and settings.force_tolerance is None
    judged = [name for name in found if not (chosen and name in PRESSURES)]
    asked = settings.force_tolerance
    limits = ERROR_LIMITS if asked is None else {**ERROR_LIMITS, "peak pressure": asked}
    worse = [f"{name} ({found[name]:.1%})" for name in judged if found[name] > limits[name]]
    if worse:
        yield Finding(
            f"the mesh does not resolve {', '.join(worse)}.",
            "The values change by as much on a finer mesh.",
            f"Omit belt.elements for a graded mesh, or set belt.elements = {2 * evidence.prepared.elements}; in steady "
            "running reduce `force_tolerance`.",
        )
    if not found:
        errors, needed = evidence.resolution.errors, evidence.resolution.needed
        if STEADY_LOSSES in evidence.recorded.attrs:
            errors = {**errors, "slip": math.nan, "losses": math.nan}  # `off_steady_running` knows them
        yield from unresolved(errors, needed, pressures=_given(evidence))


def _given(evidence: Evidence) -> bool:
    """Whether the drive file gives the number of elements; the drive of a run may hold one that was chosen."""
    text = evidence.recorded.attrs.get("drive_as_given")
    return (
        evidence.prepared.drive.belt.elements is not None
        if text is None
        else "elements" in tomllib.loads(str(text))["belt"]
    )


# Excitation that steady running ignores, and errors of losses and slip against it

STEADY_LOSSES, STEADY_SLIPS, COARSE_SETTINGS = "steady_losses", "steady_slips", "coarse_settings"
"""Attributes of a run: losses (W, in the order of `LOSSES`) and slips in steady running, and settings that differ."""

STEADY_LOSS_LIMIT = 0.01
"""Relative error of losses against those of steady running, which are known to 0.5 %, without a warning."""

_LEAST_SLIP = 1e-4
"""Largest slip of a drive above which errors of slip are reported."""


def mean_torques(evidence: Evidence) -> Iterator[Finding]:
    """Loads that depend on the shaft angle, which steady running averages."""
    if not runs_steadily(evidence.recorded):
        return
    for pulley in evidence.prepared.pulleys:
        for load in filter(_turns_with_its_shaft, pulley.load):
            yield Finding(
                f'the load of {pulley.name} of kind "{load.kind}" varies with the shaft angle; steady running uses its '
                "mean over a cycle.",
                "The vibration it excites is ignored: torques, tensions and speeds oscillate about these values.",
                "Use `beltdyn response`, or simulate the drive with `beltdyn simulate`.",
            )


def off_steady_running(evidence: Evidence) -> Iterator[Finding]:
    """Errors of losses and slip by settings of mesh and steps: steady running refines its mesh until it resolves."""
    attributes = evidence.recorded.attrs
    if STEADY_LOSSES not in attributes:
        return
    losses, slips = list(_off_losses(evidence)), list(_off_slips(evidence))
    found, wrong = losses + slips, ["losses and efficiency"] * bool(losses) + ["slip"] * bool(slips)
    if found:
        yield Finding(
            f"compared with steady running on a resolved mesh, {listing(found)}.",
            f"{listing(wrong).capitalize()} {'are' if losses else 'is'} wrong by this amount.",
            f"Omit {attributes[COARSE_SETTINGS]}, or take these values from `beltdyn steady-state`.",
        )


def _off_losses(evidence: Evidence) -> Iterator[str]:
    """Losses, by part, that differ from those of steady running."""
    losses, steady = evidence.balance.losses, np.asarray(evidence.recorded.attrs[STEADY_LOSSES])
    causes = causes_of(toothed=OF_TEETH in losses).values()
    off = np.array([losses.get(cause, 0.0) for cause in causes]) - steady
    parts = dict(zip(causes, (off / steady.sum()).tolist(), strict=True))
    total = sum(parts.values())
    if max(map(abs, (total, *parts.values()))) > STEADY_LOSS_LIMIT:
        told = (f"{cause} {part:+.1%}" for cause, part in parts.items() if abs(part) > 0.5 * STEADY_LOSS_LIMIT)
        yield f"losses are off by {total:+.1%} ({', '.join(told)} of the losses)"


def _off_slips(evidence: Evidence) -> Iterator[str]:
    """The slip that differs most from that of steady running."""
    steady = np.asarray(evidence.recorded.attrs[STEADY_SLIPS])
    largest = max(float(np.nanmax(np.abs(steady), initial=0.0)), _LEAST_SLIP)
    off = np.nan_to_num([one.slip for one in evidence.pulleys] - steady) / largest
    worst = int(np.argmax(np.abs(off)))
    if abs(off[worst]) > LOSS_LIMIT:
        yield f"the slip of {evidence.pulleys[worst].name} is off by {off[worst]:+.1%} of the largest slip"


def begun_by_means(evidence: Evidence) -> Iterator[Finding]:
    """Excitation that sets in with a run because the initial steady running ignores it."""
    prepared = evidence.prepared
    if runs_steadily(evidence.recorded) or prepared.simulation.start != "steady":
        return
    swinging = list(_swinging(prepared))
    if swinging:
        yield Finding(
            f"the run starts from steady running with the mean of {listing(swinging)}; the oscillation sets in at "
            "once.",
            "The first part of the run still shows the transient that this causes.",
            "Use the results after it has decayed, or use `beltdyn sweep`, which waits for it.",
        )


def _swinging(prepared: Prepared) -> Iterator[str]:
    """What oscillates with the shaft angles, in words."""
    for pulley in prepared.pulleys:
        if pulley.harmonics:
            yield f"the speed of {pulley.name}"
        if any(load.orders for load in pulley.load):
            yield f"the load of {pulley.name}"


def _turns_with_its_shaft(load: Load) -> bool:
    """Whether a load depends on the angle of its shaft by more than harmonics."""
    return len(load.orders) > len(load.harmonics)

"""Excitation that steady running ignores."""

from collections.abc import Iterator

from beltdyn.machines.loads.load import Load
from beltdyn.model import Drive
from beltdyn.parts.finding import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.recorded import runs_steadily


def mean_torques(evidence: Evidence) -> Iterator[Finding]:
    """Loads that depend on the shaft angle, which steady running averages."""
    if not runs_steadily(evidence.recorded):
        return
    for pulley in evidence.drive.pulleys:
        for load in filter(_turns_with_its_shaft, pulley.load):
            yield Finding(
                f'the load of {pulley.name} of kind "{load.kind}" varies with the shaft angle; steady running uses its '
                "mean over a cycle.",
                "The vibration it excites is ignored: torques, tensions and speeds oscillate about these values.",
                "Use `beltdyn response`, or simulate the drive with `beltdyn run`.",
            )


def begun_by_means(evidence: Evidence) -> Iterator[Finding]:
    """Excitation that sets in with a run because the initial steady running ignores it."""
    drive = evidence.drive
    if runs_steadily(evidence.recorded) or drive.simulation.start != "steady":
        return
    swinging = list(_swinging(drive))
    if swinging:
        yield Finding(
            f"the run starts from steady running with the mean of {listing(swinging)}; the oscillation sets in at "
            "once.",
            "The first part of the run still shows the transient that this causes.",
            "Use the results after it has decayed, or use `beltdyn sweep`, which waits for it.",
        )


def _swinging(drive: Drive) -> Iterator[str]:
    """What oscillates with the shaft angles, in words."""
    for pulley in drive.pulleys:
        if pulley.harmonics:
            yield f"the speed of {pulley.name}"
        if any(load.orders for load in pulley.load):
            yield f"the load of {pulley.name}"


def _turns_with_its_shaft(load: Load) -> bool:
    """Whether a load depends on the angle of its shaft by more than harmonics."""
    return len(load.orders) > len(load.harmonics)

"""What steady running leaves out."""

from collections.abc import Iterator

from beltdyn.machines.loads.load import Load
from beltdyn.model import Drive
from beltdyn.parts.finding import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.recorded import runs_steadily


def mean_torques(evidence: Evidence) -> Iterator[Finding]:
    """Loads over the angle of their shafts, of which steady running takes the means."""
    if not runs_steadily(evidence.recorded):
        return
    for pulley in evidence.drive.pulleys:
        for load in filter(_turns_with_its_shaft, pulley.load):
            yield Finding(
                f'the load of {pulley.name} of kind "{load.kind}" changes with the angle of its shaft: it counts '
                "with its mean over a cycle.",
                "Steady running leaves out what it excites: torques, tensions and speeds swing about these values.",
                "Look at `beltdyn response`, or simulate the drive with `beltdyn run`.",
            )


def begun_by_means(evidence: Evidence) -> Iterator[Finding]:
    """What begins with a run, as the steady running in which the run begins leaves it out."""
    drive = evidence.drive
    if runs_steadily(evidence.recorded) or drive.simulation.start != "steady":
        return
    swinging = list(_swinging(drive))
    if swinging:
        yield Finding(
            f"the run begins in steady running with the means of {listing(swinging)}, which swing from then on.",
            "What it shows at first is in part the response to their beginning.",
            "Judge it when that has died, or begin with `beltdyn sweep`, which waits for it.",
        )


def _swinging(drive: Drive) -> Iterator[str]:
    """What swings with the angles of shafts, in words."""
    for pulley in drive.pulleys:
        if pulley.harmonics:
            yield f"the speed of {pulley.name}"
        if any(load.orders for load in pulley.load):
            yield f"the load of {pulley.name}"


def _turns_with_its_shaft(load: Load) -> bool:
    """Whether a load depends on the angle of its shaft by more than harmonics."""
    return len(load.orders) > len(load.harmonics)

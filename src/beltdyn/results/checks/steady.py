"""What steady running leaves out."""

from collections.abc import Iterator

from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.recorded import runs_steadily


def mean_torques(evidence: Evidence) -> Iterator[Finding]:
    """Loads over the angle of their shafts, of which steady running takes the means."""
    if not runs_steadily(evidence.recorded):
        return
    for pulley in evidence.drive.pulleys:
        for load in pulley.load:
            if len(load.orders) > len(load.harmonics):
                yield Finding(
                    f'the load of {pulley.name} of kind "{load.kind}" changes with the angle of its shaft: it counts '
                    "with its mean over a cycle.",
                    "Steady running leaves out what it excites: torques, tensions and speeds swing about these values.",
                    "Look at `beltdyn response`, or simulate the drive with `beltdyn run`.",
                )

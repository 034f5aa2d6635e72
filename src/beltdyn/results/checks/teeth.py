"""Teeth that carry too much, or that their flanks push off the pulley."""

from collections.abc import Iterator

import numpy as np

from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.tooth_loads import ToothLoads, loads_over_time


def lifted_teeth(evidence: Evidence) -> Iterator[Finding]:
    """Teeth that flanks push off with more than presses them on, at any of some outputs."""
    worst = dict[str, float]()
    for one in _examined(evidence):
        worst[one.name] = min(one.jump_margin, worst.get(one.name, np.inf))
    lifted = {name: margin for name, margin in worst.items() if margin < 1.0}
    if lifted:
        yield Finding(
            f"teeth lift off {listing([f'{name} at {margin:.0%} of the load' for name, margin in lifted.items()])}.",
            "A real belt rides up there and jumps; the model holds it as if its teeth stayed in their grooves.",
            "Raise the tension, reduce the load, or increase the wrap angle.",
        )


def overloaded_teeth(evidence: Evidence) -> Iterator[Finding]:
    """Teeth that carry more than allowed, at any of some outputs."""
    worst = dict[str, float]()
    allowed = np.inf
    for one in _examined(evidence):
        if one.largest > one.allowed:
            allowed, worst[one.name] = one.allowed, max(one.largest, worst.get(one.name, 0.0))
    if worst:
        factor = max(worst.values()) / allowed
        yield Finding(
            f"a tooth carries {listing([f'{load:.4g} N on {name}' for name, load in worst.items()])}; the belt allows "
            f"{allowed:.4g} N.",
            "Teeth shear off early.",
            f"Choose a belt {factor:.2g} times as wide, or a pulley with more teeth in mesh, or reduce the load.",
        )


def _examined(evidence: Evidence) -> Iterator[ToothLoads]:
    """Loads of teeth on all pulleys at some outputs along the belt."""
    for _, loads in loads_over_time(evidence.recorded, evidence.prepared):
        yield from loads

"""Teeth that carry too much, or that their flanks push off the pulley."""

from collections.abc import Iterator

import numpy as np

from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.incidents import jumps_in
from beltdyn.results.tooth_loads import ToothLoads, loads_over_time

_LIFTS = 1.01
"""Margin to a jump below which lands carry next to nothing."""


def lifted_teeth(evidence: Evidence) -> Iterator[Finding]:
    """Teeth whose flanks carry all that presses the belt on, so that they lift, at any of some outputs."""
    worst = dict[str, float]()
    for one in _examined(evidence):
        worst[one.name] = min(one.jump_margin, worst.get(one.name, np.inf))
    lifted = {name: margin for name, margin in worst.items() if margin < _LIFTS}
    if lifted:
        yield Finding(
            f"teeth lift off {listing([f'{name} at {margin:.0%} of the load' for name, margin in lifted.items()])}.",
            "The belt rides up there, and jumps under a little more load.",
            "Raise the tension, reduce the load, or increase the wrap angle.",
        )


def jumped_teeth(evidence: Evidence) -> Iterator[Finding]:
    """A belt that has jumped to other grooves."""
    events = jumps_in(evidence.recorded, [pulley.name for pulley in evidence.prepared.pulleys])
    if not events:
        return
    counts = {name: sum(one.name == name for one in events) for name in dict.fromkeys(one.name for one in events)}
    teeth = [f"{count} {'tooth' if count == 1 else 'teeth'} on {name}" for name, count in counts.items()]
    yield Finding(
        f"the belt jumps {listing(teeth)}, first at {events[0].time:.4g} s.",
        "Pulleys lose their angles against each other, and the belt is damaged.",
        "Raise the tension, reduce the load or its peaks, or increase the wrap angle.",
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

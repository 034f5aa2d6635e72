"""Checks of a result: findings with numbers and a remedy.

A check takes the `Evidence` of a run and gives `Finding` objects, none when all is well. Each file holds a family of
them; to add one, write it there and enter it in `CHECKS`.
"""

from collections.abc import Callable
from dataclasses import replace

from beltdyn.errors import cause_of
from beltdyn.model import Prepared
from beltdyn.parts.messages import Finding
from beltdyn.results.checks.contact import (
    deep_penetration,
    heavy_strands,
    large_strain,
    large_tension,
    leaves_pulley,
    lifted_by_speed,
    slack_spans,
)
from beltdyn.results.checks.creep import (
    ended_by_slip,
    gross_slip,
    gross_slip_before,
    impossible_slip,
    near_gross_slip,
    regularized_slip,
    smoothed_friction,
    unknown_slip,
)
from beltdyn.results.checks.ending import NOTHING_RECORDED, empty_rolls, unfinished, unsettled
from beltdyn.results.checks.evidence import Check, Evidence
from beltdyn.results.checks.machines import (
    held_too_far,
    jumped_teeth,
    lifted_teeth,
    overloaded_teeth,
    sagging_belt,
    stopped_tensioners,
    unstable_control,
    unstable_tensioners,
)
from beltdyn.results.checks.mesh import begun_by_means, mean_torques, off_steady_running, unresolved_by_mesh
from beltdyn.results.checks.power import (
    artificial_losses,
    damped_vibrations,
    driving_loads,
    flutter,
    negative_losses,
    numerical_damping,
    open_account,
    unbalanced_powers,
)
from beltdyn.results.means import PulleySummary
from beltdyn.results.provenance import Resolution
from beltdyn.results.schema import Recorded

__all__ = ["CHECKS", "Check", "Evidence", "Finding", "find"]

CHECKS: tuple[Check, ...] = (
    unfinished,
    unsettled,
    empty_rolls,
    open_account,
    numerical_damping,
    damped_vibrations,
    unbalanced_powers,
    slack_spans,
    heavy_strands,
    sagging_belt,
    leaves_pulley,
    lifted_by_speed,
    deep_penetration,
    large_strain,
    large_tension,
    jumped_teeth,
    lifted_teeth,
    overloaded_teeth,
    gross_slip,
    near_gross_slip,
    gross_slip_before,
    unknown_slip,
    impossible_slip,
    regularized_slip,
    smoothed_friction,
    driving_loads,
    mean_torques,
    begun_by_means,
    off_steady_running,
    negative_losses,
    artificial_losses,
    flutter,
    unstable_tensioners,
    unstable_control,
    stopped_tensioners,
    held_too_far,
    unresolved_by_mesh,
)
"""All checks, in the order in which their findings are shown."""


def find(
    recorded: Recorded,
    prepared: Prepared,
    resolution: Resolution | None,
    pulleys: Callable[[], tuple[PulleySummary, ...]],
) -> list[Finding]:
    """Check a result, of which a function gives the means of the pulleys."""
    if resolution is None:
        return [NOTHING_RECORDED]
    evidence = Evidence(recorded, prepared, resolution, pulleys)
    if "slips_through" in recorded.attrs:
        return list(ended_by_slip(evidence))  # the other checks would repeat this
    return [replace(finding, kind=check.__name__) for check in CHECKS for finding in _findings(check, evidence)]


def _findings(check: Check, evidence: Evidence) -> list[Finding]:
    """The findings of a check, or that it has a fault."""
    try:
        return list(check(evidence))
    except Exception as error:
        name = check.__name__.replace("_", " ")
        fault = cause_of(error, f"bd.results.checks.{check.__name__} of this run").rstrip(".")
        return [Finding(f"the check of {name} ended: {fault}.", "It says nothing of this run.", "Report it.")]

"""Quantities that the mesh does not resolve, and the mesh that would."""

import math
import tomllib
from collections.abc import Iterator

from beltdyn.model import ERROR_LIMITS, unresolved
from beltdyn.model.resolution import PRESSURES
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.checks.steady import STEADY_LOSSES
from beltdyn.results.resolution import found_errors


def unresolved_by_mesh(evidence: Evidence) -> Iterator[Finding]:
    """Quantities whose mesh error, estimated or found with a finer mesh, exceeds its limit.

    Pressures at the ends of arcs need not be resolved by a number of elements that is chosen for a run over time.
    """
    found, settings = found_errors(evidence.recorded), evidence.drive.simulation
    chosen = found and math.isnan(found["slip"]) and not _given(evidence) and settings.force_tolerance is None
    judged = [name for name in found if not (chosen and name in PRESSURES)]
    asked = settings.force_tolerance
    limits = ERROR_LIMITS if asked is None else {**ERROR_LIMITS, "peak pressure": asked}
    worse = [f"{name} ({found[name]:.1%})" for name in judged if found[name] > limits[name]]
    if worse:
        yield Finding(
            f"the mesh does not resolve {', '.join(worse)}.",
            "The values change by as much on a finer mesh.",
            f"Omit belt.elements for a graded mesh, or set belt.elements = {2 * evidence.drive.elements}; in steady "
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
    return evidence.drive.belt.elements is not None if text is None else "elements" in tomllib.loads(str(text))["belt"]

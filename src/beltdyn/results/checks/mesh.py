"""What the mesh does not resolve, and which one would."""

import math
from collections.abc import Iterator

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.resolution import FORCE_LIMIT


def unresolved(evidence: Evidence) -> Iterator[Finding]:
    """Contact forces and tensions whose estimated error is above the limit."""
    resolution, drive = evidence.resolution, evidence.drive
    pulleys = [pulley.name for number, pulley in enumerate(drive.pulleys) if not resolution.resolves(number)]
    worst = max((error for error in resolution.force_errors if math.isfinite(error)), default=math.nan)
    said = []
    if pulleys:
        ripple = f" (they ripple by {worst:.0%} of their mean)" if worst > FORCE_LIMIT else ""
        said.append(f"the contact forces along {_enumerate(pulleys)}{ripple}")
    if not resolution.resolves_tension:
        said.append(f"the tension (up to {resolution.tension_error:.0%} too high)")
    if said:
        yield Finding(
            f"the mesh does not resolve {', and '.join(said)}.",
            "Speeds converge earlier.",
            f"Set belt.elements = {resolution.elements} or more, in place of {drive.belt.elements}.",
        )


def _enumerate(words: list[str]) -> str:
    """Write "a", "a and b", or "a, b and c"."""
    return " and ".join([*([", ".join(words[:-1])] if words[1:] else []), words[-1]])

"""Vibrations that could grow far while the belt slid."""

import math
from collections.abc import Iterator

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.recorded import attribute

GROWTH_LIMIT = math.log(100.0)
"""Largest growth of vibrations where the belt slides, as the logarithm of a factor, that passes without a warning."""

_LARGEST = 700.0
"""Logarithm of about the largest number there is."""


def flutter(evidence: Evidence) -> Iterator[Finding]:
    """Vibrations that could grow further than the limit while the belt slid."""
    growth, start, end, frequency = (
        attribute(evidence.recorded, f"flutter_{name}", 0.0) for name in ("growth", "start", "end", "frequency")
    )
    if growth > GROWTH_LIMIT:
        drive = evidence.drive
        critical = 2.0 * math.sqrt(drive.contact.stiffness * drive.belt.mass_per_length)
        yield Finding(
            f"the belt may flutter where it slides: between t = {start:.4g} s and {end:.4g} s vibrations of "
            f"{frequency:.0f} Hz can grow by up to a factor of {math.exp(min(growth, _LARGEST)):.1g}.",
            "Long time steps damp them, short ones follow them, and speeds may differ: compare a run with a smaller "
            "simulation.rtol.",
            f"Raise contact.damping = {drive.contact.damping:g} N s/m^2 (critical: {critical:.2g}).",
        )

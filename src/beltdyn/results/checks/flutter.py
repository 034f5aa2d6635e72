"""Flutter of a sliding belt: vibrations that could grow far, and those that dissipate power."""

import math
from collections.abc import Iterator

from beltdyn.model.defaults import DAMPING_RATIO
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.checks.power import DAMPING_LIMIT, damping_share, may_flutter
from beltdyn.results.recorded import attribute

GROWTH_LIMIT = math.log(100.0)
"""Largest growth of vibrations where the belt slides, as the logarithm of a factor, that passes without a warning."""

_LARGEST = 700.0
"""Logarithm of about the largest number there is."""


def flutter(evidence: Evidence) -> Iterator[Finding]:
    """Vibrations that could grow beyond the limit while the belt slid, or that show in the contact damping.

    States in which the belt flutters already show less growth than those from which it begins; but then the vibrations
    take power in contact damping.
    """
    growth, start, end, frequency = (
        attribute(evidence.recorded, f"flutter_{name}", 0.0) for name in ("growth", "start", "end", "frequency")
    )
    drive, share = evidence.drive, damping_share(evidence)
    between = f"between t = {start:.4g} s and {end:.4g} s, vibrations of {frequency:.0f} Hz"
    fault = ""
    if growth > GROWTH_LIMIT:
        factor = math.exp(min(growth, _LARGEST))
        fault = f"the belt may flutter where it slides: {between} could grow by a factor of {factor:.1g}."
    elif share > DAMPING_LIMIT and may_flutter(evidence):
        fault = f"the belt flutters where it slides: {between} grow and dissipate {share:.1%} of the power."
    if fault:
        yield Finding(
            fault,
            f"Contact forces are then uncertain; a run with simulation.rtol = {drive.simulation.rtol / 10.0:g} shows "
            "by how much speeds and slip are. Real belts rarely flutter like this.",
            f"Increase contact.damping from {drive.contact_damping:.2g} to "
            f"{DAMPING_RATIO * drive.critical_damping:.2g} N s/m^2, half of critical.",
        )

"""The energy account."""

from collections.abc import Iterator

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.closure import largest_closure

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account, at any time, that passes without a warning."""


def open_account(evidence: Evidence) -> Iterator[Finding]:
    """Say that more energy is missing at any time than the limit; NaN is missing too."""
    time, error = largest_closure(evidence.recorded)
    if not abs(error) <= CLOSURE_LIMIT:
        yield Finding(
            f"the energy account is open by {error:.2%} of the energy put in at t = {time:.4g} s, more than "
            f"{CLOSURE_LIMIT:.0%}: works, losses and efficiency may be wrong by as much.",
            remedy=f"Reduce simulation.rtol = {evidence.drive.simulation.rtol:g}.",
        )

"""The energy account."""

from collections.abc import Iterator

from beltdyn.results.checks.finding import Evidence, Finding

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account that passes without a warning."""


def open_account(evidence: Evidence) -> Iterator[Finding]:
    """Say that more energy is missing than the limit."""
    closure = float(evidence.recorded["energy_closure"][-1])
    if abs(closure) > CLOSURE_LIMIT:
        yield Finding(
            f"the energy account is open by {closure:.2%} of the energy put in, more than {CLOSURE_LIMIT:.0%}.",
            remedy=f"Reduce simulation.rtol = {evidence.drive.simulation.rtol:g}.",
        )

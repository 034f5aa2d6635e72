"""The energy account."""

from collections.abc import Iterator

from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.closure import largest_closure, largest_numerical_share

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account, at any time, that passes without a warning."""

NUMERICAL_LIMIT = 0.01
"""Largest part of the energy put in, at any time, that time integration may take without a warning."""


def open_account(evidence: Evidence) -> Iterator[Finding]:
    """Say that more energy is missing at any time than the limit; NaN is missing too."""
    time, error = largest_closure(evidence.recorded)
    if not abs(error) <= CLOSURE_LIMIT:
        yield Finding(
            f"the energy account is open by {error:.2%} of the energy put in at t = {time:.4g} s, more than "
            f"{CLOSURE_LIMIT:.0%}: works, losses and efficiency may be wrong by as much.",
            remedy=f"Reduce simulation.rtol = {evidence.drive.simulation.rtol:g}.",
        )


def numerical_damping(evidence: Evidence) -> Iterator[Finding]:
    """Say that the damping of the time integrator takes more energy than the limit."""
    time, share = largest_numerical_share(evidence.recorded)
    if not abs(share) <= NUMERICAL_LIMIT:
        yield Finding(
            f"the damping of the time integrator took {share:.2%} of the energy put in by t = {time:.4g} s, more than "
            f"{NUMERICAL_LIMIT:.0%}:",
            spoils="vibrations die out sooner than they should, and efficiency is too low.",
            remedy=f"Reduce simulation.rtol = {evidence.drive.simulation.rtol:g}.",
        )

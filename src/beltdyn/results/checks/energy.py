"""The energy account."""

from collections.abc import Iterator

from beltdyn.results.balance import power_balance
from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.closure import largest_closure, largest_numerical_share

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account, at any time, that passes without a warning."""

NUMERICAL_LIMIT = 0.01
"""Largest part of the energy put in, at any time, that time integration may take without a warning."""

POWER_LIMIT = 0.01
"""Part of the power put in that may be missing in mean powers without a warning; they are means over outputs."""

_OTHER_INTERVAL = 0.7
"""The interval of outputs that the remedy names, over that of the run; elements are met at other places then."""


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


def unbalanced_powers(evidence: Evidence) -> Iterator[Finding]:
    """Say that the powers of shafts do not balance over whole turns, though the account of their works does.

    Torques of prescribed shafts ripple as elements pass. Outputs that meet each of them at the same place give a mean
    torque and power that are off.
    """
    balance = power_balance(evidence.recorded, evidence.window)
    missing = balance.power_in - balance.power_out - balance.lost - balance.stored
    closes = abs(largest_closure(evidence.recorded)[1]) <= CLOSURE_LIMIT
    if evidence.window.turns and closes and abs(missing) > POWER_LIMIT * balance.power_in > 0.0:
        interval = evidence.drive.simulation.output_interval
        yield Finding(
            f"of {balance.power_in:.4g} W put in, {missing:.3g} W ({missing / balance.power_in:.1%}) are neither taken "
            "out, lost nor stored, though the energy account closes:",
            f"outputs every {interval:g} s meet the ripple of a torque at the same place each time, and mean torques "
            "and powers are wrong by as much; losses and efficiency are not concerned.",
            f"Set simulation.output_interval = {_OTHER_INTERVAL * interval:.2g}.",
        )

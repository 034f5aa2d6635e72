"""The energy account."""

from collections.abc import Iterator

from beltdyn.model import Drive
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence, shorter_steps
from beltdyn.results.closure import largest_closure, largest_numerical_share

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account, at any time, that passes without a warning."""

NUMERICAL_LIMIT = 0.01
"""Largest part of the energy put in, at any time, that time integration may take without a warning."""

POWER_LIMIT = 0.01
"""Part of the power (`Evidence.power`) that may be missing in means over outputs without a warning."""

_OTHER_INTERVAL = 0.7
"""The interval of outputs that the remedy names, over that of the run; elements are met at other places then."""


def open_account(evidence: Evidence) -> Iterator[Finding]:
    """Say that more energy is missing at any time than the limit; NaN is missing too."""
    time, error = largest_closure(evidence.recorded)
    if not abs(error) <= CLOSURE_LIMIT:
        yield Finding(
            f"the energies do not add up: by t = {time:.4g} s {error:.2%} of the energy put in is missing, more than "
            f"{CLOSURE_LIMIT:.0%}.",
            "Losses and efficiency may be wrong by as much.",
            _closing(evidence.drive),
        )


def _closing(drive: Drive) -> str:
    """What closes the account: on the mesh that stays finer elements, or shorter steps."""
    if not drive.frame.stays:
        return shorter_steps(drive)
    return (
        f"On the mesh that stays the account closes with the mesh: set belt.elements = {2 * drive.elements}, or a "
        f"smaller simulation.force_tolerance. If that does not help: {shorter_steps(drive)}"
    )


def numerical_damping(evidence: Evidence) -> Iterator[Finding]:
    """Say that the damping of the time integrator takes more energy than the limit."""
    time, share = largest_numerical_share(evidence.recorded)
    if not abs(share) <= NUMERICAL_LIMIT:
        yield Finding(
            f"time steps are too long for the vibrations: by t = {time:.4g} s they took {share:.2%} of the energy put "
            f"in, more than {NUMERICAL_LIMIT:.0%}.",
            "Vibrations die out sooner than they should, and the efficiency is too low by up to as much.",
            shorter_steps(evidence.drive),
        )


def unbalanced_powers(evidence: Evidence) -> Iterator[Finding]:
    """Say that the powers of shafts do not balance over whole turns, though the account of their works does.

    Torques of prescribed shafts ripple as elements pass. Outputs that meet each of them at the same place give a mean
    torque and power that are off.
    """
    balance = evidence.balance
    missing = balance.power_in - balance.power_out - balance.lost - balance.stored
    closes = abs(largest_closure(evidence.recorded)[1]) <= CLOSURE_LIMIT
    if evidence.window.turns and closes and abs(missing) > POWER_LIMIT * evidence.power and balance.power_in > 0.0:
        interval = evidence.drive.simulation.output_interval
        yield Finding(
            f"of {balance.power_in:.4g} W put in, {missing:.3g} W ({missing / balance.power_in:.1%}) are neither taken "
            f"out, lost nor stored: a torque ripples in step with the outputs, every {interval:g} s.",
            "Mean torques and powers are wrong by as much; losses and speeds are right.",
            f"Set simulation.output_interval = {_OTHER_INTERVAL * interval:.2g}.",
        )

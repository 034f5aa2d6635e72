"""The energy account."""

from collections.abc import Iterator

from beltdyn.model import Drive
from beltdyn.parts.finding import Finding
from beltdyn.results.checks.evidence import Evidence, shorter_steps
from beltdyn.results.closure import largest_closure, largest_numerical_share

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account, at any time, that passes without a warning."""

NUMERICAL_LIMIT = 0.01
"""Largest share of the energy input, at any time, that time integration may dissipate without a warning."""

POWER_LIMIT = 0.01
"""Part of the power (`Evidence.power`) that may be missing in means over outputs without a warning."""

_OTHER_INTERVAL = 0.7
"""The interval of outputs that the remedy names, over that of the run; elements are met at other places then."""


def open_account(evidence: Evidence) -> Iterator[Finding]:
    """An energy balance open by more than the limit at any time; NaN counts as open."""
    time, error = largest_closure(evidence.recorded)
    if not abs(error) <= CLOSURE_LIMIT:
        yield Finding(
            f"the energy balance does not close: at t = {time:.4g} s {error:.2%} of the energy input is unaccounted "
            f"for (limit {CLOSURE_LIMIT:.0%}).",
            "Losses and efficiency may be wrong by as much.",
            _closing(evidence.drive),
        )


def _closing(drive: Drive) -> str:
    """The remedy: on a staying mesh finer elements, otherwise shorter steps."""
    if not drive.frame.stays:
        return shorter_steps(drive)
    return (
        f"On a staying mesh the error falls as the mesh is refined: set belt.elements = {2 * drive.elements}, or "
        f"reduce simulation.force_tolerance. If that does not help: {shorter_steps(drive)}"
    )


def numerical_damping(evidence: Evidence) -> Iterator[Finding]:
    """Numerical damping by the time integrator above the limit."""
    time, share = largest_numerical_share(evidence.recorded)
    if not abs(share) <= NUMERICAL_LIMIT:
        yield Finding(
            f"time steps are too long for the vibrations: numerical damping has dissipated {share:.2%} of the energy "
            f"input by t = {time:.4g} s (limit {NUMERICAL_LIMIT:.0%}).",
            "Vibrations decay too fast, and the efficiency is too low by up to this share.",
            shorter_steps(evidence.drive),
        )


def unbalanced_powers(evidence: Evidence) -> Iterator[Finding]:
    """Mean shaft powers that do not balance over whole belt turns although the energy balance closes.

    Torques of prescribed shafts ripple as elements pass. Outputs that meet each of them at the same place give a mean
    torque and power that are off.
    """
    balance = evidence.balance
    missing = balance.power_in - balance.power_out - balance.lost - balance.stored
    closes = abs(largest_closure(evidence.recorded)[1]) <= CLOSURE_LIMIT
    if evidence.window.turns and closes and abs(missing) > POWER_LIMIT * evidence.power and balance.power_in > 0.0:
        interval = evidence.drive.simulation.output_interval
        yield Finding(
            f"the mean powers do not balance: {missing:.3g} W ({missing / balance.power_in:.1%}) of "
            f"{balance.power_in:.4g} W input is unaccounted for, because a torque ripple is in step with the "
            f"outputs, every {interval:g} s.",
            "Mean torques and powers are wrong by as much; losses and speeds are correct.",
            f"Set simulation.output_interval = {_OTHER_INTERVAL * interval:.2g}.",
        )

"""Powers of the wrong sign, and losses that exist only in the computation."""

import math
from collections.abc import Iterator

import numpy as np

from beltdyn.model import Prepared
from beltdyn.model.defaults import DAMPING_RATIO
from beltdyn.parts.messages import Finding, beyond, listing
from beltdyn.parts.quantity import RPM
from beltdyn.results.checks.evidence import Evidence, shorter_steps
from beltdyn.results.cycles import last_change
from beltdyn.results.energy_balance import OF_TEETH, Balance, largest_closure, largest_numerical_share
from beltdyn.results.free_decay import free_decay, real_decay
from beltdyn.results.schema import attribute

DAMPING_LIMIT = 0.01
"""Largest share of the power (`Evidence.power`) that contact damping may dissipate without a warning."""

_DAMPING_GOAL = 1e-3
"""The same share with the damping that the remedy gives."""

GAIN_LIMIT = 1e-3
"""Largest negative loss, over `Evidence.power`, without a warning."""

_GIVES = 0.01
"""Smallest power of a driving load, over `Evidence.power`, that gets a warning."""


def negative_losses(evidence: Evidence) -> Iterator[Finding]:
    """Losses with a negative mean, against the second law."""
    balance = evidence.balance
    limit = GAIN_LIMIT * evidence.power
    giving = {cause: power for cause, power in balance.losses.items() if -power > limit and cause != OF_TEETH}
    if giving and balance.power_in > 0.0:
        point = evidence.prepared.contact.moment_arm == "point" and "friction" in giving
        gains = listing([f"{power:.3g} W in {cause}" for cause, power in giving.items()])
        yield Finding(
            f"a computed loss is negative (numerical error): {gains} on average.",
            _spoiled(balance, sum(giving.values())),
            'Set contact.moment_arm = "rim", with which the friction loss cannot be negative.'
            if point
            else shorter_steps(evidence.prepared),
        )


def damping_share(evidence: Evidence) -> float:
    """Share of the power (`Evidence.power`) lost in contact damping; zero for an unloaded drive."""
    balance = evidence.balance
    loaded = min(balance.power_in, balance.power_out) > 0.0
    return balance.losses["contact damping"] / evidence.power if loaded else 0.0


def may_flutter(evidence: Evidence) -> bool:
    """Whether vibrations could grow where the belt slid, and more contact damping would suppress them.

    From half of critical damping on, more does not help: the loss in contact damping is then no sign of vibrations.
    """
    growth = attribute(evidence.recorded, "flutter_growth", 0.0)
    return growth > 0.0 and evidence.prepared.contact_damping < DAMPING_RATIO * evidence.prepared.critical_damping


def artificial_losses(evidence: Evidence) -> Iterator[Finding]:
    """Power lost in contact damping, which belongs to the numerical contact and not to a belt.

    Where vibrations grow they cause the loss: see `beltdyn.results.checks.power`.
    """
    balance, share = evidence.balance, damping_share(evidence)
    power, prepared = balance.losses["contact damping"], evidence.prepared
    if share > DAMPING_LIMIT and not may_flutter(evidence):
        # beyond critical damping the loss no longer grows with the damping
        growing = min(prepared.contact_damping, prepared.critical_damping)
        yield Finding(
            f"contact damping dissipates {power:.3g} W, {share:.1%} of the power input: it stabilizes the computation "
            "and is not a loss of a real belt.",
            _spoiled(balance, power),
            f"Reduce contact.damping from {prepared.contact_damping:.2g} to "
            f"{beyond(prepared.contact_damping, growing * _DAMPING_GOAL / share, 1):.1g} N s/m^2 or less.",
        )


def _spoiled(balance: Balance, power: float) -> str:
    """The efficiency with and without a loss."""
    rest = balance.power_out + balance.lost - power
    if not (balance.power_out > 0.0 and rest > 0.0):
        return f"The losses are wrong by {abs(power):.3g} W."
    return f"Without it the efficiency would be {balance.power_out / rest:.2%} instead of {balance.efficiency:.2%}."


def driving_loads(evidence: Evidence) -> Iterator[Finding]:
    """Loads that put power in, in a drive with a motor or a prescribed speed; rollers of a web line may."""
    prepared = evidence.prepared
    if prepared.drive.is_web:
        return
    motors = [pulley.prescribed or any(one.driven_speed for one in pulley.load) for pulley in prepared.pulleys]
    most = max(evidence.power, *(abs(one.power) for one in evidence.pulleys))
    if not any(motors):
        return
    loads = [one for one, motor in zip(evidence.pulleys, motors, strict=True) if not motor]
    driving = [one for one in loads if one.power > _GIVES * most]
    facts = [
        f"{one.name}, {one.shaft_torque:.4g} N m at {RPM * one.speed:.4g} rpm, {one.power:.4g} W" for one in driving
    ]
    if driving:
        yield Finding(
            f"a load drives the belt because its torque has the sign of its speed: {listing(facts)}.",
            f"Efficiency, slip and tensions are those of a drive with {sum(one.power for one in driving):.4g} W input "
            "there.",
            "If the load should absorb power, change its sign: a load is negative on a shaft that turns "
            f"{prepared.drive.rotation} and positive on one that turns the other way.",
        )


# The energy account

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
            _closing(evidence.prepared),
        )


def _closing(prepared: Prepared) -> str:
    """The remedy: on a staying mesh finer elements, otherwise shorter steps."""
    if not prepared.frame.stays:
        return shorter_steps(prepared)
    return (
        f"On a staying mesh the error falls as the mesh is refined: set belt.elements = {2 * prepared.elements}, or "
        f"reduce simulation.force_tolerance. If that does not help: {shorter_steps(prepared)}"
    )


def numerical_damping(evidence: Evidence) -> Iterator[Finding]:
    """Numerical damping by the time integrator above the limit."""
    time, share = largest_numerical_share(evidence.recorded)
    if not abs(share) <= NUMERICAL_LIMIT:
        yield Finding(
            f"time steps are too long for the vibrations: numerical damping has dissipated {share:.2%} of the energy "
            f"input by t = {time:.4g} s (limit {NUMERICAL_LIMIT:.0%}).",
            "Vibrations decay too fast, and the efficiency is too low by up to this share.",
            shorter_steps(evidence.prepared),
        )


VISIBLE = 1e-3
"""Amplitude of a vibration over the mean tension of its span from which on its decay is told."""
DECAY_LIMIT = 0.1
"""Largest error of the rate of decay of a free vibration by the time integrator, relative, without a warning."""
_SMALL_PART = 0.02
"""That error with the advised step."""


def damped_vibrations(evidence: Evidence) -> Iterator[Finding]:
    """A free vibration that the time integrator lets die away at another rate than the drive does."""
    recorded, settings = evidence.recorded, evidence.prepared.simulation
    if "step_size" not in recorded or settings.integrator != "generalized_alpha":
        return
    since = evidence.time >= last_change(evidence.prepared, evidence.time)
    time, tensions = evidence.time[since][:-1], np.asarray(recorded["span_tension"])[since][:-1]
    found = [
        (decay.amplitude / float(np.mean(tension)), decay, span)
        for tension, span in zip(tensions.T, evidence.prepared.spans, strict=True)
        if (decay := free_decay(time, tension)) is not None
    ]
    if not found or max(found)[0] < VISIBLE:
        return
    _, decay, (start, end) = max(found)
    steps = np.asarray(recorded["step_size"])[since]
    real, step = real_decay(decay, evidence.time[since], steps, settings.spectral_radius)
    part = abs(decay.rate - real.rate)
    if part > DECAY_LIMIT * decay.rate:
        shorter = step * (_SMALL_PART * decay.rate / part) ** (1.0 / 3.0)
        yield Finding(
            f"the time integrator changes a free vibration of {decay.frequency:.3g} Hz ({decay.amplitude:.2g} N in the "
            f"span from {start} to {end}): with time steps of {step:.2g} s it dies away with {decay.rate:.3g} 1/s.",
            f"This rate is off by up to {part:.2g} 1/s, and resonance peaks by as large a part.",
            f"Set simulation.max_step = {shorter:.1g} for errors of {_SMALL_PART:.0%}, or take decays from "
            "`beltdyn modes`.",
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
        interval = evidence.prepared.simulation.output_interval
        yield Finding(
            f"the mean powers do not balance: {missing:.3g} W ({missing / balance.power_in:.1%}) of "
            f"{balance.power_in:.4g} W input is unaccounted for, because a torque ripple is in step with the "
            f"outputs, every {interval:g} s.",
            "Mean torques and powers are wrong by as much; losses and speeds are correct.",
            f"Set simulation.output_interval = {_OTHER_INTERVAL * interval:.2g}.",
        )


# Flutter of a sliding belt: vibrations that could grow far, and those that dissipate power

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
    prepared, share = evidence.prepared, damping_share(evidence)
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
            f"Contact forces are then uncertain; a run with simulation.rtol = {prepared.simulation.rtol / 10.0:g} "
            "shows by how much speeds and slip are. Real belts rarely flutter like this.",
            _steadying(prepared.contact_damping, DAMPING_RATIO * prepared.critical_damping),
        )


def _steadying(present: float, usual: float) -> str:
    """Remedy against flutter of a belt with a contact damping (N s/m^2), where half of critical is the usual one."""
    if present < usual and f"{present:.2g}" != f"{usual:.2g}":
        return f"Increase contact.damping from {present:.2g} to {usual:.2g} N s/m^2, half of critical."
    return "Raise the tension or the friction, or reduce the load, so that the belt does not slide there."

"""Powers with the wrong sign, and losses that no belt has."""

import math
from collections.abc import Iterator

from beltdyn.results.balance import Balance, power_balance
from beltdyn.results.checks.finding import Evidence, Finding
from beltdyn.results.recorded import attribute

DAMPING_LIMIT = 0.01
"""Largest part of the power put in that contact damping may take without a warning."""

_DAMPING_GOAL = 1e-3
"""The same with the damping that the remedy names."""

GAIN_LIMIT = 1e-3
"""Largest power that a loss may give, over the power put in, without a warning."""

_GIVES = 0.01
"""Smallest power that a load gives, over the power put in, that is worth a warning."""


def negative_losses(evidence: Evidence) -> Iterator[Finding]:
    """Losses that give power in the mean, against the second law."""
    balance = power_balance(evidence.recorded, evidence.window)
    for cause, power in balance.losses.items():
        if balance.power_in > 0.0 and -power > GAIN_LIMIT * balance.power_in:
            point = evidence.drive.contact.moment_arm == "point" and cause == "friction"
            yield Finding(
                f"the losses in {cause} are {power:.3g} W in the mean: they give power, which no loss can.",
                _spoiled(balance, power),
                'Set contact.moment_arm = "rim", with which friction gives none.'
                if point
                else f"Reduce simulation.rtol = {evidence.drive.simulation.rtol:g}.",
            )


def damping_share(evidence: Evidence) -> float:
    """Part of the power put in that contact damping takes; zero of a drive that takes no power out."""
    balance = power_balance(evidence.recorded, evidence.window)
    loaded = min(balance.power_in, balance.power_out) > 0.0
    return balance.losses["contact damping"] / balance.power_in if loaded else 0.0


def artificial_losses(evidence: Evidence) -> Iterator[Finding]:
    """Power that contact damping takes, which belongs to the numerical contact and not to a belt.

    Where vibrations grow it is they that take it: see `beltdyn.results.checks.flutter`.
    """
    balance, share = power_balance(evidence.recorded, evidence.window), damping_share(evidence)
    power, drive = balance.losses["contact damping"], evidence.drive
    if share > DAMPING_LIMIT and not attribute(evidence.recorded, "flutter_growth", 0.0) > 0.0:
        critical = 2.0 * math.sqrt(drive.contact_stiffness * drive.belt.mass_per_length)
        growing = min(drive.contact.damping, critical)  # beyond it the loss no longer grows with the damping
        yield Finding(
            f"contact damping takes {power:.3g} W, {share:.1%} of the power put in: it is a means of computation, and "
            "no loss of a belt.",
            _spoiled(balance, power),
            f"Lower contact.damping = {drive.contact.damping:g} to {growing * _DAMPING_GOAL / share:.1g} N s/m^2 "
            "or less.",
        )


def _spoiled(balance: Balance, power: float) -> str:
    """What the efficiency is with a loss and without it."""
    rest = balance.power_out + balance.lost - power
    if not (balance.power_out > 0.0 and rest > 0.0):
        return "The losses are wrong by that much."
    return f"Without them the efficiency is {balance.power_out / rest:.2%}, not {balance.efficiency:.2%}."


def driving_loads(evidence: Evidence) -> Iterator[Finding]:
    """Torques and loads that drive, in a drive with a motor or a prescribed speed."""
    drive = evidence.drive
    motors = [pulley.prescribed or any(one.driven_speed for one in pulley.load) for pulley in drive.pulleys]
    most = max(abs(one.power) for one in evidence.pulleys)
    for pulley, motor, means in zip(drive.pulleys, motors, evidence.pulleys, strict=True):
        if any(motors) and not motor and means.power > _GIVES * most:
            sense = "counter-clockwise" if means.speed > 0.0 else "clockwise"
            yield Finding(
                f"the load on {pulley.name} drives: its torque of {means.shaft_torque:.4g} N m has the sign of its "
                f"speed, {means.speed:.4g} rad/s, and gives {means.power:.4g} W.",
                "Efficiency and slip are those of a drive with power from there.",
                f"If it is meant to take power, change its sign: a load on a shaft that turns {sense} is "
                f"{'negative' if means.speed > 0.0 else 'positive'}.",
            )

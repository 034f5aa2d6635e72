"""Powers of the wrong sign, and losses that exist only in the computation."""

from collections.abc import Iterator

from beltdyn.model.defaults import DAMPING_RATIO
from beltdyn.parts.finding import Finding, listing
from beltdyn.parts.quantity import RPM
from beltdyn.results.balance import Balance
from beltdyn.results.checks.evidence import Evidence, shorter_steps
from beltdyn.results.recorded import attribute

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
    giving = {cause: power for cause, power in balance.losses.items() if -power > GAIN_LIMIT * evidence.power}
    if giving and balance.power_in > 0.0:
        point = evidence.drive.contact.moment_arm == "point" and "friction" in giving
        gains = listing([f"{power:.3g} W in {cause}" for cause, power in giving.items()])
        yield Finding(
            f"a computed loss is negative (numerical error): {gains} on average.",
            _spoiled(balance, sum(giving.values())),
            'Set contact.moment_arm = "rim", with which the friction loss cannot be negative.'
            if point
            else shorter_steps(evidence.drive),
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
    return growth > 0.0 and evidence.drive.contact_damping < DAMPING_RATIO * evidence.drive.critical_damping


def artificial_losses(evidence: Evidence) -> Iterator[Finding]:
    """Power lost in contact damping, which belongs to the numerical contact and not to a belt.

    Where vibrations grow they cause the loss: see `beltdyn.results.checks.flutter`.
    """
    balance, share = evidence.balance, damping_share(evidence)
    power, drive = balance.losses["contact damping"], evidence.drive
    if share > DAMPING_LIMIT and not may_flutter(evidence):
        # beyond critical damping the loss no longer grows with the damping
        growing = min(drive.contact_damping, drive.critical_damping)
        yield Finding(
            f"contact damping dissipates {power:.3g} W, {share:.1%} of the power input: it stabilises the computation "
            "and is not a loss of a real belt.",
            _spoiled(balance, power),
            f"Reduce contact.damping from {drive.contact_damping:.2g} to {growing * _DAMPING_GOAL / share:.1g} N s/m^2 "
            "or less.",
        )


def _spoiled(balance: Balance, power: float) -> str:
    """The efficiency with and without a loss."""
    rest = balance.power_out + balance.lost - power
    if not (balance.power_out > 0.0 and rest > 0.0):
        return f"The losses are wrong by {abs(power):.3g} W."
    return f"Without it the efficiency would be {balance.power_out / rest:.2%} instead of {balance.efficiency:.2%}."


def driving_loads(evidence: Evidence) -> Iterator[Finding]:
    """Loads that put power in, in a drive with a motor or a prescribed speed."""
    drive = evidence.drive
    motors = [pulley.prescribed or any(one.driven_speed for one in pulley.load) for pulley in drive.pulleys]
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
            "counter-clockwise and positive on one that turns clockwise.",
        )

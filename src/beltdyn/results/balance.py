"""Power balance of a drive over part of a run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from beltdyn.results.recorded import Recorded
from beltdyn.results.window import Window, plain_window

LOSSES: Mapping[str, str] = {
    "friction_loss": "friction",
    "damping_loss": "contact damping",
    "stretch_loss": "belt stretch",
    "bending_loss": "belt bending",
    "compression_loss": "belt compression",
    "tensioner_loss": "tensioners",
    "coupling_loss": "couplings",
    "numerical_loss": "time integration",
}
"""Recorded works of the losses, and their causes in words."""

_BEFORE = {"material_loss": "belt material"}
"""What stands in place of the losses of stretch and bending in files that do not tell them apart."""

STORED = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")
"""Recorded energies that the drive holds."""


@dataclass(frozen=True, slots=True)
class Balance:
    """Mean powers over a part of a run, W.

    Attributes
    ----------
    pulleys : tuple of float
        Power into the drive at each shaft, positive for a driving shaft.
    losses : dict of str to float
        Power lost, by cause, such as "friction".
    stored : float
        Rate of change of the stored energy: kinetic, strain, contact, spring and potential energy.

    Examples
    --------
    >>> balance = bd.derived.balance(run)
    >>> sorted(balance.losses)[:3]
    ['belt bending', 'belt compression', 'belt stretch']
    """

    pulleys: tuple[float, ...]
    losses: Mapping[str, float]
    stored: float

    @property
    def power_in(self) -> float:
        """Power input of the driving shafts."""
        return sum(power for power in self.pulleys if power > 0.0)

    @property
    def power_out(self) -> float:
        """Power output to the loads."""
        return -sum(power for power in self.pulleys if power < 0.0)

    @property
    def efficiency(self) -> float:
        """Power output over the sum of power output and losses; NaN without power input.

        In steady running this is power output over power input; stored and returned energy is not counted.
        """
        return self.power_out / (self.power_out + self.lost) if self.power_in > 0.0 else math.nan

    @property
    def lost(self) -> float:
        """Sum of the losses."""
        return sum(self.losses.values())


def losses_of(recorded: Recorded) -> Mapping[str, str]:
    """Give the recorded works of the losses, and their causes in words.

    Parameters
    ----------
    recorded : Recorded
        The results.
    """
    return {name: cause for name, cause in LOSSES.items() if name in recorded} | (
        {} if "bending_loss" in recorded else _BEFORE
    )


def power_balance(recorded: Recorded, window: Window | None = None) -> Balance:
    """Give mean powers over a window.

    Shaft powers are means over outputs; losses and stored power are differences of recorded integrals. With a single
    output all rates are zero.

    Parameters
    ----------
    recorded : Recorded
        The results.
    window : Window, optional
        The averaging window; by default from the first to the last output.

    Returns
    -------
    Balance
        The mean powers.

    Examples
    --------
    >>> with run.recorded() as recorded:
    ...     balance = bd.power_balance(recorded)
    >>> sorted(balance.losses)[:2]
    ['belt bending', 'belt compression']
    """
    window = plain_window(np.asarray(recorded["time"])) if window is None else window
    return Balance(
        pulleys=tuple(map(float, window.product(recorded, "shaft_torque", "shaft_speed"))),
        losses={cause: float(window.rate(recorded, name)) for name, cause in losses_of(recorded).items()},
        stored=sum(float(window.rate(recorded, name)) for name in STORED),
    )

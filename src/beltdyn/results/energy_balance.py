"""The energy account of a run: mean powers, losses by cause, and how far it closes."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared
from beltdyn.model.carrying import stretch_of
from beltdyn.results.cycles import Window, plain_window
from beltdyn.results.schema import Recorded

LOSSES: Mapping[str, str] = {
    "friction_loss": "friction",
    "damping_loss": "contact damping",
    "stretch_loss": "belt stretch",
    "bending_loss": "belt bending",
    "compression_loss": "belt compression",
    "tensioner_loss": "tensioners",
    "coupling_loss": "couplings",
    "carrying_loss": "supports and goods",
    "numerical_loss": "time integration",
}
"""Recorded works of the losses, and their causes in words."""

OF_TEETH = "teeth and compression"
"""Cause in words of `compression_loss` of belts with teeth: what these lose, store, and leave as they enter and leave
under load, which may be negative."""

_OF_GROOVES = "tooth_phases"
"""Attribute of the results of belts with teeth."""

WEB_LINE = "web_line"
"""Attribute of the results of web lines, whose works of loads include those of both ends."""

_BEFORE = {"material_loss": "belt material"}
"""The combined loss of stretch and bending in files of earlier formats."""

STORED = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")
"""Recorded energies that the drive holds."""


@dataclass(frozen=True, slots=True)
class Balance:
    """Mean powers over a part of a run, W.

    Examples
    --------
    >>> balance = bd.derived.balance(run)
    >>> sorted(balance.losses)[:3]
    ['belt bending', 'belt compression', 'belt stretch']
    """

    pulleys: tuple[float, ...]
    """Power into the drive at each shaft, positive for a driving shaft."""
    losses: Mapping[str, float]
    """Power lost, by cause, such as "friction"."""
    stored: float
    """Rate of change of the stored energy: kinetic, strain, contact, spring and potential energy."""
    web: float = 0.0
    """Power that comes in with the web of a line, less that which goes out with it."""
    lifted: float = 0.0
    """Power that lifts goods, which is useful; negative where goods that go down drive the belt."""

    @property
    def power_in(self) -> float:
        """Power input of driving shafts, of goods that go down, and of a web that brings more than it takes along."""
        return sum(power for power in (*self.pulleys, self.web, -self.lifted) if power > 0.0)

    @property
    def power_out(self) -> float:
        """Power output to the loads, to goods that are lifted, and to a web that takes more along than it brings."""
        return -sum(power for power in (*self.pulleys, self.web, -self.lifted) if power < 0.0)

    @property
    def efficiency(self) -> float:
        """Power output over the sum of power output and losses; NaN without either power, as of a level conveyor.

        In steady running this is power output over power input; stored and returned energy is not counted.
        """
        delivers = self.power_in > 0.0 and self.power_out > 0.0
        return self.power_out / (self.power_out + self.lost) if delivers else math.nan

    @property
    def lost(self) -> float:
        """Sum of the losses."""
        return sum(self.losses.values())


def losses_of(recorded: Recorded) -> Mapping[str, str]:
    """Give the recorded works of the losses, and their causes in words."""
    causes = causes_of(toothed=_OF_GROOVES in recorded.attrs)
    return {name: cause for name, cause in causes.items() if name in recorded} | (
        {} if "bending_loss" in recorded else _BEFORE
    )


def causes_of(*, toothed: bool) -> Mapping[str, str]:
    """Works of the losses and their causes in words, of belts with or without teeth."""
    return {**LOSSES, "compression_loss": OF_TEETH} if toothed else LOSSES


def lifting_power(recorded: Recorded, prepared: Prepared, window: Window) -> float:
    """Power that lifts the goods on spans, mean over a window, W; batches, whose place changes, count as losses.

    It is part of the recorded work on supports and goods.
    """
    whole = [one for one in prepared.goods if one.batch is None]
    if not whole:
        return 0.0
    path, speed = prepared.installation.path, window.mean(recorded, "belt_speed")
    uphill = -path.span_directions @ np.array(prepared.gravity)
    power, times = 0.0, np.asarray(recorded["time"])[window.first :]
    for one in whole:
        place = stretch_of(one, prepared.spans, path)
        share = 1.0 if one.schedule is None else float(np.mean(one.schedule.at(times)))
        power += share * one.mass_per_length * place.length * float(uphill[place.span] * speed[place.span])
    return power


def power_balance(recorded: Recorded, window: Window | None = None, lifted: float = 0.0) -> Balance:
    """Give mean powers over a window.

    Shaft powers are means over outputs; losses and stored power are differences of recorded integrals. With a single
    output all rates are zero.

    Parameters
    ----------
    recorded : Recorded
        The results.
    window : Window, optional
        The averaging window; by default from the first to the last output.
    lifted : float, default 0
        Power that lifts goods, W (`lifting_power`), which the work on supports and goods includes.

    Returns
    -------
    Balance
        The mean powers.

    Examples
    --------
    >>> with run.recorded() as recorded:
    ...     balance = bd.results.power_balance(recorded)
    >>> sorted(balance.losses)[:2]
    ['belt bending', 'belt compression']
    """
    window = plain_window(np.asarray(recorded["time"])) if window is None else window
    pulleys = tuple(map(float, window.product(recorded, "shaft_torque", "shaft_speed")))
    put_in = sum(float(window.rate(recorded, name)) for name in ("driver_work", "torque_work"))
    losses = {cause: float(window.rate(recorded, name)) for name, cause in losses_of(recorded).items()}
    if lifted:
        losses[LOSSES["carrying_loss"]] -= lifted
    return Balance(
        pulleys=pulleys,
        losses=losses,
        lifted=lifted,
        stored=sum(float(window.rate(recorded, name)) for name in STORED),
        web=put_in - sum(pulleys) if WEB_LINE in recorded.attrs else 0.0,
    )


# Largest energy balance error and numerical loss of a run


class Closure(NamedTuple):
    """Largest energy balance error of a run."""

    time: float
    """When, s."""
    error: float
    """Closure error at that time, over the energy put in by then."""


def largest_closure(recorded: Recorded) -> Closure:
    """Largest energy balance error over time."""
    return _largest(recorded, np.asarray(recorded["energy_closure"]))


def largest_numerical_share(recorded: Recorded) -> Closure:
    """Largest share of the energy input lost in time integration."""
    taken, given = np.asarray(recorded["numerical_loss"]), energy_put_in(recorded)
    shares = np.divide(taken, given, out=np.zeros_like(given), where=given > 0.0)
    return _largest(recorded, shares)


def _largest(recorded: Recorded, shares: FloatArray) -> Closure:
    """The share of largest magnitude, and its instant."""
    worst = int(np.argmax(np.abs(shares)))
    return Closure(float(recorded["time"][worst]), float(shares[worst]))


def energy_put_in(recorded: Recorded) -> FloatArray:
    """Energy put in up to each output, J: the energy stored at first, and the largest works of each kind by then.

    Works of drivers and torques, and of springs and weight, count either way.
    """

    def values(name: str) -> FloatArray:
        return np.asarray(recorded[name], dtype=np.float64)

    stored = sum(float(values(name)[0]) for name in ("kinetic_energy", "strain_energy", "penalty_energy"))
    kinds = ("driver_work", "torque_work", "spring_energy", "potential_energy")
    done = np.abs(np.stack([values(name) - values(name)[0] for name in kinds]))
    return np.asarray(stored + np.maximum.accumulate(done, axis=1).sum(axis=0))

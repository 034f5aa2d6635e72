"""What excites a drive in steady running: harmonics of speeds and loads, turns of pulleys, and turns of the belt."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.number_range import numbers_in
from beltdyn.results import Run
from beltdyn.solve.vibration.waves import torque_orders

RIM, SHAFT, BELT = "pulley_speed", "shaft_speed", "belt"
"""What turns: the rim of a pulley, its shaft behind the hub chain, or the belt."""
SPEED, LOAD, TURN = "speed", "load", "turn"
_SAME = 0.01
"""Frequencies that differ by this part or less are drawn as one line."""


class Excitation(NamedTuple):
    """Something that repeats itself with what turns."""

    name: str
    cause: str
    """What repeats itself: `SPEED` or `LOAD` of a shaft, or a `TURN`, of which the amplitude is not known."""
    order: float
    """Waves in a turn."""
    turning: str
    """What turns."""
    pulley: int = 0
    """Number of the pulley, unless it is the belt."""

    def frequency(self, run: Run) -> float:
        """Its frequency in steady running, Hz."""
        if self.turning == BELT:
            return self.order * abs(float(run.dataset.attrs["belt_parameter"])) / run.drive.belt_length
        return self.order * abs(float(run.dataset[self.turning][-1, self.pulley])) / (2.0 * np.pi)


def own_excitations(drive: Drive) -> list[Excitation]:
    """What a drive has that excites it: harmonics, then turns of pulleys, which may be out of true, and of the belt.

    Parameters
    ----------
    drive
        With constant speeds, torques and schedules.
    """
    found = list[Excitation]()
    for number, one in enumerate(drive.pulleys):
        found += [
            Excitation(f"speed of {one.name}, order {wave.order:g}", SPEED, wave.order, SHAFT, number)
            for wave in one.harmonics
        ]
        found += [
            Excitation(f"load of {one.name}, order {order:g}", LOAD, order, SHAFT, number)
            for load in one.load
            if load.schedule is None or load.schedule.at([0.0])[0] != 0.0
            for order in torque_orders(load)
        ]
    found += [Excitation(f"turn of {one.name}", TURN, 1.0, RIM, number) for number, one in enumerate(drive.pulleys)]
    return [*dict.fromkeys(found), Excitation("turn of the belt", TURN, 1.0, BELT)]


def given_excitations(orders: str, drive: Drive, number: int) -> list[Excitation]:
    """Orders of the rotation of a pulley that a user gives.

    Parameters
    ----------
    orders
        Such as "1, 2, 0.5".
    drive
        The drive.
    number
        Of the pulley.

    Raises
    ------
    ModelError
        If the text holds no numbers above zero.
    """
    name = drive.pulleys[number].name
    found = [] if ".." in orders else [float(one) for one in numbers_in("orders", orders, "", 2)]
    if not found or found[0] <= 0.0:
        raise ModelError(f'orders = {orders!r} must be positive numbers separated by commas, such as "0.5, 1, 2".')
    return [Excitation(f"order {order:g} of {name}", TURN, order, SHAFT, number) for order in found]


def one_line_each(excitations: Sequence[Excitation], frequencies: FloatArray) -> tuple[list[str], FloatArray]:
    """Names and frequencies of excitations, those of the same frequency together.

    Parameters
    ----------
    excitations
        k of them.
    frequencies : ndarray, shape (n, k)
        At n speeds, Hz; NaN where they are not known.

    Returns
    -------
    names : list of str
        Of j lines.
    frequencies : ndarray, shape (n, j)
        Of the first one of each line.
    """
    names, kept = list[list[str]](), list[int]()
    for number, one in enumerate(excitations):
        own = frequencies[:, number]
        same = [
            line
            for line, other in enumerate(kept)
            if np.nanmax(np.abs(own / frequencies[:, other] - 1.0), initial=0.0) <= _SAME
        ]
        if same:
            names[same[0]].append(one.name)
        else:
            names.append([one.name])
            kept.append(number)
    return ["; ".join(one) for one in names], frequencies[:, kept]

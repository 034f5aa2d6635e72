"""What excites a drive in steady running: harmonics of speeds and loads, turns of pulleys, and turns of the belt."""

from cmath import exp
from collections.abc import Sequence
from math import tau
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.machines import AngleSpeedTable, AngleTable, LoadTable
from beltdyn.machines.loads.load import Load
from beltdyn.model import Drive
from beltdyn.parts.quantity import Numbers, numbers_in
from beltdyn.results import Run

# Amplitudes of what excites a drive: waves in the speeds and torques of shafts over their angles

_SAMPLES = 256
"""Angles of a cycle at which a torque is looked at."""
_LEAST = 0.01
"""Waves below this part of the largest of a table are left out."""


def speed_waves(drive: Drive, pulley: int) -> dict[float, complex]:
    """Waves in the angle of a shaft of prescribed speed.

    The speed m (1 + a cos(k m t + phi)) makes the angle a / k sin(k m t + phi) beside m t.
    """
    found = dict[float, complex]()
    for wave in drive.counter_clockwise_pulleys[pulley].harmonics:
        amplitude = -1j * wave.amplitude / wave.order * exp(1j * wave.phase)
        found[wave.order] = found.get(wave.order, 0.0) + amplitude
    return found


def torque_waves(drive: Drive, pulley: int, speed: float) -> dict[float, complex]:
    """Waves in the torque of the loads of a shaft."""
    found = dict[float, complex]()
    for load in drive.counter_clockwise_pulleys[pulley].load:
        factor = 1.0 if load.schedule is None else float(load.schedule.at([0.0])[0])
        for order, amplitude in _waves_of(load, speed).items():
            if factor != 0.0:
                found[order] = found.get(order, 0.0) + factor * amplitude
    return found


def torque_orders(load: Load) -> list[float]:
    """Orders of the waves in the torque of a load, ascending."""
    speeds = load.speeds if isinstance(load, AngleSpeedTable) else (0.0,)
    return sorted({order for speed in speeds for order in _waves_of(load, speed)})


def averaged(drive: Drive) -> Drive:
    """A drive whose torques over the angle of shafts are replaced by their means."""
    if not any(isinstance(load, AngleTable | AngleSpeedTable) for one in drive.pulleys for load in one.load):
        return drive
    return drive.replace(pulley=[one.replace(load=[_averaged(load) for load in one.load]) for one in drive.pulleys])


def _waves_of(load: Load, speed: float) -> dict[float, complex]:
    """Order -> amplitude, N m, of a load without its schedule."""
    if not isinstance(load, AngleTable | AngleSpeedTable):
        mean = float(load.torque_over(np.zeros(1), speed)[0]) if load.harmonics else 0.0
        return {wave.order: mean * wave.amplitude * exp(1j * wave.phase) for wave in load.harmonics}
    angles = load.cycle * np.arange(_SAMPLES) / _SAMPLES
    spectrum: ComplexArray = 2.0 * np.fft.rfft(load.torque_over(angles, speed))[1 : _SAMPLES // 2] / _SAMPLES
    kept = np.flatnonzero(np.abs(spectrum) > _LEAST * np.abs(spectrum).max(initial=1e-300))
    return {float((number + 1) * tau / load.cycle): complex(spectrum[number]) for number in kept}


def _averaged(load: Load) -> Load:
    """A load over the angle as one over the speed alone."""
    if not isinstance(load, AngleTable | AngleSpeedTable):
        return load
    angles = load.cycle * np.arange(_SAMPLES) / _SAMPLES
    speeds = list(load.speeds) if isinstance(load, AngleSpeedTable) else [0.0, 1.0]
    torques = [float(load.torque_over(angles, speed).mean()) for speed in speeds]
    return LoadTable(kind="table", speeds=speeds, torques=torques, schedule=load.schedule)


RIM, SHAFT, BELT = "pulley_speed", "shaft_speed", "belt"
"""What turns: the rim of a pulley, its shaft behind the hub chain, or the belt."""
SPEED, LOAD, TURN = "speed", "load", "turn"
_SAME = 0.01
"""Frequencies that differ by this part or less are drawn as one line."""


class Excitation(NamedTuple):
    """Something that repeats itself with what turns."""

    name: str
    cause: str
    """The periodic quantity: `SPEED` or `LOAD` of a shaft, or a `TURN`, whose amplitude is unknown."""
    order: float
    """Waves in a turn."""
    turning: str
    """What turns."""
    pulley: int = 0
    """Number of the pulley, unless it is the belt."""

    def frequency(self, run: Run) -> float:
        """Its frequency in steady running, Hz."""
        if self.turning == BELT:
            return self.order * abs(float(run.dataset.attrs["belt_parameter"])) / run.prepared.belt_length
        return self.order * abs(float(run.dataset[self.turning][-1, self.pulley])) / (2.0 * np.pi)


def own_excitations(drive: Drive) -> list[Excitation]:
    """What a drive has that excites it: harmonics, then turns of pulleys, which may be out of true, and of the belt."""
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
    found += [
        Excitation(f"turn of {one.name}", TURN, 1.0, RIM, number)
        for number, (one, stands) in enumerate(zip(drive.pulleys, drive.guides, strict=True))
        if not stands
    ]
    if not drive.ends:
        found.append(Excitation("turn of the belt", TURN, 1.0, BELT))
    return list(dict.fromkeys(found))


def given_excitations(orders: Numbers, drive: Drive, number: int) -> list[Excitation]:
    """Orders of the rotation of a pulley that a user gives."""
    name = drive.pulleys[number].name
    ranged = isinstance(orders, str) and ".." in orders
    found = [] if ranged else numbers_in("orders", orders, "", 2).tolist()
    if not found or found[0] <= 0.0:
        raise ModelError(f'orders = {orders!r} must be positive numbers separated by commas, such as "0.5, 1, 2".')
    return [Excitation(f"order {order:g} of {name}", TURN, order, SHAFT, number) for order in found]


def one_line_each(excitations: Sequence[Excitation], frequencies: FloatArray) -> tuple[list[str], FloatArray]:
    """Names and frequencies of excitations, merged where frequencies are equal, shape (n speeds, lines), Hz."""
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

"""Amplitudes of what excites a drive: waves in the speeds and torques of shafts over their angles."""

from cmath import exp
from math import tau

import numpy as np

from beltdyn.arrays import ComplexArray
from beltdyn.machines import AngleSpeedTable, AngleTable, LoadTable
from beltdyn.machines.loads.load import Load
from beltdyn.model import Drive

_SAMPLES = 256
"""Angles of a cycle at which a torque is looked at."""
_LEAST = 0.01
"""Waves below this part of the largest of a table are left out."""


def speed_waves(drive: Drive, pulley: int) -> dict[float, complex]:
    """Waves in the angle of a shaft of prescribed speed.

    The speed m (1 + a cos(k m t + phi)) makes the angle a / k sin(k m t + phi) beside m t.

    Parameters
    ----------
    drive
        The drive.
    pulley
        Number of the pulley.

    Returns
    -------
    dict
        Order k -> amplitude of exp(i k theta), rad.
    """
    found = dict[float, complex]()
    for wave in drive.pulleys[pulley].harmonics:
        amplitude = -1j * wave.amplitude / wave.order * exp(1j * wave.phase)
        found[wave.order] = found.get(wave.order, 0.0) + amplitude
    return found


def torque_waves(drive: Drive, pulley: int, speed: float) -> dict[float, complex]:
    """Waves in the torque of the loads of a shaft.

    Parameters
    ----------
    drive
        With constant schedules.
    pulley
        Number of the pulley.
    speed
        Of the shaft, rad/s.

    Returns
    -------
    dict
        Order k -> amplitude of exp(i k theta), N m.
    """
    found = dict[float, complex]()
    for load in drive.pulleys[pulley].load:
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
    """A drive whose torques over the angle of shafts are replaced by their means.

    Parameters
    ----------
    drive
        The drive.
    """
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

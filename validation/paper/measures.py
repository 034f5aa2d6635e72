"""What the sections read from runs."""

import numpy as np
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.results import Run

DRIVER, DRIVEN = 0, 1
RAMP_START, RAMP_END = 0.05, 0.6
"""When the driver's speed rises, s (Eq. 28)."""

LAG_START = 0.3
"""When the first swings of the ramp have died down, s."""

SETTLED = 0.2
"""Length of the window at the end of a run over which means are taken, s."""


def times(run: Run) -> FloatArray:
    """Instants of the outputs, s."""
    return np.asarray(run.dataset["time"], dtype=float)


def speed(run: Run, pulley: int = DRIVEN) -> FloatArray:
    """Speed of a pulley over time, rad/s."""
    return np.asarray(run.dataset["pulley_speed"], dtype=float)[:, pulley]


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def largest(values: FloatArray) -> float:
    """Largest magnitude."""
    return float(np.max(np.abs(values)))


def settled(run: Run, name: str) -> xr.DataArray:
    """A variable over the end of a run."""
    variable = run.dataset[name]
    instants = variable[variable.dims[0]].values
    return variable[instants > instants[-1] - SETTLED]


def settled_mean(run: Run, name: str, pulley: int = DRIVEN) -> float:
    """Mean of a pulley's or span's variable over the end of a run."""
    return float(settled(run, name)[:, pulley].mean())


def ripple(run: Run) -> FloatArray:
    """Driven speed less driver speed after the ramp, rad/s."""
    return (speed(run, DRIVEN) - speed(run, DRIVER))[times(run) >= RAMP_END]


def ripple_frequency(run: Run, crossings: int = 6) -> float:
    """Frequency of the ripple from its first crossings of the driver's speed after the ramp, Hz.

    Crossings are found between outputs by linear interpolation; NaN where there are too few.

    Parameters
    ----------
    run : Run
        The run.
    crossings : int
        How many of them.
    """
    swing, after = ripple(run), times(run)[times(run) >= RAMP_END]
    (before,) = np.nonzero(np.diff(np.signbit(swing).astype(int)))
    if before.size < crossings:
        return float("nan")
    part = swing[before] / (swing[before] - swing[before + 1])
    at = after[before] + part * (after[before + 1] - after[before])
    return float(0.5 / np.mean(np.diff(at[:crossings])))


def lag(run: Run) -> FloatArray:
    """Driver speed less driven speed within the ramp, from `LAG_START` on, rad/s."""
    inside = (times(run) > LAG_START) & (times(run) < RAMP_END)
    return (speed(run, DRIVER) - speed(run, DRIVEN))[inside]

"""Transmission error of toothed drives, and spectra over the orders of a pulley."""

from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from beltdyn.errors import ModelError
from beltdyn.results.derived.labels import labelled, pulley_number, window
from beltdyn.results.derived.spectrum import amplitude_spectrum, instants_of
from beltdyn.results.run import Run

_FEWEST_TURNS = 2


def transmission_error(
    run: Run, reference: str | int | None = None, start: float | None = None, end: float | None = None
) -> xr.DataArray:
    """Way at the pitch line by which each toothed pulley is ahead of where the ratio of the teeth has it.

    Parameters
    ----------
    run : Run
        A run of a belt with teeth.
    reference : str or int, optional
        Name or number of the pulley from whose angle others are expected; by default the driver, or the first pulley
        with teeth.
    start, end : float, optional
        Time range, s; the error is zero at its first output.

    Returns
    -------
    DataArray
        m, time and pulley with teeth: (z theta - z_r theta_r) p / 2 pi, less its first value, positive in the sense of
        ascending belt coordinate; z teeth, theta angle, p pitch.

    Raises
    ------
    ModelError
        If the belt has no teeth, or the reference has none.

    Examples
    --------
    >>> bd.derived.transmission_error(run)
    Traceback (most recent call last):
    beltdyn.errors.ModelError: the belt has no teeth, which a transmission error needs. Use a run of a toothed belt.
    """
    toothing, pulleys = run.prepared.belt.toothing, run.prepared.pulleys
    held = np.flatnonzero(run.prepared.toothed).tolist()
    if toothing is None or not held:
        raise ModelError("the belt has no teeth, which a transmission error needs. Use a run of a toothed belt.")
    usual = run.drive.reference if run.drive.reference in held else held[0]
    first = usual if reference is None else pulley_number(run, reference)
    if first not in held:
        raise ModelError(
            f"{pulleys[first].name} has no teeth. Choose a reference of {', '.join(pulleys[one].name for one in held)}."
        )
    angle = window(run, start, end)["pulley_angle"]
    teeth = np.array([float(pulley.teeth or 0) for pulley in pulleys])
    passed = teeth * angle.values * toothing.pitch / (2.0 * np.pi)
    ahead = passed[:, held] - passed[:, first : first + 1]
    return labelled(ahead - ahead[:1], angle[:, held], "m", "Transmission error")


def order_spectrum(values: xr.DataArray, angle: xr.DataArray, window: str = "hann") -> xr.DataArray:
    """Amplitudes of a variable over the orders of a pulley, cycles per turn, in a run at any speed that keeps its sign.

    The variable is laid out by cubic splines in equal steps of the angle, over whole turns.

    Parameters
    ----------
    values : DataArray
        A variable whose first dimension is time.
    angle : DataArray
        Angle of the pulley over the same time, rad.
    window : str
        Name of a window of `scipy.signal.get_window`; "boxcar" keeps the orders of whole turns apart.

    Returns
    -------
    DataArray
        In the unit of the variable, with ``order`` in the place of time; see `amplitude_spectrum`.

    Raises
    ------
    ModelError
        If the pulley makes less than two turns, or turns back.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> time = np.linspace(0.0, 1.0, 2001)  # s
    >>> angle = xr.DataArray(40.0 * np.pi * time, {"time": time}, "time")
    >>> error = (2e-6 * np.cos(24.0 * angle)).assign_attrs(units="m", long_name="Transmission error")
    >>> found = bd.derived.order_spectrum(error, angle)
    >>> found.sel(order=24.0, method="nearest").round(8).item()  # m
    2e-06
    """
    instants = instants_of(values)
    turns = np.abs(np.interp(instants, angle["time"].values, angle.values - angle.values[0])) / (2.0 * np.pi)
    whole = np.floor(turns[-1] - turns[0] + 1e-9)
    if whole < _FEWEST_TURNS or np.any(np.diff(turns) <= 0.0):
        raise ModelError(
            f"the pulley makes {turns[-1] - turns[0]:.3g} turns without turning back; an order spectrum needs "
            f"{_FEWEST_TURNS} or more. Make the run longer, or select a part of it."
        )
    each = int(np.ceil((len(instants) - 1) / (turns[-1] - turns[0])))
    steps = turns[0] + np.arange(int(whole) * each) / each
    laid = CubicSpline(turns, values.values, axis=0)(np.minimum(steps, turns[-1]))
    coordinates: dict[Any, Any] = {name: values[name] for name in values.dims[1:] if name in values.coords}
    even = xr.DataArray(laid, {**coordinates, "turn": steps}, ("turn", *values.dims[1:]), attrs=values.attrs)
    found = amplitude_spectrum(even, window).rename(frequency="order")
    found["order"] = found["order"].assign_attrs(units="1", long_name="Order")
    return found

"""Means over a turn of the first pulley, in which what repeats in every turn drops out."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from beltdyn.results.run import Run

FloatArray = NDArray[np.float64]


def turn_means(run: Run, variable: xr.DataArray) -> xr.DataArray:
    """Average a variable over the turn of the first pulley around every instant.

    Parameters
    ----------
    run : Run
        The run.
    variable : DataArray
        A variable over time (first dimension) and one more, at outputs of this run.

    Returns
    -------
    DataArray
        The same variable averaged, over what there is of a turn at both ends; NaN where a value in it is NaN.
    """
    time = variable["time"].values
    speed = np.abs(run.dataset["pulley_speed"].sel(time=time).values[:, :1])
    turned = _integral(speed, time)[:, 0]
    starts, ends = (np.interp(turned + half, turned, time) for half in (-np.pi, np.pi))
    unknown = ~np.isfinite(variable.values)
    values = np.where(unknown, 0.0, variable.values)
    total, missing = (
        np.column_stack([np.interp(ends, time, column) - np.interp(starts, time, column) for column in integral.T])
        for integral in (_integral(values, time), _integral(unknown.astype(float), time))
    )
    known = (missing <= 0.0) & (ends > starts)[:, None]
    return variable.copy(data=np.divide(total, (ends - starts)[:, None], out=np.full(total.shape, np.nan), where=known))


def _integral(values: FloatArray, time: FloatArray) -> FloatArray:
    """Integral of columns over time up to each output, by trapezoids."""
    areas = 0.5 * (values[1:] + values[:-1]) * np.diff(time)[:, None]
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(areas, axis=0)])

"""Span tensions and mid-span displacements."""

import xarray as xr

from beltdyn.results.derived.labels import window
from beltdyn.results.run import Run


def span_tensions(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Mean, minimum and maximum tension of every span.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    xarray.Dataset
        ``mean``, ``min`` and ``max``, N, by span.

    Examples
    --------
    >>> bd.derived.span_tensions(run, end=0.0)["mean"].values.round(2)  # N, at rest
    array([28.19, 28.19])
    """
    tension = window(run, start, end)["span_tension"]
    numbers = {
        "mean": (tension.mean("time"), "Mean span tension"),
        "min": (tension.min("time"), "Minimum span tension"),
        "max": (tension.max("time"), "Maximum span tension"),
    }
    return xr.Dataset(
        {name: value.assign_attrs(units="N", long_name=meaning) for name, (value, meaning) in numbers.items()}
    )


def mid_span_displacements(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Mid-span displacement of every span.

    The straight line between the tangent points of the two pulleys, where these are at the instant, is zero; the
    belt's place is interpolated between the points of contact of the free belt before and after the middle. Since the
    belt sinks into pulleys, it is a little off zero even at rest.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    DataArray
        m, time and span, positive to the left of the direction of ascending belt coordinate: inwards on a drive
        without crossings; NaN where the belt has left a pulley.

    Raises
    ------
    ModelError
        If it was not recorded.

    Examples
    --------
    >>> bd.derived.mid_span_displacements(run).dims
    ('time', 'span')
    """
    run.require("mid_span_displacement")
    return window(run, start, end)["mid_span_displacement"]

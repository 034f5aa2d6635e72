"""Pulley loads over time: hub load, capstan margin and tension ratio."""

import numpy as np
import xarray as xr

from beltdyn.results.derived.labels import labelled, window
from beltdyn.results.mechanics import across
from beltdyn.results.run import Run
from beltdyn.results.slip_margin import capstan_margin


def hub_loads(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Hub load of every pulley as vector, magnitude and direction.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    xarray.Dataset
        ``hub_force`` (time, pulley, axis) and ``hub_load``, its magnitude, in N; ``hub_direction``, its direction
        from the x axis, counter-clockwise from -pi to pi, rad.

    Examples
    --------
    >>> bd.derived.hub_loads(run)["hub_load"][0].values.round(2)  # N, at rest
    array([69.39, 69.39])
    """
    force = window(run, start, end)["hub_force"]
    x, y = force.sel(axis="x", drop=True), force.sel(axis="y", drop=True)
    return xr.Dataset(
        {
            "hub_force": force,
            "hub_load": labelled(np.hypot(x.values, y.values), x, "N", "Hub load"),
            "hub_direction": labelled(np.arctan2(y.values, x.values), x, "rad", "Hub load direction"),
        }
    )


def capstan_margins(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Capstan margin: the factor on all loads at which each pulley reaches gross slip, at each instant.

    See `beltdyn.results.slip_margin.capstan_margin`: 1 at the edge of gross slip, NaN without load.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    DataArray
        Time and pulley; NaN where a span is missing because the belt has left a pulley.

    Examples
    --------
    >>> bd.derived.capstan_margins(run).dims
    ('time', 'pulley')
    """
    dataset = window(run, start, end)
    tension, speed, centers = (dataset[name].values for name in ("span_tension", "belt_speed", "pulley_center"))
    return labelled(capstan_margin(tension, speed, centers, run.drive), dataset["wrap_angle"], "1", "Capstan margin")


def tension_ratios(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Tension ratio at every pulley: the larger over the smaller tension of its two spans.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    DataArray
        Time and pulley, at least 1; NaN where a span is slack.

    Examples
    --------
    >>> bd.derived.tension_ratios(run)[0].values.round(3)  # at rest
    array([1., 1.])
    """
    dataset = window(run, start, end)
    before, after = across(dataset["span_tension"].values, run.drive)
    tight, slack = np.maximum(before, after), np.minimum(before, after)
    ratio = np.divide(tight, slack, out=np.full_like(slack, np.nan), where=slack > 0.0)
    return labelled(ratio, dataset["wrap_angle"], "1", "Tension ratio")

"""A variable over time of one pulley, span or tensioner, in the unit of run-up figures."""

import numpy as np
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.parts.quantity import SHOWN_UNITS
from beltdyn.results import Run

HUB_LOAD = "hub_load"
"""Magnitude of the hub force."""

_SHOWN = {**SHOWN_UNITS, "m": ("mm", 1e3)}
"""Unit of a variable -> the one that is shown, and the factor on its numbers."""


def names_of(run: Run, variable: str) -> list[str]:
    """Give the names of what a variable over time is recorded for.

    Parameters
    ----------
    run : Run
        The run.
    variable : str
        Its name, or "hub_load".

    Returns
    -------
    list of str
        Of pulleys, spans or tensioners.

    Raises
    ------
    ModelError
        If there is no such variable.
    """
    known = {
        str(name): str(values.dims[1])
        for name, values in run.dataset.data_vars.items()
        if values.ndim == 2 and values.dims[0] == "time" and values.dims[1] in run.dataset.coords
    }
    if "hub_force" in run.dataset:
        known[HUB_LOAD] = "pulley"
    if variable not in known:
        raise ModelError(f"variable = {variable!r} is not a variable over time. Choose from: {', '.join(known)}.")
    return [str(name) for name in run.dataset[known[variable]].values]


def series(run: Run, variable: str, of: str | int) -> xr.DataArray:
    """One variable over time, filtered if it was recorded so.

    Parameters
    ----------
    run : Run
        The run.
    variable : str
        Its name, or "hub_load", the magnitude of the hub force.
    of : str or int
        Name or number of the pulley, span or tensioner.

    Returns
    -------
    DataArray
        Speeds in rpm, displacements in mm, angles in degrees, others in the unit of the dataset. Its attribute ``of``
        is the name of what it belongs to.

    Raises
    ------
    ModelError
        If there is no such variable, or nothing of that name; or the run holds no output.
    """
    run.require_output()
    names = names_of(run, variable)
    if of in names:
        of = names.index(str(of))
    if not isinstance(of, int) or not 0 <= of < len(names):
        raise ModelError(f"of = {of!r} is not in this drive. Choose one of {', '.join(names)}.")
    recorded = "hub_force" if variable == HUB_LOAD else variable
    filtered = f"filtered_{recorded}"
    values = run.dataset[filtered if filtered in run.dataset else recorded][:, of]
    unit = str(values.attrs["units"])
    if variable == HUB_LOAD:
        attributes = values.attrs | {"long_name": "Hub load"}
        values = values.isel(axis=0, drop=True).copy(data=np.hypot(*values.values.T)).assign_attrs(attributes)
    if variable.startswith("tensioner_"):
        unit = unit.split(", ")[run.drive.moving_tensioners[of].turns]
    shown, factor = _SHOWN.get(unit, (unit, 1.0))
    scaled: xr.DataArray = factor * values
    return scaled.assign_attrs(values.attrs | {"units": shown, "of": names[of]})

"""One instant of a run."""

import xarray as xr

from beltdyn.results import Run


def at(run: Run, time: float | None) -> xr.Dataset:
    """Take the output nearest to an instant.

    Parameters
    ----------
    run : Run
        The run.
    time : float or None
        The instant, s; None for the last output.

    Returns
    -------
    xarray.Dataset
        The dataset without the dimension ``time``.

    Raises
    ------
    ModelError
        If the run holds no output.
    """
    run.require_output()
    if time is None:
        return run.dataset.isel(time=-1)
    return run.dataset.sel(time=time, method="nearest")

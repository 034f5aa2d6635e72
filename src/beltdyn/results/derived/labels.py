"""Names and units of what is derived from a dataset."""

from typing import Any

import xarray as xr
from numpy.typing import NDArray

from beltdyn.errors import ModelError
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.schema import TIMES


def labelled(values: NDArray[Any], like: xr.DataArray, units: str, long_name: str) -> xr.DataArray:
    """Give an array the dimensions and coordinates of another one, and its own unit and name."""
    return like.copy(data=values).assign_attrs(units=units, long_name=long_name)


def window(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Take the outputs from one instant to another, both included, and those of fields between them."""
    run.require_output()
    dataset = run.dataset.sel({name: slice(start, end) for name in TIMES})
    if dataset.sizes["time"] == 0:
        times = run.dataset["time"].values
        raise ModelError(
            f"there is no output from {in_words(start, end)}; the run was recorded from {times[0]:g} to "
            f"{times[-1]:g} s. Choose a time range between these."
        )
    return dataset


def in_words(start: float | None, end: float | None) -> str:
    """A time range whose ends may be open."""
    first = "the start" if start is None else f"{start:g} s"
    return f"{first} to the end" if end is None else f"{first} to {end:g} s"


def pulley_number(run: Result, pulley: str | int) -> int:
    """Give the number of a pulley.

    Parameters
    ----------
    run : Result
        What was computed of a drive.
    pulley : str or int
        Its name or number.

    Raises
    ------
    ModelError
        If there is no such pulley.

    Examples
    --------
    >>> bd.derived.pulley_number(run, "driven")
    1
    """
    if isinstance(pulley, int) and 0 <= pulley < len(run.drive.pulleys):
        return pulley
    return run.drive.number_of(pulley)

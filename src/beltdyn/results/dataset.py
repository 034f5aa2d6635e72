"""The labelled dataset of a run, from arrays in memory or lazily from its file."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from beltdyn.errors import ModelError
from beltdyn.results.layout import Layout
from beltdyn.results.schema import AXIS_NAMES, COORDINATES, DERIVED, OPTIONAL, TIMES, VARIABLES

if TYPE_CHECKING:
    import xarray as xr

_OURS = ("drive", "status")
"""Global attributes that every result has."""


def build_dataset(layout: Layout, arrays: Mapping[str, NDArray[Any]], attributes: Mapping[str, Any]) -> "xr.Dataset":
    """Label arrays with their dimensions, coordinates and units.

    Parameters
    ----------
    layout : Layout
        Names and reference coordinates.
    arrays : mapping
        An array for every name in `Layout.recorded`, each with one row for each instant.
    attributes : mapping
        Global attributes.

    Returns
    -------
    xarray.Dataset
        The dataset.
    """
    import xarray as xr

    coordinates = layout.coordinates | {name: arrays[name] for name in TIMES}
    variables = {name: variable for name, variable in layout.recorded.items() if name in VARIABLES}
    dataset = xr.Dataset(
        {name: (variable.dims, arrays[name], variable.attributes) for name, variable in variables.items()},
        {name: (COORDINATES[name].dims, coordinates[name], COORDINATES[name].attributes) for name in coordinates},
        dict(attributes),
    )
    return _with_parts(dataset)


def open_dataset(path: Path) -> "xr.Dataset":
    """Open a result file; values are read when they are used.

    Parameters
    ----------
    path : Path
        A file written by `FileRecorder`, finished or not.

    Returns
    -------
    xarray.Dataset
        Its complete outputs.

    Raises
    ------
    ModelError
        If the file cannot be read or is not a result of beltdyn.
    """
    import xarray as xr

    try:
        dataset = xr.open_dataset(path, engine="h5netcdf", decode_times=False)
    except (OSError, ValueError, KeyError) as error:
        raise ModelError(f"{path} cannot be read as a result file: {error}.") from error
    known = {name: variable for name, variable in (COORDINATES | VARIABLES).items() if name not in DERIVED}
    needed = [name for name in known if OPTIONAL.isdisjoint(known[name].dims) or not OPTIONAL.isdisjoint(dataset.dims)]
    missing = [name for name in needed if name not in dataset.variables]
    missing += [name for name in _OURS if name not in dataset.attrs]
    if missing:
        dataset.close()
        if "drive" in dataset.attrs and "status" in dataset.attrs:
            raise ModelError(
                f"{path} was written by another version of beltdyn: it holds no `{missing[0]}`. Run the drive again; "
                "its file is the attribute `drive`."
            )
        raise ModelError(
            f"{path} is not a result of beltdyn: it holds no `{missing[0]}`. Give a file written by `beltdyn run`."
        )
    times = dataset["time"].values
    complete = int(np.count_nonzero(np.isfinite(times)))
    last = times[complete - 1] if complete else -np.inf
    result = _with_parts(dataset.isel({name: slice(np.count_nonzero(dataset[name].values <= last)) for name in TIMES}))
    result.set_close(dataset.close)
    return result


def _with_parts(dataset: "xr.Dataset") -> "xr.Dataset":
    """Add the variables that are parts of others."""
    places = dataset["nodal_coordinates"].isel(coordinate=slice(len(AXIS_NAMES))).drop_vars("coordinate")
    places = places.rename(coordinate="axis").assign_coords(axis=dataset["axis"])
    return dataset.assign(node_position=places.assign_attrs(VARIABLES["node_position"].attributes))


def is_result(path: Path) -> bool:
    """Tell whether a file is a result of beltdyn.

    Parameters
    ----------
    path : Path
        A regular file.

    Returns
    -------
    bool
        False too if it cannot be read.
    """
    try:
        with h5py.File(path, "r") as file:
            return all(name in file.attrs for name in _OURS)
    except (OSError, RuntimeError, ValueError, KeyError):
        return False


def checked_chunk(layout: Layout, chunk: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Check names and shapes of a chunk of outputs.

    Parameters
    ----------
    layout : Layout
        Sizes of the dimensions.
    chunk : mapping
        An array for every name in `Layout.recorded`, each with one row for each new output or output of fields.

    Returns
    -------
    dict
        The same arrays in the schema's types and order.

    Raises
    ------
    ValueError
        If a name is missing or unknown, or a shape is wrong.
    """
    recorded = layout.recorded
    if chunk.keys() != recorded.keys():
        names = sorted(chunk.keys() ^ recorded.keys())
        raise ValueError(f"missing or unknown variables in a chunk of outputs: {', '.join(names)}")
    arrays = {name: np.asarray(chunk[name], dtype=variable.dtype) for name, variable in recorded.items()}
    for name, array in arrays.items():
        expected = layout.shape(recorded[name], len(chunk[recorded[name].dims[0]]))
        if array.shape != expected:
            raise ValueError(f"{name} has shape {array.shape}, expected {expected}")
    return arrays

"""The labeled dataset of a run, from arrays in memory or lazily from its file."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from beltdyn.analyses import RUN
from beltdyn.errors import ModelError
from beltdyn.results.atomic import unreadable
from beltdyn.results.layout import Layout
from beltdyn.results.schema import (
    AXIS_NAMES,
    COORDINATES,
    DERIVED,
    FORMAT,
    OPTIONAL,
    SUBSTITUTES,
    TIMES,
    VARIABLES,
    Variable,
)
from beltdyn.results.staged_file import DamageError, is_marked, verify

if TYPE_CHECKING:
    import xarray as xr

_OURS = ("drive", "status")
"""Global attributes that every result has."""


def build_dataset(layout: Layout, arrays: Mapping[str, NDArray[Any]], attributes: Mapping[str, Any]) -> "xr.Dataset":
    """Label arrays with their dimensions, coordinates and units."""
    import xarray as xr

    coordinates = layout.coordinates | {name: arrays[name] for name in TIMES}
    variables = {name: variable for name, variable in layout.recorded.items() if name in VARIABLES}
    own = {name: (variable.dims, arrays[name], variable.attributes) for name, variable in variables.items()}
    position = VARIABLES["node_position"]
    places = arrays["nodal_coordinates"][..., : len(AXIS_NAMES)]
    return xr.Dataset(
        own | {"node_position": (position.dims, places, position.attributes)},
        {name: (COORDINATES[name].dims, coordinates[name], COORDINATES[name].attributes) for name in coordinates},
        dict(attributes),
    )


def open_dataset(path: Path) -> "xr.Dataset":
    """Open the result file of a run lazily."""
    return complete_dataset(path, read_dataset(path))


def complete_dataset(path: Path, dataset: "xr.Dataset") -> "xr.Dataset":
    """The complete outputs of an open result file of a run."""
    try:
        _check_names(path, dataset)
        return _complete(dataset)
    except ModelError:
        dataset.close()
        raise
    except Exception as error:  # see read_dataset
        dataset.close()
        raise ModelError(unreadable(path, error)) from error


def read_dataset(path: Path) -> "xr.Dataset":
    """Open a result file of any kind lazily."""
    from beltdyn.results.stored_values import open_values

    try:
        require_intact(path)
        dataset = open_values(path)
    except Exception as error:  # readers of HDF5 raise many unrelated types where bytes are wrong
        raise ModelError(unreadable(path, error)) from error
    try:
        _check_attributes(path, dataset)
        return dataset
    except ModelError:
        dataset.close()
        raise
    except Exception as error:
        dataset.close()
        raise ModelError(unreadable(path, error)) from error


def require_intact(path: Path) -> None:
    """Check that a result file is undamaged."""
    verified = verify(path)
    with h5py.File(path, "r") as file:  # h5netcdf complains on standard error where HDF5 cannot open a file
        if not verified and is_marked(file):
            raise DamageError(
                "its checksums are missing: the end of the file is damaged, or another program has modified it (a copy "
                "written by xarray can be read)"
            )


def kind_of(dataset: "xr.Dataset") -> str:
    """Kind of a result: the name of the analysis. The first files, all of runs, have none."""
    return str(dataset.attrs.get("kind", RUN))


def _check_attributes(path: Path, dataset: "xr.Dataset") -> None:
    """Check that a file is a result in a known format; the first files have no format."""
    missing = [name for name in _OURS if name not in dataset.attrs]
    if missing:
        raise ModelError(
            f"{path} is not a beltdyn result: it has no `{missing[0]}`. Give a file written by `beltdyn simulate`."
        )
    for name in _OURS:
        if not isinstance(dataset.attrs[name], str):
            raise ValueError(f"`{name}` is not a text")
    ours, given = ".".join(map(str, FORMAT)), str(dataset.attrs.get("format", "1.0"))
    if int(given.split(".")[0]) > FORMAT[0]:
        raise ModelError(
            f"{path} has format {given}, written by beltdyn {dataset.attrs.get('beltdyn_version')}; this version reads "
            f"formats up to {ours}. Install a newer beltdyn."
        )


def _check_names(path: Path, dataset: "xr.Dataset") -> None:
    """Check that a file holds the core variables of a run, with the expected dimensions and types.

    Unknown variables are left as they are.
    """
    if kind_of(dataset) != RUN:
        raise ModelError(
            f"{path} is the result of another analysis ({kind_of(dataset)}) and has no outputs over time. "
            "Open it with `bd.open_result`, or draw it with `beltdyn plot`."
        )
    known = {name: variable for name, variable in (COORDINATES | VARIABLES).items() if name not in DERIVED}
    missing = [name for name in known if _is_needed(known[name], dataset) and name not in dataset.variables]
    if missing:
        raise ModelError(
            f"{path} is incomplete: it has no `{missing[0]}`. Run the drive again; the drive file is stored in the "
            "attribute `drive`."
        )
    for name in known.keys() & dataset.variables.keys():
        variable, dtype = dataset[name], known[name].dtype
        if variable.dims != known[name].dims or (dtype != "str" and variable.dtype.kind != np.dtype(dtype).kind):
            raise ValueError(f"`{name}` has unexpected dimensions or type")


def _is_needed(variable: Variable, dataset: "xr.Dataset") -> bool:
    """Whether a variable is part of the core, and of what a drive with or without tensioners and single teeth has."""
    return variable.core and OPTIONAL.intersection(variable.dims) <= set(dataset.dims)


def _complete(dataset: "xr.Dataset") -> "xr.Dataset":
    """The complete outputs of a file."""
    times = dataset["time"].values
    complete = int(np.count_nonzero(np.isfinite(times)))
    last = times[complete - 1] if complete else -np.inf
    result = _with_parts(dataset.isel({name: slice(np.count_nonzero(dataset[name].values <= last)) for name in TIMES}))
    for name in TIMES:
        if not np.all(np.diff(result[name].values) > 0.0):
            raise ValueError(f"the instants of `{name}` do not increase")
    result.set_close(dataset.close)
    return result


def _with_parts(dataset: "xr.Dataset") -> "xr.Dataset":
    """Add the variables that are parts of others, and those that files of earlier formats lack."""
    places = dataset["nodal_coordinates"].isel(coordinate=slice(len(AXIS_NAMES))).drop_vars("coordinate")
    places = places.rename(coordinate="axis").assign_coords(axis=dataset["axis"])
    parts = {"node_position": places} | {
        name: dataset[other] for name, other in SUBSTITUTES.items() if name not in dataset and other in dataset
    }
    return dataset.assign({name: one.assign_attrs(VARIABLES[name].attributes) for name, one in parts.items()})


def is_result(path: Path) -> bool:
    """Tell whether a file is a result of beltdyn."""
    try:
        if not path.is_file():
            return False
        with h5py.File(path, "r") as file:
            return all(name in file.attrs for name in _OURS)
    except Exception:  # see open_dataset
        return False


def checked_outputs(layout: Layout, outputs: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Check names and shapes of outputs."""
    recorded = layout.recorded
    if outputs.keys() != recorded.keys():
        names = sorted(outputs.keys() ^ recorded.keys())
        raise ValueError(f"missing or unknown variables in outputs: {', '.join(names)}")
    arrays = {name: np.asarray(outputs[name], dtype=variable.dtype) for name, variable in recorded.items()}
    for name, array in arrays.items():
        expected = layout.shape(recorded[name], len(outputs[recorded[name].dims[0]]))
        if array.shape != expected:
            raise ValueError(f"{name} has shape {array.shape}, expected {expected}")
    return arrays

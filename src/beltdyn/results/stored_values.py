"""Values in a result file, read on use; errors name the file."""

from pathlib import Path
from typing import Any

import xarray as xr
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core.indexing import IndexingSupport, LazilyIndexedArray, explicit_indexing_adapter

from beltdyn.errors import ModelError
from beltdyn.results.atomic import unreadable


def open_values(path: Path) -> xr.Dataset:
    """Open a file of HDF5; values that cannot be read later raise a `ModelError`."""
    return xr.open_dataset(path, engine=_ResultFile, decode_times=False)


class _ResultFile(BackendEntrypoint):
    """A file whose values are `_Values`, as xarray's guide on new backends describes."""

    open_dataset_parameters = ("filename_or_obj", "drop_variables", "decode_times")

    def open_dataset(self, filename_or_obj: Any, *, drop_variables: Any = None, decode_times: bool = False) -> Any:
        path = Path(filename_or_obj)
        stored = xr.open_dataset(
            path, engine="h5netcdf", cache=False, drop_variables=drop_variables, decode_times=decode_times
        )
        guarded = {
            name: xr.Variable(
                variable.dims, LazilyIndexedArray(_Values(variable, path)), variable.attrs, variable.encoding
            )
            for name, variable in stored.variables.items()
            if name not in stored.xindexes
        }
        dataset = stored.assign({name: guarded[name] for name in stored.data_vars})
        dataset = dataset.assign_coords({name: guarded[name] for name in guarded if name in stored.coords})
        dataset.set_close(stored.close)
        return dataset


class _Values(BackendArray):
    """The values of a variable."""

    def __init__(self, variable: xr.Variable, path: Path) -> None:
        self._variable, self._path = variable, path
        self.shape, self.dtype = variable.shape, variable.dtype

    def __getitem__(self, key: Any) -> Any:
        return explicit_indexing_adapter(key, self.shape, IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[Any, ...]) -> Any:
        try:
            return self._variable[key].values
        except Exception as error:  # readers of HDF5 raise many unrelated types where bytes are wrong
            raise ModelError(unreadable(self._path, error)) from error

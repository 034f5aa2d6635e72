"""Values in a result file, read on use; errors name the file."""

from pathlib import Path
from typing import Any

import xarray as xr
from xarray.backends.h5netcdf_ import H5NetCDFArrayWrapper, H5NetCDFStore
from xarray.core.indexing import LazilyIndexedArray

from beltdyn.errors import ModelError
from beltdyn.results.atomic import unreadable


def open_values(path: Path) -> xr.Dataset:
    """Open a file of HDF5; values that cannot be read later raise a `ModelError`."""
    store = _Store.open(path)
    try:
        return xr.open_dataset(store, decode_times=False)
    except BaseException:
        store.close()
        raise


class _Values(H5NetCDFArrayWrapper):
    """The values of a variable."""

    __slots__ = ()

    def _getitem(self, key: Any) -> Any:
        try:
            return super()._getitem(key)  # type: ignore[no-untyped-call]
        except Exception as error:  # readers of HDF5 raise many unrelated types where bytes are wrong
            raise ModelError(unreadable(Path(self.datastore.ds.filename), error)) from error


class _Store(H5NetCDFStore):
    """A file whose values are `_Values`."""

    __slots__ = ()

    def open_store_variable(self, name: str, var: Any) -> xr.Variable:
        variable: xr.Variable = super().open_store_variable(name, var)  # type: ignore[no-untyped-call]
        return variable.copy(data=LazilyIndexedArray(_Values(name, self)))  # type: ignore[no-untyped-call,arg-type]

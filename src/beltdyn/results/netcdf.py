"""The NetCDF4 file of a growing result.

Dimensions and coordinates are made by h5netcdf, which knows the conventions of NetCDF4; variables are made and
outputs appended by h5py, which is quicker. Both keep to HDF5's earliest format: it has no consistency flags, so that
a file whose writer was killed opens like any other. All of them write into memory: what they change reaches the disk
as a whole or not at all (`staged_file`). ``time`` has a length of its own: the number of complete outputs.
"""

import io
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5netcdf
import h5py
import numpy as np
from numpy.typing import NDArray

from beltdyn.results.layout import Layout, chunk_rows
from beltdyn.results.schema import AUXILIARY_COORDINATES, COORDINATES, RECORDED, TIMES, Variable
from beltdyn.results.staged_file import RESERVE, Checksums, StagedFile, identity, mark

if TYPE_CHECKING:
    import xarray as xr

_FORMAT = "earliest"
_COPIED = 512
"""Outputs that are copied at a time."""


class ReplacedError(OSError):
    """The file is not the one any more that was created."""


class GrowingFile:
    """A file to which outputs are appended, closed and readable between any two of them.

    `owner` is the file that the writer has locked.
    """

    def __init__(self, path: Path, layout: Layout, attributes: Mapping[str, Any], owner: str = "") -> None:
        path.touch()
        self._identity, self._owner = identity(path.stat()), owner
        self._outputs = dict.fromkeys(TIMES, 0)
        self._checksums: Checksums | None = None
        with self._open(path) as staged:
            staged.write(memoryview(_contents(layout, attributes)))
            self._commit(staged)

    def append(self, path: Path, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write outputs."""
        *variables, time = arrays.items()
        for some in (variables, [time]):
            with self._open(path) as staged:
                with h5py.File(staged, "r+", libver=_FORMAT) as file:
                    for name, values in some:
                        _extend(file, name, self._outputs[RECORDED[name].dims[0]], values)
                self._commit(staged)
        for name in TIMES:
            self._outputs[name] += len(arrays[name])

    def finish(self, path: Path, attributes: Mapping[str, Any]) -> None:
        """Cut what an interrupted `append` has left, and set global attributes."""
        with self._open(path) as staged:
            with h5py.File(staged, "r+", libver=_FORMAT) as file:
                for name, dataset in file.items():
                    if dataset.maxshape[0] is None:
                        dataset.resize(self._outputs[RECORDED[name].dims[0]], axis=0)
                for name in TIMES:
                    _fix_dimension(file, name)
            with h5netcdf.File(staged, "r+", libver=_FORMAT) as file:
                file.attrs.update(attributes)
            self._commit(staged, ends=True)

    def _commit(self, staged: StagedFile, *, ends: bool = False) -> None:
        staged.commit(*((0, "") if ends else (RESERVE, self._owner)))
        self._checksums = staged.checksums

    def _open(self, path: Path) -> StagedFile:
        """Open the file, if it is still the one that was created."""
        file = StagedFile(path, self._checksums)
        if file.identity() != self._identity:
            file.close()
            raise ReplacedError("another file has taken its place")
        return file


def copied(source: Path, path: Path, layout: Layout, counts: Mapping[str, int], owner: str) -> GrowingFile:
    """Copy the first outputs of a file into one that grows."""
    with h5netcdf.File(source, "r") as attributed:
        attributes = {**attributed.attrs, "status": "running"}
    copy = GrowingFile(path, layout, attributes, owner)
    with h5py.File(source, "r") as file:
        for name, count in counts.items():
            if len(file[name]) < count:
                raise ValueError(f"it holds {len(file[name])} of {count} values of {name}")
        for first in range(0, max(counts.values(), default=0), _COPIED):
            rows = {time: slice(min(first, count), min(first + _COPIED, count)) for time, count in counts.items()}
            copy.append(path, {name: file[name][rows[one.dims[0]]] for name, one in layout.recorded.items()})
    return copy


def write_dataset(
    path: Path, dataset: "xr.Dataset", encoding: Mapping[Hashable, Mapping[str, Any]] | None = None
) -> None:
    """Write a dataset that is complete to a file of its own."""
    from xarray.backends import H5NetCDFStore

    path.touch()
    with StagedFile(path) as staged:
        with h5netcdf.File(staged, "w") as file:
            dataset.load().dump_to_store(H5NetCDFStore(file), encoding=encoding)
        with h5py.File(staged, "r+") as marked:
            mark(marked)
        staged.commit(reserve=0)


def _contents(layout: Layout, attributes: Mapping[str, Any]) -> bytes:
    """A file that holds everything but outputs."""
    memory = io.BytesIO()
    with h5netcdf.File(memory, "w", libver=_FORMAT) as file:
        file.dimensions = {**dict.fromkeys(TIMES), **layout.sizes}
        for name, values in layout.coordinates.items():
            _create_coordinate(file, name, values)
        for name in TIMES:
            time = COORDINATES[name]
            created = file.create_variable(
                name, time.dims, time.dtype, chunks=(chunk_rows((), time.dtype),), fillvalue=np.nan
            )
            created.attrs.update(time.attributes)
        file.attrs.update(attributes)
    with h5py.File(memory, "r+", libver=_FORMAT) as file:
        mark(file)
        for name, variable in layout.recorded.items():
            if name not in TIMES:
                _create_variable(file, name, variable, layout.shape(variable, 1)[1:])
    return memory.getvalue()


def _create_coordinate(file: h5netcdf.File, name: str, values: NDArray[Any]) -> None:
    variable = COORDINATES[name]
    if variable.dtype == "str":
        values = values.astype(h5py.string_dtype())
    created = file.create_variable(name, variable.dims, values.dtype, data=values)
    created.attrs.update(variable.attributes)


def _create_variable(file: h5py.File, name: str, variable: Variable, row: tuple[int, ...]) -> None:
    """Make a variable without outputs, whose rows have a shape."""
    chunks = chunk_rows(row, variable.dtype), *row
    floating = np.issubdtype(variable.dtype, np.floating)
    fill = {"_FillValue": np.array([np.nan], variable.dtype)} if floating else {}
    auxiliary = [AUXILIARY_COORDINATES[dim] for dim in variable.dims if dim in AUXILIARY_COORDINATES]
    coordinates = {"coordinates": " ".join(auxiliary)} if auxiliary else {}
    created = file.create_dataset(
        name,
        (0, *row),
        variable.dtype,
        maxshape=(None, *row),
        chunks=chunks,
        fillvalue=fill.get("_FillValue"),
        track_order=True,
    )
    for axis, dim in enumerate(variable.dims):
        created.dims[axis].attach_scale(file[dim])
    created.attrs.update({**fill, **variable.attributes, **coordinates})


def _fix_dimension(file: h5py.File, name: str) -> None:
    """Let a dimension grow no longer: of one that may grow readers look for the length anew in all its variables."""
    growing = file[name]
    fixed = file.create_dataset("fixed", data=growing[()], fillvalue=growing.fillvalue, track_order=True)
    fixed.make_scale(name)
    for key, value in growing.attrs.items():
        if key not in {"CLASS", "NAME", "REFERENCE_LIST"}:
            fixed.attrs[key] = value
    for variable in (file[reference] for reference, _ in growing.attrs.get("REFERENCE_LIST", ())):
        variable.dims[0].detach_scale(growing)
        variable.dims[0].attach_scale(fixed)
    del file[name]
    file.move("fixed", name)


def _extend(file: h5py.File, name: str, start: int, values: NDArray[Any]) -> None:
    """Write rows by h5py's low-level calls, which take a third of the time of the others."""
    dataset = h5py.h5d.open(file.id, name.encode())
    dataset.set_extent((start + len(values), *values.shape[1:]))
    space = dataset.get_space()
    space.select_hyperslab((start, *(0 for _ in values.shape[1:])), values.shape)
    dataset.write(h5py.h5s.create_simple(values.shape), space, np.ascontiguousarray(values))

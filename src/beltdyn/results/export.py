"""Export of results to the formats of other programs."""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from itertools import pairwise
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple
from zipfile import ZipFile

import h5py
import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError, Parts
from beltdyn.results.atomic import MARK, atomic_path, is_marked, make_folder, require_replaceable
from beltdyn.results.mechanics import curve_points, element_lengths, present_lengths, recorded_kind
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.staged_file import staged_hdf5
from beltdyn.results.tables import NAMES, Table, require_tables, tables_folder, tables_of, write_csv

if TYPE_CHECKING:
    import xarray as xr


# The drive as surfaces in space over time: the belt as a ribbon, pulleys as cylinders that turn

PIECES = 4
"""Equal pieces of an element at whose ends the ribbon has points, besides those where contact is recorded."""

SECTORS = 72
"""Sectors of a pulley."""

_MARKED = SECTORS // 12
"""Sectors of a pulley that are marked, so that one sees it turn."""

_AT_A_TIME = 64
"""Instants that are read and shaped together."""

_SAME = 1e-9
"""Distance of points of the ribbon, over the length of their element, below which they are one."""

_IN_CONTACT = ("normal_force", "friction_force", "slip_velocity")
_OF_ELEMENTS = ("belt_tension", "tension_variation")
_OF_PULLEYS = ("pulley_speed", "pulley_angle", "pulley_torque")


class Surface(NamedTuple):
    """Polygons whose points move, while their corners stay the same."""

    corners: list[IntArray]
    """Numbers of the points at the corners of each polygon."""
    points: int
    """Number of points."""


class Frames(NamedTuple):
    """A surface at some instants."""

    places: FloatArray
    """Where the points are, m, shape (k, points, 3)."""
    on_points: dict[str, FloatArray]
    """Values at the points, shape (k, points)."""
    on_cells: dict[str, FloatArray]
    """Values on the polygons, shape (k, polygons)."""


class Ribbon:
    """The centerline of the belt, as wide as the belt: from -b/2 to b/2 out of the plane.

    It has points at all nodes and at all places where contact is recorded, where values are those that are recorded; in
    between they are interpolated. An element has one tension.
    """

    def __init__(self, run: Run) -> None:
        dataset, self._width = run.dataset, run.drive.belt.width
        self._kind = recorded_kind(dataset, run.prepared)
        self._belt_length = run.prepared.belt_length
        lengths = element_lengths(dataset, self._belt_length)
        closed = run.prepared.path.ends is None
        start = float(dataset["node_coordinate"][0])
        contact = dataset["belt_coordinate"].values
        self._curve, self._xi = _stations(lengths, contact - start, closed)
        ends = start + np.cumsum(lengths)
        self.coordinate: FloatArray = (ends - lengths)[self._curve] + self._xi * lengths[self._curve]
        """Belt coordinates of the pairs of points, m."""
        period = run.prepared.belt_length if closed else None
        self._before, self._after, self._share = _between(contact, self.coordinate, period)
        first = np.arange(len(self._curve) if closed else len(self._curve) - 1)
        after = (first + 1) % len(self._curve)
        self._element = self._curve[first]
        corners = np.stack([2 * first, 2 * after, 2 * after + 1, 2 * first + 1], axis=1)
        self.surface = Surface(list(corners), 2 * len(self._curve))

    def frames(self, instants: "xr.Dataset") -> Frames:
        """Give the ribbon at instants of `Run.fields`, shape (k,)."""
        line = curve_points(
            self._kind,
            instants["nodal_coordinates"].values,
            present_lengths(instants, self._belt_length),
            self._curve,
            self._xi,
        ).repeat(2, axis=1)
        across = np.tile([-0.5 * self._width, 0.5 * self._width], len(self._curve))
        places = np.concatenate([line, np.broadcast_to(across[:, None], (*line.shape[:2], 1))], axis=2)
        on_points = {name: self._interpolated(instants[name].values).repeat(2, axis=1) for name in _IN_CONTACT}
        on_points["contact_pressure"] = on_points["normal_force"] / self._width
        there = (name for name in _OF_ELEMENTS if name in instants)
        return Frames(places, on_points, {name: instants[name].values[:, self._element] for name in there})

    def _interpolated(self, values: FloatArray) -> FloatArray:
        """Values at the points of the ribbon of those where contact is recorded."""
        return np.asarray((1.0 - self._share) * values[:, self._before] + self._share * values[:, self._after])


_LEAST = 0.5
"""Drawn radius of a pulley over its own, at least."""


class Cylinders:
    """Pulleys as wide as the belt, with a marked sector that begins on the x axis when their angle is zero.

    They end below the ribbon, which shows the centerline, by half of the belt's thickness at least: it is seen on arcs.
    """

    def __init__(self, run: Run) -> None:
        drive = run.drive
        own, below = np.array([pulley.radius for pulley in drive.pulleys]), drive.radii - 0.5 * drive.belt.thickness
        self._radii = np.minimum(own, np.maximum(below, _LEAST * own))
        self._width = drive.belt.width
        corners, self._mark = _cylinder()
        size = 2 * (SECTORS + 1)
        self._each = len(corners)
        every = [one + size * pulley for pulley in range(len(self._radii)) for one in corners]
        self.surface = Surface(every, size * len(self._radii))

    def frames(self, instants: "xr.Dataset") -> Frames:
        """Give the cylinders at instants of `Run.fields`, shape (k,)."""
        angles = instants["pulley_angle"].values[..., None] + 2.0 * np.pi * np.arange(SECTORS) / SECTORS
        rim = self._radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        middle = np.zeros_like(rim[:, :, :1])
        disc = instants["pulley_center"].values[:, :, None] + np.concatenate([middle, rim], axis=2)
        sides = [_at_height(disc, side * self._width) for side in (-0.5, 0.5)]
        places = np.concatenate(sides, axis=2).reshape(len(disc), -1, 3)
        on_cells = {name: instants[name].values.repeat(self._each, axis=1) for name in _OF_PULLEYS}
        pulleys = len(self._radii)
        fixed = {"pulley": np.arange(pulleys).repeat(self._each), "mark": np.tile(self._mark, pulleys)}
        shape = (len(places), pulleys * self._each)
        return Frames(places, {}, on_cells | {name: np.broadcast_to(one, shape) for name, one in fixed.items()})


def batches(run: Run) -> "Iterator[xr.Dataset]":
    """All instants at which fields were recorded, some at a time, in order."""
    fields = run.fields
    count = fields.sizes["time"]
    for first, last in pairwise([*range(0, count, _AT_A_TIME), count]):
        yield fields.isel(time=slice(first, last))


def _stations(lengths: FloatArray, contact: FloatArray, closed: bool) -> tuple[IntArray, FloatArray]:
    """Curves and places on these where the ribbon has points: nodes, parts of elements, and contact points."""
    ends = np.cumsum(lengths)
    touching = np.minimum(np.searchsorted(ends, contact, side="right"), len(lengths) - 1)
    curve = np.concatenate([np.arange(len(lengths)).repeat(PIECES), touching])
    equal = np.tile(np.arange(PIECES) / PIECES, len(lengths))
    xi = np.concatenate([equal, (contact - (ends - lengths)[touching]) / lengths[touching]])
    order = np.lexsort((xi, curve))
    along = (curve + xi)[order]
    kept = order[np.diff(along, prepend=-1.0) > _SAME]
    kept = kept[xi[kept] < 1.0 - _SAME]
    last = ([], []) if closed else ([len(lengths) - 1], [1.0])
    return np.append(curve[kept], np.array(last[0], dtype=int)), np.append(xi[kept], last[1])


def _between(known: FloatArray, wanted: FloatArray, period: float | None) -> tuple[IntArray, IntArray, FloatArray]:
    """Numbers of the known places before and after each wanted one, and the share of the second in its value."""
    number = np.searchsorted(known, wanted, side="right")
    if period is None:
        before, after = np.maximum(number - 1, 0), np.minimum(number, len(known) - 1)
        gap = known[after] - known[before]
        way = wanted - known[before]
    else:
        before, after = (number - 1) % len(known), number % len(known)
        gap = (known[after] - known[before]) % period
        way = (wanted - known[before]) % period
    return before, after, np.divide(way, gap, out=np.zeros_like(way), where=gap > 0.0)


def _at_height(disc: FloatArray, height: float) -> FloatArray:
    """Points in a plane, shape (..., 2), in space, shape (..., 3)."""
    return np.concatenate([disc, np.full((*disc.shape[:-1], 1), height)], axis=-1)


def _cylinder() -> tuple[list[IntArray], IntArray]:
    """Corners of the polygons of a pulley, and which are marked; each side has its middle first, then the rim."""
    other = SECTORS + 1
    here = 1 + np.arange(SECTORS)
    there = 1 + (here % SECTORS)
    middle = np.zeros(SECTORS, dtype=int)
    back = np.stack([middle, there, here], axis=1)
    front = np.stack([middle, here, there], axis=1) + other
    mantle = np.stack([here, there, there + other, here + other], axis=1)
    marked = (np.arange(SECTORS) < _MARKED).astype(int)
    return [*back, *front, *mantle], np.tile(marked, 3)


_VERSION = (2, 2)
"""Version of the format."""

_CELL_KINDS = ("Vertices", "Lines", "Polygons", "Strips")
"""Kinds of cells of a surface, all of which a file must have, in the order of the columns of offsets."""

_CREATOR = "creator"

_PARTS: dict[str, type[Ribbon | Cylinders]] = {"belt": Ribbon, "pulleys": Cylinders}


def write_vtkhdf(run: Run, path: Path | str, overwrite: bool = False) -> list[Path]:
    """Write belt and pulleys over time for ParaView and VTK.

    Each of them is a surface (PolyData) in a file of its own, at every instant at which fields were recorded. The belt
    is a ribbon of its width, with ``normal_force`` (N/m), ``contact_pressure`` (Pa, the normal force over the width),
    ``friction_force`` (N/m) and ``slip_velocity`` (m/s) at its points, and ``belt_tension`` and ``tension_variation``
    (N) on its polygons. Pulleys are cylinders that turn, with ``pulley`` (their number), ``pulley_speed`` (rad/s),
    ``pulley_angle`` (rad), ``pulley_torque`` (N m) and ``mark``, 1 on one sector and 0 elsewhere, on their polygons.
    Numbers have single precision, times double.

    Notes
    -----
    `VTKHDF file format <https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/>`_, Kitware.
    """
    run.require_output()
    require_vtkhdf(path, overwrite)
    files = _files(path)
    for name, part in _PARTS.items():
        with atomic_path(files[name], _is_ours, overwrite) as temporary:
            _write_part(temporary, run, part(run))
    return list(files.values())


def require_vtkhdf(path: Path | str, overwrite: bool = False) -> None:
    """Check that files replace at most those of `write_vtkhdf`."""
    for file in _files(path).values():
        require_replaceable(file, _is_ours, overwrite)


def _files(path: Path | str) -> dict[str, Path]:
    """The file of each part."""
    path = Path(path)
    return {name: path.with_name(f"{path.stem}-{name}.vtkhdf") for name in _PARTS}


def _is_ours(path: Path) -> bool:
    """Whether a file was written by `write_vtkhdf`."""
    with suppress(OSError), h5py.File(path, "r") as file:
        return file.attrs.get(_CREATOR) == MARK and "VTKHDF" in file
    return False


def _write_part(path: Path, run: Run, part: Ribbon | Cylinders) -> None:
    """Write a part at all instants, some at a time."""
    path.touch()
    times = run.dataset["field_time"].values
    with staged_hdf5(path, "w") as file:
        file.attrs[_CREATOR] = MARK
        _begin(file.create_group("VTKHDF"), part.surface, times)
    done = 0
    for instants in batches(run):
        frames = part.frames(instants)
        with staged_hdf5(path, "r+") as file:
            _SurfaceOverTime(file["VTKHDF"], len(times), done).append(frames)
        done += len(frames.places)


def _begin(group: h5py.Group, surface: Surface, times: FloatArray) -> None:
    """Write polygons, which are the same at all instants, and the instants (s), shape (steps,)."""
    group.attrs["Version"] = _VERSION
    group.attrs["Type"] = np.bytes_("PolyData")
    group["NumberOfPoints"] = np.array([surface.points])
    for kind in _CELL_KINDS:
        _write_cells(group.create_group(kind), surface if kind == "Polygons" else Surface([], 0))
    steps, count = group.create_group("Steps"), len(times)
    steps.attrs["NSteps"] = count
    steps["Values"] = times
    steps["NumberOfParts"] = np.ones(count, dtype=int)
    steps["PartOffsets"] = np.zeros(count, dtype=int)
    steps["PointOffsets"] = surface.points * np.arange(count)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        steps[name] = np.zeros((count, len(_CELL_KINDS)), dtype=int)


class _SurfaceOverTime:
    """A surface in a file, to which instants are appended; `done` of `count` were written."""

    def __init__(self, group: h5py.Group, count: int, done: int) -> None:
        self._group, self._steps, self._count, self._done = group, group["Steps"], count, done

    def append(self, frames: Frames) -> None:
        """Write the next instants."""
        self._write("Points", frames.places)
        for kind, values in (("PointData", frames.on_points), ("CellData", frames.on_cells)):
            for name, one in values.items():
                self._write(f"{kind}/{name}", one)
                offsets = f"{kind}Offsets/{name}"
                if offsets not in self._steps:
                    self._steps[offsets] = one.shape[1] * np.arange(self._count)

    def _write(self, name: str, values: FloatArray) -> None:
        """Write values of instants, shape (k, n, ...), behind those before."""
        each = values.shape[1]
        if name not in self._group:
            shape, chunk = ((length, *values.shape[2:]) for length in (self._count * each, each))
            self._group.create_dataset(name, shape, "f4", chunks=chunk, compression="gzip", shuffle=True)
        first = self._done * each
        flat = values.reshape(-1, *values.shape[2:])
        self._group[name][first : first + len(flat)] = flat


def _write_cells(group: h5py.Group, surface: Surface) -> None:
    """Write the polygons of a surface."""
    sizes = [len(one) for one in surface.corners]
    group["NumberOfCells"] = np.array([len(sizes)])
    group["NumberOfConnectivityIds"] = np.array([sum(sizes)])
    group["Offsets"] = np.cumsum([0, *sizes])
    group["Connectivity"] = np.concatenate([np.zeros(0, dtype=int), *surface.corners])


# Tables of a result as MAT and Parquet files, and workbooks

_LONGEST_NAME = 63
"""Letters of a name in MATLAB."""

_COUNTED = 3
"""Letters of a name that are kept for a number where names are the same."""

_HEADER = f"MATLAB 5.0 MAT-file, created by {MARK}".encode()
"""Text with which a MAT file begins; other programs look at its first words only."""

_HEADER_BYTES = 116
"""Bytes of the text at the head of a MAT file of version 5, by its format; the text is padded with blanks."""

_MAKER = b"creator"

_MOST_ROWS, _COLUMN_WIDTH = 1_048_575, 14
"""Of a sheet below its headings, and in letters."""


def write_mat(result: Result, path: Path | str, overwrite: bool = False) -> Path:
    """Write the tables of a result for MATLAB, Octave and Simulink.

    The file (MAT, version 5) holds a structure for each table of `write_csv`, such as ``pulleys``, with a column for
    each heading: ``pulleys.pulley_speed_driver`` for ``pulley_speed driver [rad/s]``. What is no letter or digit of a
    name in MATLAB becomes ``_``, and ``pulleys.headings`` are the headings with units, in order of the columns. Numbers
    are double, names are cells.
    """
    from scipy.io import savemat

    path = Path(path)
    require_mat(path, overwrite)
    with Parts() as parts:
        content = {name: _structure(table) for name, table in _tables(result, "mat", parts).items()}
        with atomic_path(path, is_marked, overwrite) as temporary:
            savemat(temporary, content, appendmat=False, long_field_names=True, do_compression=True, oned_as="column")
            with temporary.open("r+b") as file:
                file.write(_HEADER.ljust(_HEADER_BYTES))
        parts.completed.append(path)
    return path


def _tables(result: Result, form: str, parts: Parts) -> dict[str, Table]:
    """The tables of a result but for those that have a fault, which is among the errors of `parts`."""
    tables = dict[str, Table]()
    for name, table in tables_of(result).items():
        with parts.part(f"bd.export({result.source}, {form!r}), table {name}"):
            tables[name] = table()
    return tables


def mat_file(path: Path) -> Path:
    """Where the MAT file of a result file is written."""
    return path.with_name(f"{path.stem}.mat")


def require_mat(path: Path, overwrite: bool = False) -> None:
    """Check that a MAT file replaces at most one of beltdyn."""
    require_replaceable(path, is_marked, overwrite)


def write_parquet(result: Result, folder: Path | str, overwrite: bool = False) -> list[Path]:
    """Write the tables of a result as Parquet, for data frames: those of `write_csv` with the same headings."""
    folder = Path(folder)
    require_parquet(folder, overwrite)
    import pyarrow as pa
    from pyarrow import parquet

    make_folder(folder)
    with Parts() as parts:
        for name, table in _tables(result, "parquet", parts).items():
            columns = [pa.array(values) for _, values in table]
            schema = pa.schema(
                [(heading, column.type) for (heading, _), column in zip(table, columns, strict=True)],
                metadata={_MAKER: MARK.encode()},
            )
            path = folder / f"{name}.parquet"
            with atomic_path(path, _is_parquet, overwrite) as temporary:
                parquet.write_table(pa.Table.from_arrays(columns, schema=schema), temporary)
            parts.completed.append(path)
    return parts.completed


def require_parquet(folder: Path, overwrite: bool = False) -> None:
    """Check that Parquet files can be written, and replace at most tables of beltdyn."""
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        raise ModelError(
            f"tables in {folder} cannot be written as Parquet because pyarrow is not installed. "
            "Install beltdyn with its extra beltdyn[parquet], or write CSV or MAT."
        ) from None
    for name in NAMES:
        require_replaceable(folder / f"{name}.parquet", _is_parquet, overwrite)


def _is_parquet(path: Path) -> bool:
    """Whether a file was written by `write_parquet`."""
    from pyarrow import ArrowException, parquet

    with suppress(OSError, ArrowException):
        return (parquet.read_schema(path).metadata or {}).get(_MAKER) == MARK.encode()
    return False


def write_xlsx(result: Result, path: Path | str, overwrite: bool = False) -> Path:
    """Write the tables of a result as a workbook for spreadsheets: a sheet for each table of `write_csv`."""
    path = Path(path)
    require_xlsx(path, overwrite)
    from xlsxwriter import Workbook

    parts = Parts()
    tables = _tables(result, "xlsx", parts)
    longest = max((len(column) for table in tables.values() for _, column in table), default=0)
    if longest > _MOST_ROWS:
        raise ModelError(f"{path} would have {longest} rows, and a sheet has {_MOST_ROWS}. Write CSV or Parquet.")
    with atomic_path(path, is_marked, overwrite) as temporary:
        with Workbook(temporary) as book:
            bold = book.add_format({"bold": True, "text_wrap": True, "valign": "top"})
            for name, table in tables.items():
                sheet = book.add_worksheet(name)
                sheet.freeze_panes(1, 0)
                sheet.set_column(0, max(len(table) - 1, 0), _COLUMN_WIDTH)
                for column, (heading, values) in enumerate(table):
                    sheet.write_string(0, column, heading, bold)
                    sheet.write_column(1, column, _cells(values))
        with ZipFile(temporary, "a") as archive:
            archive.comment = MARK.encode()
    parts.completed.append(path)
    parts.end()
    return path


def _cells(values: NDArray[Any]) -> list[Any]:
    """Values of a column; a cell is empty where there is no number."""
    if values.dtype.kind != "f":
        return list(values.tolist())
    return [value if isfinite(value) else None for value in values.tolist()]


def xlsx_file(path: Path) -> Path:
    """Where the workbook of a result file is written."""
    return path.with_name(f"{path.stem}.xlsx")


def require_xlsx(path: Path, overwrite: bool = False) -> None:
    """Check that a workbook can be written, and replaces at most one of beltdyn."""
    try:
        import xlsxwriter  # noqa: F401
    except ImportError:
        raise ModelError(
            f"{path} cannot be written because XlsxWriter is not installed. Install beltdyn with its extra "
            "beltdyn[xlsx], or write CSV, which spreadsheets open too."
        ) from None
    require_replaceable(path, is_marked, overwrite)


def _structure(table: Table) -> dict[str, Any]:
    """A table as a structure of MATLAB."""
    found: dict[str, Any] = {}
    for heading, values in table:
        text = values.dtype.kind in "UO"
        found[_identifier(heading, found)] = values.astype(object) if text else values.astype(float)
    return found | {"headings": np.array([heading for heading, _ in table], dtype=object)}


def _identifier(heading: str, taken: dict[str, Any]) -> str:
    """A name for MATLAB that is not taken yet."""
    name = re.sub(r"[^A-Za-z0-9_]+", "_", re.sub(r" \[.*\]$", "", heading))[: _LONGEST_NAME - _COUNTED]
    number, unique = 1, name
    while unique in taken:
        number += 1
        unique = f"{name}_{number}"
    return unique


class _Format(NamedTuple):
    """An export format."""

    place: Callable[[Path], Path]
    """What the other two take, from a result file beside which to write."""
    require: Callable[[Path, bool], None]
    """Makes sure that nothing of others is replaced there."""
    write: Callable[[Any, Path, bool], Path | list[Path]]
    """Writes a result there; gives one path or several."""


FORMATS = MappingProxyType(
    {
        "vtk": _Format(Path, require_vtkhdf, write_vtkhdf),
        "csv": _Format(tables_folder, require_tables, write_csv),
        "mat": _Format(mat_file, require_mat, write_mat),
        "xlsx": _Format(xlsx_file, require_xlsx, write_xlsx),
        "parquet": _Format(tables_folder, require_parquet, write_parquet),
    }
)
"""Export formats by name."""


def export(
    result: Result, formats: str | Sequence[str], path: Path | str | None = None, overwrite: bool = False
) -> list[Path]:
    """Export a result to the formats of other programs.

    Parameters
    ----------
    result : Result
        A run, or for tables another result.
    formats : str or sequence of str
        "vtk": belt and pulleys over time for ParaView, ``NAME-belt.vtkhdf`` and ``NAME-pulleys.vtkhdf``; "csv", "mat",
        "xlsx" and "parquet": tables, in the folder ``NAME-tables``, ``NAME.mat`` or ``NAME.xlsx``.
    path : Path or str, optional
        A result file that gives the folder and the base name; by default that of the result.
    overwrite : bool
        Replace any regular files, not only those of beltdyn.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    ModelError
        If a format is unknown, does not fit the result, or needs a missing package; or if a file cannot be written, or
        would replace a file of another program.
    InternalError
        If a table has a fault; all others are written, to the files that are its `completed`.

    Examples
    --------
    >>> [file.name for file in bd.export(run, ["vtk", "mat"], "drive.nc")]
    ['drive-belt.vtkhdf', 'drive-pulleys.vtkhdf', 'drive.mat']
    """
    names = [formats] if isinstance(formats, str) else list(formats)
    path = _base(result, path)
    _require(result, names)
    for name in names:
        FORMATS[name].require(FORMATS[name].place(path), overwrite)
    with Parts(refuses=True) as parts:
        for name in names:
            with parts.part(f"bd.export({result.source}, {name!r})"):
                written = FORMATS[name].write(result, FORMATS[name].place(path), overwrite)
                parts.completed += written if isinstance(written, list) else [written]
    return parts.completed


def _base(result: Result, path: Path | str | None) -> Path:
    """The result file after which files are named."""
    if path is not None:
        return Path(path)
    if result.path is None:
        raise ModelError('this result has no file name to derive others from. Give path, such as "drive.nc".')
    return result.path


def _require(result: Result, names: Sequence[str]) -> None:
    """Make sure that there are formats, that they are known, and fit the result."""
    if not names:
        raise ModelError(f"no format is given. Choose from {', '.join(FORMATS)}.")
    for name in names:
        if name not in FORMATS:
            raise ModelError(f"{name!r} is not a result format. Choose from {', '.join(FORMATS)}.")
    if "vtk" in names and not isinstance(result, Run):
        raise ModelError(
            f"vtk needs results over time, such as those of `beltdyn simulate`; these are of {result.kind}. "
            "Choose tables: csv, mat, xlsx or parquet."
        )

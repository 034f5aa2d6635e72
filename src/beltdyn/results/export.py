"""Export of results to the formats of other programs."""

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from beltdyn.errors import ModelError
from beltdyn.results.atomic import MARK, atomic_path, is_marked, make_folder, require_replaceable
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.tables import NAMES, Table, require_tables, tables_folder, tables_of, write_csv
from beltdyn.results.vtkhdf import require_vtkhdf, write_vtkhdf

# Tables of a result as MAT and Parquet files, and workbooks

_LONGEST_NAME = 63
"""Letters of a name in MATLAB."""

_COUNTED = 3
"""Letters of a name that are kept for a number where names are the same."""

_HEADER = f"MATLAB 5.0 MAT-file, created by {MARK}".encode()
"""Text with which a MAT file begins; other programs look at its first words only."""

_HEADER_BYTES = 116

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
    content = {name: _structure(table) for name, table in tables_of(result).items()}
    with atomic_path(path, is_marked, overwrite) as temporary:
        savemat(temporary, content, appendmat=False, long_field_names=True, do_compression=True, oned_as="column")
        with temporary.open("r+b") as file:
            file.write(_HEADER.ljust(_HEADER_BYTES))
    return path


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

    tables = tables_of(result)
    make_folder(folder)
    paths = []
    for name, table in tables.items():
        columns = [pa.array(values) for _, values in table]
        schema = pa.schema(
            [(heading, column.type) for (heading, _), column in zip(table, columns, strict=True)],
            metadata={_MAKER: MARK.encode()},
        )
        path = folder / f"{name}.parquet"
        with atomic_path(path, _is_parquet, overwrite) as temporary:
            parquet.write_table(pa.Table.from_arrays(columns, schema=schema), temporary)
        paths.append(path)
    return paths


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

    tables = tables_of(result)
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
        would replace a file of another program. Files completed before the error remain.

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
    files: list[Path] = []
    for name in names:
        written = FORMATS[name].write(result, FORMATS[name].place(path), overwrite)
        files += written if isinstance(written, list) else [written]
    return files


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

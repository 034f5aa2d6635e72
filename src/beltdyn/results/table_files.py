"""Tables of a result as MAT and Parquet files."""

import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.results.atomic import MARK, atomic_path, is_marked, make_folder, require_replaceable
from beltdyn.results.result import Result
from beltdyn.results.tables import NAMES, Table, tables_of

_LONGEST_NAME = 63
"""Letters of a name in MATLAB."""

_COUNTED = 3
"""Letters of a name that are kept for a number where names are the same."""

_HEADER = f"MATLAB 5.0 MAT-file, created by {MARK}".encode()
"""Text with which a MAT file begins; other programs look at its first words only."""

_HEADER_BYTES = 116

_MAKER = b"creator"


def write_mat(result: Result, path: Path | str, overwrite: bool = False) -> Path:
    """Write the tables of a result for MATLAB, Octave and Simulink.

    The file (MAT, version 5) holds a structure for each table of `write_csv`, such as ``pulleys``, with a column for
    each heading: ``pulleys.pulley_speed_driver`` for ``pulley_speed driver [rad/s]``. What is no letter or digit of a
    name in MATLAB becomes ``_``, and ``pulleys.headings`` are the headings with units, in order of the columns. Numbers
    are double, names are cells.

    Parameters
    ----------
    result : Result
        A run, or another result.
    path : Path or str
        The file, ``.mat``.
    overwrite : bool
        Replace any regular file, and not only those of beltdyn.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If it is a run without an output, or the file cannot be written or would replace one that is not ours.
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
    """Where the MAT file of a result file is written.

    Parameters
    ----------
    path : Path
        The result file.

    Returns
    -------
    Path
        A file beside it, named after it.
    """
    return path.with_name(f"{path.stem}.mat")


def require_mat(path: Path, overwrite: bool = False) -> None:
    """Check that a MAT file replaces at most one of beltdyn.

    Parameters
    ----------
    path : Path
        The file, which may not exist yet.
    overwrite : bool
        Whether any regular file may be replaced.

    Raises
    ------
    ModelError
        If there is another file.
    """
    require_replaceable(path, is_marked, overwrite)


def write_parquet(result: Result, folder: Path | str, overwrite: bool = False) -> list[Path]:
    """Write the tables of a result as Parquet, for data frames: those of `write_csv` with the same headings.

    Parameters
    ----------
    result : Result
        A run, or another result.
    folder : Path or str
        Where to write; made if need be.
    overwrite : bool
        Replace any regular files, and not only tables of ours.

    Returns
    -------
    list of Path
        ``pulleys.parquet``, ``spans.parquet`` and so on.

    Raises
    ------
    ModelError
        If pyarrow is missing, it is a run without an output, a file cannot be written, or would replace another one.
    """
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
    """Check that Parquet files can be written, and replace at most tables of beltdyn.

    Parameters
    ----------
    folder : Path
        The folder, which may not exist yet.
    overwrite : bool
        Whether any regular files may be replaced.

    Raises
    ------
    ModelError
        If pyarrow is missing, or there is another file.
    """
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        raise ModelError(
            f"tables in {folder} cannot be written as Parquet because pyarrow is not installed. "
            "Install it: pip install 'beltdyn[parquet]', or write CSV or MAT."
        ) from None
    for name in NAMES:
        require_replaceable(folder / f"{name}.parquet", _is_parquet, overwrite)


def _is_parquet(path: Path) -> bool:
    """Whether a file was written by `write_parquet`."""
    from pyarrow import ArrowException, parquet

    with suppress(OSError, ArrowException):
        return (parquet.read_schema(path).metadata or {}).get(_MAKER) == MARK.encode()
    return False


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

"""Export of results to the formats of other programs."""

from collections.abc import Callable, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from beltdyn.errors import ModelError
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.table_files import mat_file, require_mat, require_parquet, write_mat, write_parquet
from beltdyn.results.tables import require_tables, tables_folder, write_csv
from beltdyn.results.vtkhdf import require_vtkhdf, write_vtkhdf


class _Format(NamedTuple):
    """An export format.

    Attributes
    ----------
    place : callable
        What the other two take, from a result file beside which to write.
    require : callable
        Makes sure that nothing of others is replaced there.
    write : callable
        Writes a result there; gives one path or several.
    """

    place: Callable[[Path], Path]
    require: Callable[[Path, bool], None]
    write: Callable[[Any, Path, bool], Path | list[Path]]


FORMATS = MappingProxyType(
    {
        "vtk": _Format(Path, require_vtkhdf, write_vtkhdf),
        "csv": _Format(tables_folder, require_tables, write_csv),
        "mat": _Format(mat_file, require_mat, write_mat),
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
        "vtk": belt and pulleys over time for ParaView, ``NAME-belt.vtkhdf`` and ``NAME-pulleys.vtkhdf``; "csv", "mat"
        and "parquet": tables, in the folder ``NAME-tables`` or ``NAME.mat``.
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
            f"vtk needs results over time, such as those of `beltdyn run`; these are of {result.kind}. "
            "Choose tables: csv, mat or parquet."
        )

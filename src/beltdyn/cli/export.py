"""`beltdyn export`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show
from beltdyn.errors import ModelError


def export(
    file: Path,
    /,
    *,
    vtk: Annotated[bool, Parameter(negative="")] = False,
    csv: Annotated[bool, Parameter(negative="")] = False,
    mat: Annotated[bool, Parameter(negative="")] = False,
    parquet: Annotated[bool, Parameter(negative="")] = False,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Export a result file to other programs: ParaView, spreadsheets, MATLAB, data frames.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn run` or another analysis.
    vtk
        Belt and pulleys over time for ParaView and VTK, FILE-belt.vtkhdf and FILE-pulleys.vtkhdf; runs and sweeps only.
    csv
        Plain tables, in the folder FILE-tables.
    mat
        The same tables for MATLAB and Octave, FILE.mat.
    parquet
        The same tables as Parquet for data frames, in the folder FILE-tables; needs the extra beltdyn[parquet].
    output
        The folder of the exported files; by default that of the result file.
    force
        Also replace files that beltdyn did not write.
    """
    from beltdyn.results import export as export_result
    from beltdyn.results import open_result
    from beltdyn.results.atomic import make_folder

    wanted = {"vtk": vtk, "csv": csv, "mat": mat, "parquet": parquet}
    formats = [name for name, asked in wanted.items() if asked]
    if not formats:
        raise ModelError(f"export needs a format: one or more of {', '.join(f'--{name}' for name in wanted)}.")
    result = open_result(file)
    folder = file.parent if output is None else make_folder(output)
    written = export_result(result, formats, folder / file.name, force)
    show(f"Written: {', '.join(str(path) for path in written)}")

"""`beltdyn run`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from cyclopts.validators import Number

from beltdyn.cli.batch import run_several
from beltdyn.cli.output import doubt, ended, require_output, simulate_to, write_tables


def run(
    file: Path,
    /,
    *more: Path,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    jobs: Annotated[int | None, Parameter(alias="-j", validator=Number(gte=1))] = None,
    csv: Annotated[bool, Parameter(negative="")] = False,
    strict: Annotated[bool, Parameter(negative="")] = False,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Simulate a drive: a progress bar, then a summary, and the results in a NetCDF file.

    Several drives run side by side on all cores. Ctrl-C, or the signal to terminate, ends the simulation and
    keeps what was computed. Earlier results are replaced, and no other files.

    Parameters
    ----------
    file
        The drive file, TOML.
    more
        More drive files.
    output
        The result file; by default the drive file's name with the ending .nc. Of several drives, the folder for these.
    jobs
        How many drives to simulate at a time; by default as many as there are cores.
    csv
        Write plain tables too, into a folder beside the result file, named after it with -tables.
    strict
        End with an error (exit code 4) where a warning makes results doubtful; they are kept.
    force
        Replace other files too.
    """
    if more:
        return run_several((file, *more), output, jobs, csv=csv, strict=strict, force=force)
    from beltdyn.model import load

    drive = load(file)
    path = output or file.with_suffix(".nc")
    require_output(path, (file,), csv, force)
    finished = simulate_to(drive, path, force)
    if csv and finished.outputs:
        write_tables(finished, path, force)
    return ended(finished) or (doubt(finished.warnings) if strict else 0)

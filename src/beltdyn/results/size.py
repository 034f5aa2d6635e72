"""Expected size of the results of a drive."""

import shutil
from math import ceil, prod
from pathlib import Path

import numpy as np
import psutil

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results.friction_work import ARC_PARTS
from beltdyn.results.schema import AXIS_NAMES, RECORDED, Variable

_CHUNK_BYTES = 32768
_CHUNK_ROWS = 1024
_HEADER = 64_000
"""Bytes of a file without outputs, about."""
_COPIES = 2.0
"""Parts of memory that a run in memory takes while its outputs are put together, over their size."""
_UNITS = ("bytes", "kB", "MB", "GB", "TB")


def chunk_rows(row: tuple[int, ...], dtype: str) -> int:
    """Number of outputs that a file keeps together of a variable, whose rows have a shape."""
    return min(max(_CHUNK_BYTES // _row_bytes(row, dtype), 1), _CHUNK_ROWS)


def expected_bytes(drive: Drive) -> int:
    """Give the expected size of the results of a run.

    Parameters
    ----------
    drive : Drive
        The drive.

    Returns
    -------
    int
        Bytes of its file, to about a tenth; files grow by pieces of up to 32 kB for each variable.
    """
    instants, sizes = drive.simulation.instants, _sizes(drive)
    counts = {"time": instants.count, "field_time": instants.fields, "filtered_time": instants.count}
    return _HEADER + sum(
        _variable_bytes(variable, tuple(sizes[dim] for dim in variable.dims[1:]), counts[variable.dims[0]])
        for variable in RECORDED.values()
        if all(sizes[dim] for dim in variable.dims[1:])
    )


def describe_size(drive: Drive) -> str:
    """Describe the number, interval and size of outputs.

    Parameters
    ----------
    drive : Drive
        The drive.
    """
    instants = drive.simulation.instants
    return (
        f"{_in_words(expected_bytes(drive))}: {instants.count} outputs every {instants.interval:.4g} s, "
        f"{instants.fields} along the belt every {instants.stride * instants.interval:.4g} s"
    )


def require_room(drive: Drive, path: Path | None) -> None:
    """Check that the results of a run fit on the disk or in memory.

    Parameters
    ----------
    drive : Drive
        The drive.
    path : Path or None
        The result file, or None for memory.

    Raises
    ------
    ModelError
        If they do not fit, with ways to reduce them.
    """
    expected = expected_bytes(drive)
    if path is None:
        needed, free, place = _COPIES * expected, float(psutil.virtual_memory().available), "memory"
        remedy = "Write them to a file (output=...)"
    else:
        folder = path.absolute().parent
        if not folder.is_dir():
            return
        needed, free, place = float(expected), float(shutil.disk_usage(folder).free), f"the disk of {folder}"
        remedy = "Write them to another disk"
    if needed > free:
        settings = drive.simulation
        raise ModelError(
            f"the results need {_in_words(needed)} of {place}, but only {_in_words(free)} are free: "
            f"{describe_size(drive)}. {remedy}, increase simulation.output_interval = {settings.output_interval:g} s "
            "or simulation.field_interval, or simulate a shorter time."
        )


def _sizes(drive: Drive) -> dict[str, int]:
    """Size of every dimension but times."""
    belt, pulleys = drive.completed.belt, len(drive.pulleys)
    kind, curves = belt.element_kind, belt.element_kind.curves * belt.given_elements
    points = 2 if drive.contact.sampling == "nodal" else drive.contact.quadrature_points
    return {
        "pulley": pulleys,
        "span": drive.path.spans,
        "tensioner": len(drive.moving_tensioners),
        "body": _bodies(drive),
        "axis": len(AXIS_NAMES),
        "coordinate": len(kind.coordinates),
        "node": kind.points * (belt.given_elements + (bool(drive.ends) or drive.simulation.joint == "multipliers")),
        "element": curves,
        "contact_point": points * curves,
        "arc_part": ARC_PARTS,
    }


def _bodies(drive: Drive) -> int:
    """Number of what has a coordinate beside the belt: rims, hub chains, controllers, belt, tensioners."""
    behind = sum(len(one.hub) + sum(load.state_lag is not None for load in one.load) for one in drive.pulleys)
    flows = drive.frame.stays
    return len(drive.pulleys) + behind + flows + len(drive.moving_tensioners)


def _variable_bytes(variable: Variable, row: tuple[int, ...], count: int) -> int:
    """Bytes of a variable in a file, which keeps whole chunks."""
    rows = chunk_rows(row, variable.dtype)
    return ceil(count / rows) * rows * _row_bytes(row, variable.dtype)


def _row_bytes(row: tuple[int, ...], dtype: str) -> int:
    return prod(row) * np.dtype(dtype).itemsize


def _in_words(number: float) -> str:
    """A number of bytes with a unit, such as "12 MB"."""
    for unit in _UNITS[:-1]:
        if number < 1000.0:
            return f"{number:.3g} {unit}"
        number /= 1000.0
    return f"{number:.3g} {_UNITS[-1]}"

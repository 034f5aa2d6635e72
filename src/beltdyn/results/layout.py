"""Layout of recorded data: names and reference coordinates of all dimensions except time."""

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import ceil, prod
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Prepared
from beltdyn.results.friction_work import ARC_PARTS, arc_shares
from beltdyn.results.schema import AXIS_NAMES, COORDINATES, RECORDED, Variable


@dataclass(frozen=True, eq=False)
class Layout:
    """Names and reference coordinates of recorded data."""

    pulleys: tuple[str, ...]
    """Names of the pulleys."""
    spans: tuple[str, ...]
    """Names of the spans, "driver-driven" for the one from driver to driven."""
    node_coordinate: FloatArray
    """Belt coordinate of the nodes in the unstretched belt, m, shape (nodes,)."""
    element_coordinate: FloatArray
    """Belt coordinate of the elements' middles in the unstretched belt, m, shape (elements,)."""
    belt_coordinate: FloatArray
    """Belt coordinate of the contact points in the unstretched belt, m, shape (contact_points,)."""
    coordinate_names: tuple[str, ...]
    """Names of the coordinates of a node."""
    tensioners: tuple[str, ...] = ()
    """Names of the pulleys carried by tensioners, in the order of their coordinates."""
    nips: tuple[str, ...] = ()
    """Names of the rollers of nips, in the order of the pulleys."""
    carriages: tuple[str, ...] = ()
    """Name of the carriage, if there is one."""
    rolls: tuple[str, ...] = ()
    """Names of unwinder and winder that have rolls."""
    bodies: tuple[str, ...] = ()
    """Names of all bodies other than the belt, in the order of the coordinates."""
    tooth_coordinate: tuple[float, ...] = ()
    """Belt coordinate of single teeth in the unstretched belt, m."""

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.node_coordinate)

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.element_coordinate)

    @property
    def contact_points(self) -> int:
        """Number of points at which contact is recorded."""
        return len(self.belt_coordinate)

    @property
    def coordinates(self) -> dict[str, NDArray[Any]]:
        """Every coordinate of the dataset but times, by name; those along a dimension of size zero are left out."""
        values: Mapping[str, Any] = {
            "pulley": self.pulleys,
            "span": self.spans,
            "tensioner": self.tensioners,
            "nip": self.nips,
            "carriage": self.carriages,
            "roll": self.rolls,
            "body": self.bodies,
            "axis": AXIS_NAMES,
            "coordinate": self.coordinate_names,
            "node_coordinate": self.node_coordinate,
            "element_coordinate": self.element_coordinate,
            "belt_coordinate": self.belt_coordinate,
            "tooth_coordinate": self.tooth_coordinate,
            "arc_share": arc_shares(),
        }
        return {name: np.asarray(value, COORDINATES[name].dtype) for name, value in values.items() if len(value)}

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Size of every dimension but times; those of size zero are left out."""
        sizes = {
            "pulley": len(self.pulleys),
            "span": len(self.spans),
            "tensioner": len(self.tensioners),
            "nip": len(self.nips),
            "carriage": len(self.carriages),
            "roll": len(self.rolls),
            "body": len(self.bodies),
            "axis": len(AXIS_NAMES),
            "coordinate": len(self.coordinate_names),
            "node": self.nodes,
            "element": self.elements,
            "contact_point": self.contact_points,
            "tooth": len(self.tooth_coordinate),
            "arc_part": ARC_PARTS,
        }
        return {name: size for name, size in sizes.items() if size}

    @cached_property
    def recorded(self) -> dict[str, Variable]:
        """The variables of `RECORDED` without those that have a dimension of size zero."""
        sizes = self.sizes
        return {name: variable for name, variable in RECORDED.items() if all(dim in sizes for dim in variable.dims[1:])}

    def shape(self, variable: Variable, outputs: int) -> tuple[int, ...]:
        """Shape of a variable."""
        sizes = self.sizes
        return (outputs, *(sizes[dim] for dim in variable.dims[1:]))


# Expected size of the results of a drive

_CHUNK_BYTES = 32768
"""Bytes of a chunk, the outputs of a variable that a file keeps together; a longer row has a chunk of its own."""
_CHUNK_ROWS = 1024
"""Outputs of a chunk, at most, so that chunks of variables with few numbers are not mostly empty in short runs."""
_HEADER = 64_000
"""Bytes of a file without outputs, about."""
_COPIES = 2.0
"""Parts of memory that a run in memory takes while its outputs are put together, over their size."""
_UNITS = ("bytes", "kB", "MB", "GB", "TB")


def chunk_rows(row: tuple[int, ...], dtype: str) -> int:
    """Number of outputs that a file keeps together of a variable, whose rows have a shape."""
    return min(max(_CHUNK_BYTES // _row_bytes(row, dtype), 1), _CHUNK_ROWS)


def expected_bytes(prepared: Prepared) -> int:
    """Give the expected size of the results of a run."""
    instants, sizes = prepared.simulation.instants, _sizes(prepared)
    counts = {"time": instants.count, "field_time": instants.fields, "filtered_time": instants.count}
    return _HEADER + sum(
        _variable_bytes(variable, tuple(sizes[dim] for dim in variable.dims[1:]), counts[variable.dims[0]])
        for variable in RECORDED.values()
        if all(sizes[dim] for dim in variable.dims[1:])
    )


def describe_size(prepared: Prepared) -> str:
    """Describe the number, interval and size of outputs."""
    instants = prepared.simulation.instants
    return (
        f"{_in_words(expected_bytes(prepared))}: {instants.count} outputs every {instants.interval:.4g} s, "
        f"{instants.fields} along the belt every {instants.stride * instants.interval:.4g} s"
    )


def require_room(prepared: Prepared, path: Path | None) -> None:
    """Check that the results of a run fit on the disk or in memory."""
    expected = expected_bytes(prepared)
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
        settings = prepared.simulation
        raise ModelError(
            f"the results need {_in_words(needed)} of {place}, but only {_in_words(free)} are free: "
            f"{describe_size(prepared)}. {remedy}, increase simulation.output_interval = {settings.output_interval:g} "
            "s or simulation.field_interval, or simulate a shorter time."
        )


def _sizes(prepared: Prepared) -> dict[str, int]:
    """Size of every dimension but times."""
    belt, pulleys = prepared.belt, len(prepared.pulleys)
    kind, curves = belt.element_kind, belt.element_kind.curves * belt.given_elements
    points = 2 if prepared.contact.sampling == "nodal" else prepared.contact.quadrature_points
    return {
        "pulley": pulleys,
        "span": prepared.path.spans,
        "tensioner": len(prepared.moving_tensioners),
        "nip": len(prepared.path.nips),
        "carriage": int(prepared.carriage is not None),
        "roll": len(prepared.drive.rolls),
        "body": _bodies(prepared),
        "axis": len(AXIS_NAMES),
        "coordinate": len(kind.coordinates),
        "node": kind.points
        * (belt.given_elements + (bool(prepared.ends) or prepared.simulation.joint == "multipliers")),
        "element": curves,
        "contact_point": points * curves,
        "tooth": (belt.teeth or 0) if belt.has_single_teeth and not prepared.frame.stays else 0,
        "arc_part": ARC_PARTS,
    }


def _bodies(prepared: Prepared) -> int:
    """Number of what has a coordinate beside the belt: rims, hub chains, controllers, belt, tensioners or carriage."""
    behind = sum(len(one.hub) + sum(load.state_lag is not None for load in one.load) for one in prepared.pulleys)
    by_arcs = prepared.drive.is_web or prepared.carries or prepared.carriage is not None
    flows = prepared.frame.stays * (1 + by_arcs * len(prepared.path.on) + prepared.drive.is_web)
    carried = len(prepared.moving_tensioners) + (prepared.carriage is not None)
    return len(prepared.pulleys) + behind + flows + carried


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

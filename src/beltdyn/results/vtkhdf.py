"""Runs as VTKHDF files for ParaView and VTK."""

from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.results.atomic import MARK, atomic_path, require_replaceable
from beltdyn.results.run import Run
from beltdyn.results.scene import Cylinders, Frames, Ribbon, Surface, batches
from beltdyn.results.staged_file import staged_hdf5

_VERSION = (2, 2)
"""Version of the format."""

_CELL_KINDS = ("Vertices", "Lines", "Polygons", "Strips")
"""Kinds of cells of a surface, all of which a file must have, in the order of the columns of offsets."""

_MAKER = "creator"

_PARTS: dict[str, type[Ribbon | Cylinders]] = {"belt": Ribbon, "pulleys": Cylinders}


def write_vtkhdf(run: Run, path: Path | str, overwrite: bool = False) -> list[Path]:
    """Write belt and pulleys over time for ParaView and VTK.

    Each of them is a surface (PolyData) in a file of its own, at every instant at which fields were recorded. The belt
    is a ribbon of its width, with ``normal_force`` (N/m), ``contact_pressure`` (Pa, the normal force over the width),
    ``friction_force`` (N/m) and ``slip_velocity`` (m/s) at its points, and ``belt_tension`` and ``tension_variation``
    (N) on its polygons. Pulleys are cylinders that turn, with ``pulley`` (their number), ``pulley_speed`` (rad/s),
    ``pulley_angle`` (rad), ``pulley_torque`` (N m) and ``mark``, 1 on one sector and 0 elsewhere, on their polygons.
    Numbers have single precision, times double.

    Parameters
    ----------
    run : Run
        The run.
    path : Path or str
        A result file, beside and after which the files are named.
    overwrite : bool
        Replace any regular files, and not only those of this function.

    Returns
    -------
    list of Path
        ``NAME-belt.vtkhdf`` and ``NAME-pulleys.vtkhdf``.

    Raises
    ------
    ModelError
        If the run holds no output, or a file cannot be written or would replace one that is not ours.

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
    """Check that files replace at most those of `write_vtkhdf`.

    Parameters
    ----------
    path : Path or str
        The result file after which they are named.
    overwrite : bool
        Whether any regular files may be replaced.

    Raises
    ------
    ModelError
        If there is another file.
    """
    for file in _files(path).values():
        require_replaceable(file, _is_ours, overwrite)


def _files(path: Path | str) -> dict[str, Path]:
    """The file of each part."""
    path = Path(path)
    return {name: path.with_name(f"{path.stem}-{name}.vtkhdf") for name in _PARTS}


def _is_ours(path: Path) -> bool:
    """Whether a file was written by `write_vtkhdf`."""
    with suppress(OSError), h5py.File(path, "r") as file:
        return file.attrs.get(_MAKER) == MARK and "VTKHDF" in file
    return False


def _write_part(path: Path, run: Run, part: Ribbon | Cylinders) -> None:
    """Write a part at all instants, some at a time."""
    path.touch()
    times = run.dataset["field_time"].values
    with staged_hdf5(path, "w") as file:
        file.attrs[_MAKER] = MARK
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
    """A surface in a file, to which instants are appended.

    Parameters
    ----------
    group : h5py.Group
        Where it stands, with its polygons.
    count : int
        Number of all instants.
    done : int
        Of these that were written.
    """

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

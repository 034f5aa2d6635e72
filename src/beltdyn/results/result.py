"""The result of an analysis: a labeled dataset, its drive, and its file."""

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from beltdyn.analyses import ANALYSES
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Prepared, loads, prepare
from beltdyn.parts.messages import listing
from beltdyn.results.atomic import atomic_path, unreadable
from beltdyn.results.dataset import is_result, kind_of
from beltdyn.results.netcdf import write_dataset
from beltdyn.results.provenance import STAYING, mesh_used, own_kinds, provenance, unknown_kinds
from beltdyn.results.schema import Variable

if TYPE_CHECKING:
    import xarray as xr

    from beltdyn.results.schema import Recorded


_MOST_SIZES = 4
"""Dimensions that a result names where it says what it is."""


class Result:
    """The result of an analysis.

    Parameters
    ----------
    dataset : xarray.Dataset
        Labeled variables; its attributes include ``kind``, ``drive``, ``status`` and ``warnings``.
    drive : Drive or ModelError
        The drive that was analyzed, or why it cannot be read.
    path : Path or None
        The result file, or None for a result in memory.

    Examples
    --------
    >>> run.kind, run.drive.title
    ('run', 'Belt drive')
    """

    def __init__(self, dataset: "xr.Dataset | None", drive: Drive | ModelError, path: Path | None = None) -> None:
        self._drive, self.path = drive, path
        self._dataset = dataset

    def __repr__(self) -> str:
        try:
            said = f"{self._extent}; {self.status}"
        except (ModelError, OSError):
            said = "its file cannot be read any more"
        file = "" if self.path is None else f", {self.path}"
        title = self._drive.title if isinstance(self._drive, Drive) else "a drive with kinds not registered here"
        return f'{type(self).__name__} of "{title}": {said}{file}'

    @property
    def _extent(self) -> str:
        """What it covers, in a few words."""
        sizes = [f"{size} {dim}" for dim, size in list(self.dataset.sizes.items())[:_MOST_SIZES]]
        return ", ".join([self.kind.replace("_", " "), *sizes])

    def _repr_html_(self) -> str:
        """Show the result in a notebook: presentation lies above, and is found by its name."""
        html: str = import_module("beltdyn.show.notebook").result_html(self)
        return html

    @cached_property
    def prepared(self) -> Prepared:
        """The drive with all that it leaves open; see `prepare`."""
        return prepare(self.drive)

    @property
    def drive(self) -> Drive:
        """The drive that was analyzed.

        Raises
        ------
        ModelError
            If it has a kind that is not registered here.
        """
        if isinstance(self._drive, ModelError):
            raise self._drive
        return self._drive

    @property
    def dataset(self) -> "xr.Dataset":
        """All variables with their dimensions, units and meaning."""
        assert self._dataset is not None
        return self._dataset

    @property
    def stored(self) -> "xr.Dataset":
        """The variables stored in a file."""
        return self.dataset

    @property
    def drive_as_given(self) -> str:
        """The drive file as given, before the analysis chose its open values."""
        return str(self.dataset.attrs.get("drive_as_given") or self.drive.text)

    @property
    def status(self) -> str:
        """How the analysis ended: "completed"; for a `Run` also "running", "interrupted" or "failed"."""
        return str(self.dataset.attrs["status"])

    @property
    def kind(self) -> str:
        """Name of the analysis, or "run" for results over time; each figure belongs to one kind."""
        return kind_of(self.dataset)

    @property
    def source(self) -> str:
        """Python that gives this result, such as ``bd.open_result("drive.nc")``."""
        return "result" if self.path is None else f"bd.open_result({str(self.path)!r})"

    @property
    def warnings(self) -> list[str]:
        """The warnings: faults and remedies; empty for a sound result."""
        return str(self.dataset.attrs.get("warnings", "")).splitlines()

    def require_output(self) -> None:
        """Make sure that this is a run with an output; see `Run`."""
        raise ModelError(
            f"this needs results over time, of a run; these are of {self.kind.replace('_', ' ')}. Use their dataset."
        )

    def require(self, name: str) -> None:
        """Make sure that a run has recorded a variable; see `Run`."""
        self.require_output()

    def recorded(self) -> "AbstractContextManager[Recorded]":
        """The recorded variables of a run; see `Run`."""
        self.require_output()
        raise NotImplementedError

    def fields_at(self, time: float | None = None) -> "xr.Dataset":
        """The variables of a run at an instant; see `Run`."""
        self.require_output()
        raise NotImplementedError

    def save(self, path: Path | str, overwrite: bool = False) -> Path:
        """Save the result to a file for `open_result` and `beltdyn plot`.

        Parameters
        ----------
        path : Path or str
            The file (NetCDF4); an existing beltdyn result is replaced.
        overwrite : bool
            Replace any regular file.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        ModelError
            If the file cannot be written, or would replace a file that is not a result.
        """
        path = Path(path)
        with atomic_path(path, is_result, overwrite) as temporary:
            write_dataset(temporary, self.stored)
        return path


def build_result(
    kind: str,
    drive: Drive,
    variables: Mapping[str, tuple[Variable, ArrayLike]],
    coordinates: Mapping[str, tuple[Variable, ArrayLike]],
    warnings: Sequence[str] = (),
) -> Result:
    """Build the result of an analysis.

    Parameters
    ----------
    kind : str
        Name of the analysis.
    drive : Drive
        The drive that was analyzed.
    variables : mapping
        Name -> description and values of a variable.
    coordinates : mapping
        The same for coordinates; a coordinate named after its dimension labels that dimension.
    warnings : sequence of str
        The warnings, one line each.

    Returns
    -------
    Result
        In memory, with its provenance among its attributes.

    Examples
    --------
    >>> power, speed = bd.extend.Variable(("speed",), "W", "Power"), bd.extend.Variable(("speed",), "rad/s", "Speed")
    >>> known, over = {"power": (power, [10.0, 20.0])}, {"speed": (speed, [50.0, 100.0])}
    >>> found = bd.extend.build_result("dynamometer", drive, known, over)
    >>> found.dataset.power.sel(speed=100.0).item()
    20.0
    """
    import xarray as xr

    def labelled(parts: Mapping[str, tuple[Variable, ArrayLike]]) -> dict[str, tuple[object, ...]]:
        return {name: (variable.dims, values, variable.attributes) for name, (variable, values) in parts.items()}

    origin = provenance(drive.text, f"{drive.title}, {kind.replace('_', ' ')}", kind) | own_kinds(drive)
    if kind in ANALYSES and ANALYSES[kind].stays:
        origin |= mesh_used(drive, STAYING)
    attributes = origin | {"status": "completed", "warnings": "\n".join(warnings)}
    return Result(xr.Dataset(labelled(variables), labelled(coordinates), attributes), drive)


def drive_of(dataset: "xr.Dataset", path: Path) -> Drive | ModelError:
    """Read the drive of a result file, or say which of its kinds are not registered."""
    if unknown := unknown_kinds(dataset.attrs):
        return ModelError(
            f"the drive of {path} has the {listing(unknown)}, not registered here. Its dataset can be used; to use the "
            "drive, figures and checks, import what registers it before opening the file."
        )
    try:
        return loads(dataset.attrs["drive"], base=path.parent)
    except ValueError as error:
        raise ModelError(unreadable(path, error)) from error

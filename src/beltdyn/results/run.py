"""A run: its dataset, the drive it belongs to and how it ended; its outputs in a time range."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from beltdyn.analyses import EQUILIBRIUM, RUN
from beltdyn.errors import ModelError
from beltdyn.model import ERROR_LIMITS, Drive, Prepared, layer_lengths
from beltdyn.results.atomic import stamp, unreadable
from beltdyn.results.checks import Finding, find
from beltdyn.results.dataset import complete_dataset, kind_of, open_dataset, read_dataset
from beltdyn.results.means import PulleySummary, pulley_means
from beltdyn.results.provenance import (
    MESH,
    Resolution,
    estimate_resolution,
    found_errors,
    mesh_error_attribute,
    mesh_resolution,
)
from beltdyn.results.result import Result, build_result, drive_of
from beltdyn.results.schema import (
    COORDINATES,
    DERIVED,
    TIMES,
    VARIABLES,
    InFile,
    InMemory,
    Recorded,
    Variable,
    runs_steadily,
)

if TYPE_CHECKING:
    import xarray as xr

T = TypeVar("T")

# Results of static equilibrium: tensions, contact forces and hub loads

_MOTION = ("pulley_speed", "pulley_angle", "friction_force", "slip_velocity")
"""What is zero at rest, and figures of a drive at one instant look at."""

OWN = {
    "belt_length": Variable((), "m", "Unstretched length of the belt"),
    "tension": Variable((), "N", "Mean tension of the spans"),
    "hub_load": Variable(("pulley",), "N", "Hub load"),
}
"""What a drive at rest has beside the variables of a run."""


class StaticResult(Result):
    """Results of static equilibrium.

    Parameters
    ----------
    dataset : xarray.Dataset
        Variables of a `Run` without a time, and ``belt_length``, ``tension`` and ``hub_load``.
    drive : Drive
        The drive, with the belt length or the take-up that gives the installed tension.
    path : Path or None
        The result file, or None for a result in memory.

    Examples
    --------
    >>> rest = bd.equilibrium(drive)
    >>> rest.kind, rest.dataset.tension.attrs["units"]
    ('equilibrium', 'N')
    """

    def fields_at(self, time: float | None = None) -> "xr.Dataset":
        """All variables as one instant at time zero; see `Run.fields_at`."""
        sizes, motion = self.dataset.sizes, {name: VARIABLES[name] for name in _MOTION}
        still = {
            name: (one.dims[1:], np.zeros([sizes[dim] for dim in one.dims[1:]]), one.attributes)
            for name, one in motion.items()
        }
        return self.dataset.assign(still).assign_coords(time=0.0)

    @cached_property
    def resolution(self) -> Resolution:
        """The mesh error: found with a finer mesh, or else estimated."""
        found, tension = found_errors(self.dataset), float(self.dataset["belt_tension"].mean())
        if found:
            return Resolution(found, {}, layer_lengths(self.prepared, tension))
        return mesh_resolution(self.prepared, tension, 0.0)


def static_result(run: "Run") -> StaticResult:
    """Give the drive at rest of a run that holds it as its only output."""
    instant = run.fields_at()
    seen = {
        name: (replace(variable, dims=variable.dims[1:]), instant[name].values)
        for name, variable in VARIABLES.items()
        if variable.at_rest and name in instant
    }
    own = (
        run.prepared.belt_length,
        float(instant["span_tension"].mean()),
        np.linalg.norm(instant["hub_force"], axis=1),
    )
    variables = {name: (OWN[name], values) for name, values in zip(OWN, own, strict=True)} | seen
    used = {dim for variable, _ in variables.values() for dim in variable.dims}
    coordinates = {
        name: (variable, instant[name].values)
        for name, variable in COORDINATES.items()
        if name in instant.coords and used.issuperset(variable.dims)
    }
    result = build_result(EQUILIBRIUM, run.drive, variables, coordinates, run.warnings)
    names = ("title", "drive_as_given", *MESH, *map(mesh_error_attribute, ERROR_LIMITS))
    kept = {name: run.dataset.attrs[name] for name in names if name in run.dataset.attrs}
    return StaticResult(result.dataset.assign_attrs(kept), run.drive)


class Run(Result):
    """The result of a simulation.

    Parameters
    ----------
    dataset : xarray.Dataset or None
        All recorded variables; None for a finished result file, which is opened on demand.
    drive : Drive
        The drive that was simulated.
    path : Path or None
        The result file, or None for a run in memory.

    Examples
    --------
    >>> run.status, run.dataset["pulley_speed"].dims
    ('completed', ('time', 'pulley'))
    """

    def __init__(self, dataset: "xr.Dataset | None", drive: Drive | ModelError, path: Path | None = None) -> None:
        super().__init__(dataset, drive, path)
        self._stamp = None if path is None else stamp(path)

    @property
    def _extent(self) -> str:
        dataset, pulleys = self.dataset, f"{len(self.drive.pulleys)} pulleys"
        if runs_steadily(dataset):
            return f"steady running, {pulleys}"
        times = dataset["time"].values
        over = f"{times[0]:.4g} to {times[-1]:.4g} s, " if times.size else ""
        return f"{over}{times.size} outputs, {pulleys}"

    @property
    def kind(self) -> str:
        """Kind of all results over time."""
        return RUN

    @property
    def dataset(self) -> "xr.Dataset":
        """All recorded variables with their units; see `beltdyn.results.VARIABLES`."""
        if self._dataset is None:
            self._dataset = open_dataset(self._file)
        return self._dataset

    @property
    def stored(self) -> "xr.Dataset":
        """The variables stored in a file; parts of others are added when it is opened."""
        return self.dataset.drop_vars(DERIVED, errors="ignore")

    @property
    def fields(self) -> "xr.Dataset":
        """All variables at the instants of outputs along the belt, with ``time`` for these instants only."""
        dataset = self.dataset.drop_dims("filtered_time")
        along_belt = [name for name, variable in dataset.data_vars.items() if "field_time" in variable.dims]
        others = dataset.drop_vars([*along_belt, "field_time"]).sel(time=dataset["field_time"].values)
        fields = dataset[along_belt].rename(field_time="time")
        return others.assign({name: fields[name] for name in along_belt})

    def fields_at(self, time: float | None = None) -> "xr.Dataset":
        """All variables at one instant of the outputs along the belt.

        Parameters
        ----------
        time : float, optional
            s; the nearest of these instants is used. By default the last.

        Returns
        -------
        xarray.Dataset
            Without the dimension ``time``.

        Raises
        ------
        ModelError
            If the run holds no output.
        """
        self.require_output()
        times = self.dataset["field_time"].values
        number = -1 if time is None else int(np.argmin(np.abs(times - time)))
        instant = self.dataset.drop_dims("filtered_time").isel(field_time=number).sel(time=times[number])
        return instant.drop_vars("field_time")

    @contextmanager
    def recorded(self) -> Iterator[Recorded]:
        """The recorded variables: arrays in memory, or those of the open file, which are faster than a dataset's."""
        if self._dataset is not None:
            yield InMemory(self._dataset)
            return
        with h5py.File(self._file, "r") as file:
            yield InFile(file)

    @property
    def _file(self) -> Path:
        """The result file, if it is still that of this run."""
        if self.path is None or self._stamp is None or stamp(self.path) != self._stamp:
            raise ModelError(
                f"{self.path} was changed, replaced or removed after this run wrote it. Run the drive again."
            )
        return self.path

    @property
    def status(self) -> str:
        """How the run ended: "completed", "interrupted", "failed", or "running" if its end was not recorded."""
        with self.recorded() as recorded:
            return str(recorded.attrs["status"])

    @property
    def outputs(self) -> int:
        """Number of recorded outputs."""
        with self.recorded() as recorded:
            return len(recorded["time"])

    @cached_property
    def findings(self) -> list[Finding]:
        """The findings: faults, the values they affect, and remedies; empty for a sound run."""
        resolution = self.resolution if self.outputs else None
        with self.recorded() as recorded:
            return find(recorded, self.prepared, resolution, lambda: self.pulley_means)

    @cached_property
    def warnings(self) -> list[str]:
        """The findings as texts."""
        return [str(finding) for finding in self.findings]

    @cached_property
    def pulley_means(self) -> tuple[PulleySummary, ...]:
        """Means of the pulleys over the averaging window.

        Raises
        ------
        ModelError
            If the run holds no output.
        """
        return self._from_outputs(pulley_means)

    @cached_property
    def resolution(self) -> Resolution:
        """The estimated mesh error.

        Raises
        ------
        ModelError
            If the run holds no output.
        """
        return self._from_outputs(estimate_resolution)

    def _from_outputs(self, function: Callable[[Recorded, Prepared], T]) -> T:
        """What a function makes of the recorded outputs and the prepared drive."""
        self.require_output()
        with self.recorded() as recorded:
            return function(recorded, self.prepared)

    def require(self, name: str) -> None:
        """Check that an optional variable was recorded.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        ModelError
            If it was not.
        """
        if name not in self.dataset:
            raise ModelError(
                f"this result has no `{name}`: it was written by another version of beltdyn. Run the drive again."
            )

    def require_output(self) -> None:
        """Check that the run holds an output.

        Raises
        ------
        ModelError
            If the run holds no output.
        """
        if self.outputs == 0:
            raise ModelError("the run ended before its first output: there is nothing to show. Run the drive again.")


def open_run(path: Path | str) -> Run:
    """Open the result file of a run lazily.

    Parameters
    ----------
    path : Path or str
        A file written by `FileRecorder`, finished or not.

    Returns
    -------
    Run
        The run with its complete outputs.

    Raises
    ------
    ModelError
        If the file cannot be read or is not a result of beltdyn.

    Examples
    --------
    >>> short = drive.replace(simulation=drive.simulation.replace(duration=0.01))
    >>> _ = bd.simulate(short, "short.nc")
    >>> bd.results.open_run("short.nc").dataset.pulley_speed.dims
    ('time', 'pulley')
    """
    path = Path(path)
    return _run(path, open_dataset(path))


def _run(path: Path, dataset: "xr.Dataset") -> Run:
    """The run of a dataset, which is closed if it is refused."""
    try:
        drive = drive_of(dataset, path)
        names = list(dataset["pulley"].values)
        if isinstance(drive, Drive) and names != [pulley.name for pulley in drive.pulleys]:
            raise ModelError(unreadable(path, ValueError("its pulleys do not match its drive")))
    except ModelError:
        dataset.close()
        raise
    return Run(dataset, drive, path)


def run_of(option: str, given: object) -> Run:
    """The run, or the result file of one, that an option of an analysis names."""
    result = open_result(given) if isinstance(given, Path | str) else given
    if isinstance(result, Run):
        return result
    if not isinstance(result, Result):
        raise ModelError(f"{option} = {result!r} is not a run. Give a run, or the result file of `beltdyn simulate`.")
    where = f" = {str(given)!r}" if isinstance(given, Path | str) else ""
    raise ModelError(
        f"{option}{where} holds results of {result.kind}, not of a run. Give a result file of `beltdyn simulate`."
    )


def open_result(path: Path | str) -> Result:
    """Open a result file of any kind lazily.

    Parameters
    ----------
    path : Path or str
        A file written by a run or by another analysis.

    Returns
    -------
    Result
        A `Run` where results grow over time, a `StaticResult` of a drive at rest.

    Raises
    ------
    ModelError
        If the file cannot be read or is not a result of beltdyn.

    Examples
    --------
    >>> _ = bd.equilibrium(drive).save("rest.nc")
    >>> bd.open_result("rest.nc").dataset.sizes["span"]
    2
    """
    path = Path(path)
    dataset = read_dataset(path)
    try:
        kind = kind_of(dataset)
        if kind != RUN:
            return (StaticResult if kind == EQUILIBRIUM else Result)(dataset, drive_of(dataset, path), path)
    except ModelError:
        dataset.close()
        raise
    return _run(path, complete_dataset(path, dataset))


def labelled(values: NDArray[Any], like: "xr.DataArray", units: str, long_name: str) -> "xr.DataArray":
    """Give an array the dimensions and coordinates of another one, and its own unit and name."""
    return like.copy(data=values).assign_attrs(units=units, long_name=long_name)


def window(run: Run, start: float | None = None, end: float | None = None) -> "xr.Dataset":
    """Take the outputs from one instant to another, both included, and those of fields between them."""
    run.require_output()
    dataset = run.dataset.sel({name: slice(start, end) for name in TIMES})
    if dataset.sizes["time"] == 0:
        times = run.dataset["time"].values
        raise ModelError(
            f"there is no output from {in_words(start, end)}; the run was recorded from {times[0]:g} to "
            f"{times[-1]:g} s. Choose a time range between these."
        )
    return dataset


def in_words(start: float | None, end: float | None) -> str:
    """A time range whose ends may be open."""
    first = "the start" if start is None else f"{start:g} s"
    return f"{first} to the end" if end is None else f"{first} to {end:g} s"


def pulley_number(run: Result, pulley: str | int) -> int:
    """Give the number of a pulley.

    Parameters
    ----------
    run : Result
        What was computed of a drive.
    pulley : str or int
        Its name or number.

    Raises
    ------
    ModelError
        If there is no such pulley.

    Examples
    --------
    >>> bd.derived.pulley_number(run, "driven")
    1
    """
    if isinstance(pulley, int) and 0 <= pulley < len(run.drive.pulleys):
        return pulley
    return run.drive.number_of(pulley)

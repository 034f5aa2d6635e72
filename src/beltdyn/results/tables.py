"""Plain tables of a run, for spreadsheets and other programs."""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.results.atomic import atomic_path, make_folder
from beltdyn.results.run import Run

if TYPE_CHECKING:
    import xarray as xr

_PULLEYS = ("pulley_speed", "pulley_angle", "pulley_torque", "shaft_torque", "hub_force", "wrap_angle")
_SPANS = ("span_tension", "belt_speed")
_ENERGY = (
    "kinetic_energy",
    "strain_energy",
    "penalty_energy",
    "driver_work",
    "torque_work",
    "friction_loss",
    "damping_loss",
    "energy_closure",
    "step_size",
)
_CONTACT = ("contact_position", "contact_pulley", "normal_force", "friction_force", "slip_velocity")

Column = tuple[str, NDArray[Any]]


def write_csv(run: Run, folder: Path | str) -> list[Path]:
    """Write tables: pulleys, spans and energy over time, and contact at the last output.

    Every file has one line of headings, such as ``pulley_speed driver [rad/s]``, and numbers with
    ten significant digits.

    Parameters
    ----------
    run : Run
        The run.
    folder : Path or str
        Where to write; made if need be.

    Returns
    -------
    list of Path
        ``pulleys.csv``, ``spans.csv``, ``energy.csv`` and ``contact.csv``.

    Raises
    ------
    ModelError
        If the run holds no output, or a file cannot be written.
    """
    run.require_output()
    folder = make_folder(Path(folder))
    last = run.dataset.isel(time=-1)
    tables = {
        "pulleys.csv": _columns(run.dataset, ("time", *_PULLEYS)),
        "spans.csv": _columns(run.dataset, ("time", *_SPANS)),
        "energy.csv": _columns(run.dataset, ("time", *_ENERGY)),
        "contact.csv": _columns(last, ("belt_coordinate", *_CONTACT)),
    }
    return [_write(folder / name, list(columns)) for name, columns in tables.items()]


def _columns(dataset: "xr.Dataset", names: Iterable[str]) -> Iterable[Column]:
    """Take variables apart into columns along their first dimension."""
    for name in names:
        variable = dataset[name]
        labels = [dataset[dim].values for dim in variable.dims[1:]]
        for index in np.ndindex(*variable.shape[1:]):
            words = [name, *(str(label[i]) for label, i in zip(labels, index, strict=True))]
            yield f"{' '.join(words)} [{variable.attrs['units']}]", variable.values[(slice(None), *index)]


def _write(path: Path, columns: list[Column]) -> Path:
    with atomic_path(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([heading for heading, _ in columns])
        rows = zip(*(values for _, values in columns), strict=True)
        writer.writerows([f"{value:.10g}" for value in row] for row in rows)
    return path

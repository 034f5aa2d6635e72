"""What the page keeps of a run: a few curves and means in place of all that was recorded, a hundredth of its size."""

from pathlib import Path

import numpy as np
import xarray as xr

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.model import Drive
from beltdyn.results import Result, Run
from beltdyn.solvers.run_progress import Report
from beltdyn.system.build import contact_points
from beltdyn.transient.simulate import simulate
from validation.paper.averages import BINS, contact_samples

CURVES = (
    *("pulley_speed", "pulley_torque", "shaft_torque", "wrap_angle", "span_tension", "belt_speed"),
    *("driver_work", "torque_work", "friction_loss", "damping_loss"),
    *("kinetic_energy", "strain_energy", "penalty_energy", "energy_closure"),
)
"""Variables that are kept at all outputs."""

AT_END = ("normal_force", "friction_force", "slip_velocity", "contact_pulley", "contact_position")
"""Variables along the belt that are kept at their last instant."""

_FREE = -1


def paper_run(drive: Drive, *, progress: Report | None = None) -> Result:
    """Simulate a drive in memory, and give what the page needs of the run.

    Parameters
    ----------
    drive : Drive
        The drive.
    progress : callable, optional
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        See `reduce`; an interrupted run as it is.
    """
    run = simulate(drive, progress=progress)
    if run.status != "completed":
        return run
    kept = reduce(run)
    for variable in kept.data_vars.values():
        variable.encoding = {"zlib": True, "shuffle": True, "complevel": 4}
    return Result(kept, run.drive)


def open_kept(path: Path) -> xr.Dataset:
    """Read what was kept of a run.

    Parameters
    ----------
    path : Path
        A file with the result of `paper_run`.
    """
    return xr.load_dataset(path, engine="h5netcdf", decode_times=False)


def reduce(run: Run) -> xr.Dataset:
    """Take curves and means from a run.

    Parameters
    ----------
    run : Run
        A run with all that was recorded.

    Returns
    -------
    xarray.Dataset
        `CURVES` over time and `AT_END` at their last instant under their own names, with the attributes of the run, and

        mean_normal_force (field_time, pulley), N/m
            Mean over the points that touch a pulley; NaN where none does.
        mean_slip_velocity (field_time), m/s
            Mean magnitude over the points that touch.
        mean_belt_tension (field_time), N
            Mean over the elements.
        mixed_elements (field_time)
            Elements with points that slide and points that stick.
        joint_gap (field_time), m
            Largest distance between the first and the last node in a direction.
        arc_normal_force, arc_friction_force (pulley, part), N/m
            Mean forces over the nominal arc at the end of the run; see `ContactSamples.mean`.
        unevenness (pulley)
            See `ContactSamples.unevenness`.
    """
    data = run.dataset
    touching, slip, normal = (data[name].values for name in ("contact_pulley", "slip_velocity", "normal_force"))
    each = [_mean_where(normal, touching == pulley) for pulley in range(len(run.drive.pulleys))]
    ends = data["node_position"].values[:, [0, -1]]
    last, over_time = run.fields_at(), "field_time"
    samples = contact_samples(run)
    arcs = {kind: np.stack([pulley.mean(kind) for pulley in samples]) for kind in ("normal", "friction")}
    assert all(arc.shape[1] == BINS for arc in arcs.values())
    return data[list(CURVES)].assign(
        {
            **{name: last[name].drop_vars("time") for name in AT_END},
            "mean_normal_force": ((over_time, "pulley"), np.stack(each, axis=1)),
            "mean_slip_velocity": (over_time, _mean_where(np.abs(slip), touching != _FREE)),
            "mean_belt_tension": data["belt_tension"].mean("element"),
            "mixed_elements": (over_time, mixed_elements(run)),
            "joint_gap": (over_time, np.abs(ends[:, 1] - ends[:, 0]).max(axis=-1)),
            **{f"arc_{kind}_force": (("pulley", "part"), arc) for kind, arc in arcs.items()},
            "unevenness": ("pulley", np.array([pulley.unevenness() for pulley in samples])),
        }
    )


def _mean_where(values: FloatArray, chosen: BoolArray) -> FloatArray:
    """Mean of the chosen values of each row; NaN where none is."""
    counts = chosen.sum(axis=1)
    return np.where(counts, (values * chosen).sum(axis=1) / np.maximum(counts, 1), np.nan)


def sliding(run: Run) -> BoolArray:
    """Where the friction law saturates; of points that do not touch it says nothing.

    Parameters
    ----------
    run : Run
        A run, or what was kept of it.
    """
    data, drive = run.dataset, run.drive
    friction = drive.frictions[data["contact_pulley"].values]
    creep = drive.friction_parameters.saturation(data["normal_force"].values, friction, 0.0)
    return np.asarray(np.abs(data["slip_velocity"].values) >= creep)


def mixed_elements(run: Run) -> IntArray:
    """Count, at each instant with fields, the elements with points that slide and points that stick.

    Parameters
    ----------
    run : Run
        A run, or what was kept of it.
    """
    touches, slides = run.dataset["contact_pulley"].values != _FREE, sliding(run)
    elements = (*slides.shape[:-1], -1, contact_points(run.drive.contact).points.size)
    some_slide, some_stick = (which.reshape(elements).any(axis=-1) for which in (touches & slides, touches & ~slides))
    return np.asarray((some_slide & some_stick).sum(axis=-1))

"""Results of static equilibrium: tensions, contact forces and hub loads."""

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.analyses import STATIC
from beltdyn.model import ERROR_LIMITS, layer_lengths
from beltdyn.results.provenance import MESH
from beltdyn.results.resolution import Resolution, found_errors, mesh_error_attribute, mesh_resolution
from beltdyn.results.result import Result, build_result
from beltdyn.results.schema import COORDINATES, VARIABLES, Variable

if TYPE_CHECKING:
    import xarray as xr

    from beltdyn.results.run import Run

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
    ('static', 'N')
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
            return Resolution(found, {}, layer_lengths(self.drive, tension))
        return mesh_resolution(self.drive, tension, 0.0)


def static_result(run: "Run") -> StaticResult:
    """Give the drive at rest of a run that holds it as its only output.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    StaticResult
        In memory, with the warnings of the run.
    """
    instant = run.fields_at()
    seen = {
        name: (replace(variable, dims=variable.dims[1:]), instant[name].values)
        for name, variable in VARIABLES.items()
        if variable.at_rest and name in instant
    }
    own = (run.drive.belt_length, float(instant["span_tension"].mean()), np.linalg.norm(instant["hub_force"], axis=1))
    variables = {name: (OWN[name], values) for name, values in zip(OWN, own, strict=True)} | seen
    used = {dim for variable, _ in variables.values() for dim in variable.dims}
    coordinates = {
        name: (variable, instant[name].values)
        for name, variable in COORDINATES.items()
        if name in instant.coords and used.issuperset(variable.dims)
    }
    result = build_result(STATIC, run.drive, variables, coordinates, run.warnings)
    names = ("title", "drive_as_given", *MESH, *map(mesh_error_attribute, ERROR_LIMITS))
    kept = {name: run.dataset.attrs[name] for name in names if name in run.dataset.attrs}
    return StaticResult(result.dataset.assign_attrs(kept), run.drive)

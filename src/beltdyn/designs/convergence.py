"""Convergence of results over meshes and tolerances: differences from the finest, observed orders, and limits."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.analyses import ANALYSES, SIMULATE
from beltdyn.arrays import FloatArray
from beltdyn.designs.study import study
from beltdyn.errors import ModelError, SimulationError
from beltdyn.model import Drive, ParameterStudy
from beltdyn.parts.messages import listing
from beltdyn.parts.options import takes_options
from beltdyn.parts.quantity import Numbers, numbers_in
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.schema import VARIOUS
from beltdyn.solvers.run_progress import Report
from beltdyn.theory.observed_order import extrapolated, observed_order

FEWEST_LEVELS = 3
"""Levels from which an order follows."""
ELEMENTS, TOLERANCE = "elements", "tolerance"
"""Axes of results."""
INTERRUPTED = "interrupted"
"""Status of results of an analysis that Ctrl-C has ended."""
_MESH_KEY = "belt.elements"
_TOLERANCE_KEYS = {SIMULATE: "simulation.rtol", "sweep": "simulation.rtol", "steady_state": "steady.force_tolerance"}
"""Keys of the tolerance, by the analysis."""


class _Axis(NamedTuple):
    """How an axis of levels is named."""

    option: str
    level: str
    """In names of variables."""
    finest: str
    variable: Variable


_AXES = {
    ELEMENTS: _Axis("meshes", "mesh", "finest mesh", Variable((ELEMENTS,), "1", "Belt elements", "int64")),
    TOLERANCE: _Axis("tolerances", "tolerance", "smallest tolerance", Variable((TOLERANCE,), "1", "Tolerance")),
}
_RESULT = ("result",)


def _variables(axis: str) -> dict[str, Variable]:
    """Variables along an axis of levels."""
    _, level, finest, _ = _AXES[axis]
    each = (*_RESULT, axis)
    return {
        f"{level}_value": Variable(each, VARIOUS, "Value"),
        f"{level}_error": Variable(each, "1", f"Difference from the {finest}, relative"),
        f"{level}_order": Variable(each, "1", "Observed order, from this level and the two before"),
        f"{level}_limit": Variable(_RESULT, VARIOUS, f"Limit beyond the {finest}, by Richardson's extrapolation"),
        f"{level}_left": Variable(_RESULT, "1", f"Difference of the {finest} from it, relative"),
    }


@takes_options
def convergence(
    drive: Drive,
    *,
    of: str | Sequence[str] = "all",
    meshes: Numbers | None = None,
    tolerances: Numbers | None = None,
    repeated: str = SIMULATE,
    progress: Report | None = None,
) -> Result:
    """Compute how results converge with the mesh and the tolerance, with observed orders.

    An analysis is repeated with each number of elements, the tolerance as in the drive, and with each tolerance, the
    elements as in the drive. Orders follow from three levels each, where these approach a limit in one sense.

    Parameters
    ----------
    drive
        The drive.
    of
        Results, a list or separated by commas, as of a study, such as "efficiency, hub_load[driven]" or
        "largest(span_tension)"; "all" are all single numbers.
    meshes
        Numbers of belt elements, at least three, such as "20, 40, 80". A mesh that is refined has at least as many.
    tolerances
        Tolerances, at least three, such as "1e-3, 1e-4, 1e-5": of `simulate` and `sweep` ``simulation.rtol``, of
        `steady_state` ``steady.force_tolerance``.
    repeated
        The analysis that is repeated, by its name, such as "simulate" or "steady_state".
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Along ``result`` and ``elements`` ``mesh_value`` in SI units (``unit``), ``mesh_error``, relative to the finest
        mesh, and ``mesh_order``; along ``result`` the extrapolated ``mesh_limit``, and ``mesh_left``, the relative
        difference from it of the finest mesh. Along ``tolerance`` the same with ``tolerance_value`` and so on.

    Raises
    ------
    ModelError
        If there are fewer than three levels, the analysis has no tolerance, or there is no such result.
    SimulationError
        If no level could be computed.
    KeyboardInterrupt
        After Ctrl-C before the first level; later the result has the status "interrupted".

    Examples
    --------
    >>> found = bd.convergence(drive, of="hub_load[driven]", meshes=[12, 16, 24], repeated="equilibrium")
    >>> found.dataset.mesh_error.dims
    ('result', 'elements')
    """
    sizes = {
        axis: _levels(axis, numbers)
        for axis, numbers in ((ELEMENTS, meshes), (TOLERANCE, tolerances))
        if numbers is not None
    }
    if not sizes:
        raise ModelError("no levels are given. Give meshes = [20, 40, 80] or tolerances = [1e-3, 1e-4, 1e-5].")
    if repeated not in ANALYSES:
        raise ModelError(f'repeated = "{repeated}" is no analysis. Choose one of {listing(list(ANALYSES))}.')
    keys = {axis: _key(axis, repeated) for axis in sizes}
    results = [name.strip() for name in of.split(",")] if isinstance(of, str) else list(of)
    studies = dict[str, Result]()
    for axis, levels in sizes.items():
        plan = ParameterStudy(
            analysis=repeated, results=results, number=[{"path": keys[axis], "values": levels.tolist()}]
        )
        studies[axis] = study(plan, drive, jobs=1, progress=progress)
        if studies[axis].status == INTERRUPTED:
            break
    return _result(drive, repeated, sizes, studies)


def _levels(axis: str, numbers: Numbers) -> NDArray[Any]:
    """Levels of an axis, the finest last."""
    name = _AXES[axis].option
    levels = numbers_in(name, numbers, "", FEWEST_LEVELS)
    if levels.size < FEWEST_LEVELS:
        raise ModelError(f"{name} has {levels.size} levels; an order needs at least {FEWEST_LEVELS}. Give more.")
    if axis == TOLERANCE:
        return levels[::-1]
    if np.any(levels != np.round(levels)):
        raise ModelError(f"{name} = {numbers!r} must be whole numbers.")
    return levels.astype(int)


def _key(axis: str, analysis: str) -> str:
    """The key of the drive file that an axis varies."""
    if axis == TOLERANCE and analysis not in _TOLERANCE_KEYS:
        raise ModelError(f'"{analysis}" has no tolerance. Give meshes, or choose {listing(list(_TOLERANCE_KEYS))}.')
    return _MESH_KEY if axis == ELEMENTS else _TOLERANCE_KEYS[analysis]


def _result(drive: Drive, analysis: str, sizes: Mapping[str, NDArray[Any]], studies: Mapping[str, Result]) -> Result:
    """Values, differences and orders of all results that a study has."""
    names = list(
        dict.fromkeys(name for table in studies.values() for name in table.dataset.attrs["results"].split("\n"))
    )
    is_interrupted = any(table.status == INTERRUPTED for table in studies.values())
    if not any(names):
        if is_interrupted:
            raise KeyboardInterrupt
        raise SimulationError("\n".join(doubt for table in studies.values() for doubt in table.warnings))
    units = [
        next(table.dataset[name].attrs["units"] for table in studies.values() if name in table.dataset)
        for name in names
    ]
    values: dict[str, tuple[Variable, Any]] = {"unit": (Variable(_RESULT, "1", "Unit", "str"), units)}
    coordinates: dict[str, tuple[Variable, Any]] = {"result": (Variable(_RESULT, "1", "Result", "str"), names)}
    doubts = list[str]()
    for axis, axis_study in studies.items():
        table, levels = axis_study.dataset, sizes[axis]
        missing = np.full(levels.size, np.nan)
        computed = np.array([table[name].values if name in table else missing for name in names], dtype=float)
        steps = 1.0 / levels if axis == ELEMENTS else levels
        variables = _variables(axis)
        values |= dict(zip(variables, zip(variables.values(), _columns(steps, computed), strict=True), strict=True))
        coordinates[axis] = _AXES[axis].variable, levels
        doubts += [f"{axis}: {doubt}" for doubt in axis_study.warnings]
    result = build_result("convergence", drive, values, coordinates, doubts)
    result.dataset.attrs |= {"axes": "result", "columns_by": " ".join(studies)}
    result.dataset.attrs["title"] = f"Convergence of {drive.title}: {analysis}"
    if is_interrupted:
        result.dataset.attrs["status"] = INTERRUPTED
    return result


def _columns(steps: FloatArray, computed: FloatArray) -> tuple[FloatArray, ...]:
    """Values, relative differences, orders, limits, and what is left on the finest level; of each result a row."""
    scale = np.abs(computed[:, -1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        differences = np.where(scale > 0.0, np.abs(computed - computed[:, -1:]) / scale, np.nan)
    orders = np.full(computed.shape, np.nan)
    limits = np.full(len(computed), np.nan)
    for row, numbers in enumerate(computed):
        for last in range(FEWEST_LEVELS - 1, steps.size):
            levels = slice(last - FEWEST_LEVELS + 1, last + 1)
            orders[row, last] = observed_order(steps[levels].tolist(), numbers[levels].tolist())
        if np.isfinite(orders[row, -1]):
            limits[row] = extrapolated(steps[-2:].tolist(), numbers[-2:].tolist(), orders[row, -1])
    with np.errstate(divide="ignore", invalid="ignore"):
        left = np.abs(computed[:, -1] - limits) / np.abs(limits)
    return computed, differences, orders, limits, left

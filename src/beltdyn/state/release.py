"""The belt released from its pulleys: its shape in equilibrium, and during the iterations (Figs. 4 and 5)."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.parts.messages import listing
from beltdyn.parts.options import takes_options
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.schema import AXIS_NAMES, COORDINATES
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.state.installation import on_equal_elements
from beltdyn.state.static import Equilibrium, find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.observe import observe
from beltdyn.system.state import State, at_rest, laid, point_coordinates

METHODS = ("globalized", "newton")
"""Newton's method with damped steps, and the plain one."""
_EXTREMES = {"leftmost": (0, 1.0), "rightmost": (0, -1.0), "lowest": (1, 1.0), "highest": (1, -1.0)}
"""Word for a node -> axis, and the sign with which its position is the least of all nodes."""
_RIGID_MOTIONS = 3
"""Rigid motions of a belt in its plane: two translations and a rotation."""
_LEAST_ARM = 1e-3
"""Arm of supports against rotation, over the size of the belt, below which they are taken to leave it."""
_VARIABLES = {
    "node_position": Variable(("iteration", "node", "axis"), "m", "Node position"),
    "nodal_coordinates": Variable(("iteration", "node", "coordinate"), "m, 1", "Nodal coordinates"),
    "fixed": Variable(("node", "axis"), "1", "Whether the node is fixed", "bool"),
    "step_strain": Variable(("iteration",), "1", "Energy norm of the step, as a mean strain"),
    "strain_energy": Variable(("iteration",), "J", "Strain energy"),
    "iterations": Variable((), "1", "Iterations", "int64"),
}
_LABELS = {
    "iteration": Variable(("iteration",), "1", "Iteration, from the initial shape", "int64"),
    **{name: COORDINATES[name] for name in ("node_coordinate", "axis", "coordinate")},
}


@takes_options
def release(
    drive: Drive,
    *,
    fixed: str = "leftmost xy, rightmost y",
    method: str = "globalized",
    start: FloatArray | None = None,
    progress: Report | None = None,
) -> Result:
    """Compute the shape of the belt released from its pulleys, with all iterations.

    The closed belt is laid on its path, the pulleys are removed, and Newton's method finds the static equilibrium under
    elastic forces and weight. Without weight it is a circle.

    Parameters
    ----------
    drive
        The drive. Its pulleys give the initial shape.
    fixed
        Fixed nodes with their directions, separated by commas: a number from 0, or ``leftmost``, ``rightmost``,
        ``lowest`` or ``highest`` in the initial shape, and ``x``, ``y`` or ``xy``. They must prevent rigid motions.
    method
        "globalized" for Newton's method with damped steps, or "newton" for the plain one.
    start : ndarray, shape (nodes, nodal coordinates), optional
        Nodal coordinates of the initial shape, as in `nodal_coordinates`; by default the belt laid on its path.
    progress
        Called with a `Progress`.

    Returns
    -------
    Result
        Along ``iteration``, from the initial shape on, ``node_position`` (m), ``nodal_coordinates``,
        ``strain_energy`` (J) and ``step_strain``, the energy norm of the step that led there.

    Raises
    ------
    ModelError
        If the belt is open, `fixed` leaves a rigid motion or has an unknown node, or `start` has another shape.
    ConvergenceError
        If no equilibrium is found.

    Examples
    --------
    >>> released = bd.release(drive, method="newton")
    >>> released.dataset.node_position.dims
    ('iteration', 'node', 'axis')
    >>> released.dataset.iterations.item()
    28
    """
    if drive.ends:
        raise ModelError("an open belt is held by its ends. `release` applies to closed belts; use `equilibrium`.")
    if method not in METHODS:
        raise ModelError(f'method = "{method}" is unknown. Choose {listing(METHODS)}.')
    prepared = prepare(on_equal_elements(drive))
    free = belt_system(prepared.belt, closure="shared_node", gravity=prepared.gravity)
    initial = laid(free, prepared.path) if start is None else _state_at(free, start)
    points = free.nodes * free.points
    held = _fixed_coordinates(fixed, initial.nodes(free).reshape(points, -1)[:, :2])
    supports = np.zeros((points, len(free.scale) // free.points), dtype=bool)
    supports[:, : held.shape[1]] = held
    if progress is not None:
        progress(Progress(0.0, prepared.simulation.duration, 0.0, 0, "equilibrium"))
    system = belt_system(
        prepared.belt,
        closure="shared_node",
        gravity=prepared.gravity,
        fixed=[(int(node), int(number)) for node, number in np.argwhere(supports.reshape(free.nodes, -1))],
    )
    plain = method == "newton"
    try:
        found = find_equilibrium(system, initial, method="newton" if plain else "globalized")
    except ConvergenceError as error:
        remedy = 'Choose method = "globalized"' if plain else "Increase belt.elements, or begin nearer to it by `start`"
        raise ConvergenceError(f"{str(error).partition('. ')[0]}. {remedy}.") from None
    return _result(prepared, system, held, found)


def _state_at(system: System, start: ArrayLike) -> State:
    """The belt at rest at nodal coordinates."""
    coordinates, shape = (
        np.asarray(start, dtype=float),
        (system.nodes * system.points, len(system.scale) // system.points),
    )
    if coordinates.shape != shape or not np.isfinite(coordinates).all():
        raise ModelError(
            f"start must be finite nodal coordinates of shape {shape}, not of shape {coordinates.shape}. Take those of "
            "a result, such as nodal_coordinates[0]."
        )
    return at_rest(system, coordinates)


def _fixed_coordinates(fixed: str, places: FloatArray) -> BoolArray:
    """Whether nodes are held along the axes, shape (N, 2); `places` (N, 2), m, are those of the initial shape."""
    held = np.zeros(places.shape, dtype=bool)
    for text in fixed.split(","):
        node, _, axes = text.strip().partition(" ")
        axes = axes.strip()
        if axes not in ("x", "y", "xy"):
            raise ModelError(f'fixed = "{fixed}": "{text.strip()}" must be a node with x, y or xy, such as "0 xy".')
        held[_node(node, fixed, places), [AXIS_NAMES.index(axis) for axis in axes]] = True
    nodes, axes_held = np.nonzero(held)
    size = float(np.ptp(places, axis=0).max())
    x, y = ((places[nodes] - places.mean(axis=0)) / size).T
    motions = np.stack([axes_held == 0, axes_held == 1, np.where(axes_held == 0, -y, x)], axis=1)
    if np.linalg.matrix_rank(motions, tol=_LEAST_ARM) < _RIGID_MOTIONS:
        raise ModelError(
            f'fixed = "{fixed}" leaves a rigid motion of the belt. Fix both directions of a node and one of another, '
            'such as "leftmost xy, rightmost y".'
        )
    return held


def _node(word: str, fixed: str, places: FloatArray) -> int:
    """Number of a node."""
    if word in _EXTREMES:
        axis, sign = _EXTREMES[word]
        return int(np.argmin(sign * places[:, axis]))
    if word.isdecimal() and int(word) < len(places):
        return int(word)
    raise ModelError(
        f'fixed = "{fixed}": "{word}" is no node. Give a number from 0 to {len(places) - 1}, or '
        f"{listing(list(_EXTREMES))}."
    )


def _result(prepared: Prepared, system: System, held: BoolArray, found: Equilibrium) -> Result:
    """All iterates as a result."""
    count = found.iterations + 1
    positions = found.iterates.reshape(count, -1)
    iterates = positions.reshape(count, len(held), -1)
    seen = observe(system, np.zeros(count), positions, np.zeros_like(positions))
    values: dict[str, Any] = {
        "node_position": iterates[:, :, :2],
        "nodal_coordinates": iterates,
        "fixed": held,
        "step_strain": np.concatenate([[np.nan], found.norms]),
        "strain_energy": seen.strain_energy,
        "iterations": found.iterations,
    }
    labels: dict[str, Any] = {
        "iteration": np.arange(count),
        "node_coordinate": point_coordinates(system),
        "axis": list(AXIS_NAMES),
        "coordinate": list(prepared.element_kind.coordinates),
    }
    result = build_result(
        "release",
        prepared.drive,
        {name: (variable, values[name]) for name, variable in _VARIABLES.items()},
        {name: (variable, labels[name]) for name, variable in _LABELS.items()},
    )
    result.dataset.attrs["title"] = f"Belt of {prepared.drive.title}, released from its pulleys"
    return result

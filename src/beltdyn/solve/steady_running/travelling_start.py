"""Where a run on the travelling mesh begins in steady running.

Steady running is found on a staying mesh. Its curve and motion, taken over by the nodes of the travelling mesh,
are close to a state of that mesh. A run at constant speeds and loads goes the rest of the way.
"""

from dataclasses import dataclass, replace

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.model.instants import Instants
from beltdyn.solve.integrators.settling import Start, settle, with_angles
from beltdyn.solve.integrators.trajectory import Integrator, Statistics, drive_task
from beltdyn.solve.progress import Report
from beltdyn.solve.rest.installation import Rest
from beltdyn.solve.rest.staying import stand
from beltdyn.solve.steady_running.search import SteadySearch
from beltdyn.system.arrays import System
from beltdyn.system.centreline import centreline_points
from beltdyn.system.constant_drive import constant_drive
from beltdyn.system.discretization import curve_lengths, nodal_coordinates, point_coordinates
from beltdyn.system.state import State, at_rest

_NEAR = 1e-6
"""Distance over which rates of nodal coordinates are found, over the length of the belt."""
_WINDOWS = 4
"""Windows of means in a turn of the belt, about."""
_TURNS = 5
"""Longest way on which the belt settles, in turns of it."""


def steady_state_on(rest: Rest) -> State:
    """Steady running at the beginning of a run, as near as the travelling mesh comes to it.

    Parameters
    ----------
    rest
        The drive at rest on that mesh.

    Raises
    ------
    ConvergenceError
        If there is no steady running.
    """
    standing = stand(rest.drive)
    search = SteadySearch(rest.drive, standing.system, standing.state, rest.drive.simulation.begin)
    search.run(standing)
    return taken_over(search, rest.system)


def taken_over(search: SteadySearch, system: System) -> State:
    """The curve and motion of steady running on the nodes of another mesh, which travels with the belt.

    Parameters
    ----------
    search
        In steady running.
    system
        The same drive on the other mesh.

    Returns
    -------
    State
        The belt coordinate of the other mesh begins where that of the first one does, in the middle of a span.
    """
    found, given, length = search.running(), search.constant, search.drive.belt_length

    def nodes(ahead: float) -> FloatArray:
        along = (point_coordinates(system) + ahead) % length
        return nodal_coordinates(system, *centreline_points(given, found.position, along))

    state, way = at_rest(system, nodes(0.0)), _NEAR * length
    rates = search.belt_parameter * (nodes(way) - nodes(-way)) / (2.0 * way)
    state.velocity[: system.first_body] = rates.ravel()
    for mine, other in ((state.position, found.position), (state.velocity, found.velocity)):
        mine[system.first_body :] = other[given.first_body :]
    return state


@dataclass(frozen=True)
class Held:
    """A run at the speeds and loads of the beginning, until nothing but the ripple of the mesh is left."""

    def __call__(
        self, drive: Drive, system: System, state: State, integrator: Integrator, progress: Report | None, /
    ) -> Start:
        """Settle.

        Parameters
        ----------
        drive, system
            Those of the run to come.
        state
            From `steady_state_on`.
        integrator
            Method of time integration.
        progress
            Whom to tell.
        """
        held = constant_drive(system, drive.simulation.begin)._replace(tensioners=system.tensioners)
        stops = np.arange(1.0, _WINDOWS * _TURNS + 1.0) * _window(drive, system, state)
        task = drive_task(drive, held, state, Statistics())
        instants = Instants(drive.simulation.output_interval, float(stops[-1]))
        task = replace(task, instants=instants, breakpoints=stops.tolist())
        end, settled = settle(task, integrator, stops, drive.simulation.duration, progress)
        return Start(with_angles(drive, system, held, settled.time), end, settled.attributes)


def _window(drive: Drive, system: System, state: State) -> float:
    """Time in which a whole number of elements pass, about a part of a turn of the belt, s."""
    elements = curve_lengths(system).size
    passing = max(elements // _WINDOWS, 1) / elements
    speeds = np.abs(state.velocity[system.first_body :][: system.pulleys.size] * drive.rolling_radii)
    return float(passing * drive.path.length / speeds.max())

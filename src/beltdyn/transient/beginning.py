"""Initial state of a run: at rest, laid, in steady running, or from an earlier run."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.nip import refuse_forces
from beltdyn.model.simulation import EarlierRun, Frame, Instants
from beltdyn.observation.compilation import ahead, compile_kernels, compile_run, compile_solving
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.progress import Report
from beltdyn.solvers.trajectory import Integrator, Statistics, drive_task
from beltdyn.state.installation import Rest, rest_of
from beltdyn.state.search import SteadySearch
from beltdyn.state.settling import Beginning, Start, begin_flowing, settle, with_angles
from beltdyn.state.staying import stand
from beltdyn.state.steady import require_steady_start
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.build_staying import flowing_system, open_ended, staying_system
from beltdyn.system.constant_drive import constant_drive
from beltdyn.system.discretization import curve_lengths, nodal_coordinates, point_coordinates
from beltdyn.system.frame import centreline_points
from beltdyn.system.meshing import fit_phases, tooth_phases, turned_as, turning
from beltdyn.system.state import State, at_rest, laid
from beltdyn.transient.earlier_run import begin_from, with_instant

# Where a run on the travelling mesh begins in steady running

_NEAR = 1e-6
"""Distance over which rates of nodal coordinates are found, over the length of the belt."""
_WINDOWS = 4
"""Windows of means in a turn of the belt, about."""
_TURNS = 5
"""Longest way on which the belt settles, in turns of it."""


def steady_state_on(rest: Rest) -> tuple[System, State]:
    """Steady running at the beginning of a run, as near as the travelling mesh comes to it, with its grooves."""
    standing = stand(rest.prepared)
    search = SteadySearch(rest.prepared, standing.system, standing.state, rest.prepared.simulation.begin)
    search.run(standing)
    state = taken_over(search, rest.system)
    return turned_as(rest.system, turning(search.constant, search.running())), state


def taken_over(search: SteadySearch, system: System) -> State:
    """The curve and motion of steady running on the nodes of another mesh, which travels with the belt."""
    found, given, length = search.running(), search.constant, search.prepared.belt_length

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
        self, prepared: Prepared, system: System, state: State, integrator: Integrator, progress: Report | None, /
    ) -> Start:
        """Settle."""
        held = constant_drive(system, prepared.simulation.begin)._replace(tensioners=system.tensioners)
        stops = np.arange(1.0, _WINDOWS * _TURNS + 1.0) * _window(prepared, system, state)
        task = drive_task(prepared, held, state, Statistics())
        instants = Instants(prepared.simulation.output_interval, float(stops[-1]))
        task = replace(task, instants=instants, breakpoints=stops.tolist())
        end, settled = settle(task, integrator, stops, prepared.simulation.duration, progress)
        return Start(with_angles(prepared, system, held, settled.time), end, settled.attributes)


def _window(prepared: Prepared, system: System, state: State) -> float:
    """Time in which a whole number of elements pass, about a part of a turn of the belt, s."""
    elements = curve_lengths(system).size
    passing = max(elements // _WINDOWS, 1) / elements
    speeds = np.abs(state.velocity[system.first_body :][: system.pulleys.size] * prepared.rolling_radii)
    return float(passing * prepared.path.length / speeds.max())


Begin = Callable[[Prepared, System, State, Integrator, Report | None], Start]
"""``begin(prepared, system, state, integrator, progress) -> Start``, from the drive and its state at rest."""


def settled(drive: Drive, integrator: Integrator) -> tuple[Drive, Frame]:
    """The drive with the instant and the mesh of the earlier run in which it begins, and its mesh with the reason.

    Where the drive leaves the mesh open, it is that of an earlier run, and travels where the integrator needs it.
    """
    if drive.is_web and drive.nips:
        raise ModelError(
            "a web line with nips has no run over time. Find how it runs steadily with `beltdyn steady-state`, or "
            "remove its [[nip]]."
        )
    refuse_forces(drive.nips)
    begun = with_instant(drive)
    if begun.simulation.frame != drive.simulation.frame:
        return begun, begun.frame._replace(reason="as in the run it continues")
    if drive.simulation.frame is None and drive.frame.stays and not isinstance(integrator, GeneralizedAlpha):
        moved = begun.replace(simulation=begun.simulation.replace(frame="travelling"))
        return moved, moved.frame._replace(reason=f"since the integrator is {integrator.name}")
    return begun, begun.frame


def compile_ahead(drive: Drive) -> None:
    """Compile the kernels of a run once, before several processes need them."""
    compile_kernels(*_before_run(prepare(drive)))


def compile_solving_ahead(prepared: Prepared) -> AbstractContextManager[None]:
    """Let another process compile meanwhile what solves the equations of motion of a run."""
    return ahead(compile_solving, *_before_run(prepared))


def _before_run(prepared: Prepared) -> tuple[System, State]:
    """Arrays of the types that a run will have, and a state."""
    if prepared.frame.stays:
        given = staying_system(prepared, prepared.equal_lengths(prepared.elements))
        at_zero = at_rest(given, np.zeros((given.nodes, len(given.scale))))
        system = flowing_system(turning(open_ended(prepared, given), at_zero), np.array([1.0, 0.0]))
    else:
        system = drive_system(prepared)
    return system, laid(system, prepared.path)


def mesh_of(prepared: Prepared, integrator: Integrator, progress: Report | None = None) -> Beginning:
    """The mesh of a run, with the state on it where the mesh is found by that."""
    settings, staying = prepared.simulation, prepared.frame.stays
    if staying and not isinstance(integrator, GeneralizedAlpha):
        raise ModelError(
            f'the integrator "{integrator.name}" does not support simulation.frame = "staying". Omit the '
            'integrator, or set simulation.frame = "travelling".'
        )
    if settings.start == "steady":
        require_steady_start(prepared.drive)
    if isinstance(settings.start, EarlierRun):
        return begin_from(prepared.drive)
    if staying:
        with ahead(compile_run, *_before_run(prepared)):
            return begin_flowing(prepared, progress)
    system = drive_system(prepared)
    return Beginning(prepared, system, _laid(prepared, system), attributes=tooth_phases(system))


def begin_on(
    mesh: Beginning, integrator: Integrator, progress: Report | None = None, begin: Begin | None = None
) -> Beginning:
    """The state in which a run begins."""
    settings = mesh.prepared.simulation
    if mesh.prepared.frame.stays or isinstance(settings.start, EarlierRun):
        found = mesh
    else:
        found = _travelling(mesh, progress)
        begin = begin or (Held() if settings.start == "steady" else None)
    if begin is None:
        return found
    system, state, said = begin(found.prepared, found.system, found.state, integrator, progress)
    return found._replace(system=system, state=state, attributes={**found.attributes, **said})


def _travelling(mesh: Beginning, progress: Report | None) -> Beginning:
    """The state in which a run on the travelling mesh begins."""
    start = mesh.prepared.simulation.start
    if mesh.prepared.installed_tension is None and start == "laid":
        return mesh
    rest = rest_of(mesh.prepared, progress)
    system, state = rest.system, rest.state
    if start == "steady":
        system, state = steady_state_on(rest)
    elif start == "laid":
        state = _laid(rest.prepared, system)
    return Beginning(rest.prepared, system, state, rest.unstable, tooth_phases(system))


def _laid(prepared: Prepared, system: System) -> State:
    """The belt laid on its path, with grooves under its teeth, if it has any."""
    state = laid(system, prepared.path)
    fit_phases(system, state)
    return state

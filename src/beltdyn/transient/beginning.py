"""Initial state of a run: at rest, laid, in steady running, or from an earlier run."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError, ModelError
from beltdyn.machines.profiles.functions import go_on
from beltdyn.model import Drive, Prepared, loads, prepare
from beltdyn.model.nip import refuse_set
from beltdyn.model.simulation import EarlierRun, Frame, Instants
from beltdyn.observation.compilation import ahead, classes_in, compile_kernels, compile_run, compile_solving
from beltdyn.parts.quantity import number_in
from beltdyn.parts.text_file import entry_name, shorten
from beltdyn.results import Run, open_run
from beltdyn.results.mechanics import MESH_BESIDE
from beltdyn.results.schema import runs_steadily
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.run_progress import Report
from beltdyn.solvers.trajectory import Integrator, Statistics, drive_task
from beltdyn.state.installation import Rest, rest_of
from beltdyn.state.loaded_teeth import with_loads_on_teeth
from beltdyn.state.search import SteadySearch
from beltdyn.state.settling import DIRECTION, Beginning, Start, begin_flowing, settle, with_angles
from beltdyn.state.staying import stand
from beltdyn.state.steady import require_steady_start
from beltdyn.system.arc_mesh import MESH_LENGTHS, lengths_of, with_shares
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system, flowing_system, open_ended, staying_system
from beltdyn.system.constant_drive import constant_drive
from beltdyn.system.frame import centreline_points
from beltdyn.system.meshing import TOOTH_PHASES, fit_phases, has_teeth, tooth_phases, turned_as, turned_by, turning
from beltdyn.system.state import State, at_rest, curve_lengths, laid, nodal_coordinates, point_coordinates
from beltdyn.transient.checkpoint import is_checkpoint

_SAME = 1e-6
"""Distance of instants that count as one, over the time between them."""
_FREE = frozenset({"name", "description", "limits", "sheet", "simulation", "steady"})
"""Groups of a drive file that may differ between a run and the earlier run it starts from."""
_FREE_OF_PULLEYS = frozenset({"speed", "harmonics", "torque", "load", "inertia", "mass", "friction"})


def instant_of(run: Run, at: float | str | None, name: str = "at") -> float:
    """The requested instant of an output along the belt, s."""
    run.require_output()
    run.require("nodal_velocities")
    run.require("body_velocity")
    times = run.dataset["field_time"].values
    if at is None:
        return float(times[-1])
    wanted = number_in(name, at, "s")
    nearest = float(times[np.argmin(np.abs(times - wanted))])
    step = float(np.diff(times).min()) if times.size > 1 else max(abs(nearest), 1.0)
    if not abs(nearest - wanted) <= _SAME * step:
        every = f", every {step:.6g} s," if times.size > 1 else ""
        raise ModelError(
            f"{name} = {wanted:g} s is not an output along the belt of this run: it has outputs from "
            f"{times[0]:.6g} to {times[-1]:.6g} s{every} the nearest at {nearest:.8g} s. Use that one, or run "
            "the drive again with another simulation.field_interval."
        )
    return nearest


def staying_mesh(prepared: Prepared, run: Run) -> System:
    """The arrays of a drive over time on the mesh of a run that stays, with a belt that does not flow."""
    lengths = lengths_of(run.dataset, prepared)
    return turned_by(prepared, staying_system(prepared, lengths), run.dataset.attrs.get(TOOTH_PHASES))


def recorded_state(run: Run, time: float, system: System) -> State:
    """The state of a run."""
    seen = run.fields_at(time)
    state, first = at_rest(system, seen["nodal_coordinates"].values), system.first_body
    state.position[first:] = seen["body_position"].values
    state.velocity[:first] = seen["nodal_velocities"].values.ravel()
    state.velocity[first:] = seen["body_velocity"].values
    return state


def with_instant(drive: Drive) -> Drive:
    """The drive with the instant of the earlier run in which it begins, and its mesh; any other drive as it is."""
    start = drive.simulation.start
    if not isinstance(start, EarlierRun):
        return drive
    with _opened(start) as run:
        start = start.replace(time=instant_of(run, start.time, "time"))
        frame = drive.simulation.frame or run.drive.frame.name
    return drive.replace(simulation=drive.simulation.replace(start=start, frame=frame))


def begin_from(drive: Drive) -> Beginning:
    """Begin in the state of an earlier run, on its mesh."""
    start = drive.simulation.start
    assert isinstance(start, EarlierRun)
    assert start.time is not None
    with _opened(start) as run:
        prepared = prepare(_as_installed(drive, run))
        attributes: dict[str, Any] = {
            name: run.dataset.attrs[name]
            for name in (DIRECTION, TOOTH_PHASES, MESH_LENGTHS, *MESH_BESIDE)
            if name in run.dataset.attrs
        }
        if prepared.frame.stays:
            direction = np.array(run.dataset.attrs[DIRECTION], dtype=float)
            system = flowing_system(open_ended(prepared, staying_mesh(prepared, run)), direction)
            if set(MESH_BESIDE) <= attributes.keys():
                system = with_shares(system, *(np.asarray(attributes[name]) for name in MESH_BESIDE))
        else:
            system = turned_by(prepared, drive_system(prepared), attributes.get(TOOTH_PHASES))
        _require_same_mesh(system, run)
        state = recorded_state(run, start.time, system)
    shafts = [number for number, pulley in enumerate(drive.pulleys) if pulley.prescribed]
    angles = state.position[system.first_body + system.pulleys.shaft[shafts]]
    go_on(system.profiles, shafts, drive.simulation.begin, angles.tolist())
    return Beginning(prepared, system, state, attributes=attributes)


@contextmanager
def _opened(start: EarlierRun) -> Iterator[Run]:
    """The earlier run; errors name the key."""
    if is_checkpoint(Path(start.file)):
        results = Path(start.file).with_suffix(".nc")
        raise ModelError(
            f"simulation.start: {start.file} is a checkpoint, which can only resume its own run: "
            f"beltdyn simulate --resume {results}. "
            f"To start another run from a state of that one, give its result file, {results}."
        )
    try:
        run = open_run(Path(start.file))
        try:
            if runs_steadily(run.dataset):
                raise ModelError(
                    f'{start.file} holds steady running, not a run over time. Set start = "steady", which computes it.'
                )
            yield run
        finally:
            run.dataset.close()
    except ModelError as error:
        raise ModelError(f"simulation.start: {error}") from error


def _as_installed(drive: Drive, run: Run) -> Drive:
    """The drive with the belt, the contact and the tensioners of the earlier run, in which its length was found."""
    given = run.dataset.attrs.get("drive_as_given")
    earlier = loads(given) if given is not None else run.drive
    found = _difference(_fixed(drive), _fixed(earlier))
    if found is not None and _difference(_fixed(drive), _fixed(run.drive)) is not None:
        path, mine, theirs = found
        raise ModelError(
            f"{path} is {mine} in this drive but {theirs} in that of {run.path}. Belt, contact, mesh, frame, "
            "tensioners and pulley positions must be the same; speeds, torques, loads, inertia and pulley "
            "friction may differ. Make it the same, or choose another simulation.start."
        )
    installed = run.drive
    return drive.replace(belt=installed.belt, contact=installed.contact, tensioner=installed.tensioners)


def _fixed(drive: Drive) -> dict[str, Any]:
    """What must agree of a drive, as in its file."""
    data = {key: value for key, value in drive.data.items() if key not in _FREE}
    data["pulley"] = [
        {key: value for key, value in pulley.items() if key not in _FREE_OF_PULLEYS} for pulley in data["pulley"]
    ]
    data["belt"]["discretization"] = drive.element_kind.name
    return {"simulation": {"frame": drive.frame.name, "joint": drive.simulation.joint}} | data


def _difference(mine: Any, other: Any, path: str = "") -> tuple[str, str, str] | None:
    """The first key that differs, with both values in words."""
    if isinstance(mine, Mapping) and isinstance(other, Mapping):
        places = [(f"{path}.{key}" if path else key, mine.get(key), other.get(key)) for key in {**mine, **other}]
    elif isinstance(mine, list) and isinstance(other, list) and len(mine) == len(other):
        names = [entry_name(one) or str(number) for number, one in enumerate(mine, 1)]
        places = [(f"{path}[{name}]", a, b) for name, a, b in zip(names, mine, other, strict=True)]
    else:
        return None if mine == other else (path, _shown(mine), _shown(other))
    found = (_difference(a, b, place) for place, a, b in places)
    return next((one for one in found if one is not None), None)


def _shown(value: Any) -> str:
    if value is None:
        return "not given"
    return f"a list of {len(value)}" if isinstance(value, list) else shorten(value)


def _require_same_mesh(system: System, run: Run) -> None:
    """Make sure that nodes and bodies of a drive are those of the earlier run."""
    theirs, mine = run.dataset["node_coordinate"].values, point_coordinates(system)
    if mine.shape != theirs.shape or not np.allclose(mine, theirs, rtol=0.0, atol=1e-9 * float(theirs[-1])):
        raise ModelError(
            f"this drive has {mine.size} nodes, but that of {run.path} has {theirs.size}, or at other "
            f"positions. Set belt.elements = {run.prepared.elements} in both."
        )
    if system.bodies.size != run.dataset.sizes["body"]:
        raise ModelError(
            f"this drive has {system.bodies.size} bodies and controllers beside the belt, but that of "
            f"{run.path} has {run.dataset.sizes['body']}: {', '.join(run.dataset['body'].values)}. Loads with "
            "controllers, such as servo motors, must be the same."
        )


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
    refuse_set(drive.belt, drive.nips, "a run over time")
    drive = drive.with_slides()
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


def kind_of_kernels(drive: Drive) -> tuple[object, ...]:
    """What the kernels of a run depend on; empty where the drive cannot be prepared."""
    try:
        return drive.simulation.integrator, *classes_in(_like_a_run(prepare(drive)))
    except BeltdynError:
        return ()


def compile_solving_ahead(prepared: Prepared) -> AbstractContextManager[None]:
    """Let another process compile meanwhile what solves the equations of motion of a run."""
    return ahead(compile_solving, *_before_run(prepared))


def _before_run(prepared: Prepared) -> tuple[System, State]:
    """Arrays of the types that a run will have, and a state."""
    system = _like_a_run(prepared)
    return system, laid(system, prepared.path)


def _like_a_run(prepared: Prepared) -> System:
    """Arrays of the types that a run will have."""
    if not prepared.frame.stays:
        return drive_system(prepared)
    still = staying_system(prepared, prepared.equal_lengths(prepared.elements))
    at_zero = at_rest(still, np.zeros((still.nodes, len(still.scale))))
    return flowing_system(turning(open_ended(prepared, still), at_zero), np.array([1.0, 0.0]))


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
    elif has_teeth(system):
        system, state = with_loads_on_teeth(rest.prepared, system, state)
    return Beginning(rest.prepared, system, state, rest.unstable, tooth_phases(system))


def _laid(prepared: Prepared, system: System) -> State:
    """The belt laid on its path, with grooves under its teeth, if it has any."""
    state = laid(system, prepared.path)
    fit_phases(system, state)
    return state

"""Runs that start from a recorded state of an earlier run."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.machines.profiles.functions import go_on
from beltdyn.model import Drive, Prepared, loads, prepare
from beltdyn.model.simulation import EarlierRun
from beltdyn.parts.quantity import number_in
from beltdyn.parts.text_file import entry_name, shorten
from beltdyn.results import Run, open_run
from beltdyn.results.schema import runs_steadily
from beltdyn.state.settling import DIRECTION, Beginning
from beltdyn.system.arc_mesh import MESH_LENGTHS, lengths_of
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.build_staying import flowing_system, open_ended, staying_system
from beltdyn.system.discretization import point_coordinates
from beltdyn.system.meshing import TOOTH_PHASES, turned_by
from beltdyn.system.state import State, at_rest
from beltdyn.transient.checkpoint import is_checkpoint

_SAME = 1e-6
"""Distance of instants that count as one, over the time between them."""
_FREE = frozenset({"name", "description", "limits", "simulation", "steady"})
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
            for name in (DIRECTION, TOOTH_PHASES, MESH_LENGTHS)
            if name in run.dataset.attrs
        }
        if prepared.frame.stays:
            direction = np.array(run.dataset.attrs[DIRECTION], dtype=float)
            system = flowing_system(open_ended(prepared, staying_mesh(prepared, run)), direction)
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

"""The state of a run over time, at an instant at which its belt was recorded, on the mesh that stays."""

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.solve.rest.staying import anchor_at
from beltdyn.solve.steady_running.flowing_start import with_passage
from beltdyn.solve.steady_running.neighbour import take_along
from beltdyn.system.arrays import System
from beltdyn.system.build_staying import flowing_system, smoothed_over_time, staying_system
from beltdyn.system.constant_drive import constant_drive
from beltdyn.system.observe import observe
from beltdyn.system.state import State, at_rest

_SAME = 1e-6
"""Distance of instants that count as one, over the time between them."""


def instant_of(run: Run, at: float | None) -> float:
    """The instant at which the belt was recorded that is asked for, s.

    Parameters
    ----------
    run
        A run over time.
    at
        s; the last one by default.

    Raises
    ------
    ModelError
        If the mesh of the run travels, or its belt was not recorded then.
    """
    if run.drive.simulation.frame != "staying":
        raise ModelError(
            'the mesh of this run travels with the belt, simulation.frame = "travelling", so that nodes come and go at '
            'arcs, and no state of it stays. Run the drive again with frame = "staying", or find its modes about '
            "steady running."
        )
    run.require_output()
    run.require("nodal_velocities")
    times = run.dataset["field_time"].values
    if at is None:
        return float(times[-1])
    nearest = float(times[np.argmin(np.abs(times - at))])
    step = float(np.diff(times).min()) if times.size > 1 else max(abs(nearest), 1.0)
    if not abs(nearest - at) <= _SAME * step:
        every = f", every {step:.6g} s," if times.size > 1 else ""
        raise ModelError(
            f"at = {at:g} s is no instant at which this run has recorded its belt: it has from {times[0]:.6g} to "
            f"{times[-1]:.6g} s{every} the nearest at {nearest:.8g} s. Give that one, or run the drive again with "
            "another simulation.field_interval."
        )
    return nearest


def state_of(run: Run, time: float) -> tuple[System, State, float]:
    """A drive at an instant of a run, with speeds, torques and schedules as they are then.

    Parameters
    ----------
    run
        A run on a mesh that stays.
    time
        From `instant_of`, s.

    Returns
    -------
    system : System
        From `constant_drive`; its belt flows at the speed.
    state : State
        Position and velocity; angles of bodies are zero.
    speed : float
        Length of unstretched belt that passes in a second, m/s.
    """
    seen = run.fields_at(time)
    lengths = np.diff(seen["node_coordinate"].values, append=run.drive.belt_length)
    given = smoothed_over_time(staying_system(run.drive, lengths))
    state, first = at_rest(given, seen["nodal_coordinates"].values), given.first_body
    state.velocity[:first] = seen["nodal_velocities"].values.ravel()
    if given.tensioners.size:
        state.position[-given.tensioners.size :] = seen["tensioner_position"].values
        state.velocity[-given.tensioners.size :] = seen["tensioner_speed"].values
    bodies, rims = state.velocity[first:], seen["pulley_speed"].values
    bodies[: rims.size] = rims
    take_along(given, bodies, seen["shaft_speed"].values)
    held, passing = constant_drive(given, time), _passing(given, state, seen["belt_speed"].values, time)
    held.frame.speed[0] = passing
    return held, state, passing


def _passing(given: System, state: State, seen: np.ndarray, time: float) -> float:
    """Length of belt that passes in a second, m/s, with which spans have the speeds that were seen.

    Their speeds are straight in it.
    """
    flowing = flowing_system(given, anchor_at(given, state, True).direction)

    def speeds(passing: float) -> np.ndarray:
        moving = with_passage(given, state, passing)
        motion = moving.position[None].copy(), moving.velocity[None].copy()
        return np.asarray(observe(flowing, np.array([time]), *motion).belt_speed[0])

    still = speeds(0.0)
    slope = speeds(1.0) - still
    return float(np.nanmean((seen - still) / slope))

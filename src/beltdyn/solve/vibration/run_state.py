"""The state of a run over time, at an instant at which its belt was recorded, on the staying mesh."""

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.solve.earlier_run import recorded_state, staying_mesh
from beltdyn.solve.steady_running.flowing_start import DIRECTION
from beltdyn.system.arrays import System
from beltdyn.system.build_staying import flowing_system, staying_system
from beltdyn.system.constant_drive import constant_drive
from beltdyn.system.state import State


def require_mesh_that_stays(run: Run) -> None:
    """Make sure that a run has states that stay.

    Parameters
    ----------
    run
        A run over time.

    Raises
    ------
    ModelError
        If the mesh of the run travels.
    """
    if not run.drive.frame.stays:
        raise ModelError(
            'modes need a run on a staying mesh, but this run has simulation.frame = "travelling", whose nodes '
            'enter and leave the arcs. Run the drive again with frame = "staying", or compute its modes about '
            "steady running."
        )


def state_of(run: Run, time: float) -> tuple[System, State, float]:
    """A drive at an instant of a run, with speeds, torques and schedules as they are then.

    Parameters
    ----------
    run
        A run on a staying mesh.
    time
        From `instant_of`, s.

    Returns
    -------
    system : System
        From `constant_drive`; its belt flows at the speed.
    state : State
        Position and velocity.
    speed : float
        Length of unstretched belt that passes in a second, m/s.
    """
    given = staying_mesh(run.drive, run)
    flowing = flowing_system(given, np.array(run.dataset.attrs[DIRECTION]))
    moving, place = recorded_state(run, time, flowing), flowing.frame.place
    speed = float(moving.velocity[place])
    state = State(*(np.delete(vector, place) for vector in (moving.position, moving.velocity, moving.acceleration)))
    held = constant_drive(given, time)._replace(element=staying_system(run.drive, given.length).element)
    held.frame.speed[0] = speed
    return held, state, speed

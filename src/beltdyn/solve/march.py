"""The moving state of generalised-alpha and what it is told, as named tuples for its kernels."""

from typing import Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import ENERGY_WORKS, POWERS, BodyForces, Motion, System
from beltdyn.system.body_forces import load_history
from beltdyn.system.motion import no_multipliers

STEPS: Final = 0
REJECTED: Final = 1
FAILED: Final = 2
ITERATIONS: Final = 3

SLOWEST: Final = 2
"""Place in `March.clock`."""


class Settings(NamedTuple):
    """Choices of the user, as numbers."""

    spectral_radius: float
    """rho at infinite frequency, 0 (strongest damping) to 1 (none)."""
    velocity_tolerance: float
    """Local error allowed per unit of time, m/s: the relative tolerance times a velocity of the drive."""
    newton_fraction: float
    """Newton stops when its error is below this fraction of the local error allowed."""
    max_step: float
    """s."""
    long_step: float = np.inf
    """Length from which on a step is allowed no more local error than one of this length, s."""
    output_interval: float = np.inf
    """Steps end on multiples of this where they can, s."""


class March(NamedTuple):
    """The moving state of an integration, and what it tries next; everything is changed in place."""

    clock: FloatArray
    """Time and next step, s, and the largest Newton change of the last step over the one before it; shape (3,)."""
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    auxiliary: FloatArray
    """A of the method."""
    multipliers: FloatArray
    work: FloatArray
    """In the order of `ENERGY_WORKS`, J, shape (8,)."""
    power: FloatArray
    """These powers at the present time, W, shape (7,)."""
    impulse: FloatArray
    """Impulses on the bodies that the ends of the step in hand miss, from `missed_impulses`, shape (2, 6 N + D)."""
    lagged: FloatArray
    """What the method makes of each profile, as A is of the acceleration; nan after a jump; shape (profiles,)."""
    missed: FloatArray
    """Works that the powers at its ends miss, from `missed_work`, J, shape (7,)."""
    trial: FloatArray
    """Position, velocity, acceleration and A at the end of the step that is tried, shape (4, 6 N + D)."""
    counts: IntArray
    """Steps, steps rejected for their error, steps that Newton failed, Newton iterations; shape (4,)."""


class Steps(NamedTuple):
    """Room for the ends of accepted steps, filled by `advance`: there the equations of motion hold."""

    time: FloatArray
    """s, shape (k,)."""
    step: FloatArray
    """Length of the step, s, shape (k,)."""
    position: FloatArray
    """Shape (k, 6 N + D)."""
    velocity: FloatArray
    """Alike."""
    work: FloatArray
    """In the order of `ENERGY_WORKS`, J, shape (k, 8)."""
    loads: BodyForces
    """A history of k states."""


@kernel
def allowed_error(settings: Settings, length: float) -> float:
    """Local error of the position that a step of a length (s) should have, m."""
    return settings.velocity_tolerance * min(length, settings.long_step)


@kernel
def motion_of(march: March) -> Motion:
    """The motion at the beginning of the next step."""
    return Motion(march.clock[0], march.position, march.velocity, march.acceleration)


def empty_steps(system: System, count: int) -> Steps:
    """Make room for steps.

    Parameters
    ----------
    system
        The system.
    count
        How many; without room for any, `advance` keeps none.
    """
    size = system.first_body + system.bodies.size
    return Steps(
        time=np.empty(count),
        step=np.empty(count),
        position=np.empty((count, size)),
        velocity=np.empty((count, size)),
        work=np.empty((count, len(ENERGY_WORKS))),
        loads=load_history(system, count),
    )


def new_march(system: System, time: float, step: float, position: FloatArray, velocity: FloatArray) -> March:
    """Begin an integration.

    Parameters
    ----------
    system
        What is integrated.
    time, step
        Where to begin, and the first step to try, s.
    position, velocity : ndarray, shape (6 N + D,)
        State to begin from; copied.

    Returns
    -------
    March
        `engine.restart` has to give it accelerations before it can advance.
    """
    size = position.size
    return March(
        clock=np.array((time, step, 1.0)),
        position=position.copy(),
        velocity=velocity.copy(),
        acceleration=np.zeros(size),
        auxiliary=np.zeros(size),
        multipliers=no_multipliers(system),
        work=np.zeros(len(ENERGY_WORKS)),
        power=np.zeros(len(POWERS)),
        impulse=np.zeros((2, size)),
        lagged=np.full(system.profiles.table.size - 1, np.nan),
        missed=np.zeros(len(POWERS)),
        trial=np.zeros((4, size)),
        counts=np.zeros(4, dtype=np.int64),
    )

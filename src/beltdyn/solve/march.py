"""The moving state of generalised-alpha and what it is told, as named tuples for its kernels."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.system.arrays import NODE, POWERS, FloatArray

IntArray = NDArray[np.int64]

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
    """Time integrals of the powers in the loads, J, shape (7,)."""
    power: FloatArray
    """These powers at the present time, W, shape (7,)."""
    trial: FloatArray
    """Position, velocity, acceleration and A at the end of the step that is tried, shape (4, 6 N + D)."""
    counts: IntArray
    """Steps, steps rejected for their error, steps that Newton failed, Newton iterations; shape (4,)."""


class Outputs(NamedTuple):
    """Steps around the output instants, filled by `advance`.

    Most steps end on an output instant.  Where instants lie closer together than steps, both ends of the step are
    kept: only there do the equations of motion hold, so that forces are interpolated, not taken from interpolated
    states.
    """

    time: FloatArray
    """Instants, s, ascending, shape (k,)."""
    fraction: FloatArray
    """Where in its step each instant lies, 0 to 1, shape (k,)."""
    step: FloatArray
    """Length of the step, s, shape (k,)."""
    position: FloatArray
    """At start and end of the step, shape (k, 2, 6 N + D)."""
    velocity: FloatArray
    """Alike."""
    work: FloatArray
    """Works at the instant, shape (k, 7)."""
    horizon: float = np.inf
    """First output instant for which there is no room, s: no step may reach it."""


def empty_outputs(times: FloatArray, size: int) -> Outputs:
    """Make room for the steps around some output instants.

    Parameters
    ----------
    times : ndarray, shape (k,)
        Instants, s, ascending.
    size
        Size of a state, 6 N + D.
    """
    count = len(times)
    return Outputs(
        time=times.copy(),
        fraction=np.empty(count),
        step=np.empty(count),
        position=np.empty((count, 2, size)),
        velocity=np.empty((count, 2, size)),
        work=np.empty((count, len(POWERS))),
    )


def new_march(time: float, step: float, position: FloatArray, velocity: FloatArray) -> March:
    """Begin an integration.

    Parameters
    ----------
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
        multipliers=np.zeros(NODE),
        work=np.zeros(len(POWERS)),
        power=np.zeros(len(POWERS)),
        trial=np.zeros((4, size)),
        counts=np.zeros(4, dtype=np.int64),
    )

"""State and settings of generalized-alpha, as records for its kernels."""

from typing import Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, blank, record
from beltdyn.kernel import kernel
from beltdyn.system.arrays import ENERGY_WORKS, POWERS, BodyForces, Motion, System
from beltdyn.system.body_forces import body_forces_history
from beltdyn.system.missed_action import missed_action
from beltdyn.system.steady_assembly import no_multipliers

CLOCK = record(
    time="f8",  # s
    next_step="f8",  # length of the step to try next, s
    contraction="f8",  # largest Newton change of the last step over the one before it
    persistence="f8",  # part of the change of A over the last step that the next is expected to go on with
)
"""How far an integration is."""

LOSSES = record(
    physical="f8",  # mean power of all losses, W
    numerical="f8",  # that of numerical damping over the cube of the step, in whose proportion it grows, W/s^3
)
"""What is lost, in the mean over `Settings.averaging_time`."""

COUNTS = record(
    steps="i8",  # accepted
    rejected="i8",  # for their error
    failed="i8",  # not solved by Newton's method
    iterations="i8",  # of Newton's method
)
"""What an integration did so far."""


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
    output_begin: float = 0.0
    """First output, s."""
    output_interval: float = np.inf
    """Steps end on multiples of this after the first output where they can, s."""
    numerical_share: float = np.inf
    """Part of the losses that numerical damping may take in the mean."""
    averaging_time: float = np.inf
    """Time over which this mean is taken, s."""
    rounding: float = 0.0
    """Change of the position below which rounding alone moves nodes, m."""


class Trial(NamedTuple):
    """State at the end of a step that is tried; each vector has shape (n N + D,)."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    auxiliary: FloatArray
    """A of the method."""


class IntegratorState(NamedTuple):
    """The moving state of generalized-alpha, and what it tries next; everything is changed in place."""

    clock: np.record
    """Row of `CLOCK`."""
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    auxiliary: FloatArray
    """A of the method."""
    trend: FloatArray
    """Its change over the last step per unit of time, zero after a restart, shape (n N + D,)."""
    multipliers: FloatArray
    work: FloatArray
    """In the order of `ENERGY_WORKS`, J, shape (9,)."""
    power: FloatArray
    """These powers at the present time, W, shape (8,)."""
    impulse: FloatArray
    """Impulses on the bodies that the ends of the step in hand miss, from `missed_impulses`, shape (2, n N + D)."""
    lagged: FloatArray
    """What the method makes of each profile and then each load over the angle, as A is of the acceleration; nan after a
    jump; shape (profiles + loads,)."""
    missed: FloatArray
    """Works that the powers at its ends miss, from `missed_work`, J, shape (8,)."""
    losses: np.record
    """Row of `LOSSES`."""
    trial: Trial
    counts: np.record
    """Row of `COUNTS`."""


class Steps(NamedTuple):
    """Room for the ends of accepted steps, filled by `advance`: there the equations of motion hold."""

    time: FloatArray
    """s, shape (k,)."""
    step: FloatArray
    """Length of the step, s, shape (k,)."""
    position: FloatArray
    """Shape (k, n N + D)."""
    velocity: FloatArray
    """Alike."""
    work: FloatArray
    """In the order of `ENERGY_WORKS`, J, shape (k, 9)."""
    forces: BodyForces
    """A history of k states."""


@kernel
def allowed_error(settings: Settings, length: float) -> float:
    """Local error of the position that a step of a length (s) should have, m."""
    return settings.velocity_tolerance * min(length, settings.long_step)


@kernel
def motion_of(state: IntegratorState) -> Motion:
    """The motion at the beginning of the next step."""
    return Motion(state.clock.time, state.position, state.velocity, state.acceleration)


@kernel
def trial_motion(state: IntegratorState, time: float) -> Motion:
    """The motion at the end of the step that is tried, at an instant (s)."""
    return Motion(time, state.trial.position, state.trial.velocity, state.trial.acceleration)


def empty_steps(system: System, count: int) -> Steps:
    """Make room for steps."""
    size = system.first_body + system.bodies.size
    return Steps(
        time=np.empty(count),
        step=np.empty(count),
        position=np.empty((count, size)),
        velocity=np.empty((count, size)),
        work=np.empty((count, len(ENERGY_WORKS))),
        forces=body_forces_history(system, count),
    )


def grown(state: IntegratorState, position: FloatArray, velocity: FloatArray) -> IntegratorState:
    """The same integration at another position and velocity, which may have further coordinates at the end."""
    more = position.size - state.position.size

    def longer(vector: FloatArray) -> FloatArray:
        return np.pad(vector, [(0, 0)] * (vector.ndim - 1) + [(0, more)])

    return state._replace(
        position=position.copy(),
        velocity=velocity.copy(),
        acceleration=longer(state.acceleration),
        auxiliary=longer(state.auxiliary),
        trend=longer(state.trend),
        impulse=longer(state.impulse),
        trial=Trial(*map(longer, state.trial)),
    )


def new_state(system: System, time: float, step: float, position: FloatArray, velocity: FloatArray) -> IntegratorState:
    """Begin an integration; `engine.restart` has to give it accelerations before it can advance."""
    size, clock = position.size, blank(CLOCK)
    clock.time, clock.next_step, clock.contraction = time, step, 1.0
    return IntegratorState(
        clock=clock,
        position=position.copy(),
        velocity=velocity.copy(),
        acceleration=np.zeros(size),
        auxiliary=np.zeros(size),
        trend=np.zeros(size),
        multipliers=no_multipliers(system),
        work=np.zeros(len(ENERGY_WORKS)),
        power=np.zeros(len(POWERS)),
        impulse=np.zeros((2, size)),
        lagged=np.full(system.profiles.table.size + system.shaft_loads.table.size - 2, np.nan),
        missed=np.zeros(len(POWERS)),
        losses=blank(LOSSES),
        trial=Trial(np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)),
        counts=blank(COUNTS),
    )


# How long a step may be so that nothing prescribed comes and goes inside it

_SHORTEST: Final = 1e-7
"""What happens within this time (s) is an impulse to any belt."""
_BISECTIONS: Final = 3
"""Bisections between the longest resolved halving of a step and twice that length: the step lacks at most an eighth of
that halving."""
_FIRST_STEP = 1e-4
"""About the first step of a solver at most, s."""
_GROWTH = 10.0
"""Most that solvers lengthen a step by."""


@kernel
def resolved_length(system: System, settings: Settings, motion: Motion, wanted: float) -> float:
    """Shorten a step until what its ends miss moves no rim by more than the local error allowed.

    `settings`: tolerances; `motion`: beginning of the step; `wanted`: its length, s. Returns length of the step, s.
    """
    length = wanted
    for source in range(system.pulleys.size + system.links.size):
        length = _resolve(system, settings, source, motion, length)
    return length


@kernel(inline=True)
def _resolve(system: System, settings: Settings, source: int, motion: Motion, wanted: float) -> float:
    """Shorten a step until the angle or impulse of one source that its ends miss is allowed."""
    if is_resolved(system, settings, source, motion, wanted):
        return wanted
    length = 0.5 * wanted
    while length > _SHORTEST and not is_resolved(system, settings, source, motion, length):
        length *= 0.5
    part = 0.5 * length
    for _ in range(_BISECTIONS):
        if is_resolved(system, settings, source, motion, length + part):
            length += part
        part *= 0.5
    return max(length, min(wanted, _SHORTEST))


@kernel
def is_resolved(system: System, settings: Settings, source: int, motion: Motion, length: float) -> bool:
    """Whether the ends of a step see enough of what a source does in between."""
    allowed = allowed_error(settings, length)
    if source >= system.pulleys.size:
        link = system.links[source - system.pulleys.size]
        front, back = _impulse(system, link.front, allowed, length), _impulse(system, link.back, allowed, length)
        limit = min(front, back)
    else:
        body = system.pulleys[source].shaft
        free = system.bodies[body].unknown >= 0
        limit = _impulse(system, body, allowed, length) if free else allowed / system.bodies[body].reach
    return missed_action(system, source, motion, length, limit)[0] <= limit


@kernel(inline=True)
def _impulse(system: System, body: int, allowed: float, length: float) -> float:
    """Angular impulse that moves the rim of a body by an allowed length within a step; any on a prescribed body."""
    if system.bodies[body].unknown < 0:
        return np.inf
    return float(allowed * system.bodies[body].inertia / (system.bodies[body].reach * length))


class StepBound:
    """Bound on the next step, such that it misses at most `velocity_tolerance` (m/s) of prescribed motion."""

    def __init__(self, system: System, velocity_tolerance: float) -> None:
        self._system = system
        self._settings = Settings(0.0, velocity_tolerance, 0.0, np.inf)
        self.restart()

    def restart(self) -> None:
        """Begin anew, with small steps."""
        self._before: tuple[float, FloatArray] | None = None
        self._last = _FIRST_STEP

    def end(self, time: float, position: FloatArray, velocity: FloatArray) -> float:
        """Farthest end of a step from a state at a time, s."""
        acceleration = np.zeros_like(velocity)
        if self._before is not None and time > self._before[0]:
            self._last = time - self._before[0]
            acceleration = (velocity - self._before[1]) / self._last
        self._before = time, velocity.copy()
        motion = Motion(time, position.copy(), velocity.copy(), acceleration)
        return time + resolved_length(self._system, self._settings, motion, _GROWTH * self._last)

"""How long a step may be so that nothing prescribed comes and goes inside it."""

from typing import Final

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.solve.integrators.integrator_state import Settings, allowed_error
from beltdyn.system.arrays import Motion, System
from beltdyn.system.missed_action import missed_action

_SHORTEST: Final = 1e-7
"""What happens within this time (s) is an impulse to any belt."""
_BISECTIONS: Final = 3
_FIRST_STEP = 1e-4
"""About the first step of a solver at most, s."""
_GROWTH = 10.0
"""Most that solvers lengthen a step by."""


@kernel
def resolved_length(system: System, settings: Settings, motion: Motion, wanted: float) -> float:
    """Shorten a step until what its ends miss moves no rim by more than the local error allowed.

    Parameters
    ----------
    system
        Belt, bodies, supports.
    settings
        Tolerances.
    motion
        Beginning of the step.
    wanted
        Its length, s.

    Returns
    -------
    float
        Length of the step, s.
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
    """How far the next step of a solver may reach without missing what is prescribed.

    Parameters
    ----------
    system
        Belt, bodies, supports.
    velocity_tolerance
        Velocity that a step may miss, m/s.
    """

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

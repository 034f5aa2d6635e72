"""Generalised-alpha behind the interface of all integrators."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from beltdyn.errors import ConvergenceError
from beltdyn.solve.engine import advance, restart
from beltdyn.solve.generalized_alpha import REACHED
from beltdyn.solve.march import (
    FAILED,
    ITERATIONS,
    REJECTED,
    STEPS,
    March,
    Settings,
    Steps,
    empty_steps,
    new_march,
)
from beltdyn.solve.trajectory import Chunk, Task
from beltdyn.system.arrays import BodyForces
from beltdyn.system.motion import new_equations
from beltdyn.system.state import crossing_time

_ROOM = 64
"""Steps handed out at once, at most."""
_STEPS_AT_ONCE = 8000
_FIRST_STEP = 1e-6
_NEWTON_FRACTION = 0.01
_CROSSINGS = 2.0
"""A step is long from sqrt(rtol) times the time of so many crossings of the belt by an axial wave.  The drive vibrates
on its belt about that slowly, and until that turns, errors that pull the same way add up."""


@dataclass(frozen=True)
class GeneralizedAlpha:
    """Generalised-alpha with variable steps.

    Attributes
    ----------
    spectral_radius : float
        At infinite frequency, 0 (strongest damping) to 1 (none).
    rtol : float
        Local error per unit of time over the velocity scale of the task; less for long steps.
    max_step : float or None
        s.
    """

    spectral_radius: float
    rtol: float
    max_step: float | None = None

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate; see `Integrator`."""
        system, start = task.system, task.start
        settings = Settings(
            spectral_radius=self.spectral_radius,
            velocity_tolerance=self.rtol * task.velocity_scale,
            newton_fraction=_NEWTON_FRACTION,
            max_step=self.max_step or task.instants.end,
            long_step=_CROSSINGS * self.rtol**0.5 * crossing_time(system),
            output_interval=task.instants.interval,
        )
        first_step = min(_FIRST_STEP, settings.max_step)
        march = new_march(system, 0.0, first_step, start.position, start.velocity)
        equations = new_equations(system)
        budget = max(1, _STEPS_AT_ONCE // system.length.size)
        yield Chunk.start(system, start)
        for stop in task.stops:
            restart(system, march, equations)
            while march.clock[0] < stop:
                steps = empty_steps(system, min(_ROOM, budget))
                status, filled = advance(system, settings, march, equations, stop, budget, steps)
                _count(task, march)
                yield _chunk(steps, filled, march)
                if status != REACHED:
                    raise ConvergenceError(_message(task, march, self))


def _chunk(steps: Steps, filled: int, march: March) -> Chunk:
    """The filled part of the room for steps."""
    loads = BodyForces(*(array[:filled] for array in steps.loads))
    rows = {name: array[:filled] for name, array in steps._asdict().items() if name != "loads"}
    return Chunk(**rows, loads=loads, reached=float(march.clock[0]))


def _count(task: Task, march: March) -> None:
    """Hand the counters on."""
    task.statistics.steps = int(march.counts[STEPS])
    task.statistics.rejected_steps = int(march.counts[REJECTED] + march.counts[FAILED])
    task.statistics.newton_iterations = int(march.counts[ITERATIONS])


def _message(task: Task, march: March, method: GeneralizedAlpha) -> str:
    """Where and when the march ended, and what to try."""
    places, accelerations = (
        vector[: task.system.first_body].reshape(-1, len(task.system.scale) // task.system.points)[:, :2]
        for vector in (march.position, march.acceleration)
    )
    worst = int(np.argmax(np.hypot(accelerations[:, 0], accelerations[:, 1])))
    x, y = places[worst]
    undamped = "a simulation.spectral_radius below 1, " if method.spectral_radius == 1.0 else ""
    return (
        f"the simulation cannot go on at t = {march.clock[0]:.6g} s: no time step above 1e-11 s converges. "
        f"The belt moves most wildly at node {worst}, x = {x:.4g} m, y = {y:.4g} m. Try {undamped}more elements, "
        f"another simulation.rtol than {method.rtol:g}, a smaller contact.stiffness or a smaller slope of friction."
    )

"""Generalized-alpha behind the interface of all integrators."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from beltdyn.errors import ConvergenceError
from beltdyn.parts.messages import listing
from beltdyn.solvers.alpha_advance import REACHED, SMALLEST_STEP
from beltdyn.solvers.engine import advance, restart
from beltdyn.solvers.integrator_state import IntegratorState, Settings, Steps, empty_steps, new_state
from beltdyn.solvers.trajectory import Chunk, Task
from beltdyn.system.arrays import BodyForces, Equations, System
from beltdyn.system.frame import FlowingByArcs
from beltdyn.system.meshing import toothed_pulleys
from beltdyn.system.state import crossing_time
from beltdyn.system.steady_assembly import new_equations

_ROOM = 64
"""Steps handed out at once, at most."""
_ELEMENT_STEPS = 8000
"""Steps times elements that one call of the kernel tries, but at least one step: between calls progress is reported."""
_FIRST_STEP = 1e-6
"""Length of the first step, s, unless `max_step` is shorter: errors are not known before it. Later steps grow by up to
2."""
_SLIDING = 0.01
"""What Newton's method may leave, over the local error allowed.  With 0.03 iterations are fewer by a tenth, but belts
slide up to 4 % too slowly on arcs of travelling meshes: what it leaves adds up."""
_HELD = 0.1
"""The same where all pulleys have teeth, which bring the belt back: a third fewer iterations, tooth loads equal to
1e-5."""
_CROSSINGS = 2.0
"""The drive vibrates on its belt about as slowly as an axial wave crosses it so often.  Until that turns, errors that
pull the same way add up: a step is long from sqrt(rtol) times this time."""
_ROUNDING = 1e-10
"""Of coordinates along a long belt, over its size: rounding of places times the stiffness of short elements."""
_FINE = 1e-4
"""The default tolerance; looser ones leave vibrations to numerical damping."""
_NUMERICAL_SHARE = 10.0
"""Part of the losses that numerical damping may take, over rtol.  The losses err by about five times this part: waves
that errors of time excite have an energy of fourth order in the step, and are lost in contact."""


@dataclass(frozen=True)
class GeneralizedAlpha:
    """Generalized-alpha with variable steps.

    Examples
    --------
    >>> bd.extend.GeneralizedAlpha(spectral_radius=0.9, rtol=1e-4)
    GeneralizedAlpha(spectral_radius=0.9, rtol=0.0001, max_step=None)
    """

    spectral_radius: float
    """At infinite frequency, 0 (strongest damping) to 1 (none)."""
    rtol: float
    """Local error per unit of time over the velocity scale of the task; less for long steps."""
    max_step: float | None = None
    """s."""
    name: ClassVar[str] = "generalized_alpha"

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate; see `Integrator`."""
        return self.begin(task).chunks()

    def begin(self, task: Task) -> "AlphaIntegration":
        """Start an integration that can be saved and continued."""
        begin = task.instants.begin
        period = _CROSSINGS * crossing_time(task.system)
        settings = Settings(
            spectral_radius=self.spectral_radius,
            velocity_tolerance=self.rtol * task.velocity_scale,
            newton_fraction=_HELD if toothed_pulleys(task.system).size == task.system.pulleys.size else _SLIDING,
            max_step=self.max_step or task.instants.end - begin,
            long_step=self.rtol**0.5 * period,
            output_begin=begin,
            output_interval=task.instants.interval,
            numerical_share=_NUMERICAL_SHARE * self.rtol if self.rtol <= _FINE else np.inf,
            averaging_time=period,
            rounding=_rounding(task.system),
        )
        first_step = min(_FIRST_STEP, settings.max_step)
        state = new_state(task.system, begin, first_step, task.start.position, task.start.velocity)
        return AlphaIntegration(self, task, settings, task.system, state)


def _rounding(system: System) -> float:
    """Change of the position of a long belt, whose coordinates are large, that rounding makes, m; zero of others."""
    if not isinstance(system.frame, FlowingByArcs):
        return 0.0
    return _ROUNDING * float(np.ptp(system.frame.arcs.place, axis=0).max())


@dataclass
class AlphaIntegration:
    """The state of an integration: all that its next step depends on, so that a copy continues with the same steps."""

    method: GeneralizedAlpha
    """The integrator."""
    task: Task
    """The initial value problem."""
    settings: Settings
    """Numbers of the method and its step control."""
    system: System
    """Its arrays; profiles may be exchanged between two stops."""
    state: IntegratorState
    """Where it is."""
    begun: bool = False
    """Whether the state at the beginning was handed out."""
    restarted: float = -np.inf
    """Stop up to which the accelerations were last taken from the equations of motion, s."""

    @cached_property
    def _equations(self) -> Equations:
        """Arrays to work in."""
        return new_equations(self.system)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_equations"}

    def exchange(self, system: System, state: IntegratorState) -> None:
        """Go on with another system and state; after more than an exchange of numbers `restart` is needed."""
        self.system, self.state = system, state
        vars(self).pop("_equations", None)

    def chunks(self) -> Iterator[Chunk]:
        """Integrate from where it is to the end; see `Integrator`."""
        task = self.task
        if not self.begun:
            self.begun = True
            yield Chunk.start(self.system, task.start, task.instants.begin)
        for stop in task.stops:
            if stop > self.restarted:
                self.restart()
                self.restarted = stop
            yield from self.until(stop)

    def restart(self) -> None:
        """Take accelerations from the equations of motion: at the beginning, and where what drives has a kink."""
        restart(self.system, self.state, self._equations)

    def until(self, stop: float) -> Iterator[Chunk]:
        """Integrate up to an instant (s), on which the last step ends."""
        budget = max(1, _ELEMENT_STEPS // self.system.length.size)
        while self.state.clock.time < stop:
            steps = empty_steps(self.system, min(_ROOM, budget))
            status, filled = advance(self.system, self.settings, self.state, self._equations, stop, budget, steps)
            _count(self.task, self.state)
            yield _chunk(steps, filled, self.state)
            if status != REACHED:
                raise ConvergenceError(_message(self.task, self.state, self.method))


def _chunk(steps: Steps, filled: int, state: IntegratorState) -> Chunk:
    """The filled part of the room for steps."""
    forces = BodyForces(*(array[:filled] for array in steps.forces))
    rows = {name: array[:filled] for name, array in steps._asdict().items() if name != "forces"}
    return Chunk(**rows, forces=forces, reached=float(state.clock.time))


def _count(task: Task, state: IntegratorState) -> None:
    """Hand the counters on."""
    task.statistics.steps = int(state.counts.steps)
    task.statistics.rejected_steps = int(state.counts.rejected + state.counts.failed)
    task.statistics.newton_iterations = int(state.counts.iterations)


def _message(task: Task, state: IntegratorState, method: GeneralizedAlpha) -> str:
    """Where and when the state ended, and what to try."""
    places, accelerations = (
        vector[: task.system.first_body].reshape(-1, len(task.system.scale) // task.system.points)[:, :2]
        for vector in (state.position, state.acceleration)
    )
    worst = int(np.argmax(np.hypot(accelerations[:, 0], accelerations[:, 1])))
    x, y = places[worst]
    undamped = "a simulation.spectral_radius below 1, " if method.spectral_radius == 1.0 else ""
    keys = [f"contact.{key}" for key in task.contact_keys]
    omitted = f"; omit {listing(keys)}, so that the drive chooses {'it' if len(keys) == 1 else 'them'}" if keys else ""
    return (
        f"the simulation fails at t = {state.clock.time:.6g} s: a time step of "
        f"{min(SMALLEST_STEP, method.max_step or SMALLEST_STEP):g} s is still too long. The largest "
        f"acceleration is at node {worst}, x = {x:.4g} m, y = {y:.4g} m. Try {undamped}more elements, "
        f"another simulation.rtol than {method.rtol:g}, or gentler changes of speeds and loads"
        f"{omitted}."
    )

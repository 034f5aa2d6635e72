"""Integrators composed of a one-step method and a step control."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.solve.integrators.step_bound import StepBound
from beltdyn.solve.integrators.trajectory import Chunk, Task
from beltdyn.system.arrays import ENERGY_WORKS, POWERS
from beltdyn.system.first_order import FirstOrder

POSITION_TIME = 1e-3
"""Positions may err by what the allowed error of velocities makes in this time, s."""
_SHORTEST = 1e-12
"""Steps below this length are none, s."""
_SAFETY, _LEAST, _MOST = 0.9, 0.2, 5.0
"""Of the step that the error allows; and how much shorter or longer the next step may be."""


class StepError(Exception):
    """A step without a solution; the message gives the reason. A shorter step may succeed."""


class Method(Protocol):
    """A one-step method for dy/dt = f(t, y)."""

    @property
    def name(self) -> str:
        """Name, for results and messages."""

    @property
    def order(self) -> int:
        """Order p: the estimated error of a step scales with the power p + 1 of its length."""

    def step(self, equations: FirstOrder, time: float, y: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
        """Go one step from state to state.

        Parameters
        ----------
        equations
            ``equations.rates(t, y)`` is f, and ``equations.jacobian(t, y)`` its derivative by y.
        time
            Beginning of the step, s.
        y : ndarray, shape (size,)
            Positions, velocities and works there; not to be changed.
        length
            Length of the step, s.

        Returns
        -------
        y, error : ndarray, shape (size,)
            At the end of the step, and an estimate of the error made in it.

        Raises
        ------
        StepError
            If the step has no solution.
        """


class Verdict(NamedTuple):
    """The decision of a step control on a step."""

    accepted: bool
    length: float
    """Length of the next or repeated step, s."""


class StepControl(Protocol):
    """Chooses step lengths and accepts or rejects steps."""

    @property
    def first(self) -> float:
        """Length of the first step, and of that after a jump or kink of the excitation, s."""

    @property
    def missed(self) -> float:
        """Excitation that a step may miss, over the velocity scale; infinite for any."""

    def judge(self, length: float, error: float, order: int) -> Verdict:
        """Accept or reject a step.

        Parameters
        ----------
        length
            Of the step, s.
        error
            Its largest error over the velocity scale of the drive; infinite where the step has no solution.
        order
            Order of the method.
        """


@dataclass(frozen=True)
class FixedSteps:
    """Steps of constant length.

    Attributes
    ----------
    length : float
        s; steps that end on a breakpoint may be shorter.
    missed : float
        See `StepControl`.

    Examples
    --------
    >>> bd.FixedSteps(1e-4).length
    0.0001
    """

    length: float
    missed: float = np.inf

    @property
    def first(self) -> float:
        """See `StepControl`."""
        return self.length

    def judge(self, length: float, error: float, order: int) -> Verdict:
        """Accept every step that has a solution; see `StepControl.judge`."""
        return Verdict(error < np.inf, self.length)


@dataclass(frozen=True)
class ErrorControl:
    """Steps controlled by an error tolerance.

    Attributes
    ----------
    rtol : float
        Allowed error of a step over the velocity scale of the drive.
    max_step : float
        s.
    first : float
        Length of the first step, s.

    Examples
    --------
    >>> bd.ErrorControl(rtol=1e-4).rtol
    0.0001
    """

    rtol: float
    max_step: float = np.inf
    first: float = 1e-6

    @property
    def missed(self) -> float:
        """Equal to the error tolerance; see `StepControl`."""
        return self.rtol

    def judge(self, length: float, error: float, order: int) -> Verdict:
        """Accept steps within the tolerance; see `StepControl.judge`."""
        ratio = error / self.rtol
        factor = _SAFETY * ratio ** (-1.0 / (order + 1)) if ratio > 0.0 else _MOST
        return Verdict(ratio <= 1.0, min(length * min(max(factor, _LEAST), _MOST), self.max_step))


@dataclass(frozen=True)
class Stepwise:
    """A one-step method with a step control, as an integrator for `simulate`.

    Attributes
    ----------
    method : Method
        From state to state.
    control : StepControl
        How long steps are.
    """

    method: Method
    control: StepControl

    @property
    def name(self) -> str:
        """Name of the method."""
        return self.method.name

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate; see `Integrator`."""
        equations = FirstOrder(task.system)
        bound = StepBound(task.system, self.control.missed * task.velocity_scale)
        y, time = equations.pack(task.start), task.instants.begin
        yield Chunk.start(task.system, task.start, time)
        for stop in task.stops:
            after = float(np.nextafter(time, np.inf))
            equations.jump(after, y)
            bound.restart()
            length = self.control.first
            while time < stop:
                farthest = bound.end(time, *equations.unpack(y)[:2]) if self.control.missed < np.inf else stop
                longest = min(farthest, stop) - time
                taken, y, length = self._step(task, equations, (max(time, after), y), min(length, longest))
                end = stop if stop - time - taken < _SHORTEST else time + taken
                task.statistics.steps += 1
                task.statistics.evaluations = equations.evaluations
                yield first_order_chunk(equations, np.array([end]), y[None], end - time, end)
                time = end

    def _step(
        self, task: Task, equations: FirstOrder, start: tuple[float, FloatArray], length: float
    ) -> tuple[float, FloatArray, float]:
        """Go one step from a time and state; gives its length, the state at its end, and the length of the next one."""
        time, y = start
        scale = equations.tolerances(task.velocity_scale, POSITION_TIME)
        while True:
            reason = "its error is too large"
            try:
                after, estimate = self.method.step(equations, time, y, length)
                error = float(np.max(np.abs(estimate) / scale))
            except StepError as failure:
                error, reason = np.inf, str(failure)
            verdict = self.control.judge(length, error if np.isfinite(error) else np.inf, self.method.order)
            if verdict.accepted:
                return length, after, verdict.length
            task.statistics.rejected_steps += 1
            if not _SHORTEST < verdict.length < length:
                raise ConvergenceError(
                    f"the integrator {self.name} fails at t = {round(time, 12):.6g} s "
                    f"with a step of {length:.3g} s: {reason}. "
                    "Try shorter steps, a larger tolerance, or the integrator generalized_alpha."
                )
            length = verdict.length


def first_order_chunk(equations: FirstOrder, time: FloatArray, y: FloatArray, step: float, reached: float) -> Chunk:
    """States of the first-order system as integrators hand them out.

    Parameters
    ----------
    equations
        The system.
    time : ndarray, shape (k,)
        s.
    y : ndarray, shape (k, size)
        Unknowns at these times.
    step
        Length of the step in which they lie, s.
    reached
        Time that the solver has reached, s.

    Returns
    -------
    Chunk
        With prescribed bodies where they have to be, and the body forces of each state.
    """
    position, velocity, work = (np.ascontiguousarray(part) for part in equations.unpack(y))
    forces = equations.body_forces_at(time, position, velocity)
    work = np.pad(work, ((0, 0), (0, len(ENERGY_WORKS) - len(POWERS))))  # their own damping is not known
    return Chunk(time, np.full(len(time), step), position, velocity, work, forces, reached)

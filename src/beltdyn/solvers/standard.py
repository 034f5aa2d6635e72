"""The paper's "any standard integrator": SUNDIALS CVODE and IDA, and SciPy's BDF and Radau, on the same equations.

The unknowns are y = (positions, velocities, works): the powers of the energy account are integrated along.  With
multipliers, the accelerations come from Eq. 26 with its constant matrices; with shared nodes from Eq. 27.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, nextafter
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model.simulation import SAME
from beltdyn.solvers.integrator_state import StepBound
from beltdyn.solvers.trajectory import Chunk, Task
from beltdyn.system.arrays import (
    ENERGY_WORKS,
    POWERS,
)
from beltdyn.system.first_order import FirstOrder

# Integrators composed of a one-step method and a step control

POSITION_TIME = 1e-3
"""Positions may err by what the allowed error of velocities makes in this time, s."""
_MIN_STEP = 1e-12
"""Time to a stop that counts as none, and length of a step at which the integrator fails, s."""
_SAFETY, _MIN_REDUCTION, _MAX_GROWTH = 0.9, 0.2, 5.0
"""Step over that which the error allows, and the least and largest factor from a step to the next."""


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
        """Accept or reject a step."""


@dataclass(frozen=True)
class FixedSteps:
    """Steps of constant length.

    Examples
    --------
    >>> bd.extend.FixedSteps(1e-4).length
    0.0001
    """

    length: float
    """s; steps that end on a breakpoint may be shorter."""
    missed: float = np.inf
    """See `StepControl`."""

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

    Examples
    --------
    >>> bd.extend.ErrorControl(rtol=1e-4).rtol
    0.0001
    """

    rtol: float
    """Allowed error of a step over the velocity scale of the drive."""
    max_step: float = np.inf
    """s."""
    first: float = 1e-6
    """Length of the first step, s."""

    @property
    def missed(self) -> float:
        """Equal to the error tolerance; see `StepControl`."""
        return self.rtol

    def judge(self, length: float, error: float, order: int) -> Verdict:
        """Accept steps within the tolerance; see `StepControl.judge`."""
        ratio = error / self.rtol
        factor = _SAFETY * ratio ** (-1.0 / (order + 1)) if ratio > 0.0 else _MAX_GROWTH
        return Verdict(ratio <= 1.0, min(length * min(max(factor, _MIN_REDUCTION), _MAX_GROWTH), self.max_step))


@dataclass(frozen=True)
class Stepwise:
    """A one-step method with a step control, as an integrator for `simulate`."""

    method: Method
    """From state to state."""
    control: StepControl
    """How long steps are."""

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
            after = nextafter(time, inf)
            equations.jump(after, y)
            bound.restart()
            length = self.control.first
            while time < stop:
                farthest = bound.end(time, *equations.unpack(y)[:2]) if self.control.missed < np.inf else stop
                longest = min(farthest, stop) - time
                taken, y, length = self._step(task, equations, (max(time, after), y), min(length, longest))
                end = stop if stop - time - taken < _MIN_STEP else time + taken
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
            if not _MIN_STEP < verdict.length < length:
                raise ConvergenceError(
                    f"the integrator {self.name} fails at t = {round(time, 12):.6g} s "
                    f"with a step of {length:.3g} s: {reason}. "
                    "Try shorter steps, a larger tolerance, or the integrator generalized_alpha."
                )
            length = verdict.length


def first_order_chunk(equations: FirstOrder, time: FloatArray, y: FloatArray, step: float, reached: float) -> Chunk:
    """States of the first-order system as integrators return them, with prescribed motion and body forces."""
    position, velocity, work = (np.ascontiguousarray(part) for part in equations.unpack(y))
    forces = equations.body_forces_at(time, position, velocity)
    work = np.pad(work, ((0, 0), (0, len(ENERGY_WORKS) - len(POWERS))))  # their own damping is not known
    return Chunk(time, np.full(len(time), step), position, velocity, work, forces, reached)


Name = Literal["cvode", "ida", "bdf", "radau"]

_MAX_STATES = 64
"""States between steps that are handed out at once, at most."""
_RELATIVE_TOLERANCE = 1e-9
"""Error of an unknown over its own magnitude: so small that the absolute tolerances decide, which are physical."""
_STEP_ERROR = 0.02
"""Error that one step may make, over that of the run: the errors of steps add up."""
_PROHIBITIVE_ERROR = 1e30
"""Error constant of BDF for the order above the highest A-stable one (dimensionless): with the error estimated from it,
that order is never chosen."""
_ROUNDINGS = 16.0
"""Least step of a method of SciPy, which refuses those of less than ten roundings; none goes beyond a stop."""
_HIGHEST_A_STABLE_ORDER = 2
"""Of the backward differentiation formulas: higher orders feed the belt's fast vibrations, which nothing damps."""


@dataclass(frozen=True)
class StandardIntegrator:
    """A method of SUNDIALS or SciPy.

    Examples
    --------
    >>> bd.extend.StandardIntegrator("radau", rtol=1e-4)
    StandardIntegrator(name='radau', rtol=0.0001, max_step=None)
    """

    name: Name
    """"cvode", "ida", "bdf" or "radau"."""
    rtol: float
    """Error tolerance of velocities, relative to the velocity scale of the drive; that of positions is this velocity
    times one millisecond. A single step may use a fiftieth of it."""
    max_step: float | None = None
    """s."""

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate; see `Integrator`."""
        equations = FirstOrder(task.system)
        tolerances = equations.tolerances(_STEP_ERROR * self.rtol * task.velocity_scale, POSITION_TIME)
        bound = StepBound(task.system, _STEP_ERROR * self.rtol * task.velocity_scale)
        y, time = equations.pack(task.start), task.instants.begin
        yield Chunk.start(task.system, task.start, time)
        written = 1
        for stop in task.stops:
            make = _Sundials if self.name in ("cvode", "ida") else _SciPy
            equations.jump(nextafter(time, inf), y)
            solver: _Solver = make(_Leg(self, equations, tolerances, time, y, stop))
            bound.restart()
            while solver.time < stop:
                before = solver.time
                try:
                    solver.step(min(stop, bound.end(before, *equations.unpack(solver.y)[:2])))
                except _SolverError as error:
                    raise self._give_up(before, error) from error
                task.statistics.steps += solver.time > before  # SUNDIALS returns once more where it has interpolated
                task.statistics.evaluations = equations.evaluations
                count = task.instants.until(solver.time)
                for first in range(written, count, _MAX_STATES):
                    instants = task.instants[np.arange(first, min(first + _MAX_STATES, count))]
                    yield _chunk(equations, solver, instants[instants < solver.time - SAME], before)
                if solver.time > before:
                    yield _chunk(equations, solver, np.array([solver.time]), before)
                written = count
            time, y = stop, solver.at(stop)

    def _give_up(self, time: float, reason: Exception) -> ConvergenceError:
        """The error for a solver that stopped at a time, s."""
        return ConvergenceError(
            f"the integrator {self.name} fails at t = {time:.6g} s ({reason}). "
            f'Try a larger simulation.rtol than {self.rtol:g}, or simulation.integrator = "generalized_alpha".'
        )


@dataclass(frozen=True, eq=False)
class _Leg:
    """The way from one stop to the next, for a library's solver."""

    method: StandardIntegrator
    equations: FirstOrder
    tolerances: FloatArray
    start: float
    y: FloatArray
    stop: float

    @property
    def begin(self) -> float:
        """Instant just after the start, where profiles have jumped, s."""
        return nextafter(self.start, inf)


class _SolverError(Exception):
    """A library's solver has given up; the message is its own."""


class _Solver(Protocol):
    """A library's solver on its way from one stop to the next."""

    time: float
    y: FloatArray
    """Unknowns at this time."""

    def step(self, farthest: float) -> None:
        """Take one step of the solver's own choice that ends before an instant (s), or on it."""

    def at(self, time: float) -> FloatArray:
        """Unknowns at an instant of the last step, s."""


class _SciPy:
    """An implicit method of SciPy, which passes by numbers below the least one."""

    @np.errstate(under="ignore")
    def __init__(self, leg: _Leg) -> None:
        from scipy.integrate import BDF, Radau

        kind = BDF if leg.method.name == "bdf" else Radau
        self._solver = kind(
            leg.equations.rates,
            leg.begin,
            leg.y,
            leg.stop,
            max_step=leg.method.max_step or np.inf,
            rtol=_RELATIVE_TOLERANCE,
            atol=leg.tolerances,
            jac=leg.equations.jacobian,
        )
        if kind is BDF:  # which takes no largest order, but none whose error it thinks huge
            self._solver.error_const[_HIGHEST_A_STABLE_ORDER + 1] = _PROHIBITIVE_ERROR
        self.time, self.y, self._longest = leg.start, leg.y, self._solver.max_step

    @np.errstate(under="ignore")
    def step(self, farthest: float) -> None:
        rest = max(farthest - self.time, _ROUNDINGS * float(np.spacing(self.time)))
        self._solver.max_step = min(self._longest, rest)
        try:
            message = self._solver.step()
        except ValueError as error:  # infinite forces
            raise _SolverError(str(error)) from error
        if self._solver.status == "failed":
            raise _SolverError(message)
        self.time, self.y = float(self._solver.t), self._solver.y

    def at(self, time: float) -> FloatArray:
        return np.asarray(self._solver.dense_output()(time))


class _Sundials:
    """CVODE or IDA, with the exact dense Jacobian."""

    def __init__(self, leg: _Leg) -> None:
        options = {
            "rtol": _RELATIVE_TOLERANCE,
            "atol": leg.tolerances,
            "max_step": leg.method.max_step or 0.0,
            "max_order": _HIGHEST_A_STABLE_ORDER,
        }
        if leg.method.name == "cvode":
            self._solver = _cvode(leg.equations, options)
            self._solver.init_step(leg.begin, leg.y)
        else:
            self._solver = _ida(leg.equations, options)
            self._solver.init_step(leg.begin, leg.y, leg.equations.rates(leg.begin, leg.y))
        self.time, self.y, self._stop = leg.start, leg.y, leg.stop

    def step(self, farthest: float) -> None:
        result = self._solver.step(self._stop, method="onestep", tstop=farthest)
        if not result.success:
            raise _SolverError(result.message)
        self.time, self.y = float(np.ravel(result.t)[-1]), np.array(np.atleast_2d(result.y)[-1])

    def at(self, time: float) -> FloatArray:
        return np.array(np.atleast_2d(self._solver.step(time).y)[-1])


def _cvode(equations: FirstOrder, options: dict[str, Any]) -> Any:
    """CVODE on dy/dt = f(t, y)."""
    from_sundials = _import_sundials()

    def rates(t: float, y: FloatArray, result: FloatArray) -> None:
        result[:] = equations.rates(t, y)

    def jacobian(t: float, y: FloatArray, _: FloatArray, result: FloatArray) -> None:
        result[:] = equations.jacobian(t, y)

    return from_sundials.cvode.CVODE(rates, jacfn=jacobian, **options)


def _ida(equations: FirstOrder, options: dict[str, Any]) -> Any:
    """IDA on dy/dt - f(t, y) = 0."""
    from_sundials = _import_sundials()

    def residual(t: float, y: FloatArray, slope: FloatArray, result: FloatArray) -> None:
        result[:] = slope - equations.rates(t, y)

    def jacobian(t: float, y: FloatArray, _s: FloatArray, _r: FloatArray, by_slope: float, result: FloatArray) -> None:
        result[:] = by_slope * np.eye(y.size) - equations.jacobian(t, y)

    return from_sundials.ida.IDA(residual, jacfn=jacobian, **options)


def _import_sundials() -> Any:
    """The package scikit-sundae, an optional extra."""
    try:
        import sksundae
    except ImportError as error:
        raise ModelError(
            'simulation.integrator = "cvode" or "ida" needs scikit-sundae, which is not installed. Install beltdyn '
            'with its extra beltdyn[integrators], or choose "generalized_alpha", "bdf" or "radau".'
        ) from error
    return sksundae


def _chunk(equations: FirstOrder, solver: _Solver, time: FloatArray, before: float) -> Chunk:
    """States at some instants of the solver's last step, which began at a time, s."""
    y = np.array([solver.at(float(instant)) for instant in time]).reshape(len(time), equations.size)
    return first_order_chunk(equations, time, y, solver.time - before, solver.time)

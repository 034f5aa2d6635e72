"""The paper's "any standard integrator": SUNDIALS CVODE and IDA, and SciPy's BDF and Radau, on the same equations.

The unknowns are y = (positions, velocities, works): the powers of the energy account are integrated along.  With
multipliers, the accelerations come from Eq. 26 with its constant matrices; with shared nodes from Eq. 27.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model.simulation import SAME
from beltdyn.solvers.integrator_state import StepBound
from beltdyn.solvers.trajectory import Chunk, Task
from beltdyn.system.arrays import (
    DRIVER_WORK,
    ENERGY_WORKS,
    NO_TANGENT,
    POWERS,
    BodyForces,
    Motion,
    RingMatrix,
    System,
    TangentFactors,
)
from beltdyn.system.missed_action import jump_work
from beltdyn.system.motion import new_equations, no_multipliers
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.state import State
from beltdyn.system.state_forces import body_forces_at, prescribe
from beltdyn.system.steady_assembly import assemble

# The belt's ends joined by Lagrange multipliers, and the multipliers eliminated (Eqs. 25 and 26)


@dataclass(frozen=True, eq=False)
class JointConstraint:
    """The constant matrices of Eqs. 25 and 26: a belt of N nodes, n coordinates each, the last tied to the first."""

    jacobian: FloatArray
    """C_e: coordinates of the first node minus those of the last, shape (n, n N)."""
    by_force: FloatArray
    """First bracket of Eq. 26, M^-1 - M^-1 C^T (C M^-1 C^T)^-1 C M^-1, shape (n N, n N)."""
    by_constraint: FloatArray
    """Second bracket of Eq. 26, M^-1 C^T (C M^-1 C^T)^-1, shape (n N, n)."""

    def accelerations(self, force: FloatArray, constraint: FloatArray | None = None) -> FloatArray:
        """Accelerations of the nodal coordinates (Eq. 26) by forces Q and Q_d, which is zero for a rigid joint."""
        result = self.by_force @ force
        return result if constraint is None else result + self.by_constraint @ constraint


def joint_constraint(system: System) -> JointConstraint:
    """Compute the matrices in brackets of Eq. 26 once."""
    if not system.joint:
        raise ModelError('the belt has no joint with multipliers. Set simulation.joint = "multipliers".')
    dof = len(system.scale)
    jacobian = np.zeros((dof, system.first_body))
    jacobian[:, :dof] = np.eye(dof)
    jacobian[:, -dof:] = -np.eye(dof)
    inverse: FloatArray = np.linalg.inv(mass_matrix(system)).astype(np.float64)
    flexibility = inverse @ jacobian.T
    by_constraint: FloatArray = flexibility @ np.linalg.inv(jacobian @ flexibility).astype(np.float64)
    return JointConstraint(jacobian, inverse - by_constraint @ flexibility.T, by_constraint)


def mass_matrix(system: System) -> FloatArray:
    """Mass matrix of the belt, dense, shape (n N, n N)."""
    dof, size = len(system.scale), system.first_body
    matrix = np.zeros((size, size))
    for element, mass in enumerate(system.mass):
        nodes = np.array([element, (element + 1) % system.nodes])
        rows = (dof * nodes[:, None] + np.arange(dof)).ravel()
        matrix[np.ix_(rows, rows)] += mass
    return matrix


class FirstOrder:
    """Rates and exact Jacobian of y = (positions, velocities, works), of size 2 (n N + D) + 8."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._half = system.first_body + system.bodies.size
        self._equations = new_equations(system)
        self._no_multipliers = no_multipliers(system)
        self.size = 2 * self._half + len(POWERS)
        self.evaluations = 0

    def pack(self, state: State) -> FloatArray:
        """Unknowns of a state, with no work done yet, shape (size,)."""
        return np.concatenate([state.position, state.velocity, np.zeros(len(POWERS))])

    def unpack(self, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions, velocities and works from unknowns of shape (..., size)."""
        return y[..., : self._half], y[..., self._half : 2 * self._half], y[..., 2 * self._half :]

    def body_forces_at(self, time: FloatArray, position: FloatArray, velocity: FloatArray) -> BodyForces:
        """Body forces at states; see `state_forces.body_forces_at`.

        The prescribed motion is written into the states: a solver's integral of it has its errors.
        """
        return body_forces_at(self._system, time, position, velocity)

    def jump(self, time: float, y: FloatArray) -> None:
        """Bring prescribed bodies to their motion at a time (s) in unknowns, and count the work that it takes."""
        position, velocity, work = self.unpack(y)
        before = velocity.copy()
        prescribe(self._system, Motion(time, position, velocity, np.zeros(self._half)))
        work[DRIVER_WORK] += jump_work(self._system, before, velocity)

    def tolerances(self, velocity: float, time: float) -> FloatArray:
        """Absolute tolerances of the unknowns.

        Parameters
        ----------
        velocity
            Allowed error of the velocities of nodes, rims and other bodies, m/s.
        time
            Positions may err by what the velocity makes in this time, s.

        Returns
        -------
        ndarray, shape (size,)
            The length of an element turns gradients into m, radii angles; works are not controlled.
        """
        nodes = np.tile(self._system.scale, self._system.nodes)
        lengths = np.concatenate([nodes, self._system.bodies.reach])
        return np.concatenate([time * velocity / lengths, velocity / lengths, np.full(len(POWERS), np.inf)])

    def rates(self, time: float, y: FloatArray) -> FloatArray:
        """dy/dt at a time (s): velocities, accelerations (Eq. 27, or Eq. 26 with multipliers) and powers."""
        self.evaluations += 1
        motion = self._assemble(time, y, NO_TANGENT)
        matrix, nodes, free = self._equations.matrix, self._system.first_body, self._free
        acceleration = motion.acceleration
        acceleration[:nodes] = self._flexibility @ -matrix.node_side.ravel()
        acceleration[nodes + free] = -matrix.border_side[: free.size] / self._system.bodies.inertia[free]
        return np.concatenate([motion.velocity, acceleration, self._equations.forces.power])

    def jacobian(self, time: float, y: FloatArray) -> FloatArray:
        """Derivative of `rates` with respect to y; nothing depends on the works, and their rows are left at zero."""
        half = self._half
        result = np.zeros((self.size, self.size))
        result[:half, half : 2 * half] = np.eye(half)
        prescribed = self._system.first_body + np.flatnonzero(self._system.bodies.unknown < 0)
        result[prescribed, half + prescribed] = 0.0
        self._assemble(time, y, TangentFactors(by_position=1.0))
        result[half : 2 * half, :half] = self._by_tangent(self._equations.matrix)
        self._assemble(time, y, TangentFactors(by_velocity=1.0))
        result[half : 2 * half, half : 2 * half] = self._by_tangent(self._equations.matrix)
        return result

    def _assemble(self, time: float, y: FloatArray, factors: TangentFactors) -> Motion:
        """Residual without inertia, and its tangent; gives the motion, with no accelerations but prescribed ones."""
        position, velocity, _ = self.unpack(y)
        motion = Motion(time, position.copy(), velocity.copy(), np.zeros(self._half))
        prescribe(self._system, motion)
        assemble(self._system, motion, self._no_multipliers, factors, self._equations)
        return motion

    @cached_property
    def _flexibility(self) -> FloatArray:
        """Accelerations of the nodes by the forces on them: inverse mass matrix, or first bracket of Eq. 26.

        Fixed coordinates have none.
        """
        if self._system.joint:
            return joint_constraint(self._system).by_force
        moving, mass = np.flatnonzero(~self._system.supports.fixed), mass_matrix(self._system)
        flexibility = np.zeros_like(mass)
        flexibility[np.ix_(moving, moving)] = np.linalg.inv(mass[np.ix_(moving, moving)])
        return flexibility

    @cached_property
    def _free(self) -> IntArray:
        """Numbers of the free bodies."""
        return np.flatnonzero(self._system.bodies.unknown >= 0)

    def _by_tangent(self, matrix: RingMatrix) -> FloatArray:
        """Minus the inverse mass times a tangent, dense, shape (n N + D, n N + D)."""
        free = self._free
        nodes = self._system.first_body
        size = nodes + len(matrix.corner)
        whole, tangent = np.zeros((size, size)), np.zeros((self._half, self._half))
        np.add.at(whole, places(matrix), entries(matrix))
        moving = np.concatenate([np.arange(nodes), nodes + free])
        tangent[np.ix_(moving, moving)] = whole[: moving.size, : moving.size]
        tangent[:nodes] = self._flexibility @ tangent[:nodes]
        tangent[nodes + free] /= self._system.bodies.inertia[free, None]
        return -tangent


# Integrators composed of a one-step method and a step control

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
        factor = _SAFETY * ratio ** (-1.0 / (order + 1)) if ratio > 0.0 else _MOST
        return Verdict(ratio <= 1.0, min(length * min(max(factor, _LEAST), _MOST), self.max_step))


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
    """States of the first-order system as integrators return them, with prescribed motion and body forces."""
    position, velocity, work = (np.ascontiguousarray(part) for part in equations.unpack(y))
    forces = equations.body_forces_at(time, position, velocity)
    work = np.pad(work, ((0, 0), (0, len(ENERGY_WORKS) - len(POWERS))))  # their own damping is not known
    return Chunk(time, np.full(len(time), step), position, velocity, work, forces, reached)


Name = Literal["cvode", "ida", "bdf", "radau"]

_ROOM = 64
"""States between steps that are handed out at once, at most."""
_RELATIVE = 1e-9
_PART = 0.02
"""Error that one step may make, over that of the run: the errors of steps add up."""
_HUGE = 1e30
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
        tolerances = equations.tolerances(_PART * self.rtol * task.velocity_scale, POSITION_TIME)
        bound = StepBound(task.system, _PART * self.rtol * task.velocity_scale)
        y, time = equations.pack(task.start), task.instants.begin
        yield Chunk.start(task.system, task.start, time)
        written = 1
        for stop in task.stops:
            make = _Sundials if self.name in ("cvode", "ida") else _SciPy
            equations.jump(float(np.nextafter(time, np.inf)), y)
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
                for first in range(written, count, _ROOM):
                    instants = task.instants[np.arange(first, min(first + _ROOM, count))]
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
        return float(np.nextafter(self.start, np.inf))


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
    """An implicit method of SciPy."""

    def __init__(self, leg: _Leg) -> None:
        from scipy.integrate import BDF, Radau

        kind = BDF if leg.method.name == "bdf" else Radau
        self._solver = kind(
            leg.equations.rates,
            leg.begin,
            leg.y,
            leg.stop,
            max_step=leg.method.max_step or np.inf,
            rtol=_RELATIVE,
            atol=leg.tolerances,
            jac=leg.equations.jacobian,
        )
        if kind is BDF:  # which takes no largest order, but none whose error it thinks huge
            self._solver.error_const[_HIGHEST_A_STABLE_ORDER + 1] = _HUGE
        self.time, self.y, self._longest = leg.start, leg.y, self._solver.max_step

    def step(self, farthest: float) -> None:
        self._solver.max_step = min(self._longest, farthest - self.time)
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
            "rtol": _RELATIVE,
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

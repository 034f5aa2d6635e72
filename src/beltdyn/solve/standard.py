"""The paper's "any standard integrator": SUNDIALS CVODE and IDA, and SciPy's BDF and Radau, on the same equations of motion.

The unknowns are y = (positions, velocities, works): the powers of the energy account are integrated along.  With multipliers, the
accelerations come from Eq. 26 with its constant matrices; with shared nodes from Eq. 27.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.solve.trajectory import Chunk, Task
from beltdyn.system.arrays import FloatArray
from beltdyn.system.first_order import FirstOrder

Name = Literal["cvode", "ida", "bdf", "radau"]

_POSITION_TIME = 1e-3
_RELATIVE = 1e-9
_MANY_STEPS = 100_000


@dataclass(frozen=True)
class StandardIntegrator:
    """A method of SUNDIALS or SciPy.

    Attributes
    ----------
    name : str
        "cvode", "ida", "bdf" or "radau".
    rtol : float
        Allowed error of velocities over the velocity scale of the task; positions may err by what that makes in a millisecond.
    max_step : float or None
        s.
    """

    name: Name
    rtol: float
    max_step: float | None = None

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate; see `Integrator`."""
        equations = FirstOrder(task.system)
        start, y = float(task.times[0]), equations.pack(task.start)
        yield _chunk(equations, task.times[:1], y[None], np.zeros(1), start)
        written = 1
        march = _sundials if self.name in ("cvode", "ida") else _scipy
        for stop in task.stops:
            count = int(np.searchsorted(task.times, stop, side="right"))
            outputs = task.times[written:count]
            for chunk, y in march(self, equations, task, start, y, stop, outputs):
                written += len(chunk.time)
                yield chunk
            start = stop

    def tolerances(self, equations: FirstOrder, scale: float) -> FloatArray:
        """Absolute tolerances of the unknowns from the velocity scale, m/s."""
        return equations.tolerances(self.rtol * scale, _POSITION_TIME)

    def give_up(self, time: float, reason: str) -> ConvergenceError:
        """The error for a solver that stopped at a time, s."""
        return ConvergenceError(
            f"the integrator {self.name} cannot go on at t = {time:.6g} s ({reason}). "
            f'Try a larger simulation.rtol than {self.rtol:g}, or simulation.integrator = "generalized_alpha".'
        )


Marched = Iterator[tuple[Chunk, FloatArray]]


def _scipy(
    method: StandardIntegrator,
    equations: FirstOrder,
    task: Task,
    start: float,
    y: FloatArray,
    stop: float,
    outputs: FloatArray,
) -> Marched:
    """March to a stop with an implicit method of SciPy, step by step."""
    from scipy.integrate import BDF, Radau

    options: dict[str, Any] = {"max_step": method.max_step} if method.max_step else {}
    solver = {"bdf": BDF, "radau": Radau}[method.name](
        equations.rates,
        np.nextafter(start, np.inf),
        y,
        stop,
        rtol=_RELATIVE,
        atol=method.tolerances(equations, task.velocity_scale),
        jac=equations.jacobian,
        **options,
    )
    written = 0
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed":
            raise method.give_up(solver.t, str(message))
        task.statistics.steps += 1
        task.statistics.newton_iterations = equations.evaluations
        count = int(np.searchsorted(outputs, solver.t, side="right"))
        interpolant = solver.dense_output() if count > written else None
        states = np.array([interpolant(t) for t in outputs[written:count]]).reshape(-1, y.size)
        steps = np.full(count - written, solver.step_size)
        yield _chunk(equations, outputs[written:count], states, steps, solver.t), solver.y
        written = count


def _sundials(
    method: StandardIntegrator,
    equations: FirstOrder,
    task: Task,
    start: float,
    y: FloatArray,
    stop: float,
    outputs: FloatArray,
) -> Marched:
    """March to a stop with CVODE or IDA, from output to output."""
    begin = np.nextafter(start, np.inf)
    solver = _sundials_solver(method, equations, task)
    if method.name == "ida":
        solver.init_step(begin, y, equations.rates(begin, y))
    else:
        solver.init_step(begin, y)
    before = task.statistics.steps
    instants = outputs if len(outputs) and outputs[-1] == stop else np.append(outputs, stop)
    last = start
    for k, instant in enumerate(instants):
        result = solver.step(float(instant), tstop=stop)
        if not result.success:
            raise method.give_up(float(result.t), str(result.message))
        task.statistics.newton_iterations = equations.evaluations
        y = np.array(result.y).reshape(-1, y.size)[-1]
        written = instants[k : k + 1] if k < len(outputs) else outputs[:0]
        states = y[None][: len(written)]
        yield _chunk(equations, written, states, np.full(len(written), instant - last), float(instant)), y
        last = float(instant)
    task.statistics.steps = before + int(solver.nsteps if hasattr(solver, "nsteps") else 0)


def _sundials_solver(method: StandardIntegrator, equations: FirstOrder, task: Task) -> Any:
    """CVODE or IDA with exact dense Jacobian."""
    try:
        from sksundae.cvode import CVODE
        from sksundae.ida import IDA
    except ImportError as error:
        raise ModelError(
            f'simulation.integrator = "{method.name}" needs scikit-sundae, which is not installed: '
            'pip install "beltdyn[integrators]", or choose "generalized_alpha", "bdf" or "radau".'
        ) from error

    def rates(t: float, y: FloatArray, result: FloatArray) -> None:
        result[:] = equations.rates(t, y)

    def jacobian(t: float, y: FloatArray, _: FloatArray, result: FloatArray) -> None:
        result[:] = equations.jacobian(t, y)

    def residual(t: float, y: FloatArray, slope: FloatArray, result: FloatArray) -> None:
        result[:] = slope - equations.rates(t, y)

    def residual_jacobian(
        t: float, y: FloatArray, _slope: FloatArray, _residual: FloatArray, by_slope: float, result: FloatArray
    ) -> None:
        result[:] = by_slope * np.eye(y.size) - equations.jacobian(t, y)

    options: dict[str, Any] = {
        "rtol": _RELATIVE,
        "atol": method.tolerances(equations, task.velocity_scale),
        "max_num_steps": _MANY_STEPS,
        "max_step": method.max_step or 0.0,
    }
    if method.name == "cvode":
        return CVODE(rates, jacfn=jacobian, **options)
    return IDA(residual, jacfn=residual_jacobian, **options)


def _chunk(equations: FirstOrder, time: FloatArray, y: FloatArray, step: FloatArray, reached: float) -> Chunk:
    """Outputs from unknowns of shape (k, size)."""
    position, velocity, work = equations.unpack(y)
    return Chunk(time, position, velocity, work, step, reached)



"""What every time integrator takes and gives, whatever its method."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Protocol, Self

import numpy as np

from beltdyn.model import Drive, Motor, Pulley, install
from beltdyn.system.arrays import POWERS, FloatArray, System
from beltdyn.system.state import State


@dataclass(frozen=True, eq=False)
class Chunk:
    """Solver steps around some successive output instants; none in a chunk that only tells of progress.

    Attributes
    ----------
    time : ndarray, shape (k,)
        Output instants, s.
    fraction : ndarray, shape (k,)
        Where in its step each instant lies, 0 to 1.
    step : ndarray, shape (k,)
        Length of the step, s.
    position, velocity : ndarray, shape (k, 2, 6 N + D)
        Nodal coordinates and coordinates of bodies, and their rates, at start and end of the step.
    work : ndarray, shape (k, 7)
        Time integrals of the powers in `system.arrays.POWERS` at the instants, J.
    reached : float
        Time that the solver has reached, s.
    """

    time: FloatArray
    fraction: FloatArray
    step: FloatArray
    position: FloatArray
    velocity: FloatArray
    work: FloatArray
    reached: float

    @classmethod
    def at(
        cls, time: FloatArray, position: FloatArray, velocity: FloatArray, work: FloatArray, step: FloatArray
    ) -> Self:
        """States that a solver hands out at the output instants themselves.

        Parameters
        ----------
        time, position, velocity, work, step : ndarray
            As in a chunk, but position and velocity of shape (k, 6 N + D).
        """
        return cls(
            time=time,
            fraction=np.ones(len(time)),
            step=step,
            position=np.repeat(position[:, None], 2, axis=1),
            velocity=np.repeat(velocity[:, None], 2, axis=1),
            work=work,
            reached=float(time[-1]) if len(time) else np.nan,
        )

    @classmethod
    def start(cls, time: float, state: State) -> Self:
        """A state before the first step, at a time (s)."""
        zero = np.zeros(1)
        return cls.at(np.array([time]), state.position[None], state.velocity[None], np.zeros((1, len(POWERS))), zero)

    @classmethod
    def join(cls, chunks: Sequence[Self]) -> Self:
        """One chunk of several successive ones."""
        names = [item.name for item in fields(cls)][:-1]
        arrays = {name: np.concatenate([getattr(chunk, name) for chunk in chunks]) for name in names}
        return cls(**arrays, reached=chunks[-1].reached)

    def interpolate(self) -> tuple[FloatArray, FloatArray]:
        """Position and velocity at the instants: cubic Hermite interpolation within the steps.

        Returns
        -------
        position, velocity : ndarray, shape (k, 6 N + D)
        """
        x, step = self.fraction[:, None], self.step[:, None]
        before, after = self.position[:, 0], self.position[:, 1]
        start, end = self.velocity[:, 0], self.velocity[:, 1]
        rest = 1.0 - x
        rise = np.divide(after - before, step, out=np.zeros_like(before), where=step > 0.0)
        position = before + step * x * (x * (3.0 - 2.0 * x) * rise + rest * (rest * start - x * end))
        velocity = 6.0 * x * rest * rise + rest * (1.0 - 3.0 * x) * start + x * (3.0 * x - 2.0) * end
        inside = x < 1.0
        return np.where(inside, position, after), np.where(inside, velocity, end)


@dataclass
class Statistics:
    """What the solver did so far.

    Attributes
    ----------
    steps : int
        Accepted steps.
    rejected_steps : int
        Steps tried in vain; zero for standard integrators, which do not tell.
    newton_iterations : int
        Iterations of generalised-alpha.
    evaluations : int
        Evaluations of the equations of motion by standard integrators.
    """

    steps: int = 0
    rejected_steps: int = 0
    newton_iterations: int = 0
    evaluations: int = 0


@dataclass(frozen=True)
class Task:
    """An initial value problem.

    Attributes
    ----------
    system : System
        Belt, pulleys, supports.
    start : State
        State at the first output instant.
    times : ndarray, shape (k,)
        Output instants, s, ascending; the solver ends at the last one.
    breakpoints : sequence of float
        Instants between, s, on which a step must end because what drives the system has a kink or a jump there.
    velocity_scale : float
        Velocity that relative tolerances are relative to, m/s.
    statistics : Statistics
        Kept up to date by the solver.
    """

    system: System
    start: State
    times: FloatArray
    breakpoints: Sequence[float]
    velocity_scale: float
    statistics: Statistics

    @property
    def stops(self) -> list[float]:
        """Breakpoints after the start, and the end, s."""
        first, last = float(self.times[0]), float(self.times[-1])
        return [*sorted({float(t) for t in self.breakpoints if first < t < last}), last]


class Integrator(Protocol):
    """A method of time integration."""

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate, handing out chunks as they come.

        Parameters
        ----------
        task
            The problem; its statistics are kept up to date.

        Raises
        ------
        ConvergenceError
            If the solver cannot go on.
        """


def drive_task(drive: Drive, system: System, start: State, statistics: Statistics) -> Task:
    """The initial value problem that a drive file describes.

    Parameters
    ----------
    drive
        The drive.
    system
        Its arrays.
    start
        State at time zero.
    statistics
        Where the solver counts.

    Returns
    -------
    Task
        Outputs at multiples of the interval and at the end.
    """
    settings = drive.simulation
    count = int(np.floor(settings.duration / settings.output_interval * (1 + 1e-12)))
    times: FloatArray = settings.output_interval * np.arange(count + 1, dtype=np.float64)
    if settings.duration - times[-1] > 1e-9 * settings.duration:
        times = np.append(times, settings.duration)
    times[-1] = settings.duration
    return Task(system, start, times, drive.breakpoints, velocity_scale(drive), statistics)


def velocity_scale(drive: Drive) -> float:
    """Velocity that local errors are measured by: the fastest rim that is driven, or what the strain can cause.

    Parameters
    ----------
    drive
        The drive.

    Returns
    -------
    float
        m/s; rims are driven by a prescribed speed, or by a motor up to its synchronous speed.  The second is strain at
        rest times the speed of axial waves, the velocity of a belt end that is let go.
    """
    times = np.linspace(0.0, drive.simulation.duration, 1001)
    rims = [radius * _driven_speed(pulley, times) for pulley, radius in zip(drive.pulleys, drive.radii, strict=True)]
    wave = float(np.sqrt(drive.belt.axial_stiffness / drive.belt.mass_per_length))
    return float(max(*rims, install(drive).strain * wave, 0.0))


def _driven_speed(pulley: Pulley, times: FloatArray) -> float:
    """Largest speed at which a pulley's shaft is driven, rad/s; zero where it is not."""
    if pulley.speed is not None:
        return float(np.max(np.abs(pulley.speed.at(times))))
    return max((abs(load.synchronous_speed) for load in pulley.load if isinstance(load, Motor)), default=0.0)

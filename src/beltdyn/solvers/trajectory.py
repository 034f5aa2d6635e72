"""What every time integrator takes and gives, whatever its method."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.model import Prepared
from beltdyn.model.pulley import fastest_rim
from beltdyn.model.simulation import SAME, Instants
from beltdyn.system.arrays import ENERGY_WORKS, BodyForces, System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.state import State


@dataclass(frozen=True, eq=False)
class Chunk:
    """Successive states of a solver, at the ends of its steps; none in a chunk that only reports progress."""

    time: FloatArray
    """s, ascending, shape (k,)."""
    step: FloatArray
    """Length of the step that ends there, s; zero at the start, shape (k,)."""
    position: FloatArray
    """Nodal coordinates and coordinates of bodies, shape (k, n N + D)."""
    velocity: FloatArray
    """Their rates, shape (k, n N + D)."""
    work: FloatArray
    """In the order of `system.arrays.ENERGY_WORKS`, since time zero, J, shape (k, 10)."""
    forces: BodyForces
    """Of each state; `system.body_forces.body_forces_at` finds them where a method does not know them."""
    reached: float
    """Time that the solver has reached, s."""

    @classmethod
    def start(cls, system: System, state: State, begin: float = 0.0) -> Self:
        """The state at the beginning (s), before the first step."""
        time, position, velocity = np.full(1, begin), state.position[None].copy(), state.velocity[None].copy()
        forces = body_forces_at(system, time, position, velocity)
        return cls(time, np.zeros(1), position, velocity, np.zeros((1, len(ENERGY_WORKS))), forces, begin)

    @classmethod
    def join(cls, chunks: Sequence[Self]) -> Self:
        """One chunk of several successive ones."""
        arrays = {name: np.concatenate([getattr(chunk, name) for chunk in chunks]) for name in _ROWS}
        forces = BodyForces(*(np.concatenate(rows) for rows in zip(*(chunk.forces for chunk in chunks), strict=True)))
        return cls(**arrays, forces=forces, reached=chunks[-1].reached)

    def only(self, states: BoolArray | slice) -> Self:
        """Some of the states."""
        arrays = {name: getattr(self, name)[states] for name in _ROWS}
        return replace(self, **arrays, forces=BodyForces(*(rows[states] for rows in self.forces)))

    def around(self, instants: Instants, before: float) -> BoolArray:
        """Mask of states at the ends of steps that hold output instants; `before` is the time of the previous state.

        Where a step ends on its only instant, its beginning is left out.
        """
        counts = instants.counts_until(np.append(before, self.time))
        holds = np.diff(counts) > 0
        inside = (np.diff(counts) > 1) | (holds & (instants[counts[1:] - 1] < self.time - SAME))
        return np.asarray(holds | np.append(inside[1:], False))

    def locate(self, instants: FloatArray) -> tuple[IntArray, FloatArray]:
        """The states at which steps end that hold some ascending instants, and the part of the step to each."""
        end = np.minimum(np.searchsorted(self.time, instants - SAME), len(self.time) - 1)
        before = self.time[np.maximum(end - 1, 0)]
        length = self.time[end] - before
        part = np.divide(instants - before, length, out=np.ones(len(end)), where=length > 0.0)
        return end, np.where(instants >= self.time[end] - SAME, 1.0, part)

    def at(self, instants: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Position and velocity at some instants, by cubic Hermite interpolation within the steps."""
        end, part = self.locate(instants)
        first, x = np.maximum(end - 1, 0), part[:, None]
        step = (self.time[end] - self.time[first])[:, None]
        before, after = self.position[first], self.position[end]
        start, stop = self.velocity[first], self.velocity[end]
        rest = 1.0 - x
        rise = np.divide(after - before, step, out=np.zeros_like(before), where=step > 0.0)
        position = before + step * x * (x * (3.0 - 2.0 * x) * rise + rest * (rest * start - x * stop))
        velocity = 6.0 * x * rest * rise + rest * (1.0 - 3.0 * x) * start + x * (3.0 * x - 2.0) * stop
        inside = x < 1.0
        return np.where(inside, position, after), np.where(inside, velocity, stop)


_ROWS = ("time", "step", "position", "velocity", "work")
"""Attributes of a `Chunk` with one row for each state."""


def interpolated(values: NDArray[Any], end: IntArray, part: FloatArray) -> NDArray[Any]:
    """Interpolate linearly within steps values at their ends; of whole numbers, take that of the nearer end.

    Only at the ends do the equations of motion hold.
    """
    if values.dtype.kind == "i":
        return np.asarray(values[np.where(part < 0.5, np.maximum(end - 1, 0), end)])
    result = values[end]
    inside = np.flatnonzero(part < 1.0)
    weight = part[inside].reshape(-1, *[1] * (values.ndim - 1))
    result[inside] = weight * result[inside] + (1.0 - weight) * values[end[inside] - 1]
    return result


@dataclass
class Statistics:
    """What the solver did so far."""

    steps: int = 0
    """Accepted steps."""
    rejected_steps: int = 0
    """Rejected steps; zero for standard integrators, which do not report them."""
    newton_iterations: int = 0
    """Iterations of generalised-alpha."""
    evaluations: int = 0
    """Evaluations of the equations of motion by standard integrators."""


@dataclass(frozen=True)
class Task:
    """An initial value problem."""

    system: System
    """Belt, pulleys, supports."""
    start: State
    """State at the first output instant."""
    instants: Instants
    """Output instants, on which steps end where they can; the solver begins at the first and ends at the last one."""
    breakpoints: Sequence[float]
    """Instants between, s, on which a step must end because what drives the system has a kink or a jump there."""
    velocity_scale: float
    """Velocity that relative tolerances are relative to, m/s."""
    statistics: Statistics
    """Kept up to date by the solver."""
    contact_keys: tuple[str, ...] = ()
    """Keys of contact that the drive file gives, though the drive could choose them."""

    @property
    def stops(self) -> list[float]:
        """Breakpoints after the start, and the end, s."""
        first, last = self.instants.begin, self.instants.end
        return [*sorted({float(t) for t in self.breakpoints if first < t < last}), last]


class Integrator(Protocol):
    """A method of time integration, with its own control of steps."""

    @property
    def name(self) -> str:
        """Name, for results and messages."""

    def __call__(self, task: Task) -> Iterator[Chunk]:
        """Integrate, handing out chunks as they come."""


_CHOSEN = ("stiffness", "allowed_penetration", "damping", "creep_ratio", "standstill_creep")
"""Keys of contact that a drive chooses where they are open."""


def drive_task(prepared: Prepared, system: System, start: State, statistics: Statistics) -> Task:
    """The initial value problem that a drive file describes."""
    instants, scale = prepared.simulation.instants, velocity_scale(prepared)
    chosen, contact = {choice.key for choice in prepared.choices}, prepared.contact
    given = tuple(key for key in _CHOSEN if getattr(contact, key) is not None and f"contact.{key}" not in chosen)
    return Task(system, start, instants, prepared.breakpoints, scale, statistics, given)


def velocity_scale(prepared: Prepared) -> float:
    """Velocity that local errors are measured by: the fastest rim that is driven, or what the strain can cause."""
    rim = fastest_rim(prepared.pulleys, prepared.radii, prepared.simulation.end)
    return max(rim, prepared.installation.strain * prepared.belt.wave_speed)

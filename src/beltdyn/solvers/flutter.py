"""Whether a belt flutters where it slides: how far vibrations could grow in a run.

While a belt slides, vibrations near the frequency of the belt on its penalty springs may take energy from what drives
the pulley and grow (tests/verification/theory/test_sliding_flutter.py).  How fast, the equations of motion say,
linearized at states of the run; the integral of that over the time of sliding is the logarithm of the factor by which a
vibration grows.  What grows in a piece of belt stops growing when that has passed the arc on which it slides.
"""

from collections.abc import Callable, Mapping
from math import sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.contact.friction.law import saturation_at
from beltdyn.quadrature import running_integral
from beltdyn.solvers.eigenvalues import arnoldi, unit_masses
from beltdyn.solvers.engine import linearise
from beltdyn.system.arrays import Motion, System, TangentFactors
from beltdyn.system.frame import OverTime
from beltdyn.system.guide import rows_of_ties
from beltdyn.system.moving_center import pulley_speeds
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.steady_assembly import new_equations, no_multipliers

if TYPE_CHECKING:
    from scipy.sparse import csc_array


# Vibrations about a state in motion: eigenvalues of the equations of motion, linearized there

_BATCHES = 2
"""Batches of steps of the Arnoldi method, at most."""
_TOLERANCE = 1e-6
"""Residual of an eigenvalue that counts as found, relative; with 1e-3 some would be none."""
_ENOUGH = 24
"""Eigenvalues around a shift after which no more are looked for."""


class Vibrations:
    """Vibrations of a system about states in motion."""

    def __init__(self, system: System) -> None:
        self._system, self._equations = system, new_equations(system)
        self._no_multipliers = no_multipliers(system)
        self._rows, self._columns = places(self._equations.matrix)
        self.size = system.first_body + len(self._equations.matrix.corner)
        multipliers = self.size - len(system.scale) * system.joint
        self._ties = np.maximum(self._rows, self._columns) >= multipliers
        if isinstance(system.frame, OverTime):
            self._ties |= np.isin(self._rows, rows_of_ties(system, self.size))

    def tangents(
        self, time: float, position: FloatArray, velocity: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Entries of K, C and M at a state, in the order in which `matrix` takes them.

        The ties of a joint, and of a mesh to its place, which are in any tangent, are left in K alone.
        """
        motion = Motion(time, position.copy(), velocity.copy(), np.zeros_like(position))

        def tangent(factors: TangentFactors) -> FloatArray:
            linearise(self._system, motion, self._no_multipliers, factors, self._equations)
            return entries(self._equations.matrix)

        stiffness = tangent(TangentFactors(by_position=1.0))
        damping = tangent(TangentFactors(by_velocity=1.0))
        mass = tangent(TangentFactors(by_acceleration=1.0))
        damping[self._ties] = 0.0
        mass[self._ties] = 0.0
        return stiffness, damping, mass

    def matrix(self, values: FloatArray | ComplexArray) -> "csc_array":
        """Make a sparse matrix of entries."""
        from scipy.sparse import csc_array

        used = np.flatnonzero(values)
        return csc_array((values[used], (self._rows[used], self._columns[used])), shape=(self.size, self.size))

    def fastest_growing(self, time: float, position: FloatArray, velocity: FloatArray, shift: complex) -> complex:
        """Of the vibrations nearest to a shift the one that grows fastest."""
        solve = self._shifted_inverse(self.tangents(time, position, velocity), shift)
        found = np.zeros(0, complex)
        for ritz in arnoldi(solve, 2 * self.size, _BATCHES) if solve else ():
            found = shift + 1.0 / ritz.values[ritz.residuals < _TOLERANCE]
            if found.size >= _ENOUGH:
                break
        return complex(max(found, key=lambda value: value.real, default=np.nan))

    def _shifted_inverse(
        self, tangents: tuple[FloatArray, FloatArray, FloatArray], shift: complex
    ) -> Callable[[ComplexArray], ComplexArray] | None:
        """Solve (A - shift) z = y, where A has the eigenvectors (a, s a / |shift|); None if that is singular.

        The coordinates a = x / S are those of unit masses.
        """
        from scipy.sparse import diags_array
        from scipy.sparse.linalg import splu

        scale = diags_array(unit_masses(self.matrix(tangents[2])))
        stiffness, damping, mass = ((scale @ self.matrix(values) @ scale).tocsc() for values in tangents)
        try:
            factors = splu((stiffness + shift * damping + shift**2 * mass).tocsc())
        except RuntimeError:
            return None
        rate = abs(shift)
        by_place, by_rate = damping + shift * mass, rate * mass
        massless = np.flatnonzero(np.diff(by_rate.indptr) == 0)

        def solve(deviation: ComplexArray) -> ComplexArray:
            place, turned = deviation[: self.size], deviation[self.size :]
            moved = -factors.solve(np.asarray(by_place @ place + by_rate @ turned))
            moved[massless] = 0.0  # multipliers, on which nothing depends but themselves
            return np.concatenate([moved, (shift * moved + place) / rate])

        return solve


_ELEMENTS = 1
"""Length of belt that must slide in one piece, in elements; a mesh cannot represent shorter waves."""
_PERIODS = 10.0
"""Longest pause of sliding that a vibration survives, in periods."""
_SAMPLES = 16
"""States kept, at most."""
_SHIFT = 0.02 + 1j
"""Where to look for vibrations, over the angular frequency of the belt on its penalty springs."""


class Flutter(NamedTuple):
    """The largest growth of vibrations in a run."""

    growth: float
    """Natural logarithm of the factor by which their amplitude may grow."""
    rate: float
    """Growth of the fastest of them, 1/s."""
    frequency: float
    """Its frequency, Hz."""
    start: float
    """When growth begins, s."""
    end: float
    """When it ends, s."""

    @property
    def attributes(self) -> dict[str, float]:
        """Attributes of the results."""
        return {f"flutter_{name}": value for name, value in self._asdict().items()}


def growth_rates(eigenvalues: ComplexArray) -> FloatArray:
    """Growth rates of vibrations, 1/s: zero for growth without oscillation, and for eigenvalues not found (NaN)."""
    swinging = np.abs(eigenvalues.imag) > np.abs(eigenvalues.real)
    return np.asarray(np.where(swinging, eigenvalues.real, 0.0))


def flutter_shift(system: System) -> complex:
    """Where to look for flutter, 1/s: near the frequency of the belt on its penalty springs."""
    return _SHIFT * sqrt(system.law.normal.stiffness / system.element.section.mass)


class FlutterWatch:
    """Notes when a belt slides, with a few states in which it does; at the end it finds how vibrations grow there."""

    def __init__(self, system: System) -> None:
        self._system, self._shift = system, flutter_shift(system)
        self._memory = _PERIODS * 2.0 * np.pi / self._shift.imag
        self._time: list[FloatArray] = []
        self._transit: list[FloatArray] = []
        self._last = -np.inf
        self._states: list[tuple[float, FloatArray, FloatArray]] = []
        self._stride, self._passed = 1, 0

    def take(
        self, time: FloatArray, position: FloatArray, velocity: FloatArray, seen: Mapping[str, NDArray[Any]]
    ) -> None:
        """Take outputs: k states, and their fields of `Observations`."""
        transit = self._transit_time(velocity, seen)
        self._time.append(time)
        self._transit.append(transit)
        last = last_slid(time, transit, self._last)
        self._last = last[-1]
        for k in np.flatnonzero(time - last <= self._memory):
            self._keep(float(time[k]), position[k], velocity[k])

    def find(self) -> Flutter | None:
        """The largest growth of vibrations while the belt slid; None where none grows."""
        if len(self._states) < 2:
            return None
        instants, found = self._fastest_growing()
        rates = growth_rates(found)
        time, transit = np.concatenate(self._time), np.concatenate(self._transit)
        active = time - last_slid(time, transit) <= self._memory
        transit = transit[np.maximum.accumulate(np.where(transit > 0.0, np.arange(transit.size), 0))]
        grown = [
            growth_within(time[first:last], transit[first:last], instants, rates)
            for first, last in np.flatnonzero(np.diff(active, prepend=False, append=False)).reshape(-1, 2)
        ]
        growth, start, end = max(grown)
        fastest = int(np.argmax(rates))
        frequency = abs(float(found[fastest].imag)) / (2.0 * np.pi)
        return Flutter(growth, float(rates[fastest]), frequency, start, end) if growth > 0.0 else None

    def _fastest_growing(self) -> tuple[FloatArray, ComplexArray]:
        """Instants (s) and eigenvalues (1/s): of every second state, and of those beside one where vibrations grow."""
        vibrations, found = Vibrations(self._system), np.full(len(self._states), np.nan + 0j)
        known = np.zeros(found.size, bool)

        def look(wanted: BoolArray) -> None:
            for number in np.flatnonzero(wanted & ~known):
                found[number], known[number] = vibrations.fastest_growing(*self._states[number], self._shift), True

        look((np.arange(found.size) % 2 == 0) | (np.arange(found.size) == found.size - 1))
        look(np.convolve(growth_rates(found) > 0.0, [1, 1, 1], mode="same") > 0)
        return np.array([state[0] for state in self._states])[known], found[known]

    def _transit_time(self, velocity: FloatArray, seen: Mapping[str, NDArray[Any]]) -> FloatArray:
        """Time in which the belt moves by the length of its longest piece that slides, s; zero where none does."""
        system = self._system
        normal, touched = seen["normal_force"], seen["contact_pulley"]
        friction, rim = system.pulleys.friction, pulley_speeds(system, velocity) * system.rims.radius
        points = (normal > 0.0) & (friction[touched] > 0.0)
        saturation = saturation_at(system.law.friction, points, touched, normal, friction, rim)
        points[points] = np.abs(seen["slip_velocity"][points]) >= saturation
        result = np.zeros(len(points))
        needed = _ELEMENTS * system.control.shape[1] * system.contact.points.size
        some = np.flatnonzero(np.count_nonzero(points, axis=1) > needed)
        longest = longest_pieces(points[some])
        some, longest = some[longest > needed], longest[longest > needed]
        length = longest / points.shape[1] * float(np.sum(system.length))
        nodes = velocity[some, : system.first_body].reshape(len(some), system.nodes, len(system.scale))
        speed = np.mean(np.hypot(nodes[..., 0], nodes[..., 1]), axis=1)
        result[some] = np.divide(length, speed, out=np.full(len(some), np.inf), where=speed > 0.0)
        return result

    def _keep(self, time: float, position: FloatArray, velocity: FloatArray) -> None:
        """Keep a state if its turn has come; every second one makes room where there is none."""
        if self._passed % self._stride == 0:
            if len(self._states) == _SAMPLES:
                del self._states[1::2]
                self._stride *= 2
            self._states.append((time, position.copy(), velocity.copy()))
        self._passed += 1


def last_slid(time: FloatArray, transit: FloatArray, before: float = -np.inf) -> FloatArray:
    """When the belt slid last, s: at each output, or before them, or at a time before all."""
    return np.maximum(np.maximum.accumulate(np.where(transit > 0.0, time, -np.inf)), before)


def longest_pieces(points: BoolArray) -> IntArray:
    """Number of true points in the longest row of them on a closed belt, shape (k,), of points of shape (k, n)."""
    count = points.shape[1]
    around = np.concatenate([points, points], axis=1)
    number = np.arange(1, 2 * count + 1)
    rows = number - np.maximum.accumulate(np.where(around, 0, number), axis=1)
    longest: IntArray = np.minimum(np.max(rows, axis=1, initial=0), count)
    return longest


def growth_within(
    time: FloatArray, transit: FloatArray, instants: FloatArray, rates: FloatArray
) -> tuple[float, float, float]:
    """Largest growth in one stretch of sliding, as a logarithm, and when it begins and ends, s.

    `transit` is how long a vibration has grown at most before the belt carries it away, s; `rates` (1/s) are known at
    `instants`.
    """
    rate, count = np.interp(time, instants, rates), len(time)
    total = running_integral(rate, time)
    first = np.searchsorted(time, time - transit)
    windows = np.stack([first, np.arange(1, count + 1)], axis=1).ravel()
    gain = total - np.minimum.reduceat(np.append(total, np.inf), windows)[::2]
    end = int(np.argmax(gain))
    start = int(first[end] + np.argmin(total[first[end] : end + 1]))
    return float(gain[end]), float(time[start]), float(time[end])

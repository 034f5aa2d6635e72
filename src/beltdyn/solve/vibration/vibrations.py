"""Vibrations about a state in motion: eigenvalues of the equations of motion, linearised there.

A deviation x exp(s t) from the motion obeys (K + s C + s^2 M) x = 0, with the tangents K by position, C by velocity and
M by acceleration at the state.  They are taken as constant, which holds for vibrations much faster than the motion.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.solve.integrators.engine import linearise
from beltdyn.solve.vibration.arnoldi import arnoldi
from beltdyn.solve.vibration.eigenvalues import unit_masses
from beltdyn.system.arrays import Motion, System, TangentFactors
from beltdyn.system.frame import Flowing
from beltdyn.system.motion import new_equations, no_multipliers
from beltdyn.system.ring_matrix import entries, places

if TYPE_CHECKING:
    from scipy.sparse import csc_array


_BATCHES = 2
"""Batches of steps of the Arnoldi method, at most."""
_TOLERANCE = 1e-6
"""Residual of an eigenvalue that counts as found, relative; with 1e-3 some would be none."""
_ENOUGH = 24
"""Eigenvalues around a shift after which no more are looked for."""


class Vibrations:
    """Vibrations of a system about states in motion.

    Parameters
    ----------
    system
        The system.
    """

    def __init__(self, system: System) -> None:
        self._system, self._equations = system, new_equations(system)
        self._no_multipliers = no_multipliers(system)
        self._rows, self._columns = places(self._equations.matrix)
        self.size = system.first_body + len(self._equations.matrix.corner)
        multipliers = self.size - len(system.scale) * system.joint
        self._ties = np.maximum(self._rows, self._columns) >= multipliers
        if isinstance(system.frame, Flowing):
            self._ties |= self._rows == self.size - 1

    def tangents(
        self, time: float, position: FloatArray, velocity: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Entries of K, C and M at a state, in the order in which `matrix` takes them.

        Parameters
        ----------
        time
            s.
        position, velocity : ndarray, shape (n N + D,)
            The state.

        Returns
        -------
        tuple of 3 ndarray
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
        """Of the vibrations nearest to a shift the one that grows fastest.

        Parameters
        ----------
        time, position, velocity
            The state, as for `tangents`.
        shift
            Where to look, 1/s: growth, and i times the angular frequency.

        Returns
        -------
        complex
            Its eigenvalue s, 1/s; NaN where none is found.
        """
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

"""Damping of modes by the slope of the friction law: a belt that adheres creeps a little, and loses power.

With friction as steep as Coulomb's a belt that adheres does not slip. Modes are followed to steady running under
friction four times as steep, on the same mesh, by Rayleigh quotients of right and left vectors. Their damping falls
about in proportion to the creep: 4/3 of that change is what the slope adds.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.solvers.eigenvalues import unit_masses
from beltdyn.state.linearized import SmallMotions

if TYPE_CHECKING:
    from scipy.sparse import csc_array

CREEP_SHARE = 0.25
"""Creep of the steeper friction, over that of the drive."""
_MAX_ITERATIONS = 8
"""Iterations for an eigenvalue in the changed problem; beyond, the mode is not followed, and its damping is NaN."""
_EIGENVALUE_TOLERANCE = 1e-6
"""Relative change of an eigenvalue at which the iteration has converged."""
_SHIFT_DISTANCE = 1e-6
"""Distance of a shift from an eigenvalue, relative: on it the matrix is singular."""
_MAX_CHANGE = 0.5
"""Change of an eigenvalue, relative, beyond which it may be that of another mode."""


def creep_damping(
    motions: SmallMotions, steeper: SmallMotions, values: ComplexArray, coordinates: ComplexArray
) -> FloatArray:
    """Damping ratios of modes by the slope of the friction law, shape (k,); NaN where a mode is not found again.

    `steeper`: the same under friction with the part `CREEP_SHARE` of the creep; `values`: eigenvalues, 1/s, shape (k,);
    `coordinates`: their vectors, shape (n, k).
    """
    before, after = _Problem(motions), _Problem(steeper)
    found = np.array(
        [_followed(before, after, value, vector) for value, vector in zip(values, coordinates.T, strict=True)]
    )
    return np.asarray((found - values).real / (1.0 - CREEP_SHARE) / np.abs(values))


class _Problem:
    """(K + s C + s^2 M) x = 0 in coordinates whose masses are one."""

    def __init__(self, motions: SmallMotions) -> None:
        from scipy.sparse import diags_array

        self.scale = unit_masses(motions.mass)
        scaled = diags_array(self.scale)
        self._stiffness, self._damping, self._mass = (
            (scaled @ matrix @ scaled).tocsc() for matrix in (motions.stiffness, motions.damping, motions.mass)
        )

    def at(self, value: complex) -> "csc_array":
        """K + s C + s^2 M."""
        from scipy.sparse import csc_array

        return csc_array(self._stiffness + value * self._damping + value**2 * self._mass)

    def slope(self, value: complex) -> "csc_array":
        """Its derivative by s."""
        from scipy.sparse import csc_array

        return csc_array(self._damping + 2.0 * value * self._mass)


def _followed(before: _Problem, after: _Problem, value: complex, vector: ComplexArray) -> complex:
    """The eigenvalue of a mode in another problem; NaN if it is not found."""
    from scipy.sparse.linalg import splu

    right = vector / before.scale
    begin, nan = value, complex(np.nan)
    try:
        factors: Any = splu(before.at(value * (1.0 + _SHIFT_DISTANCE)))
        left = np.random.default_rng(0).standard_normal(right.size).astype(complex)
        for _ in range(2):
            left = _unit(factors.solve(np.asarray(before.slope(value).conj().T @ left), trans="H"))
        for _ in range(_MAX_ITERATIONS):
            factors, slope = splu(after.at(value * (1.0 + _SHIFT_DISTANCE))), after.slope(value)
            right = _unit(factors.solve(np.asarray(slope @ right)))
            left = _unit(factors.solve(np.asarray(slope.conj().T @ left), trans="H"))
            missing, rate = np.asarray(after.at(value) @ right), np.asarray(slope @ right)
            step = complex(np.vdot(left, missing) / np.vdot(left, rate))
            value -= step
            if not abs(value - begin) < _MAX_CHANGE * abs(begin):
                return nan
            if abs(step) < _EIGENVALUE_TOLERANCE * abs(value):
                return value
    except RuntimeError:  # a singular matrix
        return nan
    return nan


def _unit(vector: ComplexArray) -> ComplexArray:
    return np.asarray(vector / np.linalg.norm(vector))

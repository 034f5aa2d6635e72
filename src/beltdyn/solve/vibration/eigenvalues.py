"""Eigenvalues of linearised equations of motion (K + s C + s^2 M) x = 0, those that swing, from the slowest on.

A motion that meets no force, such as that of a free pulley that turns, gives a double eigenvalue of zero: it may stand
anywhere, and turn on.  Its rate takes its place as the unknown, which leaves no such pair.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.errors import ConvergenceError
from beltdyn.solve.vibration.arnoldi import arnoldi

if TYPE_CHECKING:
    from scipy.sparse import csc_array

_SMALL = 160
"""Order of the pencil up to which all eigenvalues are found by the QZ algorithm."""
_AT_A_TIME, _MOST_AT_A_TIME = 24, 96
"""Eigenvalues that are found around a shift, at least."""
_BATCHES, _TOLERANCE = 8, 1e-9
"""Batches of steps of the Arnoldi method, at most, and the residual of an eigenvalue that is found."""
_BAND = 0.5
"""Half of the band of frequencies around a shift whose eigenvalues are taken, over the radius within which all are."""
_SWINGS = 0.1
"""Least imaginary part of an eigenvalue that swings, over its magnitude: a damping ratio up to 0.995."""
LIGHT = 0.5
"""Damping ratio below which a mode counts as lightly damped: at resonance a force moves one damped so by 15 % more than
the same force does if it stays, 1 / (2 z sqrt(1 - z^2)), and one damped more by less."""
_SLOWEST = 1e-6
"""Least magnitude of an eigenvalue that swings, 1/s: those below are of motions without force, and of rounding."""
_RATE = 1000.0
"""w, rad/s."""
_MOST_SHIFTS = 400
MOST_SWINGING = 99
"""Eigenvalues that swing, counted or not, with which a search ends, unless more are asked for."""
_INFINITE = 1e10
"""Magnitude from which on an eigenvalue is that of a constraint or of a coordinate without mass, 1/s."""


class Pencil(NamedTuple):
    """A z = s B z for z = (a, s a / w, b' / w): x = S (Z a + N b), with coordinates a and motions N b without force.

    S makes the masses of coordinates one, and w = 1000 rad/s rates about as large as coordinates, so that an error of z
    is one of all of them alike.
    """

    by_state: "csc_array"
    """A."""
    by_rate: "csc_array"
    """B."""
    placed: IntArray
    """Numbers of the coordinates a."""
    free: FloatArray
    """N, shape (n, k)."""
    scale: FloatArray
    """Diagonal of S, shape (n,)."""

    @property
    def size(self) -> int:
        """Its order."""
        return int(self.by_state.shape[0])

    def coordinates(self, values: ComplexArray, vectors: ComplexArray) -> ComplexArray:
        """Coordinates x of eigenvectors.

        Parameters
        ----------
        values : ndarray, shape (k,)
            Eigenvalues s, 1/s.
        vectors : ndarray, shape (size, k)
            Eigenvectors z.

        Returns
        -------
        ndarray, shape (n, k)
        """
        placed = self.placed.size
        found: ComplexArray = self.free @ (_RATE * vectors[2 * placed :] / values)
        found[self.placed] += vectors[:placed]
        return self.scale[:, None] * found


def pencil(stiffness: "csc_array", damping: "csc_array", mass: "csc_array", free: FloatArray) -> Pencil:
    """Make the pencil of first order.

    Parameters
    ----------
    stiffness, damping, mass : csc_array, shape (n, n)
        K, C and M.
    free : ndarray, shape (n, k)
        N, motions without force: K N = 0.

    Returns
    -------
    Pencil
        Of order 2 n - k.
    """
    from scipy.linalg import qr
    from scipy.sparse import block_array, csc_array, diags_array, eye_array

    size, count = free.shape
    scale = unit_masses(mass)
    stiffness, damping, mass = (matrix @ diags_array(scale) for matrix in (stiffness, damping, mass))
    free = free / scale[:, None]
    given = qr(free.T, mode="r", pivoting=True)[1][:count] if count else np.zeros(0, int)
    placed = np.setdiff1d(np.arange(size), given)
    same, none = eye_array(placed.size, format="csc"), csc_array((placed.size, placed.size))
    gap, below, turning = csc_array((placed.size, count)), csc_array((size, placed.size)), csc_array(free)
    forces = [-stiffness[:, placed], -_RATE * damping[:, placed], -_RATE * (damping @ turning)]
    return Pencil(
        block_array([[none, _RATE * same, gap], forces], format="csc"),
        block_array([[same, none, gap], [below, _RATE * mass[:, placed], _RATE * (mass @ turning)]], format="csc"),
        placed,
        free,
        scale,
    )


def unit_masses(mass: "csc_array") -> FloatArray:
    """Scales of the coordinates in which their masses are one.

    In other units the matrices are so far from normal that residuals tell nothing: slopes and curvatures of quintic
    elements are numbers of other sizes than places.

    Parameters
    ----------
    mass : csc_array, shape (n, n)
        M.

    Returns
    -------
    ndarray, shape (n,)
        One for coordinates without mass.
    """
    own = np.abs(mass.diagonal())
    scale: FloatArray = np.divide(1.0, np.sqrt(own), out=np.ones(own.size), where=own > 0.0)
    return scale


def all_eigenvalues(given: Pencil) -> tuple[ComplexArray, ComplexArray]:
    """Every finite eigenvalue, with its eigenvector in a column, by the QZ algorithm on dense matrices."""
    from scipy.linalg import eig

    values, vectors = eig(given.by_state.toarray(), given.by_rate.toarray())
    finite = np.abs(values) < _INFINITE
    return values[finite], vectors[:, finite]


def nearest(given: Pencil, shift: complex, count: int) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues nearest to a shift, with their eigenvectors in columns, by the Arnoldi method on the shifted inverse.

    Parameters
    ----------
    given
        The pencil.
    shift
        1/s.
    count
        How many, at least.

    Raises
    ------
    ConvergenceError
        If they are not found.
    """
    from scipy.sparse.linalg import splu

    def inverse(vector: ComplexArray) -> ComplexArray:
        return np.asarray(factors.solve(np.asarray(given.by_rate @ vector)), complex)

    try:
        factors = splu((given.by_state - shift * given.by_rate).tocsc())
        for ritz in arnoldi(inverse, given.size, _BATCHES):
            found = int(np.argmin(np.append(ritz.residuals < _TOLERANCE, False)))
            if found >= min(count, given.size):
                with np.errstate(divide="ignore", invalid="ignore"):
                    return shift + 1.0 / ritz.values[:found], ritz.vectors(found)
    except RuntimeError as error:
        raise ConvergenceError(f"the modes cannot be computed: {error}. Check masses and inertias.") from error
    raise ConvergenceError(
        f"{count} vibrations near {abs(shift) / (2.0 * np.pi):.4g} Hz were not found. Reduce the number of modes."
    )


def swings(values: ComplexArray) -> BoolArray:
    """Which eigenvalues swing: those with a positive imaginary part, but for rounding."""
    return np.asarray((values.imag > _SWINGS * np.abs(values)) & (np.abs(values) > _SLOWEST))


def lightly_damped(values: ComplexArray) -> BoolArray:
    """Which eigenvalues (1/s) have a damping ratio below `LIGHT`."""
    return np.asarray(-values.real < LIGHT * np.abs(values))


def swinging(
    given: Pencil, count: int, first: float = 10.0, *, counted: Callable[[ComplexArray], BoolArray] = swings
) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues that swing, from the slowest on, with their eigenvectors in columns.

    Parameters
    ----------
    given
        The pencil.
    count
        How many of those that are counted.
    first
        Where to begin to look, rad/s.
    counted
        Which of those that swing are counted; all by default. Those between them are given, too.

    Returns
    -------
    values : ndarray, shape (k,)
        Growth rate and angular frequency above zero, 1/s; of each conjugate pair one. Fewer than `count` where the
        pencil has no more, and at most `MOST_SWINGING` or `count`, whichever is more.
    vectors : ndarray, shape (size, k)

    Raises
    ------
    ConvergenceError
        If eigenvalues are not found.
    """
    if given.size <= _SMALL:
        found, shapes = all_eigenvalues(given)
    else:
        found, shapes = _band_by_band(given, count, first, counted)
    chosen = np.flatnonzero(swings(found))
    chosen = chosen[np.argsort(found[chosen].imag)][: max(count, MOST_SWINGING)]
    enough = int(np.searchsorted(np.cumsum(counted(found[chosen])), count))
    chosen = chosen[: enough + 1]
    return found[chosen], shapes[:, chosen]


def _band_by_band(
    given: Pencil, count: int, first: float, counted: Callable[[ComplexArray], BoolArray]
) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues in neighbouring bands of frequencies, until enough of them swing and are counted."""
    values, shapes = list[ComplexArray](), list[ComplexArray]()
    low, ahead, number, every = 0.0, first, 0, 0
    for _ in range(_MOST_SHIFTS):
        found, vectors, high = _band(given, low, ahead)
        inside = (found.imag > low) & (found.imag <= high) & (np.abs(found) < _INFINITE)
        values.append(found[inside])
        shapes.append(vectors[:, inside])
        swing = swings(found[inside])
        every += int(np.count_nonzero(swing))
        number += int(np.count_nonzero(swing & counted(found[inside])))
        if number >= count or every >= max(count, MOST_SWINGING) or not np.isfinite(high):
            break
        low, ahead = high, 0.5 * (high - low)
    return np.concatenate(values), np.concatenate(shapes, axis=1)


def _band(given: Pencil, low: float, ahead: float) -> tuple[ComplexArray, ComplexArray, float]:
    """Eigenvalues around a shift above a frequency, and the frequency (rad/s) up to which they are all there."""
    count = _AT_A_TIME
    while True:
        found, vectors = nearest(given, 1j * (low + ahead), count)
        radius = float(np.max(np.abs(found - 1j * (low + ahead))))
        if radius > _INFINITE:
            return found, vectors, np.inf
        if _BAND * radius >= ahead:
            return found, vectors, low + ahead + _BAND * radius
        if count < _MOST_AT_A_TIME:
            count *= 2
        else:
            ahead *= 0.5

"""Eigenvalues of linearized equations of motion (K + s C + s^2 M) x = 0, those that swing, from the slowest on.

A motion that meets no force, such as that of a free pulley that turns, gives a double eigenvalue of zero: it may stand
anywhere, and turn on.  Its rate takes its place as the unknown, which leaves no such pair.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.errors import ConvergenceError

if TYPE_CHECKING:
    from scipy.sparse import csc_array


# Eigenvalues of largest magnitude of a linear map, by the Arnoldi method without restarts

_BATCH = 40
"""Steps after which eigenvalues are looked at."""


class Ritz(NamedTuple):
    """Eigenvalues as known after some steps, the largest first."""

    values: ComplexArray
    """Shape (steps,)."""
    residuals: FloatArray
    """Error of A v = value v for the unit vector v, over the magnitude of the value, shape (steps,)."""
    within: ComplexArray
    """Coordinates of the eigenvectors in the basis, shape (steps, steps)."""
    basis: ComplexArray
    """Orthonormal vectors in rows, shape (steps, size)."""

    def vectors(self, count: int) -> ComplexArray:
        """Eigenvectors of so many of the largest values, in columns."""
        return np.asarray(self.basis.T @ self.within[:, :count])


def arnoldi(apply: Callable[[ComplexArray], ComplexArray], size: int, most: int) -> Iterator[Ritz]:
    """Find eigenvalues of a map of vectors of shape (size,), better after each of at most `most` batches of steps."""
    most = min(most, -(-size // _BATCH))
    vector = np.random.default_rng(0).standard_normal(size).astype(complex)
    basis = np.zeros((most * _BATCH + 1, size), complex)
    basis[0] = vector / np.linalg.norm(vector)
    adjoint = np.zeros((size, most * _BATCH + 1), complex)
    adjoint[:, 0] = basis[0].conj()
    projected = np.zeros((most * _BATCH + 1, most * _BATCH), complex)
    for steps in range(1, min(most * _BATCH, size) + 1):
        vector, known = apply(basis[steps - 1]), basis[:steps]
        for _ in range(2):  # once more, since what is found already comes back by rounding
            # products of matrices of this size use threads, which wait for each other on a busy machine: 14 s for 0.2 s
            parts = np.vecdot(known, vector)
            projected[:steps, steps - 1] += parts
            vector -= np.vecdot(adjoint[:, :steps], parts)
        rest = float(np.linalg.norm(vector))
        if not np.isfinite(rest):
            return
        if steps % _BATCH == 0 or steps == size:
            values, within = np.linalg.eig(projected[:steps, :steps])
            order = np.argsort(-np.abs(values))
            values, within = values[order], within[:, order]
            with np.errstate(divide="ignore", invalid="ignore"):
                residuals = rest * np.abs(within[-1]) / np.abs(values)
            yield Ritz(values, residuals, within, known)
        projected[steps, steps - 1] = rest
        basis[steps] = vector / rest if rest > 0.0 else vector
        adjoint[:, steps] = basis[steps].conj()


_SMALL = 160
"""Order of the pencil up to which all eigenvalues are found by the QZ algorithm."""
_AT_A_TIME, _MOST_AT_A_TIME = 24, 96
"""Eigenvalues that are found around a shift, at least."""
_BATCHES, _TOLERANCE = 8, 1e-9
"""Batches of steps of the Arnoldi method, at most, and the residual of an eigenvalue that is found."""
_LEAST_BATCHES = 3
"""Batches after which the method ends with the eigenvalues that it has, if the last batch added none: near a cluster,
such as the creep of a belt that hardly moves, more steps add none either."""
_BAND = 0.5
"""Half of the band of frequencies around a shift whose lightly damped eigenvalues are known, over the radius within
which all are."""
_ROUNDING = 1e-6
"""Part by which a disk is smaller than the distance of its farthest eigenvalue, which is that of another disk then."""
_SWINGS = 0.1
"""Least imaginary part of an eigenvalue that grows and swings, over its magnitude."""
MOST_DAMPED = 0.9
"""Damping ratio from which on a mode is left out: within half a swing 0.15 % of a free motion is left."""
LIGHT = 0.5
"""Damping ratio below which a mode counts as lightly damped: at resonance a force moves one damped so by 15 % more than
the same force does if it stays, 1 / (2 z sqrt(1 - z^2)), and one damped more by less."""
_SLOWEST = 1e-6
"""Least magnitude of an eigenvalue that swings, 1/s: those below are of motions without force, and of rounding."""
_RATE = 1000.0
"""w, rad/s."""
_MAX_BANDS = 400
"""Number of bands of frequencies searched one after the other; a safeguard, after which the modes found so far are
taken."""
MOST_SWINGING = 99
"""Number of oscillating eigenvalues at which a search ends, unless more are requested."""
_INFINITE = 1e10
"""Magnitude from which on an eigenvalue is that of a constraint or of a coordinate without mass, 1/s."""


MOST_HEAVY = 12
"""Number of heavily damped modes above which they are left out, if they are more than the lightly damped ones: a belt
near standstill has a continuum of creeping motions, of which a mesh shows as many as it has elements."""
_MOST_CELLS = 200
"""Number of disks for heavily damped modes, at most."""
_LEAST_BAND = 1e-3
"""Least width of a band over its frequency."""
_SLIVER = 0.05
"""Size of a gap between disks, over their radius, that gets a disk of its own and is not divided further."""


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
        """Coordinates x, shape (n, k), of k eigenvectors z of eigenvalues s."""
        placed = self.placed.size
        found: ComplexArray = self.free @ (_RATE * vectors[2 * placed :] / values)
        found[self.placed] += vectors[:placed]
        return self.scale[:, None] * found


def pencil(stiffness: "csc_array", damping: "csc_array", mass: "csc_array", free: FloatArray) -> Pencil:
    """The pencil of first order, of order 2 n - k, of K, C, M and motions N without force, K N = 0, shape (n, k)."""
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
    """Scales of the coordinates in which their masses are one; one for coordinates without mass.

    In other units the matrices are so far from normal that residuals tell nothing: slopes and curvatures of quintic
    elements are numbers of other sizes than places.
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
    """Eigenvalues nearest to a shift, and eigenvectors in columns, by the Arnoldi method on the shifted inverse.

    Fewer than `count` where others are so close together that they cannot be told apart.
    """
    known = 0
    try:
        for batch, ritz in enumerate(arnoldi(_inverse(given, shift), given.size, _BATCHES), 1):
            before, known = known, int(np.argmin(np.append(ritz.residuals < _TOLERANCE, False)))
            stagnates = batch >= _LEAST_BATCHES and 0 < known <= before
            if known >= min(count, given.size) or stagnates:
                break
    except RuntimeError as error:
        raise ConvergenceError(f"the modes cannot be computed: {error}. Check masses and inertias.") from error
    if known == 0:
        raise ConvergenceError(
            f"no vibration near {abs(shift) / (2.0 * np.pi):.4g} Hz was found: motions there are too much alike. Give "
            "another speed, or simulate the drive with `beltdyn simulate`."
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        return shift + 1.0 / ritz.values[:known], ritz.vectors(known)


def _inverse(given: Pencil, shift: complex) -> Callable[[ComplexArray], ComplexArray]:
    """(A - s B)^-1 B on vectors: rates follow from coordinates, so a matrix of half the order is factorized."""
    from scipy.sparse import hstack
    from scipy.sparse.linalg import splu

    placed = given.placed.size
    forces = (given.by_state - shift * given.by_rate).tocsc()[placed:]
    by_place, by_rate, by_free = forces[:, :placed], forces[:, placed : 2 * placed] / _RATE, forces[:, 2 * placed :]
    factors = splu(hstack([by_place + shift * by_rate, by_free], format="csc"))

    def inverse(vector: ComplexArray) -> ComplexArray:
        right = np.asarray(given.by_rate @ vector, complex)
        found = factors.solve(right[placed:] - by_rate @ right[:placed])
        return np.concatenate([found[:placed], (right[:placed] + shift * found[:placed]) / _RATE, found[placed:]])

    return inverse


def swings(values: ComplexArray) -> BoolArray:
    """Which eigenvalues (1/s) swing: of each conjugate pair one, with a damping ratio below `MOST_DAMPED`."""
    size = np.abs(values)
    return np.asarray((-values.real < MOST_DAMPED * size) & (values.imag > _SWINGS * size) & (size > _SLOWEST))


def lightly_damped(values: ComplexArray) -> BoolArray:
    """Which eigenvalues (1/s) have a damping ratio below `LIGHT`."""
    return np.asarray(-values.real < LIGHT * np.abs(values))


def swinging(
    given: Pencil, count: int, first: float = 10.0, *, counted: Callable[[ComplexArray], BoolArray] = swings
) -> tuple[ComplexArray, ComplexArray]:
    """Oscillating eigenvalues from the slowest on, in columns their eigenvectors, of each conjugate pair one.

    At least `count` of those `counted`, if the pencil has as many, with those between them; `MOST_SWINGING` or `count`
    at most, whichever is more. Heavily damped ones are left out where they are a continuum; see `MOST_HEAVY`. The
    search starts at `first` (rad/s).
    """
    if given.size <= _SMALL:
        values, vectors = all_eigenvalues(given)
    else:
        values, vectors = _band_by_band(given, count, first)
    chosen = np.flatnonzero(swings(values))
    chosen = chosen[np.argsort(values[chosen].imag)]
    light = chosen[lightly_damped(values[chosen])]
    last = light[min(count, light.size) - 1] if light.size else chosen[-1] if chosen.size else 0
    below = chosen[: int(np.flatnonzero(chosen == last)[0]) + 1] if chosen.size else chosen
    if _is_continuum(values[below]):
        chosen = light
    chosen = chosen[: max(count, MOST_SWINGING)]
    enough = int(np.searchsorted(np.cumsum(counted(values[chosen])), count))
    chosen = chosen[: enough + 1]
    return values[chosen], vectors[:, chosen]


_FASTEST = 1.0
"""Largest growth rate that is looked for, over the largest angular frequency."""


def growing_swings(given: Pencil, highest: float) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues that grow and swing up to an angular frequency (rad/s), the fastest first; in columns their vectors.

    They grow by at most `highest`.
    """
    if given.size <= _SMALL:
        values, vectors = all_eigenvalues(given)
    else:
        known = _Known(given)
        known.cover(_Cell(0j, complex(_FASTEST * highest, highest)))
        values, vectors = known.values, known.vectors
    chosen = np.flatnonzero((values.real > 0.0) & (values.imag <= highest) & swings(values))
    chosen = chosen[np.argsort(-values[chosen].real)]
    return values[chosen], vectors[:, chosen]


def _is_continuum(values: ComplexArray) -> bool:
    """Whether heavily damped ones of eigenvalues that swing are too many to be modes."""
    light = int(np.count_nonzero(lightly_damped(values)))
    return values.size - light > max(light, MOST_HEAVY)


class _Disk(NamedTuple):
    """A region of the complex plane whose eigenvalues are all known."""

    center: complex
    radius: float

    def holds(self, values: ComplexArray) -> BoolArray:
        """Whether values lie in it."""
        return np.asarray(np.abs(values - self.center) < self.radius)


class _Cell(NamedTuple):
    """A rectangle of the complex plane whose eigenvalues are looked for, by its corners."""

    low: complex
    high: complex

    @property
    def center(self) -> complex:
        return 0.5 * (self.low + self.high)

    def may_hold(self, damped: float) -> bool:
        """Whether a mode in it may have less than a damping ratio: its upper right corner is the least damped."""
        return -self.high.real < damped * abs(self.high)

    def within(self, disk: _Disk) -> bool:
        """Whether all of it lies in a disk."""
        corners = np.array(
            [self.low, self.high, complex(self.low.real, self.high.imag), complex(self.high.real, self.low.imag)]
        )
        return bool(np.all(disk.holds(corners)))

    def quarters(self) -> "list[_Cell]":
        """The four parts of it."""
        step = 0.5 * (self.high - self.low)
        return [
            _Cell(low, low + step)
            for low in (self.low + complex(x * step.real, y * step.imag) for x in (0, 1) for y in (0, 1))
        ]


class _Known:
    """Eigenvalues of disks that overlap, each but once; `is_full` once the last search for all modes has ended."""

    def __init__(self, given: Pencil) -> None:
        self._given, self.disks = given, list[_Disk]()
        self.is_full = False
        self._values, self._vectors = list[ComplexArray](), list[ComplexArray]()

    @property
    def values(self) -> ComplexArray:
        """Eigenvalues, 1/s."""
        return np.concatenate(self._values)

    @property
    def vectors(self) -> ComplexArray:
        """Their eigenvectors in columns."""
        return np.concatenate(self._vectors, axis=1)

    def look(self, shift: complex, count: int) -> tuple[_Disk, bool]:
        """The disk around a shift that holds the eigenvalues nearest to it, and whether these are as many as asked."""
        found, vectors = nearest(self._given, shift, count)
        disk = _Disk(shift, (1.0 - _ROUNDING) * float(np.max(np.abs(found - shift))))
        new = disk.holds(found) & (np.abs(found) < _INFINITE)
        for other in self.disks:
            new &= ~other.holds(found)
        self.disks.append(disk)
        self._values.append(found[new])
        self._vectors.append(vectors[:, new])
        return disk, found.size >= min(count, self._given.size)

    def fill(self, high: float, damped: float, goes_on: Callable[[], bool] = lambda: True) -> None:
        """Look for all modes up to a frequency (rad/s), of less than a damping ratio, as long as that goes on."""
        widest = high * damped / sqrt(1.0 - damped**2)
        self.cover(_Cell(complex(-widest, 0.0), complex(0.0, high)), lambda cell: cell.may_hold(damped), goes_on)

    def cover(
        self,
        whole: _Cell,
        wanted: Callable[[_Cell], bool] = lambda _: True,
        goes_on: Callable[[], bool] = lambda: True,
    ) -> None:
        """Look for all eigenvalues in a rectangle, in those parts of it that are wanted, as long as that goes on."""
        cells, self.is_full = [whole], False
        while cells and goes_on():
            cell = cells.pop()
            if not wanted(cell) or any(cell.within(disk) for disk in self.disks):
                continue
            around = [disk.radius for disk in self.disks if disk.holds(np.array([cell.center]))[0]]
            if not around or abs(cell.high - cell.low) < _SLIVER * max(around):
                self.look(cell.center, _AT_A_TIME)
            if not any(cell.within(disk) for disk in self.disks):
                cells += cell.quarters()
        self.is_full = not cells


def _band_by_band(given: Pencil, count: int, first: float) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues in neighboring bands of frequencies, until enough of them are lightly damped.

    Disks along the imaginary axis leave out what is damped much between them: the rest of the wedge of modes below the
    last band is filled up, so that which of them are listed depends neither on shifts nor on the Arnoldi method. Where
    the heavily damped ones are a continuum, that is given up.
    """
    known, low, ahead = _Known(given), 0.0, first
    for _ in range(_MAX_BANDS):
        high = _band(known, low, ahead)
        if not np.isfinite(high):
            return known.values, known.vectors
        light = known.values[(known.values.imag <= high) & swings(known.values) & lightly_damped(known.values)]
        if light.size >= max(count, 1):
            break
        low, ahead = high, 0.5 * (high - low)
    known.fill(high, LIGHT)
    most = len(known.disks) + _MOST_CELLS

    def goes_on() -> bool:
        modes = known.values[(known.values.imag <= high) & swings(known.values)]
        return len(known.disks) < most and not _is_continuum(modes)

    with suppress(ConvergenceError):  # of heavily damped modes that are too much alike
        known.fill(high, MOST_DAMPED, goes_on)
    values = known.values
    kept = values.imag <= high
    if not (known.is_full and goes_on()):
        kept &= lightly_damped(values)
    return values[kept], known.vectors[:, kept]


def _band(known: _Known, low: float, ahead: float) -> float:
    """Look around a shift above a frequency; up to which frequency (rad/s) the imaginary axis is known then."""
    count = _AT_A_TIME
    while ahead > _LEAST_BAND * low:
        disk, full = known.look(1j * (low + ahead), count)
        if disk.radius > _INFINITE:
            return np.inf
        if _BAND * disk.radius >= ahead:
            return low + ahead + _BAND * disk.radius
        if full and count < _MOST_AT_A_TIME:
            count *= 2
        else:
            ahead *= 0.5
    raise ConvergenceError(
        f"vibrations near {low / (2.0 * np.pi):.4g} Hz are too much alike to be told apart. Reduce the number of "
        "modes, or give another speed."
    )

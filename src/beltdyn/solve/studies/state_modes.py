"""Modes of a state, and of states nearby, in which each is followed by its shape.

With right and left eigenvectors X and Y of m eigenvalues that are alike, s on an average, and with L(s) = K + s C +
s^2 M, those of matrices nearby are on an average

    s - tr((Y* L'(s) X)^-1 Y* (L_near(s) - L(s)) X) / m,

the first step of Newton's method for them.  Its derivative is that of the implicit function theorem (Lancaster 1964).
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.solve.vibration.mode_shapes import belt_points, shares_of
from beltdyn.solve.vibration.mode_table import FIRST_STUCK, eigenmodes
from beltdyn.solve.vibration.small_motions import SmallMotions, dry_tensioners

if TYPE_CHECKING:
    from scipy.sparse import csc_array

_ALIKE = 1e-5
"""Distance of eigenvalues, over their magnitude, up to which they count as one: their shapes mix freely."""
_BESIDE = 1e-7
"""Distance of the shift of inverse iterations from the eigenvalue, over it."""
_ITERATIONS = 3


class Mode(NamedTuple):
    """A mode of a drive."""

    number: int
    """As in the results of `modes`."""
    value: complex
    """Growth rate and angular frequency, 1/s."""
    kind: str
    span_share: FloatArray
    """Of its kinetic energy, shape (P,)."""
    alike: int
    """Modes of the same eigenvalue, itself among them."""
    among: int
    """How many modes were looked for when it was found."""

    @property
    def frequency(self) -> float:
        """Hz."""
        return self.value.imag / (2.0 * np.pi)

    @property
    def damping_ratio(self) -> float:
        """-Re s / |s|."""
        return -self.value.real / abs(self.value)


class StateModes(Protocol):
    """Modes of a state."""

    def first(self, count: int) -> list[Mode]:
        """The lowest modes, at most so many, with sliding tensioners; then those with stuck ones, if any stick.

        Parameters
        ----------
        count
            How many.
        """

    def like(self, mode: Mode) -> Mode:
        """The mode of this state which is like one of the state from which modes are followed.

        Parameters
        ----------
        mode
            One of the modes found there.
        """


class FoundModes:
    """Modes of small motions about a state.

    Parameters
    ----------
    motions
        The drive about the state.
    """

    def __init__(self, motions: SmallMotions) -> None:
        self._dry = dry_tensioners(motions.drive)
        self._motions = self.variants(motions)
        self._known = dict[int, list[_Lowest]]()

    def variants(self, motions: SmallMotions) -> list[SmallMotions]:
        """Small motions with sliding tensioners, and with stuck ones if dry friction may hold some.

        Parameters
        ----------
        motions
            About this state, or about one nearby.
        """
        return [motions, motions.with_stuck(self._dry)] if self._dry.size else [motions]

    def first(self, count: int) -> list[Mode]:
        """The lowest modes; see `StateModes`."""
        return [mode for lowest in self.lowest(count) for mode in lowest.modes]

    def like(self, mode: Mode) -> Mode:
        """The mode itself."""
        return mode

    def lowest(self, count: int) -> "list[_Lowest]":
        """The lowest modes of each of the variants, with their eigenvectors.

        Parameters
        ----------
        count
            How many, at most.
        """
        if count not in self._known:
            self._known[count] = [
                _Lowest(motions, count, first) for first, motions in zip((1, FIRST_STUCK), self._motions, strict=False)
            ]
        return self._known[count]


class FollowedModes:
    """Modes about a state nearby, in the order of those of the state from which they are followed.

    Parameters
    ----------
    base
        Modes of that state.
    motions
        The drive about the state nearby, on the same mesh.
    """

    def __init__(self, base: FoundModes, motions: SmallMotions) -> None:
        self._base, self._motions = base, base.variants(motions)

    def first(self, count: int) -> list[Mode]:
        """The same modes as the lowest ones of the other state; see `StateModes`."""
        return [self.like(mode) for mode in self._base.first(count)]

    def like(self, mode: Mode) -> Mode:
        """The mode of this state which is like one of the other; see `StateModes`."""
        variant, first = (1, FIRST_STUCK) if mode.number >= FIRST_STUCK else (0, 1)
        value = self._base.lowest(mode.among)[variant].near(mode.number - first, self._motions[variant])
        return mode._replace(value=value)


class _Group(NamedTuple):
    """Eigenvalues that are alike, m of them."""

    members: Sequence[int]
    value: complex
    right: ComplexArray
    """Shape (n, m)."""
    left: ComplexArray
    here: ComplexArray
    """Y* L(s) X, shape (m, m), nearly zero."""
    slope: ComplexArray
    """Y* L'(s) X, shape (m, m)."""


class _Lowest:
    """The lowest modes about a state, and what follows them."""

    def __init__(self, motions: SmallMotions, count: int, first: int) -> None:
        self._motions = motions
        self._values, self._vectors = eigenmodes(motions, count)
        shares = shares_of(motions, belt_points(motions), self._values, self._vectors)
        each = [shares.of(number) for number in range(self._values.size)]
        alike = _alike(self._values)
        self._members = {number: members for members in alike for number in members}
        self._groups = dict[int, _Group]()
        self.modes = [
            Mode(first + number, complex(value), one.kind, one.span, len(self._members[number]), count)
            for number, (value, one) in enumerate(zip(self._values, each, strict=True))
        ]

    def near(self, number: int, motions: SmallMotions) -> complex:
        """An eigenvalue of a state nearby, 1/s; those that are alike change by their mean.

        Parameters
        ----------
        number
            Counted from zero.
        motions
            About that state.
        """
        group = self._group(self._members[number])
        ahead = _between(group.left, motions, group.value, group.right)
        change = np.trace(np.linalg.solve(group.slope, ahead - group.here)) / len(group.members)
        return complex(self._values[number] - change)

    def _group(self, members: Sequence[int]) -> _Group:
        if members[0] not in self._groups:
            value, right = complex(np.mean(self._values[members])), self._vectors[:, members]
            left = _left_eigenvectors(_dynamic_stiffness(self._motions, value * (1.0 + _BESIDE)), len(members))
            here = _between(left, self._motions, value, right)
            slope = left.conj().T @ (self._motions.damping @ right + 2.0 * value * (self._motions.mass @ right))
            self._groups[members[0]] = _Group(members, value, right, left, here, np.asarray(slope, complex))
        return self._groups[members[0]]


def _alike(values: ComplexArray) -> list[list[int]]:
    """Numbers of eigenvalues, in groups of those that are alike."""
    groups = list[list[int]]()
    for number, value in enumerate(values):
        near = next((one for one in groups if abs(values[one[-1]] - value) <= _ALIKE * abs(value)), None)
        if near is None:
            groups.append([number])
        else:
            near.append(number)
    return groups


def _dynamic_stiffness(motions: SmallMotions, value: complex) -> "csc_array":
    """K + s C + s^2 M."""
    found: csc_array = motions.stiffness + value * motions.damping + value**2 * motions.mass
    return found


def _between(left: ComplexArray, motions: SmallMotions, value: complex, right: ComplexArray) -> ComplexArray:
    """Y* L(s) X, without making L(s)."""
    met = motions.stiffness @ right + value * (motions.damping @ right) + value**2 * (motions.mass @ right)
    return np.asarray(left.conj().T @ met, complex)


def _left_eigenvectors(matrix: "csc_array", count: int) -> ComplexArray:
    """Vectors y with y* L = 0, but for a small shift, by inverse iteration; shape (n, count)."""
    from scipy.sparse.linalg import splu

    factors: Any = splu(matrix)
    found: ComplexArray = np.random.default_rng(0).standard_normal((matrix.shape[0], count)).astype(complex)
    for _ in range(_ITERATIONS):
        found = np.linalg.qr(factors.solve(found, trans="H"))[0]
    return found

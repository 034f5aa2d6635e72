"""A drive in steady running, or at rest, and its results by name, modes among them."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.designs.named_results import MODES, OF_MODES, name_of, values_of, variable_and_label
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.points.operating_points import computed_with, labels_of
from beltdyn.results import Run
from beltdyn.state.installation import Rest, looked_at, on_equal_elements, rest_like, rest_of
from beltdyn.state.linearized import SmallMotions
from beltdyn.state.newton import SteadyWork
from beltdyn.state.staying import Standing, bring_to_stand, stand_like
from beltdyn.state.steady import Beside, require_found, steady_beside, tangent_of
from beltdyn.vibration.mode_shapes import belt_points, shares_of
from beltdyn.vibration.modes import FIRST_STUCK, eigenmodes
from beltdyn.vibration.small_motions import about_standing, about_steady, dry_tensioners

if TYPE_CHECKING:
    from scipy.sparse import csc_array


# Modes of a state, and of states nearby, in which each is followed by its shape

_ALIKE = 1e-5
"""Distance of eigenvalues, over their magnitude, up to which they count as one: their shapes mix freely."""
_SHIFT_DISTANCE = 1e-7
"""Distance of the shift of inverse iterations from the eigenvalue, over it."""
_INVERSE_ITERATIONS = 3
"""Inverse iterations for left eigenvectors: each reduces other modes a hundredfold or more, by the ratio of
`_SHIFT_DISTANCE` to their distance, which exceeds `_ALIKE`."""


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
        """The lowest modes, at most so many, with sliding tensioners; then those with stuck ones, if any stick."""

    def like(self, mode: Mode) -> Mode:
        """The mode of this state which is like one of the state from which modes are followed."""


class FoundModes:
    """Modes of small motions about a state."""

    def __init__(self, motions: SmallMotions) -> None:
        self._dry = dry_tensioners(motions.prepared)
        self._motions = self.variants(motions)
        self._known = dict[int, list[_Lowest]]()

    def variants(self, motions: SmallMotions) -> list[SmallMotions]:
        """Small motions with sliding tensioners, and with stuck ones if dry friction may hold some."""
        return [motions, motions.with_stuck(self._dry)] if self._dry.size else [motions]

    def first(self, count: int) -> list[Mode]:
        """The lowest modes; see `StateModes`."""
        return [mode for lowest in self.lowest(count) for mode in lowest.modes]

    def like(self, mode: Mode) -> Mode:
        """The mode itself."""
        return mode

    def lowest(self, count: int) -> "list[_Lowest]":
        """The lowest modes of each of the variants, with their eigenvectors."""
        if count not in self._known:
            self._known[count] = [
                _Lowest(motions, count, first) for first, motions in zip((1, FIRST_STUCK), self._motions, strict=False)
            ]
        return self._known[count]


class FollowedModes:
    """Modes about a nearby state on the same mesh, in the order of those of the base state."""

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
        """An eigenvalue of a state nearby, 1/s; those that are alike change by their mean."""
        group = self._group(self._members[number])
        ahead = _between(group.left, motions, group.value, group.right)
        change = np.trace(np.linalg.solve(group.slope, ahead - group.here)) / len(group.members)
        return complex(self._values[number] - change)

    def _group(self, members: Sequence[int]) -> _Group:
        if members[0] not in self._groups:
            value, right = complex(np.mean(self._values[members])), self._vectors[:, members]
            left = _left_eigenvectors(_dynamic_stiffness(self._motions, value * (1.0 + _SHIFT_DISTANCE)), len(members))
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
    for _ in range(_INVERSE_ITERATIONS):
        found = np.linalg.qr(factors.solve(found, trans="H"))[0]
    return found


CHANGE = 1e-5
"""Relative change of a number for derivatives on a mesh that follows arcs."""
_CHANGE_OF_EQUAL_ELEMENTS = 1e-2
"""The same where contact points come and go: with 1e-5 the largest tension of a band brake has twice its derivative."""
_MAX_MODES = 200
"""Number of modes from which on no more are searched: higher frequencies are not covered, and a span that swings most
in none of these has no mode."""
_SPAN_SHARE = 0.4
"""Share of a span in the kinetic energy of a mode with which it swings most; of two spans alike each has half."""


class FoundState(ABC):
    """A drive in a steady state, whose modes are followed from those of `near` if it is a neighbor of that."""

    def __init__(self, near: "FoundState | None") -> None:
        self._near = near

    @property
    @abstractmethod
    def drive(self) -> Drive:
        """The drive."""

    @abstractmethod
    def values(self, variable: str) -> Mapping[str, float]:
        """Its scalar results by name, at least those of a variable, but for those of modes."""

    @property
    @abstractmethod
    def motions(self) -> SmallMotions:
        """Small motions about it."""

    @property
    def has_modes(self) -> bool:
        """Whether modes are found about it; their results have no value otherwise."""
        return True

    @property
    def change(self) -> float:
        """Relative change of a number with which derivatives are taken."""
        return CHANGE

    @abstractmethod
    def neighbour(self, drive: Drive) -> "FoundState":
        """The state of a drive that differs a little, on the same mesh."""

    def value(self, name: str) -> float:
        """A result by its name; NaN where there is no such value."""
        variable, label = variable_and_label(name)
        if variable not in OF_MODES:
            return float(self.values(variable).get(name, np.nan))
        mode = self._mode_of(variable, label)
        if mode is None:
            return np.nan
        return mode.frequency if variable.endswith("frequency") else mode.damping_ratio

    def shared_modes(self, names: Sequence[str]) -> list[str]:
        """Names of results of modes that share their eigenvalue with others, so that their derivatives are means."""
        found = list[str]()
        for name in names:
            variable, label = variable_and_label(name)
            mode = self._mode_of(variable, label) if variable in OF_MODES else None
            if mode is not None and mode.alike > 1:
                found.append(name)
        return found

    def modes_up_to(self, frequency: float) -> tuple[FloatArray, list[str]]:
        """Frequencies (Hz) and kinds of its modes, at least up to a frequency if there are so many."""
        count = MODES
        while True:
            found = self._first(count)
            if max(mode.frequency for mode in found) > frequency or len(found) < count or count >= _MAX_MODES:
                return np.array([mode.frequency for mode in found]), [mode.kind for mode in found]
            count *= 2

    def _mode_of(self, variable: str, label: str) -> Mode | None:
        """The mode of a variable of `OF_MODES`; if followed from a neighbor, the mode of the neighbor."""
        if not self.has_modes:
            return None
        near = self._near if isinstance(self._modes, FollowedModes) else None
        chosen = (near or self)._chosen_mode(variable, label)
        return None if chosen is None else self._modes.like(chosen)

    def _chosen_mode(self, variable: str, label: str) -> Mode | None:
        if OF_MODES[variable].dims == ("span",):
            return self._mode_of_span(label)
        number = int(label)
        return next((mode for mode in self._first(MODES) if mode.number == number), None)

    def _mode_of_span(self, span: str) -> Mode | None:
        """The lowest mode in which a span swings most."""
        place, count = labels_of(self.drive)["span"].index(span), MODES
        while True:
            found = self._first(count)
            swings = [mode for mode in found if mode.span_share[place] >= _SPAN_SHARE]
            if swings:
                return min(swings, key=lambda mode: mode.frequency)
            if len(found) < count or count >= _MAX_MODES:
                return None
            count *= 2

    def _first(self, count: int) -> list[Mode]:
        return self._modes.first(count)

    @cached_property
    def _modes(self) -> StateModes:
        base = None if self._near is None else self._near._modes
        return FollowedModes(base, self.motions) if isinstance(base, FoundModes) else FoundModes(self.motions)


class Running(FoundState):
    """A drive in steady running.

    Parameters
    ----------
    run
        From `steady_state`.
    near
        As for `FoundState`.
    bands
        Whether its neighbors are to have the bands in which dry friction holds tensioners, as for `steady_from`.
    """

    def __init__(self, run: Run, near: FoundState | None = None, *, bands: bool = False) -> None:
        super().__init__(near)
        self.run, self._bands, self._values = run, bands, dict[Collection[str], Mapping[str, float]]()

    @property
    def drive(self) -> Drive:
        """The drive."""
        return self.run.drive

    def values(self, variable: str) -> Mapping[str, float]:
        """Its scalar results, each group of variables as soon as it is asked for; see `FoundState`."""
        group = frozenset(computed_with(variable))
        if group not in self._values:
            self._values[group] = values_of(self.run, group)
        return self._values[group]

    @cached_property
    def motions(self) -> SmallMotions:
        """Small motions about it."""
        return about_steady(self.run)

    def neighbour(self, drive: Drive) -> FoundState:
        """The steady running of a drive that differs a little, on the same mesh."""
        return self.of(self.beside(drive), self)

    def beside(self, drive: Drive) -> Beside:
        """What `neighbour` finds, by the tangent of this state."""
        return require_found(steady_beside(drive, self.run, tangent=self._tangent))

    @cached_property
    def _tangent(self) -> SteadyWork:
        return tangent_of(self.run)

    def of(self, found: Beside, near: FoundState | None) -> "Running":
        """Another state that was found on the same mesh; parameters as for this one."""
        return Running(found.run(bands=self._bands), near, bands=self._bands)


AtRest = Standing | Rest
"""A drive at rest: on a staying mesh, or an open belt on equal elements."""


def bring_at_rest(prepared: Prepared) -> AtRest:
    """Find the equilibrium of a drive at rest, with the installed tension that was asked for if one was."""
    if prepared.ends and not prepared.drive.is_web:
        return rest_of(prepare(on_equal_elements(prepared.drive)))
    return bring_to_stand(prepared)


def rest_near(prepared: Prepared, near: AtRest) -> AtRest:
    """Find the equilibrium of a drive that differs a little from another one, on the same mesh."""
    return stand_like(prepared, near) if isinstance(near, Standing) else rest_like(prepared.drive, near)


class Resting(FoundState):
    """A drive at rest, with a belt that slid into its place."""

    def __init__(self, rest: AtRest, near: FoundState | None = None) -> None:
        super().__init__(near)
        self.rest = rest

    @property
    def has_modes(self) -> bool:
        """Whether it is on a staying mesh, about which modes are found."""
        return isinstance(self.rest, Standing)

    @property
    def change(self) -> float:
        """See `FoundState`; larger on equal elements."""
        return CHANGE if isinstance(self.rest, Standing) else _CHANGE_OF_EQUAL_ELEMENTS

    @property
    def drive(self) -> Drive:
        """The drive."""
        return self.rest.drive

    def values(self, variable: str) -> Mapping[str, float]:
        """Its belt's length, tensions, hub loads, wrap angles and tensioners by name."""
        return self._values

    @cached_property
    def _values(self) -> Mapping[str, float]:
        rest, labels = self.rest, labels_of(self.rest.drive)
        there = looked_at(rest.prepared, rest.system, rest.state).installation
        found = {
            "span_tension": ("span", there.span_tensions),
            "hub_load": ("pulley", np.linalg.norm(there.hub_loads, axis=1)),
            "wrap_angle": ("pulley", there.path.wrap_angles),
            "tensioner_position": ("tensioner", there.tensioner_positions),
        }
        named = {
            name_of(name, label): float(value)
            for name, (of, values) in found.items()
            for label, value in zip(labels[of], values, strict=True)
        }
        whole = {
            "belt_length": rest.prepared.belt_length,
            "tension": rest.tension,
            "largest_tension": float(there.end_tensions.max()),
        }
        return named | whole

    @cached_property
    def motions(self) -> SmallMotions:
        """Small motions about it, with a belt that sticks to its pulleys."""
        assert isinstance(self.rest, Standing)
        return about_standing(self.rest)

    def neighbour(self, drive: Drive) -> FoundState:
        """The rest of a drive that differs a little, on the same mesh."""
        return Resting(rest_near(prepare(drive), self.rest), self)

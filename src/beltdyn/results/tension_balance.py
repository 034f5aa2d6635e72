"""The balance that holds the tensions of a belt: its unstretched length, and its tensioners.

Pulleys at fixed centers keep the belt's unstretched length on its path: spans at T_i, arcs at the tension with which
the belt reaches them up to where it slides, and penetration. A tensioner moves until spring and stops balance the
belt; an end of an open belt that is pulled keeps its tension. All are taken as changes of a state that is known: what
else holds a tensioner there, as weight and dry friction, goes on holding it.
"""

import math
from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.machines.tensioners.tensioner import MovingTensioner
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, span_points, wrap_angles
from beltdyn.results.cycles import Window, plain_window
from beltdyn.results.mechanics import UNLOADED, across
from beltdyn.results.schema import Recorded

LOSSES: Mapping[str, str] = {
    "friction_loss": "friction",
    "damping_loss": "contact damping",
    "stretch_loss": "belt stretch",
    "bending_loss": "belt bending",
    "compression_loss": "belt compression",
    "tensioner_loss": "tensioners",
    "coupling_loss": "couplings",
    "carrying_loss": "supports and goods",
    "numerical_loss": "time integration",
}
"""Recorded works of the losses, and their causes in words."""

OF_TEETH = "teeth and compression"
"""Cause in words of `compression_loss` of belts with teeth: what these lose, store, and leave as they enter and leave
under load, which may be negative."""

_OF_GROOVES = "tooth_phases"
"""Attribute of the results of belts with teeth."""

WEB_LINE = "web_line"
"""Attribute of the results of web lines, whose works of loads include those of both ends."""

_BEFORE = {"material_loss": "belt material"}
"""The combined loss of stretch and bending in files of earlier formats."""

STORED = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")
"""Recorded energies that the drive holds."""


@dataclass(frozen=True, slots=True)
class Balance:
    """Mean powers over a part of a run, W.

    Examples
    --------
    >>> balance = bd.derived.balance(run)
    >>> sorted(balance.losses)[:3]
    ['belt bending', 'belt compression', 'belt stretch']
    """

    pulleys: tuple[float, ...]
    """Power into the drive at each shaft, positive for a driving shaft."""
    losses: Mapping[str, float]
    """Power lost, by cause, such as "friction"."""
    stored: float
    """Rate of change of the stored energy: kinetic, strain, contact, spring and potential energy."""
    web: float = 0.0
    """Power that comes in with the web of a line, less that which goes out with it."""

    @property
    def power_in(self) -> float:
        """Power input of the driving shafts, and of a web that brings more than it takes along."""
        return sum(power for power in (*self.pulleys, self.web) if power > 0.0)

    @property
    def power_out(self) -> float:
        """Power output to the loads, and to a web that takes more along than it brings."""
        return -sum(power for power in (*self.pulleys, self.web) if power < 0.0)

    @property
    def efficiency(self) -> float:
        """Power output over the sum of power output and losses; NaN without power input, or power output (a conveyor).

        In steady running this is power output over power input; stored and returned energy is not counted.
        """
        delivers = self.power_in > 0.0 and self.power_out > 0.0
        return self.power_out / (self.power_out + self.lost) if delivers else math.nan

    @property
    def lost(self) -> float:
        """Sum of the losses."""
        return sum(self.losses.values())


def losses_of(recorded: Recorded) -> Mapping[str, str]:
    """Give the recorded works of the losses, and their causes in words."""
    causes = causes_of(toothed=_OF_GROOVES in recorded.attrs)
    return {name: cause for name, cause in causes.items() if name in recorded} | (
        {} if "bending_loss" in recorded else _BEFORE
    )


def causes_of(*, toothed: bool) -> Mapping[str, str]:
    """Works of the losses and their causes in words, of belts with or without teeth."""
    return {**LOSSES, "compression_loss": OF_TEETH} if toothed else LOSSES


def power_balance(recorded: Recorded, window: Window | None = None) -> Balance:
    """Give mean powers over a window.

    Shaft powers are means over outputs; losses and stored power are differences of recorded integrals. With a single
    output all rates are zero.

    Parameters
    ----------
    recorded : Recorded
        The results.
    window : Window, optional
        The averaging window; by default from the first to the last output.

    Returns
    -------
    Balance
        The mean powers.

    Examples
    --------
    >>> with run.recorded() as recorded:
    ...     balance = bd.results.power_balance(recorded)
    >>> sorted(balance.losses)[:2]
    ['belt bending', 'belt compression']
    """
    window = plain_window(np.asarray(recorded["time"])) if window is None else window
    pulleys = tuple(map(float, window.product(recorded, "shaft_torque", "shaft_speed")))
    put_in = sum(float(window.rate(recorded, name)) for name in ("driver_work", "torque_work"))
    return Balance(
        pulleys=pulleys,
        losses={cause: float(window.rate(recorded, name)) for name, cause in losses_of(recorded).items()},
        stored=sum(float(window.rate(recorded, name)) for name in STORED),
        web=put_in - sum(pulleys) if WEB_LINE in recorded.attrs else 0.0,
    )


# Largest energy balance error and numerical loss of a run


class Closure(NamedTuple):
    """Largest energy balance error of a run."""

    time: float
    """When, s."""
    error: float
    """Closure error at that time, over the energy put in by then."""


def largest_closure(recorded: Recorded) -> Closure:
    """Largest energy balance error over time."""
    return _largest(recorded, np.asarray(recorded["energy_closure"]))


def largest_numerical_share(recorded: Recorded) -> Closure:
    """Largest share of the energy input lost in time integration."""
    taken, given = np.asarray(recorded["numerical_loss"]), energy_put_in(recorded)
    shares = np.divide(taken, given, out=np.zeros_like(given), where=given > 0.0)
    return _largest(recorded, shares)


def _largest(recorded: Recorded, shares: FloatArray) -> Closure:
    """The share of largest magnitude, and its instant."""
    worst = int(np.argmax(np.abs(shares)))
    return Closure(float(recorded["time"][worst]), float(shares[worst]))


def energy_put_in(recorded: Recorded) -> FloatArray:
    """Energy put in up to each output, J: the energy stored at first, and the largest works of each kind by then.

    Works of drivers and torques, and of springs and weight, count either way.
    """

    def values(name: str) -> FloatArray:
        return np.asarray(recorded[name], dtype=np.float64)

    stored = sum(float(values(name)[0]) for name in ("kinetic_energy", "strain_energy", "penalty_energy"))
    kinds = ("driver_work", "torque_work", "spring_energy", "potential_energy")
    done = np.abs(np.stack([values(name) - values(name)[0] for name in kinds]))
    return np.asarray(stored + np.maximum.accumulate(done, axis=1).sum(axis=0))


_MOST_ITERATIONS = 25
_CONVERGED = 1e-9
"""Step of Newton's method, over the scale of each unknown."""
_DIFFERENCE = 1e-6
"""Step of difference quotients, over the scale of each unknown."""
_PRESSED = 0.1
"""Least tension above that at which the belt lifts off: of a guess over the mean tension, of a step over the last."""
_LONGEST = 0.2
"""Step of Newton's method for the place of a tensioner, over the way on which it moves by the smallest radius."""


Condition = Callable[[FloatArray, FloatArray], FloatArray]
"""What sets the factor on the loads: zero, shape (n,), of tensions that press (n, spans) and of s (n, pulleys)."""


class States(NamedTuple):
    """States in balance, a row for each."""

    tension: FloatArray
    """Of spans, N, shape (n, spans)."""
    positions: FloatArray
    """Of tensioners, m or rad, shape (n, K)."""
    centers: FloatArray
    """Of pulleys, m, shape (n, pulleys, 2)."""
    wrap: FloatArray
    """rad, shape (n, pulleys)."""


class _Geometry(NamedTuple):
    """The path with tensioners at some places, a row for each state."""

    centers: FloatArray
    """Of pulleys, m, shape (n, pulleys, 2)."""
    directions: FloatArray
    """Unit vectors along spans, shape (n, spans, 2)."""
    lengths: FloatArray
    """Of spans, m."""
    wrap: FloatArray
    """rad, shape (n, pulleys)."""
    slopes: FloatArray
    """Derivatives of the centers of carried pulleys with respect to the places of their tensioners, shape (n, K, 2)."""


class TensionBalance:
    """The balance that determines the tension of a belt, as a change of n known states.

    Unknowns are the mean tension and the displacements of tensioners. Span tensions and speeds have shape (n, spans);
    frictions, shape (n, pulleys), replace those of the drive.
    """

    def __init__(
        self,
        prepared: Prepared,
        tension: FloatArray,
        speed: FloatArray,
        centers: FloatArray,
        frictions: FloatArray | None = None,
    ) -> None:
        self._prepared, self._centers = prepared, centers
        self._frictions = np.tile(prepared.frictions, (len(tension), 1)) if frictions is None else frictions
        self.mean = tension.mean(axis=1)
        self.differences = tension - self.mean[:, None]
        self._lifted = prepared.belt.mass_per_length * speed**2
        self._backward = speed.mean(axis=1) < 0.0
        self._carriers = prepared.carriers
        self._pulled = _pulled_span(prepared)
        smallest = float(np.min(prepared.radii))
        reaches = [float(np.linalg.norm(one.place(0.0)[1])) for one in self._carriers]
        self.scales = np.array(
            [max(float(np.nanmax(np.abs(tension), initial=0.0)), 1e-9), *(smallest / one for one in reaches)]
        )
        self._places = _places(prepared, centers)
        self._along = [one.place(0.0) for one in self._carriers]
        self._held = np.zeros((len(tension), self.scales.size))
        rows, still = np.arange(len(tension)), self.start
        self._held = self.residual(rows, np.ones(len(rows)), still)

    def under(self, differences: FloatArray, speed: float | FloatArray, longer: float | FloatArray = 0.0) -> Self:
        """The balance about its one known state, for other speeds, differences from the mean and a longer belt (m)."""
        other, count = copy(self), len(differences)
        for name in ("mean", "_centers", "_places", "_held", "_frictions"):
            setattr(other, name, np.repeat(getattr(self, name)[:1], count, axis=0))
        other.differences = differences
        other._held[:, 0] += longer
        flowing = np.broadcast_to(np.asarray(speed, dtype=float), count)
        other._lifted = self._prepared.belt.mass_per_length * np.repeat(flowing[:, None] ** 2, differences.shape[1], 1)
        other._backward = flowing < 0.0
        return other

    def states(self) -> "States":
        """The states that are in balance; NaN where there is none."""
        rows, factor = np.arange(self.mean.size), np.ones(self.mean.size)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            unknowns = self.solve(rows, factor, self.start)
            shape = self._geometry(rows, unknowns)
        return States(self._tension(rows, factor, unknowns), self._places + unknowns[:, 1:], shape.centers, shape.wrap)

    def path_at(self, positions: FloatArray) -> FloatArray:
        """Unit vectors along spans, shape (spans, 2), with tensioners at positions, shape (K,); NaN without a path."""
        unknowns = np.concatenate([self.mean[:1], positions - self._places[0]])[None]
        with np.errstate(invalid="ignore"):  # a free arm may be where no belt can run
            return np.asarray(self._geometry(np.zeros(1, dtype=int), unknowns).directions[0])

    def held_at(self, number: int, position: float) -> tuple[float, float]:
        """The belt at rest that holds a tensioner at a position, with the others where they are in the known state.

        `number`: the tensioner; `position`: m or rad. Returns longer, tension: unstretched length less that of the
        known state, m, and tension, N.
        """
        still = self.under(np.zeros((1, self.differences.shape[1])), 0.0)
        rows, factor, unknowns = np.zeros(1, dtype=int), np.ones(1), still.start
        unknowns[:, 1 + number] = position - self._places[0, number]

        def off(tension: float) -> FloatArray:
            unknowns[:, 0] = tension
            return np.asarray(still.residual(rows, factor, unknowns)[0])

        none, some = off(0.0)[1 + number], off(self.scales[0])[1 + number]
        tension = float(self.scales[0] * none / (none - some))
        return float(off(tension)[0]), tension

    @property
    def start(self) -> FloatArray:
        """The unknowns in the present states."""
        return np.column_stack([self.mean, np.zeros((self.mean.size, len(self._carriers)))])

    def use(self, rows: IntArray, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        """What s is at each pulley, shape (n, pulleys); inf where the belt lifts off."""
        return self._use(rows, self.pressing(rows, factor, unknowns), self._geometry(rows, unknowns).wrap)

    def _use(self, rows: IntArray, pressing: FloatArray, wrap: FloatArray) -> FloatArray:
        before, after = across(pressing, self._prepared)
        held = (before + after) * np.tanh(0.5 * self._frictions[rows] * wrap)
        return np.where(held > 0.0, np.abs(before - after) / held, np.where(np.isnan(held), np.nan, np.inf))

    def pressing(self, rows: IntArray, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        """Tensions less m v^2, with which the belt presses, N, shape (n, spans)."""
        return np.asarray(self._tension(rows, factor, unknowns) - self._lifted[rows])

    def loaded(self) -> BoolArray:
        """Whether a pulley has a load, shape (n, pulleys)."""
        before, after = across(self.differences + self.mean[:, None], self._prepared)
        return np.asarray(np.abs(before - after) > UNLOADED * np.abs(before + after))

    def solve(self, rows: IntArray, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        """The unknowns with other loads, by Newton's method from a guess; NaN where there is no balance.

        The belt presses on every pulley: where it does not, it has slid before.
        """
        found, left = unknowns.copy(), np.arange(rows.size)
        edge = np.max(self._lifted[rows] - factor[:, None] * self.differences[rows], axis=1)
        found[:, 0] = np.maximum(found[:, 0], edge + _PRESSED * np.abs(self.mean[rows]))
        for _ in range(_MOST_ITERATIONS):
            step = -self.newton_step(rows[left], factor[left], found[left])
            step[:, 1:] = np.clip(step[:, 1:], -_LONGEST * self.scales[1:], _LONGEST * self.scales[1:])
            step[:, 0] = np.maximum(step[:, 0], (_PRESSED - 1.0) * (found[left, 0] - edge[left]))
            found[left] += step
            away = np.max(np.abs(step) / self.scales, axis=1)
            left, away = left[~(away <= _CONVERGED)], away[~(away <= _CONVERGED)]
            if not np.isfinite(away).any():
                break
        else:
            left = left[away > 1e3 * _CONVERGED]
        found[left] = np.nan
        return found

    def newton_step(
        self, rows: IntArray, factor: FloatArray, unknowns: FloatArray, condition: "Condition | None" = None
    ) -> FloatArray:
        """What Newton's method takes off the unknowns, and off ln f with a condition that sets the factor f.

        Difference quotients; the path changes with tensioners alone, so tensions and f are varied on it.
        """
        shape, moved = self._geometry(rows, unknowns), unknowns.copy()

        def off(factor: FloatArray, shape: _Geometry) -> FloatArray:
            missing = self._off(rows, factor, moved, shape)
            if condition is None:
                return missing
            pressing = self.pressing(rows, factor, moved)
            return np.column_stack([missing, condition(pressing, self._use(rows, pressing, shape.wrap))])

        here, slopes = off(factor, shape), list[FloatArray]()
        for one, scale in enumerate(self.scales.tolist()):
            moved[:, one] += _DIFFERENCE * scale
            there = off(factor, shape if one == 0 else self._geometry(rows, moved))
            slopes.append((there - here) / (_DIFFERENCE * scale))
            moved[:, one] = unknowns[:, one]
        if condition is not None:
            slopes.append((off(factor * (1.0 + _DIFFERENCE), shape) - here) / _DIFFERENCE)
        return _solved(np.stack(slopes, axis=2), here)

    def _tension(self, rows: IntArray, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        return np.asarray(unknowns[:, :1] + factor[:, None] * self.differences[rows])

    def residual(self, rows: IntArray, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
        """What the balances miss: unstretched length, m, or the tension of a pulled span, N, then each tensioner."""
        return self._off(rows, factor, unknowns, self._geometry(rows, unknowns))

    def _off(self, rows: IntArray, factor: FloatArray, unknowns: FloatArray, shape: _Geometry) -> FloatArray:
        tension = self._tension(rows, factor, unknowns)
        missing = [self._belt_on(rows, tension, shape) if self._pulled is None else tension[:, self._pulled]]
        pressing = tension - self._lifted[rows]
        path = self._prepared.path
        for number, one in enumerate(self._carriers):
            before, after = (
                pressing[:, span, None] * shape.directions[:, span]
                for span in (path.reaching[one.pulley], path.leaving[one.pulley])
            )
            belt = np.sum((after - before) * shape.slopes[:, number], axis=1)
            place = self._places[rows, number] + unknowns[:, 1 + number]
            missing.append(belt + _spring(one.tensioner, place))
        return np.column_stack(missing) - self._held[rows]

    def _belt_on(self, rows: IntArray, tension: FloatArray, shape: _Geometry) -> FloatArray:
        """Unstretched length of the belt on its path, m."""
        prepared = self._prepared
        law, radii, friction = prepared.belt.stretch_parameters, np.abs(prepared.path.radii), self._frictions[rows]
        before, after = across(tension, prepared)
        lifted_before, lifted_after = across(self._lifted[rows], prepared)
        backward, least = self._backward[rows, None], 1e-9 * self.scales[0]
        reaching, lifted = np.where(backward, after, before), np.where(backward, lifted_after, lifted_before)
        pressing = before - lifted_before, after - lifted_after
        tight, slack = (np.maximum(choice(*pressing), least) for choice in (np.maximum, np.minimum))
        ratio = np.log(tight / slack)
        slid = np.minimum(ratio / np.maximum(friction, 1e-12), shape.wrap)
        sliding = lifted + np.where(ratio > 1e-9, (tight - slack) / np.maximum(ratio, 1e-9), tight)
        part = np.divide(slid, shape.wrap, out=np.zeros_like(slid), where=shape.wrap > 0.0)
        mean = (1.0 - part) * reaching + part * sliding
        sunk = np.maximum(mean - lifted, 0.0) / (radii * prepared.contact_stiffness)
        arcs = shape.wrap * (radii - sunk) * ((1.0 - part) / law.stretch(reaching) + part / law.stretch(sliding))
        spans = shape.lengths / law.stretch(tension)
        return np.asarray(spans.sum(axis=1) + arcs.sum(axis=1))

    def _geometry(self, rows: IntArray, unknowns: FloatArray) -> _Geometry:
        """The path with the tensioners where the unknowns have them."""
        centers, slopes = self._centers[rows].copy(), np.empty((len(rows), len(self._carriers), 2))
        for number, one in enumerate(self._carriers):
            way, along = unknowns[:, 1 + number], self._along[number]
            pivot = one.tensioner.anchor
            if pivot is None:
                slopes[:, number] = along[1]
                centers[:, one.pulley] += way[:, None] * along[1]
                continue
            arm = centers[:, one.pulley] - np.array(pivot)
            sense = np.sign(_turned(along[0] - np.array(pivot)) @ along[1])
            cosine, sine = np.cos(way)[:, None], sense * np.sin(way)[:, None]
            arm = cosine * arm + sine * _turned(arm)
            centers[:, one.pulley] = pivot + arm
            slopes[:, number] = sense * _turned(arm)
        shape = self._prepared.path.shape
        directions, points = span_directions(centers, *shape), span_points(centers, *shape)
        lengths = np.linalg.norm(points[:, :, 1] - points[:, :, 0], axis=-1)
        return _Geometry(centers, directions, lengths, wrap_angles(directions, *shape), slopes)


def _pulled_span(prepared: Prepared) -> int | None:
    """Number of a span at an end that is pulled; None where nothing pulls."""
    spans = (-1, -2)  # the last span comes from the first end, and the one before reaches the second one
    return next((span for span, end in zip(spans, prepared.ends, strict=False) if not end.held), None)


def _places(prepared: Prepared, centers: FloatArray) -> FloatArray:
    """Where tensioners stand that carry pulleys, m or rad, shape (n, K)."""
    found = np.empty((len(centers), len(prepared.carriers)))
    for number, one in enumerate(prepared.carriers):
        (nominal, along), pivot = one.place(0.0), one.tensioner.anchor
        if pivot is None:
            found[:, number] = (centers[:, one.pulley] - nominal) @ along
        else:
            arm, here = nominal - np.array(pivot), centers[:, one.pulley] - np.array(pivot)
            sense = np.sign(_turned(arm) @ along)
            found[:, number] = sense * np.arctan2(here @ _turned(arm), here @ arm)
    return found


def _spring(tensioner: MovingTensioner, place: FloatArray) -> FloatArray:
    """Force of spring and stops at places, N or N m."""
    row = tensioner.spring
    low, high = (np.maximum(depth, 0.0) for depth in (row["lower"] - place, place - row["upper"]))
    return np.asarray(row["preload"] - row["rate"] * place + row["stop_stiffness"] * (low - high))


def _solved(slopes: FloatArray, off: FloatArray) -> FloatArray:
    """Solutions of many small systems; those of singular ones are the shortest."""
    try:
        return np.asarray(np.linalg.solve(slopes, off[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        known = np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(off).all(axis=1)
        found = np.full_like(off, np.nan)
        found[known] = (np.linalg.pinv(slopes[known]) @ off[known, :, None])[:, :, 0]
        return found


def _turned(vectors: FloatArray) -> FloatArray:
    """Vectors turned by a quarter to the left, shape (..., 2)."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)

"""The slip safety: the factor on all loads at which the belt slides on the whole arc of a pulley.

With the factor f on the loads the differences of the tensions grow with f, and what holds the tension sets their mean:

    T_i = T + f D_i,    D_i = the present tensions less their mean.

The balance is that of `beltdyn.results.tension_balance`, about the present state. The arc of pulley p slides on its
whole angle theta where the tensions at its ends, less m v^2, are in the ratio exp(mu theta) of Euler and Eytelwein, or,
with

    s = |T1 - T2| / ((T1 + T2 - 2 m v^2) tanh(mu theta / 2)),

where s = 1. A belt that resists bending touches on less than theta, but it turns by theta, and presses on the ends of
its arc by what is missing there.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, wrap_angles
from beltdyn.results.mechanics import across
from beltdyn.results.tension_balance import TensionBalance, newton_step

STATE = ("span_tension", "belt_speed", "pulley_center")
"""What a slip safety follows from, by the names of recorded variables."""
_GROWTH, _STEPS = 1.5, 12
"""Factors on the loads between which s = 1 is looked for: powers of the first, up to the 12th and down to the -12th."""
_REFINEMENTS = 30
_ACCURACY = 1e-6
"""Of the slip safety."""
_SLACK = 1e-3
"""Tension that presses, over the mean one, at which a span counts as slack."""
_MOST_STEPS, _WHOLE_STEPS, _WIDEST_STEP = 40, 12, 0.5
"""Steps of Newton's method, how many before halved ones, as at the kink of a stop, and the longest one, over scales."""


def slip_safety_of_states(
    tension: FloatArray,
    belt_speed: FloatArray,
    centers: FloatArray,
    prepared: Prepared,
    frictions: FloatArray | None = None,
) -> FloatArray:
    """Slip safety of each pulley: the factor on all loads at its gross slip, if the others hold.

    1 on the edge of gross slip. NaN without a load, where the difference of tensions at a pulley, over their sum, is
    below `UNLOADED`, and where the belt does not touch. Arguments have shapes (..., spans), N and m/s, and (...,
    pulleys, 2), m; frictions replace the coefficients of the drive, with the wedge effect.
    """
    pulleys = len(prepared.pulleys)
    shape = tension.shape[:-1]
    flat = (tension.reshape(-1, tension.shape[-1]), belt_speed.reshape(-1, tension.shape[-1]))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        rough = None if frictions is None else frictions.reshape(-1, pulleys)
        balance = TensionBalance(prepared, *flat, centers.reshape(-1, pulleys, 2), rough)
        return _safeties(balance).reshape(*shape, pulleys)


def friction_used(tension: FloatArray, belt_speed: FloatArray, centers: FloatArray, prepared: Prepared) -> FloatArray:
    """Share of friction used by each pulley, ln((T1 - m v^2) / (T2 - m v^2)) / mu theta.

    Parameters and shape of the result are those of `slip_safety_of_states`; 1 or more where the whole arc slides.
    """
    wrap = wrap_angles(span_directions(centers, prepared.path.radii, prepared.path.ends), prepared.path.radii)
    before, after = across(tension - prepared.belt.mass_per_length * belt_speed**2, prepared)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.log(np.maximum(before, after) / np.maximum(np.minimum(before, after), 0.0))
        return np.asarray(ratio / (prepared.frictions * wrap))


def _safeties(balance: TensionBalance) -> FloatArray:
    """Factors at which s = 1, shape (n, pulleys), by Newton's method, or between two powers of `_GROWTH` by secants.

    1 / s is straight over 1 / f where the sum of both tensions, or one of them, is held.
    """
    every = np.arange(balance.mean.size)
    present = balance.use(every, np.ones(every.size), balance.start)
    loaded = balance.loaded() & ~np.isnan(present)
    found = np.where(loaded, np.where(np.isinf(present), 0.0, 1.0 / present), np.nan)
    sought = loaded & np.isfinite(present)
    direct = _directly(balance, *np.nonzero(sought))
    found[sought] = np.where(np.isnan(direct), found[sought], direct)
    sought[sought] = np.isnan(direct)
    between = list[tuple[IntArray, IntArray, _Point, _Point]]()
    for growth, open_ in (
        (_GROWTH, sought & (present < 1.0)),
        (1.0 / _GROWTH, sought & (present >= 1.0)),
    ):
        left, last = open_.copy(), _Point(np.ones(every.size), balance.start, 1.0 / present)
        for step in range(1, _STEPS + 1):
            rows = np.flatnonzero(left.any(axis=1))
            if not rows.size:
                break
            before = last.of(rows)
            factor = np.full(rows.size, growth**step)
            here = _at(balance, rows, factor, before.unknowns)
            crossed = left[rows] & ((here.spare <= 1.0) if growth > 1.0 else (here.spare >= 1.0))
            one, pulley = np.nonzero(crossed)
            between.append((rows[one], pulley, before.of(one), here.of(one)))
            left[rows] &= ~crossed
            beyond = left[rows] & np.isfinite(here.spare)
            found[rows] = np.where(beyond, factor[:, None] * here.spare, found[rows])
            last.put(rows, here)
    if between:
        rows, pulley = (np.concatenate(parts) for parts in list(zip(*between, strict=True))[:2])
        low, high = (
            _Point(*map(np.concatenate, zip(*points, strict=True))) for points in list(zip(*between, strict=True))[2:]
        )
        found[rows, pulley] = _between(balance, rows, pulley, low, high)
    return found


def _directly(balance: TensionBalance, rows: IntArray, pulley: IntArray) -> FloatArray:
    """Factors at which s = 1 of one pulley each, or a span gets slack before; NaN where neither is found."""
    every = np.unique(rows)
    slackest = np.argmin(balance.differences[every], axis=1)

    def spare(own: IntArray, values: FloatArray, factor: FloatArray) -> FloatArray:
        return np.asarray(1.0 / balance.use(rows[own], factor, values)[np.arange(own.size), pulley[own]] - 1.0)

    def pressing(own: IntArray, values: FloatArray, factor: FloatArray) -> FloatArray:
        left = balance.pressing(every[own], factor, values)[np.arange(own.size), slackest[own]]
        return np.asarray(left / balance.mean[every[own]] - _SLACK)

    slips, slack = _newton(balance, rows, spare), _newton(balance, every, pressing)
    return np.fmin(slips, slack[np.searchsorted(every, rows)])


def _newton(
    balance: TensionBalance, rows: IntArray, condition: Callable[[IntArray, FloatArray, FloatArray], FloatArray]
) -> FloatArray:
    """Factors at which a condition holds, by Newton's method for them and the unknowns of the balance together.

    It begins at the present state; NaN where it does not converge. The condition takes numbers of entries of rows, the
    unknowns of the balance and the factors there.
    """
    scales = np.append(balance.scales, 1.0)
    found = np.column_stack([balance.start[rows], np.zeros(rows.size)])
    done, open_ = np.zeros(rows.size, dtype=bool), np.arange(rows.size)

    def off(values: FloatArray) -> FloatArray:
        factor = np.exp(values[:, -1])
        missing = balance.residual(rows[open_], factor, values[:, :-1])
        return np.column_stack([missing, condition(open_, values[:, :-1], factor)])

    for number in range(_MOST_STEPS if rows.size else 0):
        step = -newton_step(off, found[open_], scales) * (1.0 if number < _WHOLE_STEPS else 0.5)
        step *= np.minimum(1.0, _WIDEST_STEP / np.maximum(np.abs(step / scales).max(axis=1), 1e-12))[:, None]
        found[open_] += step
        settled = np.all(np.abs(step) <= _ACCURACY * scales, axis=1)
        done[open_[settled]] = True
        open_ = open_[~settled & np.isfinite(step).all(axis=1)]
        if not open_.size:
            break
    return np.where(done, np.exp(found[:, -1]), np.nan)


class _Point(NamedTuple):
    """States under a factor on the loads, a row for each."""

    factor: FloatArray
    unknowns: FloatArray
    spare: FloatArray
    """1 / s of each pulley; zero where there is no balance."""

    def of(self, rows: NDArray[np.intp]) -> "_Point":
        """Some of them."""
        return _Point(*(values[rows].copy() for values in self))

    def put(self, rows: NDArray[np.intp], others: "_Point") -> None:
        """Put others in the place of some."""
        for own, values in zip(self, others, strict=True):
            own[rows] = values


def _at(balance: TensionBalance, rows: IntArray, factor: FloatArray, guess: FloatArray) -> _Point:
    """States under a factor on the loads."""
    unknowns = balance.solve(rows, factor, guess)
    lost = np.isnan(unknowns[:, 0])
    spare = 1.0 / balance.use(rows, factor, unknowns)
    spare[lost] = 0.0
    return _Point(factor, np.where(lost[:, None], guess, unknowns), spare)


def _between(balance: TensionBalance, rows: IntArray, pulley: IntArray, low: _Point, high: _Point) -> FloatArray:
    """Factors at which s = 1 of one pulley each, between two states, by the regula falsi (Illinois)."""
    own = np.arange(rows.size)
    near, far = 1.0 / low.factor, 1.0 / high.factor
    a, b = low.spare[own, pulley] - 1.0, high.spare[own, pulley] - 1.0
    at_near, root, open_ = low.unknowns, near.copy(), own
    for _ in range(_REFINEMENTS):
        if not open_.size:
            break
        root[open_] = (near - a * (far - near) / np.where(a == b, 1.0, b - a))[open_]
        here = _at(balance, rows[open_], 1.0 / root[open_], at_near[open_])
        spare = here.spare[np.arange(open_.size), pulley[open_]]
        value = spare - 1.0
        same = np.sign(value) == np.sign(a[open_])
        near[open_], far[open_] = np.where(same, root[open_], near[open_]), np.where(same, far[open_], root[open_])
        a[open_], b[open_] = np.where(same, value, 0.5 * a[open_]), np.where(same, 0.5 * b[open_], value)
        at_near[open_] = np.where((same & (spare > 0.0))[:, None], here.unknowns, at_near[open_])
        open_ = open_[(np.abs(value) > _ACCURACY) & (np.abs(far - near)[open_] > _ACCURACY * root[open_])]
    return np.asarray(1.0 / root)

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

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, wrap_angles
from beltdyn.results.mechanics import (
    UNLOADED,
    across,
    cells,
    gross_sliding,
    pressing,
    pressing_at_arcs,
    relative_loss,
    sliding_shares,
    sliding_velocity,
)
from beltdyn.results.tension_balance import Condition, TensionBalance
from beltdyn.theory.creep import entry_strain

# Sliding of the belt on every pulley


def sliding_of_pulleys(
    prepared: Prepared,
    belt_coordinate: FloatArray,
    touched: IntArray,
    normal: FloatArray,
    slip_velocity: FloatArray,
    pulley_speed: FloatArray,
) -> dict[str, FloatArray]:
    """Speed (m/s) and share of sliding of each pulley, shape (k, pulleys), from contact at points."""
    sliding = sliding_velocity(slip_velocity, normal, touched, pulley_speed, prepared)
    pressed = pressing(normal, touched, len(prepared.pulleys))
    return {
        "sliding_speed": gross_sliding(sliding, pressed, prepared),
        "sliding_share": sliding_shares(sliding, pressed, cells(belt_coordinate, prepared.belt_length)),
    }


class SlipParts(NamedTuple):
    """Slip and its parts, shape (..., pulleys), over the speed of the driver's rim."""

    slip: FloatArray
    """The sum of the others."""
    elastic_creep: FloatArray
    """By the stretch of the spans that reach the two pulleys."""
    bending: FloatArray
    """By what bending and its hysteresis take from the stretch until the belt touches, beyond the rolling radii."""
    regularization: FloatArray
    """What is left: by the slope of the friction law, and by errors of the mesh."""
    sliding: FloatArray
    """By arcs that slide as a whole."""


def slip_parts(
    rim: FloatArray,
    tension: FloatArray,
    gross: FloatArray,
    elapsed: FloatArray | float,
    prepared: Prepared,
    at_arcs: tuple[FloatArray, FloatArray] | None = None,
) -> SlipParts:
    """Take slip apart into elastic creep, bending, what the slope of the friction law makes, and sliding.

    Between pulleys with teeth there is neither creep nor loss of stretch by bending: what is left is that of radii.

    With Coulomb's friction the belt adheres to every rim where it reaches it, with the tension T of the span before
    and the stretch g(T) there: the elastic creep is 1 - g(T_i) / g(T_d), (T_d - T_i) / EA at small strain (Grashof
    1883), with the driver d (`Drive.reference`). On its way there it bends, and the rim meets it with less stretch than
    the span has (`theory.creep.entry_strain`), on small pulleys by as much as it creeps. The rolling radii have
    a part of that already. A law of friction that starts at zero lets the belt creep where it touches, and on, while it
    bends.

    The tension T is that of spans, or where the belt reaches and leaves the pulleys (`at_arcs`), if it varies.
    """
    law = prepared.belt.stretch_parameters
    stretched = (law.stretch(np.max(tension, axis=-1)) - 1.0) * prepared.belt_length
    driver = prepared.reference
    runs = np.abs(rim[..., driver]) * elapsed > np.maximum(stretched, 0.0)
    rim = np.where(runs[..., None], rim, 0.0)
    before, after = across(tension, prepared) if at_arcs is None else at_arcs
    reaching = np.where(rim[..., driver, None] > 0.0, before, after)
    reached, lost = law.stretch(reaching), _entry_loss(reaching, prepared)
    total, sliding = relative_loss(-rim, rim, driver), relative_loss(gross, rim, driver)
    creeps = ~(prepared.toothed & prepared.toothed[driver])
    elastic = np.where(runs[..., None], creeps * (1.0 - reached / reached[..., driver, None]), np.nan)
    bending = np.where(runs[..., None], creeps * (lost - lost[..., driver, None]), np.nan)
    return SlipParts(total, elastic, bending, total - elastic - bending - sliding, sliding)


def _entry_loss(reaching: FloatArray, prepared: Prepared) -> FloatArray:
    """Strain lost where the belt first touches, beyond that of the rolling radii; none of elements that do not bend."""
    belt = prepared.belt
    if belt.element_kind.bent_strain == 0.0:
        return np.zeros_like(reaching)
    lost = entry_strain(
        reaching,
        prepared.radii,
        bending_stiffness=belt.bending_stiffness,
        axial_stiffness=belt.axial_stiffness,
        contact_stiffness=prepared.contact_stiffness,
        bent_strain=belt.element_kind.bent_strain,
        loss_factor=belt.bending_loss_factor,
    )
    return np.asarray(lost + belt.bent_strain(prepared.radii))


STATE = ("span_tension", "belt_speed", "pulley_center")
"""What a slip safety follows from, by the names of recorded variables."""
_GROWTH, _STEPS = 1.5, 12
"""Factors on the loads between which s = 1 is looked for: powers of the first, up to the 12th and down to the -12th."""
_REFINEMENTS = 30
_ACCURACY = 1e-6
"""Of the slip safety."""
_SLACK = 1e-3
"""Tension that presses, over the mean one, at which a span counts as slack."""
_MOST_STEPS = 80
"""Steps to where a balance is lost, at most."""
_LEFT = 0.1
"""Tension that presses after a step of Newton's method, over that before, at least."""
_WHOLE_STEPS, _DAMPED_STEPS, _WIDEST_STEP = 10, 24, 0.5
"""Steps of Newton's method, then halved ones, as at the kink of a stop, and the longest one, over scales."""


def slip_safety_of_states(
    tension: FloatArray,
    belt_speed: FloatArray,
    centers: FloatArray,
    prepared: Prepared,
    frictions: FloatArray | None = None,
) -> FloatArray:
    """Slip safety of each pulley: the factor on all loads at its gross slip, if the others hold.

    1 on the edge of gross slip. NaN where teeth hold the belt, on guides that stand still, without a load, where the
    difference of tensions at a pulley, over their sum, is below `UNLOADED`, and where the belt does not touch.
    Arguments have shapes (..., spans), N and m/s, and (..., pulleys, 2), m; frictions replace the coefficients of the
    drive, with the wedge effect.
    """
    pulleys = len(prepared.pulleys)
    shape = tension.shape[:-1]
    flat = (tension.reshape(-1, tension.shape[-1]), belt_speed.reshape(-1, tension.shape[-1]))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        rough = None if frictions is None else frictions.reshape(-1, pulleys)
        balance = TensionBalance(prepared, *flat, centers.reshape(-1, pulleys, 2), rough)
        safeties = np.where(prepared.gripping, _safeties(balance), np.nan)
        return safeties.reshape(*shape, pulleys)


def slip_safety_of(value_of: Callable[[str], FloatArray], prepared: Prepared) -> FloatArray:
    """Slip safety of each pulley: `slip_safety_of_states`, or of a belt that carries `slip_safety_at_arcs`.

    `value_of` gives recorded variables by name.
    """
    pressing = pressing_at_arcs(value_of, prepared)
    tension, belt_speed, centers = (value_of(name) for name in STATE)
    if pressing is None:
        return slip_safety_of_states(tension, belt_speed, centers, prepared)
    return slip_safety_at_arcs(pressing, centers, prepared)


def slip_safety_at_arcs(pressing: tuple[FloatArray, FloatArray], centers: FloatArray, prepared: Prepared) -> FloatArray:
    """Slip safety of each pulley of a belt that carries, 1 / s at the sum of the present tensions at its arc.

    `pressing` are the tensions less m v^2 before and after each pulley (`mechanics.pressing_at_arcs`), N; centers have
    shape (..., pulleys, 2), m. NaN as in `slip_safety_of_states`.
    """
    before, after = pressing
    wrap = wrap_angles(span_directions(centers, *prepared.path.shape), *prepared.path.shape)
    held, apart = (before + after) * np.tanh(0.5 * prepared.frictions * wrap), np.abs(before - after)
    loaded = (apart > UNLOADED * np.abs(before + after)) & prepared.gripping
    return np.divide(np.maximum(held, 0.0), apart, out=np.full_like(held, np.nan), where=loaded)


def friction_used(
    tension: FloatArray,
    belt_speed: FloatArray,
    centers: FloatArray,
    prepared: Prepared,
    pressing: tuple[FloatArray, FloatArray] | None = None,
) -> FloatArray:
    """Share of friction used by each pulley, ln((T1 - m v^2) / (T2 - m v^2)) / mu theta.

    Parameters and shape of the result are those of `slip_safety_of_states`, and `pressing` is that of
    `slip_safety_at_arcs`; 1 or more where the whole arc slides.
    """
    wrap = wrap_angles(span_directions(centers, *prepared.path.shape), *prepared.path.shape)
    lifted = prepared.belt.mass_per_length * belt_speed**2
    before, after = across(tension - lifted, prepared) if pressing is None else pressing
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.log(np.maximum(before, after) / np.maximum(np.minimum(before, after), 0.0))
        return np.where(prepared.gripping, ratio / (prepared.frictions * wrap), 0.0)


def _safeties(balance: TensionBalance) -> FloatArray:
    """Factors at which s = 1, shape (n, pulleys): between which powers of `_GROWTH`, and there by Newton's method.

    1 / s is straight over 1 / f where the sum of both tensions, or one of them, is held.
    """
    every = np.arange(balance.mean.size)
    present = balance.use(every, np.ones(every.size), balance.start)
    loaded = balance.loaded() & ~np.isnan(present)
    found = np.where(loaded, np.where(np.isinf(present), 0.0, 1.0 / present), np.nan)
    sought = loaded & np.isfinite(present)
    between = list[tuple[IntArray, IntArray, _Point, _Point]]()
    for growth, open_ in (
        (_GROWTH, sought & (present < 1.0)),
        (1.0 / _GROWTH, sought & (present >= 1.0)),
    ):
        left, last = open_.copy(), _Point(np.ones(every.size), balance.start, 1.0 / present)
        earlier = last.unknowns.copy()
        for step in range(1, _STEPS + 1):
            rows = np.flatnonzero(left.any(axis=1))
            if not rows.size:
                break
            before = last.of(rows)
            factor = np.full(rows.size, growth**step)
            guess = before.unknowns + growth * (before.unknowns - earlier[rows])
            here = _at(balance, rows, factor, guess, before.unknowns)
            crossed = left[rows] & ((here.spare <= 1.0) if growth > 1.0 else (here.spare >= 1.0))
            one, pulley = np.nonzero(crossed)
            between.append((rows[one], pulley, before.of(one), here.of(one)))
            left[rows] &= ~crossed
            beyond = left[rows] & np.isfinite(here.spare)
            found[rows] = np.where(beyond, factor[:, None] * here.spare, found[rows])
            earlier[rows] = before.unknowns
            last.put(rows, here)
    if between:
        rows, pulley = (np.concatenate(parts) for parts in list(zip(*between, strict=True))[:2])
        low, high = (
            _Point(*map(np.concatenate, zip(*points, strict=True))) for points in list(zip(*between, strict=True))[2:]
        )
        found[rows, pulley] = _between(balance, rows, pulley, low, high)
    return found


def _between(balance: TensionBalance, rows: IntArray, pulley: IntArray, low: "_Point", high: "_Point") -> FloatArray:
    """Factors at which s = 1 of one pulley each, or a span gets slack before, between two states."""
    own, lost = np.arange(rows.size), ~high.spare.any(axis=1)
    one, other = low.spare[own, pulley] - 1.0, high.spare[own, pulley] - 1.0
    part = np.where(lost, 0.0, one / np.where(one == other, 1.0, one - other))
    factor = 1.0 / ((1.0 - part) / low.factor + part / high.factor)
    unknowns = low.unknowns + part[:, None] * (high.unknowns - low.unknowns)

    def slips(some: IntArray) -> Condition:
        return lambda pressing, use: 1.0 / use[np.arange(some.size), pulley[some]] - 1.0

    found = _newton(balance, rows, factor, unknowns, slips)
    found = np.where(_within(found, low, high), found, np.nan)
    gone = np.flatnonzero(lost)
    each, back = np.unique(rows[gone], return_inverse=True)
    first = gone[np.unique(back, return_index=True)[1]]
    slackest = np.argmin(balance.differences[each], axis=1)

    def gets_slack(some: IntArray) -> Condition:
        mean = balance.mean[each[some]]
        return lambda pressing, use: pressing[np.arange(some.size), slackest[some]] / mean - _SLACK

    slack = _newton(balance, each, low.factor[first], low.unknowns[first], gets_slack, _DAMPED_STEPS)
    ends = _within(slack, low.of(first), high.of(first))
    open_ = np.flatnonzero(~ends)
    if open_.size:
        last = _last(balance, each[open_], low.of(first[open_]), high.factor[first[open_]])
        slack[open_] = last.factor
        pairs = np.flatnonzero(~ends[back])
        high.put(gone[pairs], last.of(np.searchsorted(open_, back[pairs])))
    passed = ~ends[back] & (high.spare[own, pulley][gone] < 1.0) & np.isnan(found[gone])
    found[gone] = np.where(passed, np.nan, np.fmin(found[gone], slack[back]))
    left = np.flatnonzero(np.isnan(found))
    if left.size:
        found[left] = _by_secants(balance, rows[left], low.of(left), high.of(left), lambda some: slips(left[some]))
    return found


def _last(balance: TensionBalance, rows: IntArray, low: "_Point", high: FloatArray) -> "_Point":
    """The last states before a balance is lost, as where a tensioner cannot follow, by steps that halve there."""
    last, earlier, step = low.of(np.arange(rows.size)), low.of(np.arange(rows.size)), 0.25 * (high - low.factor)
    for _ in range(_MOST_STEPS):
        open_ = np.flatnonzero(np.abs(step) > _ACCURACY * last.factor)
        if not open_.size:
            break
        here, way = last.of(open_), last.factor[open_] - earlier.factor[open_]
        slope = (here.unknowns - earlier.unknowns[open_]) / np.where(way == 0.0, np.inf, way)[:, None]
        factor = here.factor + step[open_]
        there = _at(balance, rows[open_], factor, here.unknowns + step[open_, None] * slope, here.unknowns)
        good = there.spare.any(axis=1) & (np.abs(factor - low.factor[open_]) <= np.abs(high - low.factor)[open_])
        earlier.put(open_[good], here.of(np.flatnonzero(good)))
        last.put(open_[good], there.of(np.flatnonzero(good)))
        step[open_] *= np.where(good, 1.0, 0.5)
    return last


def _within(factor: FloatArray, low: "_Point", high: "_Point") -> BoolArray:
    """Whether factors are between those of two states."""
    ends = np.sort([low.factor, high.factor], axis=0)
    return np.asarray((factor >= (1.0 - _ACCURACY) * ends[0]) & (factor <= (1.0 + _ACCURACY) * ends[1]))


def _newton(
    balance: TensionBalance,
    rows: IntArray,
    factor: FloatArray,
    unknowns: FloatArray,
    condition: Callable[[IntArray], Condition],
    more_steps: int = 0,
) -> FloatArray:
    """Factors at which conditions hold, by Newton's method for them and the unknowns of the balance together.

    NaN where it does not converge. Conditions are those of some entries of rows.
    """
    scales = np.append(balance.scales, 1.0)
    found = np.column_stack([unknowns, np.log(factor)])
    done, open_ = np.zeros(rows.size, dtype=bool), np.arange(rows.size)
    for number in range(_WHOLE_STEPS + more_steps if rows.size else 0):
        here = found[open_]
        step = -balance.newton_step(rows[open_], np.exp(here[:, -1]), here[:, :-1], condition(open_))
        step *= 1.0 if number < _WHOLE_STEPS else 0.5
        step *= np.minimum(1.0, _WIDEST_STEP / np.maximum(np.abs(step / scales).max(axis=1), 1e-12))[:, None]
        before, after = (balance.pressing(rows[open_], np.exp(one[:, -1]), one[:, :-1]) for one in (here, here + step))
        held = np.where(after < _LEFT * before, (1.0 - _LEFT) * before / (before - after), 1.0)
        step *= np.where(before > 0.0, held, 1.0).min(axis=1)[:, None]
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
    """1 / s of each pulley; zero where there is no balance, or a span is slack."""

    def of(self, rows: NDArray[np.intp]) -> "_Point":
        """Some of them."""
        return _Point(*(values[rows].copy() for values in self))

    def put(self, rows: NDArray[np.intp], others: "_Point") -> None:
        """Put others in the place of some."""
        for own, values in zip(self, others, strict=True):
            own[rows] = values


def _at(
    balance: TensionBalance, rows: IntArray, factor: FloatArray, guess: FloatArray, other: FloatArray | None = None
) -> _Point:
    """States under a factor on the loads, from a guess, or else from another one."""
    unknowns = balance.solve(rows, factor, guess)
    lost = np.isnan(unknowns[:, 0])
    if other is not None and lost.any():
        unknowns[lost], guess = balance.solve(rows[lost], factor[lost], other[lost]), other
        lost = np.isnan(unknowns[:, 0])
    spare = 1.0 / balance.use(rows, factor, unknowns)
    spare[lost | (balance.pressing(rows, factor, unknowns).min(axis=1) < _SLACK * balance.mean[rows])] = 0.0
    return _Point(factor, np.where(lost[:, None], guess, unknowns), spare)


def _by_secants(
    balance: TensionBalance, rows: IntArray, low: _Point, high: _Point, condition: Callable[[IntArray], Condition]
) -> FloatArray:
    """Factors at which conditions hold, or a span gets slack before, by the regula falsi (Illinois)."""
    near, far, own = 1.0 / low.factor, 1.0 / high.factor, np.arange(rows.size)

    def value(some: IntArray, point: _Point) -> FloatArray:
        pressing = balance.pressing(rows[some], point.factor, point.unknowns)
        return np.where(point.spare.any(axis=1), condition(some)(pressing, 1.0 / point.spare), -1.0)

    a, b = value(own, low), value(own, high)
    at_near, root, open_ = low.unknowns, near.copy(), own
    for _ in range(_REFINEMENTS):
        if not open_.size:
            break
        root[open_] = (near - a * (far - near) / np.where(a == b, 1.0, b - a))[open_]
        here = _at(balance, rows[open_], 1.0 / root[open_], at_near[open_])
        now = value(open_, here)
        same = np.sign(now) == np.sign(a[open_])
        near[open_], far[open_] = np.where(same, root[open_], near[open_]), np.where(same, far[open_], root[open_])
        a[open_], b[open_] = np.where(same, now, 0.5 * a[open_]), np.where(same, 0.5 * b[open_], now)
        at_near[open_] = np.where((same & here.spare.any(axis=1))[:, None], here.unknowns, at_near[open_])
        open_ = open_[(np.abs(now) > _ACCURACY) & (np.abs(far - near)[open_] > _ACCURACY * root[open_])]
    return np.asarray(1.0 / root)

"""The slip safety: the factor on a load at which the belt slides on the whole arc of a pulley.

Loads are those of all pulleys, with what the belt carries and drags, or the torque of one pulley, which the driver
takes up.  With the factor f the tensions along the path become

    T(s) + (f - 1) D(s) + c,

where D is the part of the tension that the load makes, without the weight of the belt, and c follows from what holds
the tension: `beltdyn.results.tension_balance`, about the present state. The arc of pulley p slides on its whole angle
theta where the tensions at its ends, less m v^2 and what the weight of the belt on the arc takes, are in the ratio
exp(mu theta) of Euler and Eytelwein. A belt that resists bending touches on less than theta, but it turns by theta, and
presses on the ends of its arc by what is missing there.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.model import Prepared
from beltdyn.model.nip import foundations
from beltdyn.model.path import span_directions
from beltdyn.results.mechanics import (
    UNLOADED,
    SpanTension,
    cells,
    gross_sliding,
    pressing,
    relative_loss,
    sliding_shares,
    sliding_velocity,
)
from beltdyn.results.sag import wrap_with_sag
from beltdyn.results.tension_balance import Loads, TensionBalance
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
    radial: FloatArray
    """By the sinking of the cord into the belt's rubber, where slip is taken at its radius."""
    bending: FloatArray
    """By what bending and its hysteresis take from the stretch until the belt touches, beyond the rolling radii."""
    regularization: FloatArray
    """What is left: by the slope of the friction law, and by errors of the mesh."""
    sliding: FloatArray
    """By arcs that slide as a whole."""


def slip_parts(
    rim: FloatArray, tension: SpanTension, gross: FloatArray, elapsed: FloatArray | float, prepared: Prepared
) -> SlipParts:
    """Take slip apart into elastic creep, bending, what the slope of the friction law makes, and sliding.

    Between pulleys with teeth there is neither creep nor loss of stretch by bending: what is left is that of radii.

    With Coulomb's friction the belt adheres to every rim where it reaches it, with the tension T of the span before
    and the stretch g(T) there: the elastic creep is 1 - g(T_i) / g(T_d), (T_d - T_i) / EA at small strain (Grashof
    1883), with the driver d (`Drive.reference`). On its way there it bends, and the rim meets it with less stretch than
    the span has (`theory.creep.entry_strain`), on small pulleys by as much as it creeps. The rolling radii have
    a part of that already. A law of friction that starts at zero lets the belt creep where it touches, and on, while it
    bends.

    Where slip is taken at the cord, a pulley turns faster by w/R, the sinking w = (T - m v^2) / kR over its radius.
    Friction that holds the belt while it still sinks takes a part of that off again.

    The tension T is that where the belt reaches the pulley. Where the whole arc of the driver slides, the parts of
    the others count from the speed of the belt there: 1 - v_i / v_d = g_d / v_d + (1 - g_d / v_d) (elastic + ...).
    """
    law = prepared.belt.stretch_parameters
    stretched = (law.stretch(np.max(tension.mean, axis=-1)) - 1.0) * prepared.belt_length
    driver = prepared.reference
    runs = np.abs(rim[..., driver]) * elapsed > np.maximum(stretched, 0.0)
    rim = np.where(runs[..., None], rim, 0.0)
    before, after = tension.at_arcs(prepared)
    reaching = np.where(rim[..., driver, None] > 0.0, before, after)
    reached, lost = law.stretch(reaching), _entry_loss(reaching, prepared)
    total, sliding = relative_loss(-rim, rim, driver), relative_loss(gross, rim, driver)
    led = rim[..., driver, None] != 0.0
    carried = 1.0 + np.divide(gross, rim[..., driver, None], out=np.zeros_like(rim), where=led)[..., driver, None]
    creeps = carried * ~(prepared.toothed & prepared.toothed[driver])
    elastic = np.where(runs[..., None], creeps * (1.0 - reached / reached[..., driver, None]), np.nan)
    bending = np.where(runs[..., None], creeps * (lost - lost[..., driver, None]), np.nan)
    sinking = _sinking(reaching, rim, prepared)
    radial = np.where(runs[..., None], creeps * (sinking[..., driver, None] - sinking), np.nan)
    return SlipParts(total, elastic, radial, bending, total - elastic - radial - bending - sliding, sliding)


def _sinking(reaching: FloatArray, rim: FloatArray, prepared: Prepared) -> FloatArray:
    """Sinking of the cord over the radius of a pulley; zero where slip is taken at the rim."""
    if prepared.contact.slip_radius == "rim":
        return np.zeros_like(reaching)
    stiffness = prepared.contact_stiffness * foundations(prepared.pulleys, prepared.belt, prepared.contact_stiffness)
    pressing = np.maximum(reaching - prepared.belt.mass_per_length * rim**2, 0.0)
    return np.asarray(~prepared.toothed * pressing / (stiffness * prepared.radii**2))


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


# Slip safety

STATE = ("belt_speed", "pulley_center", "pulley_torque")
"""What a slip safety follows from beside `SPAN_TENSIONS`, by the names of recorded variables."""
_ACCURACY = 1e-8
"""Of the factors on loads."""
_SLACK_TENSION = 1e-3
"""Tension that presses, over the mean one, at which a span counts as slack."""
_NEWTON_STEPS, _MAX_FACTOR_STEP = 16, 4.0
"""Steps of Newton's method for the edge of slip, and the largest change of the factor in a step."""
_FIRST_STRIDE, _LARGEST_STRIDE, _GROWTH = 1.25, 2.0, 1.2
"""Factors between loads on the way to the edge of slip: the first, the largest, and the growth of their logarithms."""
_MAX_STRIDES, _LARGEST_FACTOR = 120, 1e6
"""Strides on the way to the edge of slip, and the factor on loads at which it ends, or by its reciprocal: below that
the slip safety is zero. Twenty of the largest strides lead so far; the others allow for halved ones."""
_LOST_ACCURACY = 1e-4
"""Relative accuracy of the factor at which the balance is lost, of which no sign tells."""
_MAX_REFINEMENTS = 40
"""Steps of the regula falsi for the edge of slip; a safeguard, after which the last factor is taken."""


class SlipSafety(NamedTuple):
    """Slip safety of pulleys, shape (..., pulleys)."""

    all_loads: FloatArray
    """Factor on all loads of the drive at which the pulley slides, if the others hold."""
    own_load: FloatArray
    """Factor on the load of the pulley alone at which it slides; the driver takes it up. For the driver, that on all
    loads."""

    @property
    def least(self) -> FloatArray:
        """The lesser of both."""
        return np.fmin(self.all_loads, self.own_load)


def slip_safety_of_states(
    tension: SpanTension,
    belt_speed: FloatArray,
    centers: FloatArray,
    prepared: Prepared,
    torque: FloatArray | None = None,
    frictions: FloatArray | None = None,
) -> SlipSafety:
    """Slip safety of each pulley: factors on loads at its gross slip, or where the belt loses its tension before.

    1 on the edge of gross slip. NaN where teeth hold the belt, on guides that stand still, without a load, where the
    torque over the radius, or the difference of tensions, over their sum, is below `UNLOADED`, and where the belt does
    not touch. Tensions and speeds have shape (..., spans), N and m/s, centers (..., pulleys, 2), m, torques of the
    belt (..., pulleys), N m; frictions replace the coefficients of the drive, with the wedge effect.
    """
    pulleys, spans = len(prepared.pulleys), tension.mean.shape[-1]
    shape = tension.mean.shape[:-1]
    rough = None if frictions is None else frictions.reshape(-1, pulleys)
    flat = tension.each(lambda values: values.reshape(-1, spans))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        balance = TensionBalance(prepared, flat, belt_speed.reshape(-1, spans), centers.reshape(-1, pulleys, 2), rough)
        before, after = flat.at_arcs(prepared)
        rise = balance.jumps()
        turning = np.sign(prepared.path.radii)
        load = rise if torque is None else turning * torque.reshape(-1, pulleys) / prepared.radii
        loaded = np.zeros(rise.shape, dtype=bool)
        loaded[:] = (np.minimum(np.abs(load), np.abs(rise)) > UNLOADED * np.abs(before + after)) & prepared.gripping
        loaded[:, list(prepared.path.beside)] = False
        loaded[~np.isfinite(flat.mean).all(axis=1)] = False
        state, pulley = np.nonzero(loaded)
        loads = [balance.all_loads(load).of(state), balance.own_loads(load).of(state * pulleys + pulley)]
        others = pulley != prepared.reference
        both = Loads(*(np.concatenate([every, own[others]]) for every, own in zip(*loads, strict=True)))
        factors = _edges(balance, both, np.concatenate([pulley, pulley[others]]))
    found = SlipSafety(np.full(loaded.shape, np.nan), np.full(loaded.shape, np.nan))
    found.all_loads[state, pulley] = found.own_load[state, pulley] = factors[: pulley.size]
    found.own_load[state[others], pulley[others]] = factors[pulley.size :]
    return SlipSafety(*(values.reshape(*shape, pulleys) for values in found))


def slip_safety_of(value_of: Callable[[str], FloatArray], prepared: Prepared) -> SlipSafety:
    """Slip safety of each pulley, see `slip_safety_of_states`; `value_of` gives recorded variables by name."""
    speed, centers, torque = (value_of(name) for name in STATE)
    return slip_safety_of_states(SpanTension.of(value_of), speed, centers, prepared, torque)


class Grip(NamedTuple):
    """Tension ratio of each pulley, (T1 - m v^2) / (T2 - m v^2) with the larger tension T1, shape (..., pulleys)."""

    ratio: FloatArray
    """In use; infinite where a span is slack."""
    allowed: FloatArray
    """By friction: exp(mu theta) of Euler and Eytelwein."""

    @property
    def used(self) -> FloatArray:
        """Share of friction in use, ln(ratio) / mu theta; 1 or more where the whole arc slides, 0 without friction."""
        with np.errstate(invalid="ignore", divide="ignore"):
            used = np.log(self.ratio) / np.log(self.allowed)
        return np.where(self.allowed > 1.0, used, 0.0)


@np.errstate(under="ignore")  # of a belt that has come to rest
def grip_of_states(tension: SpanTension, belt_speed: FloatArray, centers: FloatArray, prepared: Prepared) -> Grip:
    """Tension ratios; parameters are those of `slip_safety_of_states`. Where teeth or guides hold, none is allowed."""
    spans, pulleys = belt_speed.shape[-1], len(prepared.pulleys)
    lifted = prepared.belt.mass_per_length * belt_speed**2
    directions = span_directions(centers, *prepared.path.shape).reshape(-1, spans, 2)
    flat = tension.each(lambda values: values.reshape(-1, spans))
    wrap = wrap_with_sag(prepared, flat, lifted.reshape(-1, spans), directions)
    wrap = wrap.reshape(*belt_speed.shape[:-1], pulleys)
    before, after = tension.each(lambda values: values - lifted).at_arcs(prepared)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.maximum(before, after) / np.maximum(np.minimum(before, after), 0.0)
    return Grip(ratio, np.where(prepared.gripping, np.exp(prepared.frictions * wrap), 1.0))


def grip_of(value_of: Callable[[str], FloatArray], prepared: Prepared) -> Grip:
    """Tension ratios, see `grip_of_states`; `value_of` gives recorded variables by name."""
    return grip_of_states(SpanTension.of(value_of), value_of("belt_speed"), value_of("pulley_center"), prepared)


# The edge of slip: a factor on loads at which friction carries all that it can


def _edges(balance: TensionBalance, loads: Loads, pulley: IntArray) -> FloatArray:
    """Factors at which pulleys slide: by Newton's method from the known states, or else by following the balance."""
    edges = _directly(balance, loads, pulley)
    rest = np.flatnonzero(np.isnan(edges))
    if rest.size:
        edges[rest] = _followed(balance, loads.of(rest), pulley[rest])
    return edges


def _known(balance: TensionBalance, count: int) -> tuple[FloatArray, FloatArray]:
    """Factors and unknowns of known states."""
    return np.ones(count), np.zeros((count, balance.scales.size))


def _pressing(balance: TensionBalance, loads: Loads, factor: FloatArray, unknowns: FloatArray) -> FloatArray:
    """Least tension that presses, beyond that of a span that counts as slack, N, shape (n,)."""
    mean = balance.tension.mean[loads.state].mean(axis=1)
    return np.asarray(balance.pressing(loads, factor, unknowns).min(axis=1) - _SLACK_TENSION * mean)


def _directly(balance: TensionBalance, loads: Loads, pulley: IntArray) -> FloatArray:
    """Newton's method for the unknowns of the balance and the factor; NaN where it leads to no state on that branch."""
    every = np.arange(pulley.size)
    factor, unknowns = _known(balance, pulley.size)
    sense, done, open_ = np.zeros(pulley.size), np.zeros(pulley.size, dtype=bool), every
    for number in range(_NEWTON_STEPS):
        some = loads.of(open_)
        step, slope = balance.newton_step(some, factor[open_], unknowns[open_], pulley[open_])
        if number == 0:
            sense = np.sign(slope)
        moved = balance.limited(some, factor[open_], unknowns[open_], step[:, :-1])
        whole = np.isclose(moved, step[:, :-1], rtol=1e-12, atol=0.0).all(axis=1)
        there = np.clip(factor[open_] + step[:, -1], factor[open_] / _MAX_FACTOR_STEP, factor[open_] * _MAX_FACTOR_STEP)
        settled = whole & (np.abs(there - factor[open_]) <= _ACCURACY * factor[open_])
        settled &= (np.abs(moved) <= _ACCURACY * balance.scales).all(axis=1) & (np.sign(slope) == sense[open_])
        unknowns[open_] += moved
        factor[open_] = there
        done[open_[settled]] = True
        open_ = open_[~settled & np.isfinite(step).all(axis=1)]
        if not open_.size:
            break
    return np.where(done & (_pressing(balance, loads, factor, unknowns) >= 0.0), factor, np.nan)


class _Place(NamedTuple):
    """States on the way of loads, a row for each."""

    factor: FloatArray
    """On the load."""
    unknowns: FloatArray
    """Of the balance."""
    spare: FloatArray
    """What is left to the end of the way, N: friction to be used, or released where the pulley slides at first, or
    tension that presses, if that is less; NaN where there is no balance."""

    def of(self, rows: BoolArray) -> "_Place":
        """Some of them."""
        return _Place(*(values[rows] for values in self))


class _Way(NamedTuple):
    """The ways on which loads change, a row for each."""

    balance: TensionBalance
    loads: Loads
    pulley: IntArray
    """That is to slide."""
    sense: FloatArray
    """1 where its friction carries more than the load in the known state, -1 otherwise."""

    def of(self, rows: IntArray) -> "_Way":
        """Some of them."""
        return _Way(self.balance, self.loads.of(rows), self.pulley[rows], self.sense[rows])

    def at(self, factor: FloatArray, guess: FloatArray) -> _Place:
        """The states under factors on loads, from guesses."""
        unknowns = self.balance.solve(self.loads, factor, guess)
        carried, held = _friction(self.balance, self.loads, self.pulley, factor, unknowns)
        pressing = _pressing(self.balance, self.loads, factor, unknowns)
        return _Place(factor, unknowns, np.minimum(self.sense * (held - carried), pressing))


def _friction(
    balance: TensionBalance, loads: Loads, pulley: IntArray, factor: FloatArray, unknowns: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """What friction carries at pulleys, and the most that it can carry, N, shape (n,)."""
    carried, held = balance.edge(loads, factor, unknowns)
    rows = np.arange(pulley.size)
    return carried[rows, pulley], held[rows, pulley]


def _followed(balance: TensionBalance, loads: Loads, pulley: IntArray) -> FloatArray:
    """The same by steps, to where the pulley slides, or else a span is slack or the balance is lost."""
    factor, unknowns = _known(balance, pulley.size)
    carried, held = _friction(balance, loads, pulley, factor, unknowns)
    way = _Way(balance, loads, pulley, np.where(held >= carried, 1.0, -1.0))
    spare = np.minimum(np.abs(held - carried), _pressing(balance, loads, factor, unknowns))
    before, earlier = unknowns.copy(), factor.copy()
    stride, edge = way.sense * np.log(_FIRST_STRIDE), np.where(held > 0.0, factor, 0.0)
    open_ = np.flatnonzero((held > 0.0) & (spare >= 0.0))
    for _ in range(_MAX_STRIDES):
        if not open_.size:
            break
        ahead = factor[open_] * np.exp(stride[open_])
        gone = factor[open_] - earlier[open_]
        slope = (unknowns[open_] - before[open_]) / np.where(gone == 0.0, np.inf, gone)[:, None]
        there = way.of(open_).at(ahead, unknowns[open_] + (ahead - factor[open_])[:, None] * slope)
        crossed, good = there.spare < 0.0, there.spare >= 0.0
        if crossed.any():
            rows = open_[crossed]
            edge[rows] = _between(way.of(rows), _Place(factor[rows], unknowns[rows], spare[rows]), there.of(crossed))
        rows = open_[good]
        before[rows], earlier[rows] = unknowns[rows], factor[rows]
        factor[rows], unknowns[rows], spare[rows] = there.of(good)
        edge[rows] = factor[rows]
        longer = np.minimum(_GROWTH * np.abs(stride[open_]), np.log(_LARGEST_STRIDE)) * np.sign(stride[open_])
        stride[open_] = np.where(good, longer, 0.5 * stride[open_])
        ended = crossed | (np.abs(stride[open_]) < _LOST_ACCURACY)
        ended |= (factor[open_] > _LARGEST_FACTOR) | (factor[open_] < 1.0 / _LARGEST_FACTOR)
        open_ = open_[~ended]
    return np.where(edge < 1.0 / _LARGEST_FACTOR, 0.0, edge)


def _between(way: _Way, near: _Place, far: _Place) -> FloatArray:
    """Factors at the ends of ways between two states, by the regula falsi (Illinois)."""
    low, high, a, b = near.factor.copy(), far.factor.copy(), near.spare.copy(), far.spare.copy()
    guess, root, open_ = near.unknowns.copy(), far.factor.copy(), np.arange(far.factor.size)
    side = np.zeros(root.size)
    for _ in range(_MAX_REFINEMENTS):
        if not open_.size:
            break
        root[open_] = (low - a * (high - low) / np.where(a == b, 1.0, b - a))[open_]
        here = way.of(open_).at(root[open_], guess[open_])
        now = np.where(np.isnan(here.spare), b[open_], here.spare)
        same = now >= 0.0
        again = side[open_] == np.where(same, 1.0, -1.0)
        side[open_] = np.where(same, 1.0, -1.0)
        low[open_], high[open_] = np.where(same, root[open_], low[open_]), np.where(same, high[open_], root[open_])
        other = np.where(again, 0.5, 1.0)
        a[open_], b[open_] = np.where(same, now, other * a[open_]), np.where(same, other * b[open_], now)
        guess[open_] = np.where((same & np.isfinite(here.spare))[:, None], here.unknowns, guess[open_])
        near_edge = np.abs(now) <= _ACCURACY * way.balance.scales[0]
        open_ = open_[~near_edge & (np.abs(high - low)[open_] > _ACCURACY * root[open_])]
    return root

"""Squeal: from which load on friction feeds a vibration of the drive, on which pulley, and at which frequency.

Friction that falls with the slip velocity by -d(mu f_n)/dv per length damps a sliding belt negatively.  A mass m on a
sliding belt grows by -(c + N dmu/dv) / 2m; of a drive all small motions about steady running are looked at.  Where a
vibration grows, friction on a pulley puts power into it, on an average over a period

    P = -Re((s x)* (K_f + s C_f) x) / 2

with the parts K_f, C_f of stiffness and damping that the friction of this pulley makes.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.contact.friction.creep_rate import CREEP_KEYS
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.model.contact import LAW_KEYS, Contact
from beltdyn.model.friction_state import FRICTION_STATES, FrictionState
from beltdyn.parts.messages import listing, plain
from beltdyn.points.changed_drive import held_at, is_motor, with_load
from beltdyn.results import Run, Variable, summarize
from beltdyn.solvers.eigenvalues import growing_swings, pencil
from beltdyn.solvers.flutter import Vibrations
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.state.linearized import SmallMotions
from beltdyn.state.steady import steady_state
from beltdyn.vibration.small_motions import about_steady

if TYPE_CHECKING:
    import xarray as xr

AS_GIVEN = "given"
"""Friction of the drive file, in place of that of a state."""
HIGHEST_FREQUENCY = 5e3
"""Frequency up to which squeal is looked for, Hz: beyond it the section of the belt does not move as one."""
LEAST_GROWTH = 0.01
"""Growth rate over angular frequency from which on a vibration counts: cords and rubber lose at least as much (loss
factor 0.02), which the linear motion of the belt does not have."""
_POINTS = 12
"""Loads at which small motions are looked at."""
_LEAST_LOAD, _MOST_LOAD = 0.05, 10.0
"""Least and largest factor on the loads."""
_BEFORE_SLIP = 0.99
"""Largest factor on the loads over that of gross slip: falling friction slips a little earlier."""
_ACCURACY = 0.01
"""Accuracy of the factor from which on the belt squeals, relative."""

_LOAD = ("squeal_load",)
VARIABLES = {
    "squeal": Variable((), "1", "Squeal", "str"),
    "squeal_from": Variable((), "1", "Squeal from this factor on all loads on"),
    "slip_from": Variable((), "1", "Gross slip from this factor on all loads on"),
    "squeal_growth": Variable(_LOAD, "1/s", "Growth rate, of the fastest growing vibration"),
    "squeal_frequency": Variable(_LOAD, "Hz", "Frequency, of the fastest growing vibration"),
    "squeal_pulley": Variable(_LOAD, "1", "Fed by, the pulley whose friction puts most power into it", "str"),
    "squeal_torque": Variable(_LOAD, "N m", "Torque, of the belt on that pulley"),
    "squeal_sliding": Variable(_LOAD, "1", "Sliding share, of the arc on that pulley"),
}
"""What is known of squeal, beside modes."""
COORDINATES = {"squeal_load": Variable(_LOAD, "1", "Load, factor on all loads of the drive")}


class SelfExcited(NamedTuple):
    """The fastest growing vibration under a load."""

    load: float
    """Factor on all loads."""
    growth: float
    """1/s; NaN where none grows."""
    frequency: float
    """Hz."""
    pulley: str
    """Whose friction feeds it."""
    torque: float
    """Of the belt on that pulley, N m."""
    sliding: float
    """Sliding share of its arc."""

    @property
    def squeals(self) -> bool:
        """Whether it grows faster than the material of the belt damps it."""
        return bool(self.growth > LEAST_GROWTH * 2.0 * np.pi * self.frequency)

    @property
    def words(self) -> str:
        """Where and how it vibrates."""
        where = (
            f"friction on {self.pulley}, which takes {self.torque:.3g} N m and slides on {self.sliding:.0%} of its arc"
        )
        return f"at {self.frequency:.4g} Hz, fed by {where}"


class Squeal(NamedTuple):
    """Self-excited vibrations over the load."""

    points: tuple[SelfExcited, ...]
    """By ascending load."""
    onset: SelfExcited | None
    """The least load under which the belt squeals; None if it does not."""
    slips_from: float
    """Factor on all loads at gross slip; NaN without loads."""
    state: str
    """State of friction."""

    @property
    def present(self) -> SelfExcited | None:
        """The vibration under the loads of the drive; None where the belt slips under them."""
        return next((point for point in self.points if point.load == 1.0), None)

    @property
    def words(self) -> str:
        """The answer in a sentence or two."""
        return f"{self._friction}{self._answer}"

    @property
    def _friction(self) -> str:
        if self.state == AS_GIVEN:
            return ""
        chosen = FRICTION_STATES[self.state]
        falls = f", falling to {chosen.friction * chosen.kinetic_ratio:.2g}" if chosen.kinetic_ratio < 1.0 else ""
        return f"{self.state} (friction {chosen.friction:g}{falls}): "

    @property
    def _answer(self) -> str:
        slips = f"; gross slip from {self.slips_from:.3g} times the loads" if np.isfinite(self.slips_from) else ""
        if self.onset is None:
            upper = f" up to {self.points[-1].load:.3g} times the loads" if np.isfinite(self.slips_from) else ""
            wet = ' With friction that falls with the slip velocity: squeal = "wet".' if self.state == AS_GIVEN else ""
            return f"no{upper}{slips}.{wet}"
        now = self.present
        if now is None:
            return f"the belt slips under its loads; squeals from {self._from}{slips}."
        if not now.squeals:
            return f"not under these loads, but from {self._from}{slips}."
        begins = f"; from {self._from}" if np.isfinite(self.slips_from) else ""
        return f"yes, {now.words}, growing by {plain(now.growth)} 1/s{begins}{slips}."

    @property
    def _from(self) -> str:
        assert self.onset is not None
        return f"{self.onset.load:.3g} times the loads on, {self.onset.words}"

    def beside(self, dataset: "xr.Dataset") -> "xr.Dataset":
        """A dataset with the answer."""
        values: dict[str, ArrayLike] = {
            "squeal": self.words,
            "squeal_from": np.nan if self.onset is None else self.onset.load,
            "slip_from": self.slips_from,
        }
        for name in SelfExcited._fields:
            values[f"squeal_{name}"] = np.array([getattr(point, name) for point in self.points])
        load = {name: (one.dims, values[name], one.attributes) for name, one in COORDINATES.items()}
        made = {name: (one.dims, values[name], one.attributes) for name, one in VARIABLES.items()}
        return dataset.assign_coords(load).assign(made).assign_attrs(answer=f"Squeal: {self.words}")


def in_state(drive: Drive, state: str) -> Drive:
    """The drive with the friction of a state on all pulleys that have friction; that of the file for `AS_GIVEN`."""
    if state == AS_GIVEN:
        return drive
    if state not in FRICTION_STATES:
        known = listing([f'"{name}"' for name in (AS_GIVEN, *FRICTION_STATES)])
        raise ModelError(f"squeal = {state!r} is not a state of friction. Give one of {known}.")
    chosen = FRICTION_STATES[state]
    pulleys = [pulley.replace(friction=chosen.friction) if pulley.friction else pulley for pulley in drive.pulleys]
    return drive.replace(contact=_contact(drive, chosen), pulley=pulleys)


def _contact(drive: Drive, chosen: FrictionState) -> Contact:
    """Contact with the law of a state, and the creep that is given."""
    contact, laws = drive.contact, LAW_KEYS[1]
    creep = {key.name: getattr(contact, key.name) for key in CREEP_KEYS}
    keys = dict.fromkeys(laws.names) | creep | {"friction": chosen.friction, "friction_law": "relative_creep"}
    if chosen.kinetic_ratio < 1.0:
        keys |= {
            "friction_law": "stribeck",
            "kinetic_ratio": chosen.kinetic_ratio,
            "stribeck_velocity": chosen.stribeck_velocity,
        }
    return contact.replace(**keys)


def squeal_of(
    drive: Drive, state: str, at: float | str | None, force_tolerance: float | None, tell: Report | None
) -> Squeal:
    """Look for self-excited vibrations over the load, up to gross slip."""
    held = held_at(in_state(drive, state), at)
    if held.belt.teeth is not None or not bool(np.any(held.frictions > 0.0)):
        raise ModelError("the belt is not held by friction, so that it does not squeal. Omit squeal.")
    search = _Search(held, force_tolerance, tell)
    first = search.at(1.0)
    if not _is_loaded(held):
        onset = first if first is not None and first.squeals else None
        return Squeal(() if first is None else (first,), onset, np.nan, state)
    slips_from = search.gross_slip()
    loads = np.linspace(0.0, min(_MOST_LOAD, _BEFORE_SLIP * slips_from), _POINTS + 1)[1:]
    if first is not None:
        loads = np.union1d(loads, 1.0)
    points = [point for load in loads.tolist() if (point := search.at(load)) is not None]
    number = next((number for number, point in enumerate(points) if point.squeals), None)
    if number is None:
        return Squeal(tuple(points), None, slips_from, state)
    quiet = points[number - 1].load if number else 0.0
    return Squeal(tuple(points), search.onset(quiet, points[number]), slips_from, state)


def _is_loaded(drive: Drive) -> bool:
    """Whether a factor on loads changes anything."""
    loads = any(not is_motor(load) for pulley in drive.pulleys for load in pulley.load)
    return loads or bool(drive.goods) or any(pulley.torque is not None for pulley in drive.pulleys)


class _Search:
    """Vibrations of a drive under multiples of its loads, steady running of each found from that of the one before."""

    def __init__(self, drive: Drive, force_tolerance: float | None, tell: Report | None) -> None:
        self._drive, self._force_tolerance, self._tell = drive, force_tolerance, tell
        self._known = dict[float, SelfExcited | None]()
        self._near: Run | None = None

    def at(self, load: float) -> SelfExcited | None:
        """The fastest growing vibration under a load; None without steady running."""
        if load not in self._known:
            if self._tell is not None:
                self._tell(Progress(len(self._known), max(_POINTS, len(self._known)), 0.0, 0, "operating points"))
            try:
                run = steady_state(
                    with_load(self._drive, load), force_tolerance=self._force_tolerance, start=self._near
                )
                self._near, self._known[load] = run, fastest(run, load)
            except ConvergenceError:
                self._known[load] = None
        return self._known[load]

    def gross_slip(self) -> float:
        """Factor on all loads at gross slip, by the slip safety under the loads, or less where the belt slips there."""
        load = 1.0
        while self.at(load) is None:
            load *= 0.5
            if load < _LEAST_LOAD:
                raise ConvergenceError("no steady running found under any load. Increase the tension or the friction.")
        assert self._near is not None
        return load * float(np.nanmin([pulley.slip_safety for pulley in summarize(self._near).pulleys]))

    def onset(self, quiet: float, loud: SelfExcited) -> SelfExcited:
        """The least load under which the belt squeals, between one under which it does not and one under which it does.

        A load without steady running counts as quiet.
        """
        while loud.load - quiet > _ACCURACY * loud.load:
            load = 0.5 * (quiet + loud.load)
            between = self.at(load)
            if between is not None and between.squeals:
                loud = between
            else:
                quiet = load
        return loud


def fastest(run: Run, load: float = 1.0) -> SelfExcited:
    """The self-excited vibration about steady running that counts and grows fastest, or else the fastest of all."""
    motions = about_steady(run)
    given = pencil(motions.stiffness, motions.damping, motions.mass, motions.free)
    values, vectors = growing_swings(given, 2.0 * np.pi * HIGHEST_FREQUENCY)
    nothing = SelfExcited(load, np.nan, np.nan, "", np.nan, np.nan)
    if not values.size:
        return nothing
    number = int(np.argmax(values.real > LEAST_GROWTH * values.imag))
    value, vector = complex(values[number]), given.coordinates(values, vectors)[:, number]
    fed = friction_power(motions, value, vector)
    pulley = summarize(run).pulleys[int(np.argmax(fed))]
    sliding = pulley.sliding_arc / pulley.wrap_angle
    frequency = value.imag / (2.0 * np.pi)
    return SelfExcited(load, value.real, frequency, pulley.name, abs(pulley.belt_torque), sliding)


def friction_power(motions: SmallMotions, value: complex, vector: ComplexArray) -> FloatArray:
    """Power that friction on each pulley puts into a vibration, W for displacements in m, shape (P,)."""
    velocity = value * vector
    power = np.zeros(motions.system.pulleys.size)
    for number in range(power.size):
        smooth = motions.system.pulleys.copy()
        smooth["friction"][number] = 0.0
        vibrations = Vibrations(motions.system._replace(pulleys=smooth))
        tangents = vibrations.tangents(0.0, motions.state.position, motions.state.velocity)
        stiffness, damping, _ = map(vibrations.matrix, tangents)
        force = (motions.stiffness - stiffness) @ vector + (motions.damping - damping) @ velocity
        power[number] = -0.5 * float(np.real(np.vdot(velocity, force)))
    return power

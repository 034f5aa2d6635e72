"""Why a drive has no steady running: which pulley slips, and the torque that it transmits at most.

Beyond gross slip a solution may go on: a belt that slows down while its driver turns is pressed to the pulleys by what
its inertia took before.  What a pulley transmits is told where its slip becomes gross.
"""

from collections.abc import Sequence
from math import exp, log
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared
from beltdyn.parts.messages import beyond, listing
from beltdyn.parts.quantity import RPM
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import own_torque
from beltdyn.system.nips import seen_nips
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe
from beltdyn.system.state import State, curve_lengths
from beltdyn.system.web import WebLine

_FULL = 0.9
"""Use of friction of a pulley that slips as a whole, at least."""
_ALIKE = 0.98
"""Of pulleys that use so much of the friction that the worst one does, the one that takes most power is named."""
_MAX_EXTRAPOLATED_SLIP = 0.99
"""Largest slip from which the speed without slip is extrapolated."""
GROSS = 0.01
"""Slip beyond elastic creep that is gross.  With 0.05 a belt that lags behind its driver has regained what its inertia
took from the pressure on the pulleys, and limits come out 4 % too large."""


SLACK = 0.02
"""Effective tension of the slackest span over that of the tightest one below which it is slack: infinite friction would
transmit 2 % more."""


class Setting(NamedTuple):
    """Distance of a drive from the required one."""

    speed: float = 1.0
    """Factor on prescribed speeds."""
    load: float = 1.0
    """Factor on torques and loads."""
    smoothing: float = 1.0
    """Factor on the slip velocity at which friction is fully used."""
    support: float = 0.0
    """Part of the torque that keeps a motor at the speed at which it was held."""
    stretch_length: float = 1.0
    """Factor on the length over which hysteresis smoothes slow changes of the stretch; small, it is viscous damping."""
    bending_loss: float = 1.0
    """Factor on the hysteresis of bending."""


class Passed(NamedTuple):
    """Steady running during the increase of the loads, in the order of the curve."""

    setting: Setting
    state: State
    belt_parameter: float
    """Length of unstretched belt that passes in a second, m/s."""
    tensions: FloatArray
    """Of the spans, N."""
    torques: FloatArray
    """Of the belt on each pulley, N m."""
    used: FloatArray
    """Part of the friction of each pulley that is used."""
    slips: FloatArray
    """Of each pulley, beyond the elastic creep of the belt."""

    @classmethod
    def at(cls, setting: Setting, prepared: Prepared, system: System, state: State) -> "Passed":
        """What is observed at a state, to which the speed and the places of the frame of the system belong."""
        place = State(state.position.copy(), state.velocity.copy(), np.zeros_like(state.position))
        belt = float(system.frame.speed[0])
        seen = observe(system, np.zeros(1), place.position[None], place.velocity[None])
        tensions = np.asarray(seen.span_tension[0])
        slips = _slips(prepared, system, place, belt, tensions)
        return cls(setting, place, belt, tensions, np.asarray(seen.pulley_torque[0]), _used(system, place, seen), slips)


class Refusal(NamedTuple):
    """Why there is no steady running."""

    reason: str
    is_limit: bool
    """Whether it is a limit of the drive, and not one of the search; a web may slide on some rollers and run."""


def slip_limit(prepared: Prepared, system: System, asked: System, passed: Sequence[Passed]) -> Refusal:
    """Name what ends the increase of the loads: the pulley that slips and the torque it transmits, or a tensioner."""
    if not passed:
        return Refusal(
            "the search does not get from the belt at rest to one that runs without loads. Simulate the drive over "
            "time with `beltdyn simulate`.",
            False,
        )
    if isinstance(asked.carriage, WebLine) and (ratio := _web_slips(prepared, asked, asked.carriage, passed[0])):
        return Refusal(ratio, True)
    slips = gross_slips(passed)
    sliding = np.flatnonzero(np.max(slips, axis=1) > GROSS)
    at = int(sliding[0]) if sliding.size else int(np.argmax([one.setting.load for one in passed]))
    here = passed[at]
    torques, used = here.torques, here.used.copy()
    used[[_idles(asked, here, p) for p in range(used.size)]] = 0.0
    used[prepared.drive.guides] = 0.0
    taken = torques * here.state.velocity[system.first_body :][: used.size]
    worst = int(np.argmax(slips[at] if sliding.size else np.where(used > _ALIKE * used.max(), taken, -np.inf)))
    if not sliding.size and used[worst] < _FULL:
        return _without_slip(prepared, passed, at, used)
    torque = abs(float(torques[worst]))
    if at > 0:  # where its slip becomes gross
        before, slip = float(passed[at - 1].torques[worst]), slips[at - 1 : at + 1, worst]
        part = (min(GROSS, slip[1]) - slip[0]) / (slip[1] - slip[0]) if slip[1] > slip[0] else 1.0
        torque = abs(before + part * (float(torques[worst]) - before))
    tensions = Tensions.of(prepared, passed[: at + 1])
    reason = _slipping(prepared, asked, passed[at], worst, torque, slips[at], tensions)
    return Refusal(reason, not prepared.drive.is_web)


class Tensions(NamedTuple):
    """Effective tensions of the spans on the way to a limit, T - m v^2, N."""

    inertia: float
    """m v^2, N."""
    first: FloatArray
    """Of the first solution."""
    last: FloatArray
    sets_tension: bool
    """Whether the first solution has no loads, and the tension without loads is that of a belt of constant length."""

    @classmethod
    def of(cls, prepared: Prepared, passed: Sequence[Passed]) -> "Tensions":
        """From solutions."""
        inertia = prepared.belt.mass_per_length * passed[-1].belt_parameter ** 2
        first, last = (solution.tensions - inertia for solution in (passed[0], passed[-1]))
        fixed = not (prepared.moving_tensioners or prepared.drive.is_web or prepared.carries)
        return cls(inertia, first, last, fixed and passed[0].setting.load == 0.0)

    @property
    def slack_span(self) -> int | None:
        """Number of the span that is slack; None without one."""
        span = int(np.nanargmin(self.last))
        return span if self.last[span] < SLACK * np.nanmax(self.last) else None

    def remedy(self, factor: float) -> str:
        """Tension without loads with which a pulley transmits so many times the torque."""
        if not self.sets_tension or factor <= 1.0:
            return "Raise the tension"
        tension = float(np.nanmean(self.first))
        present = tension + self.inertia
        least = beyond(present, factor * tension + self.inertia, 4)
        return f"Raise the tension without loads from {present:.4g} N to at least {least:.4g} N"


def slack(prepared: Prepared, tensions: Tensions) -> str | None:
    """Say which span goes slack; None without one."""
    span = tensions.slack_span
    if span is None:
        return None
    return "the span from `{}` to `{}` goes slack".format(*prepared.spans[span])


def _slipping(
    prepared: Prepared,
    asked: System,
    here: Passed,
    pulley: int,
    torque: float,
    slips: FloatArray,
    tensions: Tensions,
) -> str:
    """Say that a pulley slips at a torque (N m)."""
    wanted = abs(_asked_of(prepared, asked, here, slips, pulley))
    of = f" of the {wanted:.4g} N m required" if wanted > torque else ""
    speed = RPM * abs(float(here.state.velocity[asked.first_body + pulley]))
    if pulley in prepared.path.beside:
        return (
            f"the belt slips in the nip of `{prepared.pulleys[pulley].name}`, which transmits at most {torque:.4g} N m"
            f"{of} by this force of the nip. Raise it or the friction, or reduce the load."
        )
    slips_on = (
        f"the belt slips on `{prepared.pulleys[pulley].name}`, which transmits at most {torque:.4g} N m{of} at this "
        f"tension ({speed:.4g} rpm)"
    )
    remedy, goes_slack = tensions.remedy(wanted / torque if torque > 0.0 else 1.0), slack(prepared, tensions)
    if goes_slack:
        return f"{slips_on}, as {goes_slack}. {remedy}, or reduce the load; more friction does not help."
    return f"{slips_on}. {remedy}, the friction or the wrap angle, or reduce the load."


def _web_slips(prepared: Prepared, asked: System, line: WebLine, here: Passed) -> str | None:
    """Say that the tensions at the ends of a web differ by more than its rollers hold; None where they may not.

    Over driven rollers ln(T - m v^2) changes by at most mu theta, over held ones it grows by that; others must idle.
    `here`: the first state that was passed, since a web that slips through may run at any speed.
    """
    rollers = range(prepared.path.count)
    prescribed = asked.bodies.unknown[asked.pulleys.shaft] < 0
    if prepared.path.beside or not all(prescribed[p] or _idles(asked, here, p) for p in rollers):
        return None
    stretch = prepared.belt.stretch_parameters.stretch(line.ends.tensions)
    enters, leaves = line.ends.tensions - prepared.belt.mass_per_length * (here.belt_parameter * stretch) ** 2
    if not min(enters, leaves) > 0.0:
        return None
    grips, held = asked.pulleys.friction * prepared.path.wrap_angles, prepared.drive.guides
    driven = prescribed & ~held
    grown, most = float(grips[held].sum()), float(grips[driven].sum())
    if grown - most <= log(leaves / enters) <= grown + most:
        return None
    least, largest = exp(grown - most), exp(grown + most)
    names = listing([f"`{prepared.pulleys[p].name}`" for p in np.flatnonzero(driven).tolist()])
    others = " and that of held rollers" if grown else ""
    return (
        f"the web slips on {names}, whose friction{others} allows {least:.4g} to {largest:.4g} times the tension of "
        f"the unwinder at the winder (T - m v^2), where {leaves / enters:.4g} is required. Bring both tensions nearer "
        "to each other, raise the friction or the wrap angles, or drive another roller."
    )


def _without_slip(prepared: Prepared, passed: Sequence[Passed], at: int, used: FloatArray) -> Refusal:
    """Say what ends the increase of the loads where no pulley slips: a tensioner without balance, or the search."""
    here, tensioners = passed[at], prepared.moving_tensioners
    if tensioners and at < len(passed) - 1:
        places = here.state.position[here.state.position.size - len(tensioners) :].tolist()
        reaches = [each.tensioner.reach(prepared.path.centers[each.pulley]) for each in prepared.carriers]
        moved = np.abs(np.multiply(places, reaches))
        number = int(np.argmax(moved))
        return Refusal(
            f"the tensioner of `{tensioners[number].pulley}` balances the belt up to {here.setting.load:.1%} of the "
            f"loads, where it stands at {tensioners[number].written(places[number])}; beyond that its spring gives "
            "way. Use a stiffer spring or a stop that holds it, or reduce the load.",
            True,
        )
    worst = int(np.argmax(used))
    return Refusal(
        f"the search ends at {here.setting.load:.1%} of the loads, where `{prepared.pulleys[worst].name}` uses "
        f"{used[worst]:.0%} of its friction. Simulate the drive over time with `beltdyn simulate`.",
        False,
    )


def gross_slips(passed: Sequence[Passed]) -> FloatArray:
    """Slip of each pulley beyond the elastic creep of the belt, shape (k, P); zero where it slips in the first one.

    An idler that slips at the least loads already limits nothing.
    """
    slips = np.array([solution.slips for solution in passed])
    slips[:, slips[0] > GROSS] = 0.0
    return slips


def _slips(prepared: Prepared, system: System, state: State, belt_parameter: float, tensions: FloatArray) -> FloatArray:
    """How far the speed of each rim lies beyond those of the belt in both spans beside it, over the larger of them.

    Between them lies the rim of a pulley on which the belt creeps.
    """
    rims = np.abs(state.velocity[system.first_body :][: system.pulleys.size] * prepared.rolling_radii)
    strain = np.nan_to_num(tensions) / system.element.section.stretch.stiffness
    belt, path = abs(belt_parameter) * (1.0 + strain), prepared.path
    spans = np.stack([belt[path.reaching], belt[path.leaving]])
    beyond = np.maximum(np.min(spans, axis=0) - rims, rims - np.max(spans, axis=0))
    return np.asarray(np.maximum(beyond, 0.0) / np.maximum(rims, np.max(spans, axis=0)))


def _used(system: System, state: State, seen: Observations) -> FloatArray:
    """Part of the friction of each pulley that is used."""
    touched, normal, friction = (given[0] for given in (seen.contact_pulley, seen.normal_force, seen.friction_force))
    weights = np.outer(curve_lengths(system), system.contact.weights).ravel()
    used = np.zeros(system.pulleys.size)
    for p, coefficient in enumerate(system.pulleys.friction):
        here = touched == p
        limit = coefficient * float(np.sum((weights * normal)[here]))
        used[p] = abs(float(np.sum((weights * friction)[here]))) / limit if limit > 0.0 else 0.0
    nips = seen_nips(system, state.position[None], state.velocity[None])
    for row, p in enumerate(np.flatnonzero(system.pulleys.beside).tolist() if nips else ()):
        assert nips is not None
        pressed, along = (float(weights @ force[0, row]) for force in (nips.nip_normal_force, nips.nip_friction_force))
        limit = float(system.pulleys.friction[p]) * pressed
        used[p] = abs(along) / limit if limit > 0.0 else 0.0
    return used


def _idles(asked: System, here: Passed, pulley: int) -> bool:
    """Whether a pulley has neither load nor motor nor prescribed speed."""
    shaft = int(asked.pulleys.shaft[pulley])
    speed = float(here.state.velocity[asked.first_body + shaft])
    return bool(asked.bodies.unknown[shaft] >= 0 and own_torque(asked, here.state, pulley, speed) == 0.0)


def _asked_of(prepared: Prepared, asked: System, last: Passed, slips: FloatArray, pulley: int) -> float:
    """Torque of the loads of a pulley without slip, or else what those of the others need of it, N m."""
    shafts = asked.pulleys.shaft
    speeds = last.state.velocity[asked.first_body + shafts] / (1.0 - np.minimum(slips, _MAX_EXTRAPOLATED_SLIP))
    torques = np.array([own_torque(asked, last.state, p, float(speed)) for p, speed in enumerate(speeds)])
    if asked.bodies.unknown[shafts[pulley]] >= 0:
        return float(torques[pulley])
    free = asked.bodies.unknown[shafts] >= 0
    return float(np.sum((torques / prepared.path.radii)[free])) * float(prepared.path.radii[pulley])

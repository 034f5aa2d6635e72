"""Checks of what machines and belts of special kinds do: tensioners on their stops, goods on inclines, teeth."""

from collections.abc import Iterator

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.machines import Support
from beltdyn.model import off_the_stop, unstable_balance
from beltdyn.model.carrying import in_batch, lies_on, upper_side
from beltdyn.parts.messages import NOTABLE, Finding, beyond, listing, plain
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.incidents import jumps_in, on_stops
from beltdyn.theory.span import sag_ratio

GROWTH = "growth"
"""Attribute of steady running: the fastest growing motion about it, growth rate and angular frequency, 1/s."""
FRICTION_USED = "friction_used_after_"
"""Attributes of steady running, for tensioning and yielding: part of dry friction of tensioners at which it ends."""


def unstable_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners whose static equilibrium is unstable."""
    names = str(evidence.recorded.attrs.get("unstable_tensioners", ""))
    if names:
        yield unstable_balance(names.split(", "))


def unstable_control(evidence: Evidence) -> Iterator[Finding]:
    """Controllers that make steady running unstable."""
    if GROWTH in evidence.recorded.attrs:
        rate, swing = np.asarray(evidence.recorded.attrs[GROWTH], dtype=float)
        how = f"with {swing / (2.0 * np.pi):.3g} Hz" if swing > 0.0 else "without swinging"
        yield Finding(
            f"steady running is unstable: a small motion grows by {rate:.3g} 1/s {how}.",
            f"The controlled drive does not remain in it: after {np.log(10.0) / rate:.2g} s a disturbance is ten times "
            "as large.",
            "Reduce the gain of the controller, or increase its integral_time."
            if swing > 0.0
            else "Reverse the sign of the gain: rollers before the sensor need a negative one for their speed.",
        )


def held_too_far(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners that dry friction may hold where there is no steady running."""
    for name in ("tensioning", "yielding"):
        used = evidence.recorded.attrs.get(f"{FRICTION_USED}{name}")
        if used is not None:
            pulleys = [one.pulley for one in evidence.prepared.moving_tensioners if getattr(one, f"{name}_friction")]
            yield Finding(
                f"dry friction may hold the tensioner of {listing(pulleys)} where the belt does not run under these "
                f"loads: {float(used):.0%} of its friction after {name} suffice.",
                "The belt slips there, or goes slack; the slip safety is that of a tensioner without dry friction.",
                "Reduce the dry friction of the tensioner, raise its preload, or reduce the loads.",
            )


def stopped_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners on a stop at any time, and when."""
    for number, tensioner in enumerate(evidence.prepared.moving_tensioners):
        if tensioner.stops is None:
            continue
        lower, upper = (on[:, number] for on in on_stops(evidence.recorded, evidence.prepared))
        for name, on in (("lower", lower), ("upper", upper)):
            if on.any():
                tension = float(np.nanmean(np.asarray(evidence.recorded["span_tension"])[on]))
                yield Finding(
                    f"the tensioner of {tensioner.pulley} {_when(on, evidence.time, name)}.",
                    f"On the stop the belt length, not the spring, sets the tension ({tension:.4g} N on average).",
                    off_the_stop(name),
                )


def _when(on: BoolArray, time: FloatArray, stop: str) -> str:
    """Since when it is on a stop, or when and how often it was."""
    starts = np.flatnonzero(on & ~np.append(False, on[:-1]))
    if on[-1]:
        since = f" since t = {time[starts[-1]]:.4g} s" if len(time) > 1 else ""
        before = f", and first reached it at t = {time[starts[0]]:.4g} s" if starts[1:].size else ""
        return f"is on its {stop} stop{since}{before}"
    last = float(time[np.flatnonzero(on)[-1]])
    often = f", {len(starts)} times" if len(starts) > 1 else ""
    return f"was on its {stop} stop between t = {time[starts[0]]:.4g} s and {last:.4g} s{often}"


MOST_SAG = 0.01
"""Largest sag over the spacing of idlers that passes without a warning: the usual rule for conveyors."""


def sagging_belt(evidence: Evidence) -> Iterator[Finding]:
    """Supports between whose idlers the belt sags too far at any time, with the goods that are on it."""
    fields, tension = (np.asarray(evidence.recorded[name]) for name in ("field_time", "belt_tension"))
    found, needed, places = list[str](), 0.0, list[str]()
    for number, support in enumerate(evidence.prepared.supports, 1):
        if not support.free_length > 0.0:
            continue
        on, weight = _on_support(evidence, support, fields)
        taut = np.maximum(tension[:, on], weight * support.free_length)  # below it hangs slack, and no spacing helps
        sag = sag_ratio(1.0, support.free_length, 1.0) * weight / taut
        if not sag.size or not sag.max() > (1.0 + NOTABLE) * MOST_SAG:
            continue
        row, column = np.unravel_index(int(sag.argmax()), sag.shape)
        least = sag_ratio(float(weight[row, column]), support.free_length, MOST_SAG)
        found.append(
            f"{sag[row, column]:.2g} of the spacing of support[{number}], {'-'.join(support.span)}, at t = "
            f"{fields[row]:.4g} s, where its tension is {plain(tension[:, on][row, column])} N"
        )
        needed, spacing = max(needed, least), support.free_length * MOST_SAG / float(sag[row, column])
        if tension[:, on][row, column] > weight[row, column] * support.free_length:
            places.append(f"{plain(beyond(support.free_length, spacing, 3))} m apart in support[{number}]")
    if found:
        yield Finding(
            f"the belt sags between idlers by {listing(found)}, more than {MOST_SAG:.0%}.",
            "Goods work on the belt and may spill; the idlers resist more than their friction coefficient says.",
            f"Raise the least tension to {plain(beyond(0.0, needed, 3))} N by a heavier take-up"
            f"{f', or place idlers {listing(places)}' if places else ''}.",
        )


def _on_support(evidence: Evidence, support: Support, fields: FloatArray) -> tuple[IntArray, FloatArray]:
    """Numbers of the elements on a support, and the weight across the belt there over time, N/m, shape (t, e)."""
    prepared, place = evidence.prepared, np.asarray(evidence.recorded["element_coordinate"])
    stretch = prepared.stretch(support)
    on = np.flatnonzero(lies_on(prepared.laid, stretch, place))
    mass = np.full((fields.size, on.size), prepared.belt.mass_per_length)
    for one in prepared.goods:
        share = np.ones(fields.size) if one.schedule is None else one.schedule.at(fields)
        on_it = lies_on(prepared.laid, prepared.stretch(one), place[on])
        if one.batch is not None:
            passed = _passed(evidence, fields)[:, None]
            on_it = on_it & in_batch(prepared.laid, prepared.stretch(one), one, place[on], passed)
        mass += one.mass_per_length * share[:, None] * on_it
    normal = upper_side(stretch.direction, prepared.gravity)
    return on, mass * abs(float(normal @ np.array(prepared.gravity)))


def _passed(evidence: Evidence, fields: FloatArray) -> FloatArray:
    """Unstretched lengths of belt that have passed at instants (s), m, shape (t,)."""
    time = evidence.time
    speed = np.nanmean(evidence.recorded["belt_speed"], axis=1) / evidence.prepared.laid.stretch
    passed = np.append(0.0, np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time)))
    return np.asarray(np.interp(fields, time, passed))


LIFTS = 1.01
"""Margin to a jump below which lands carry next to nothing."""


def lifted_teeth(evidence: Evidence) -> Iterator[Finding]:
    """Teeth whose flanks carry all that presses the belt on, so that they lift, at any of some outputs."""
    lifted = {one.name: one.jump_margin for one in evidence.tooth_loads if one.jump_margin < LIFTS}
    if lifted:
        yield Finding(
            f"teeth lift off {listing([f'{name} at {margin:.0%} of the load' for name, margin in lifted.items()])}.",
            "The belt rides up there, and jumps under a little more load.",
            "Raise the tension, reduce the load, or increase the wrap angle.",
        )


def jumped_teeth(evidence: Evidence) -> Iterator[Finding]:
    """A belt that has jumped to other grooves."""
    events = jumps_in(evidence.recorded, [pulley.name for pulley in evidence.prepared.pulleys])
    if not events:
        return
    counts = {name: sum(one.name == name for one in events) for name in dict.fromkeys(one.name for one in events)}
    teeth = [f"{count} {'tooth' if count == 1 else 'teeth'} on {name}" for name, count in counts.items()]
    yield Finding(
        f"the belt jumps {listing(teeth)}, first at {events[0].time:.4g} s.",
        "Pulleys lose their angles against each other, and the belt is damaged.",
        "Raise the tension, reduce the load or its peaks, or increase the wrap angle.",
    )


def overloaded_teeth(evidence: Evidence) -> Iterator[Finding]:
    """Teeth that carry more than allowed, at any of some outputs."""
    over = [one for one in evidence.tooth_loads if one.largest > one.allowed]
    if over:
        worst, allowed = {one.name: one.largest for one in over}, over[0].allowed
        factor = beyond(1.0, max(worst.values()) / allowed, 3)
        yield Finding(
            f"a tooth carries {listing([f'{load:.4g} N on {name}' for name, load in worst.items()])}; the belt allows "
            f"{allowed:.4g} N.",
            "Teeth shear off early.",
            f"Choose a belt {factor:.3g} times as wide, or a pulley with more teeth in mesh, or reduce the load.",
        )

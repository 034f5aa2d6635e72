"""Loads of the teeth of a belt on its pulleys, and how far they are from jumping.

A spread tooth carries the traction over a pitch of the belt.  Its flanks, at the angle phi to the normal, push the belt
off by the force times tan(phi); the tension, less m v^2, presses it on by (T - m v^2) p / R.  Where flanks carry all of
that and the lands nothing, the tooth lifts, and the belt begins to jump there.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import Prepared
from beltdyn.results.mechanics import cells
from beltdyn.results.schema import InMemory, Recorded

if TYPE_CHECKING:
    from beltdyn.results.result import Result

_INSTANTS = 40
"""Largest number of outputs along the belt that are looked at for extremes."""
_SLIVER = 1e-6
"""Part of a pitch at the end of an arc that rounding leaves, and that is no tooth."""
_LEAST = 1e-9
"""Traction of teeth over the largest one, below which nothing lifts them."""


@dataclass(frozen=True, slots=True)
class ToothLoads:
    """Loads of the teeth on a pulley, over the arc from the inlet in the direction of ascending belt coordinate.

    Examples
    --------
    >>> bd.results.tooth_loads(bd.steady_state(drive))  # its belt has no teeth
    ()
    """

    name: str
    """Name of the pulley."""
    in_mesh: float
    """Teeth in mesh: length of belt that touches over the pitch."""
    largest: float
    """Largest force on a tooth along the belt, N; of spread teeth the largest traction times the pitch."""
    allowed: float
    """Allowed force on a tooth, N; NaN if it is not known."""
    jump_margin: float
    """Least ratio of what presses a tooth on to what its flanks push it off; at 1 a tooth lifts. Infinite without a
    flank angle."""
    places: FloatArray
    """Middles of teeth along the arc, pitches from the inlet, shape (n,); lifted teeth hold a little outside, and the
    last of spread teeth is the part of a pitch that the arc leaves."""
    loads: FloatArray
    """Forces on these teeth along the belt, N, shape (n,); positive where they push it on."""


def tooth_loads(run: "Result", time: float | None = None) -> tuple[ToothLoads, ...]:
    """Loads of the teeth of a belt in a run or in steady running.

    Parameters
    ----------
    run : Run
        The run.
    time : float, optional
        Instant of an output along the belt, s; by default the last one.

    Returns
    -------
    tuple of ToothLoads
        One for each pulley with teeth that the belt touches; empty for a belt without teeth.

    Raises
    ------
    ModelError
        If the result is not a run.

    Examples
    --------
    >>> bd.results.tooth_loads(run)
    ()
    """
    if run.kind != RUN:
        raise ModelError(f"loads of teeth need results over time; these are of {run.kind}. Use a run.")
    if run.prepared.belt.teeth is None:
        return ()
    times = run.dataset["field_time"].values
    number = times.size - 1 if time is None else int(np.argmin(np.abs(times - time)))
    return loads_at(InMemory(run.dataset), run.prepared, number)


def loads_at(recorded: Recorded, prepared: Prepared, number: int) -> tuple[ToothLoads, ...]:
    """Loads of teeth at an output along the belt, by its number."""
    toothing = prepared.belt.toothing
    if prepared.belt.teeth is None or toothing is None:
        return ()
    touched, traction, pressing = (
        np.asarray(recorded[name][number]) for name in ("contact_pulley", "friction_force", "normal_force")
    )
    held = _held_by(recorded, prepared, number)
    along, length, pitch = np.asarray(recorded["belt_coordinate"]), prepared.belt_length, prepared.belt.given_pitch
    cell = cells(along, length)
    sense = -1.0 if np.nansum(np.asarray(recorded["belt_speed"])[-1]) < 0.0 else 1.0
    flank = float(np.tan(toothing.flank_angle))
    most = np.nan if toothing.largest_tooth_load is None else toothing.largest_tooth_load
    found = list[ToothLoads]()
    for p, pulley in enumerate(prepared.pulleys):
        here = np.flatnonzero((touched == p) | (held == p))
        if not pulley.teeth or not here.size:
            continue
        place = np.mod(along[here] - _inlet(along, here, length), length)
        order = np.argsort(place)
        here, place = here[order], place[order]
        seated = touched[here] == p
        place -= place[seated][0] if seated.any() else 0.0
        whole = _Arc(place, cell[here], pressing[here], traction[here])
        arc = whole.only(seated)
        if "tooth_force" in recorded:
            ahead = np.mod(np.asarray(recorded["tooth_coordinate"]) - along[here[0]] + pitch, length) - pitch
            one = _single(arc, ahead, np.asarray(recorded["tooth_force"][number]), pitch, flank)
        else:
            one = _spread(whole, arc, pitch, flank)
        found.append(
            ToothLoads(
                name=pulley.name,
                in_mesh=arc.extent / pitch,
                largest=one.largest,
                allowed=most,
                jump_margin=one.margin,
                places=one.places / pitch,
                loads=sense * one.loads,
            )
        )
    return tuple(found)


class _Arc(NamedTuple):
    """Points on an arc of contact."""

    place: FloatArray
    """From the first one, m."""
    share: FloatArray
    """Length of belt of each, m."""
    pressing: FloatArray
    """Normal force, N/m."""
    traction: FloatArray
    """Force along the belt, N/m."""

    def only(self, points: BoolArray) -> "_Arc":
        """Some of the points."""
        return _Arc(*(values[points] for values in self))

    @property
    def length(self) -> float:
        """Length of belt, m."""
        return float(self.share.sum())

    @property
    def extent(self) -> float:
        """The same with what lies free between lands, m."""
        if not self.place.size:
            return 0.0
        return float(self.place[-1] + 0.5 * (self.share[0] + self.share[-1]))


class _Found(NamedTuple):
    """Loads of the teeth on an arc."""

    largest: float
    """N."""
    margin: float
    places: FloatArray
    """m."""
    loads: FloatArray
    """N."""


def _spread(whole: _Arc, arc: _Arc, pitch: float, flank: float) -> _Found:
    """Loads of spread teeth: of each pitch of the belt that they hold, the last in part, of which an arc touches."""
    begin = float(whole.place[0] - 0.5 * whole.share[0])
    ends = begin + np.cumsum(np.append(0.0, whole.share))
    carried = np.cumsum(np.append(0.0, whole.share * whole.traction))
    borders = np.append(np.arange(begin, ends[-1] - _SLIVER * pitch, pitch), ends[-1])
    middles: FloatArray = np.asarray(0.5 * (borders[:-1] + borders[1:]), dtype=float)
    loads: FloatArray = np.diff(np.interp(borders, ends, carried))
    largest = pitch * float(np.max(np.abs(whole.traction)))
    if not arc.place.size:
        return _Found(largest, 1.0 if flank > 0.0 else np.inf, middles, loads)
    seated = max(1, round(arc.length / pitch))
    pressed, pushed = (_means(arc.place, arc.share, values, seated) for values in (arc.pressing, arc.traction))
    return _Found(largest, _margin(pressed, np.abs(pushed) * flank), middles, loads)


def _held_by(recorded: Recorded, prepared: Prepared, number: int) -> IntArray:
    """Numbers of the pulleys whose teeth hold points of the belt that do not touch; -1 of all others."""
    touched, traction = (np.asarray(recorded[name][number]) for name in ("contact_pulley", "friction_force"))
    lifted, toothed = (touched < 0) & (traction != 0.0), np.flatnonzero(prepared.toothed)
    held = np.full(touched.size, -1)
    if not lifted.any():
        return held
    instant = int(np.searchsorted(np.asarray(recorded["time"]), np.asarray(recorded["field_time"])[number]))
    centers = np.asarray(recorded["pulley_center"][min(instant, len(recorded["time"]) - 1)])[toothed]
    away = np.asarray(recorded["contact_position"][number])[lifted, None] - centers
    nearest = toothed[np.argmin(np.hypot(away[..., 0], away[..., 1]) - np.asarray(prepared.radii)[toothed], axis=1)]
    held[lifted] = nearest
    return held


def _single(arc: _Arc, ahead: FloatArray, force: FloatArray, pitch: float, flank: float) -> _Found:
    """Loads of single teeth on an arc, or beside it in their grooves, from their places and forces."""
    near = np.flatnonzero((ahead >= 0.0) & (ahead <= arc.extent) | (ahead < arc.extent + pitch) & (force != 0.0))
    near = near[np.argsort(ahead[near])]
    loads, off = force[near], np.abs(force[near]) * flank
    inside = np.abs(arc.place - ahead[near, None]) <= 0.5 * pitch
    start, end = ahead[near] - 0.5 * pitch, ahead[near] + 0.5 * pitch
    on_arc = np.minimum(end, arc.extent) - np.maximum(start, 0.0)
    mean = np.divide(inside @ (arc.share * arc.pressing), on_arc, out=np.zeros(near.size), where=on_arc > 0.0)
    seated = on_arc > 0.5 * pitch  # others enter or leave
    if seated.any():
        margin = _margin((pitch * mean + off)[seated], off[seated])
    else:
        margin = 1.0 if np.any(off > 0.0) else np.inf
    return _Found(float(np.abs(loads).max(initial=0.0)), margin, ahead[near], loads)


def loads_over_time(recorded: Recorded, prepared: Prepared) -> Iterator[tuple[float, tuple[ToothLoads, ...]]]:
    """Loads of teeth at some outputs along the belt, with their times, s; nothing of a belt without teeth."""
    if prepared.belt.teeth is None:
        return
    times = np.asarray(recorded["field_time"])
    for number in np.unique(np.linspace(0, times.size - 1, min(times.size, _INSTANTS)).round().astype(int)).tolist():
        yield float(times[number]), loads_at(recorded, prepared, number)


def extreme_loads(recorded: Recorded, prepared: Prepared) -> tuple[ToothLoads, ...]:
    """Of each pulley over some outputs along the belt: fewest teeth in mesh, largest force, least margin to a jump."""
    found = dict[str, ToothLoads]()
    for _, loads in loads_over_time(recorded, prepared):
        for one in loads:
            before = found.get(one.name, one)
            found[one.name] = replace(
                one,
                in_mesh=min(before.in_mesh, one.in_mesh),
                largest=max(before.largest, one.largest),
                jump_margin=min(before.jump_margin, one.jump_margin),
            )
    return tuple(found.values())


def _margin(pressed: FloatArray, off: FloatArray) -> float:
    """Least ratio of what presses teeth on to what pushes them off; infinite where nothing does."""
    lifts = off > _LEAST * np.max(off)
    return float(np.min(pressed[lifts] / off[lifts])) if np.any(lifts) else np.inf


def _inlet(along: FloatArray, here: IntArray, length: float) -> float:
    """Belt coordinate of the first point of an arc, m, which may go over the first node of the belt."""
    own = along[here]
    gaps = np.diff(np.append(own, own[0] + length))
    return float(own[(int(np.argmax(gaps)) + 1) % own.size])


def _means(place: FloatArray, share: FloatArray, values: FloatArray, count: int) -> FloatArray:
    """Means over equal parts of an arc."""
    part = np.minimum((place / (share.sum()) * count).astype(int), count - 1)
    total = np.bincount(part, share * values, count)
    weight = np.bincount(part, share, count)
    return np.asarray(np.divide(total, weight, out=np.zeros(count), where=weight > 0.0))

"""Loads of the teeth of a belt on its pulleys, and how far they are from jumping.

A tooth carries the traction over a pitch of the belt.  Its flanks, at the angle phi to the normal, push the belt off by
the force times tan(phi); the tension, less m v^2, presses it on by (T - m v^2) p / R.  A tooth that is pushed off with
more than it is pressed on lifts, and the belt begins to jump there.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import Prepared
from beltdyn.results.mechanics import cells
from beltdyn.results.schema import InMemory, Recorded

if TYPE_CHECKING:
    from beltdyn.results.result import Result

_INSTANTS = 40
"""Largest number of outputs along the belt that are looked at for extremes."""
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
    """Largest force on a tooth along the belt, N: traction at its middle times the pitch."""
    allowed: float
    """Allowed force on a tooth, N; NaN if it is not known."""
    jump_margin: float
    """Least ratio of what presses a tooth on to what its flanks push it off; at 1 a tooth lifts. Infinite without a
    flank angle."""
    places: FloatArray
    """Middles of teeth along the arc, pitches from the inlet, shape (n,)."""
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
    along, length, pitch = np.asarray(recorded["belt_coordinate"]), prepared.belt_length, prepared.belt.given_pitch
    cell = cells(along, length)
    mean = float(np.nanmean(np.asarray(recorded["belt_speed"])[-1]))
    most = np.nan if toothing.largest_tooth_load is None else toothing.largest_tooth_load
    found = list[ToothLoads]()
    for p, pulley in enumerate(prepared.pulleys):
        here = np.flatnonzero(touched == p)
        if not pulley.teeth or not here.size:
            continue
        place = np.mod(along[here] - _inlet(along, here, length), length)
        order = np.argsort(place)
        here, place = here[order], place[order]
        arc = float(cell[here].sum())
        count = max(1, round(arc / pitch))
        middles = (np.arange(count) + 0.5) * arc / count
        pressed, pushed = (_means(place, cell[here], values[here], count) for values in (pressing, traction))
        found.append(
            ToothLoads(
                name=pulley.name,
                in_mesh=arc / pitch,
                largest=pitch * float(np.max(np.abs(traction[here]))),
                allowed=most,
                jump_margin=_margin(pressed, np.abs(pushed) * np.tan(toothing.flank_angle)),
                places=middles / pitch,
                loads=(-1.0 if mean < 0.0 else 1.0) * np.interp(middles, place, pitch * traction[here]),
            )
        )
    return tuple(found)


def loads_over_time(recorded: Recorded, prepared: Prepared) -> Iterator[tuple[float, tuple[ToothLoads, ...]]]:
    """Loads of teeth at some outputs along the belt, with their times, s; nothing of a belt without teeth."""
    if prepared.belt.teeth is None:
        return
    times = np.asarray(recorded["field_time"])
    for number in np.unique(np.linspace(0, times.size - 1, min(times.size, _INSTANTS)).round().astype(int)).tolist():
        yield float(times[number]), loads_at(recorded, prepared, number)


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

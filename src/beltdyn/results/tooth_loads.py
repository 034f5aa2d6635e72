"""Loads of the teeth of a belt on its pulleys, and how far they are from jumping.

A tooth carries the traction over a pitch of the belt.  Its flanks, at the angle phi to the normal, push the belt off by
the force times tan(phi); the tension, less m v^2, presses it on by (T - m v^2) p / R.  A tooth that is pushed off with
more than it is pressed on lifts, and the belt begins to jump there.
"""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.results.mechanics import cells
from beltdyn.results.run import Run

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


def tooth_loads(run: Run, time: float | None = None) -> tuple[ToothLoads, ...]:
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
    if not isinstance(run, Run):
        raise ModelError(f"loads of teeth need results over time; these are of {run.kind}. Use a run.")
    prepared, dataset = run.prepared, run.dataset
    belt, toothing = prepared.belt, prepared.belt.toothing
    if belt.teeth is None or toothing is None:
        return ()
    seen = dataset.isel(field_time=-1) if time is None else dataset.sel(field_time=time, method="nearest")
    now = dataset.sel(time=float(seen["field_time"]), method="nearest")
    touched, traction = seen["contact_pulley"].values, seen["friction_force"].values
    pressing = seen["normal_force"].values
    along, pitch = seen["belt_coordinate"].values, belt.given_pitch
    cell = cells(along, prepared.belt_length)
    found = list[ToothLoads]()
    for p, pulley in enumerate(prepared.pulleys):
        here = np.flatnonzero(touched == p)
        if not pulley.teeth or not here.size:
            continue
        place = np.mod(along[here] - _inlet(along, here, prepared.belt_length), prepared.belt_length)
        order = np.argsort(place)
        place, force, share = place[order], traction[here][order], cell[here][order]
        normal = pressing[here][order]
        count = max(1, round(float(share.sum()) / pitch))
        middles = (np.arange(count) + 0.5) * float(share.sum()) / count
        loads = np.interp(middles, place, pitch * force)
        pressed = _means(place, share, normal, count) * pitch
        off = np.abs(_means(place, share, force, count)) * pitch * np.tan(toothing.flank_angle)
        lifts = off > _LEAST * max(float(np.max(off)), 1e-300)
        margin = float(np.min(pressed[lifts] / off[lifts])) if np.any(lifts) and toothing.flank_angle > 0.0 else np.inf
        sense = pulley.turning * np.sign(float(now["belt_speed"].values.mean()) or 1.0)
        found.append(
            ToothLoads(
                pulley.name,
                float(share.sum()) / pitch,
                pitch * float(np.max(np.abs(force))),
                np.nan if toothing.largest_tooth_load is None else toothing.largest_tooth_load,
                margin,
                middles / pitch,
                sense * loads,
            )
        )
    return tuple(found)


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

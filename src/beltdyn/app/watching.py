"""Snapshots of a run being computed: colored belt, pulley positions and numbers."""

import time
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.colors import to_hex

from beltdyn.app.scene import MILLIMETRES
from beltdyn.parts.quantity import RPM
from beltdyn.results import Run, open_run
from beltdyn.show.plot.style import tension_colors
from beltdyn.show.report.motion import along_belt
from beltdyn.show.sheet import Table

_OFTEN = 0.4
"""Least interval of snapshots, s."""
_SHARE = 20.0
"""Least interval of snapshots over the cost of one."""
_PIECES = 60
"""Number of separately colored pieces of the belt."""


class Glimpse(NamedTuple):
    """A run at one instant."""

    time: float
    """s."""
    drawn: dict[str, Any]
    """What the canvas draws, ready for JSON: pieces of the belt with their colors, and pulleys with their angles;
    lengths in mm, y down."""
    tension: tuple[float, float]
    """Least and largest belt tension, N: the ends of the colors."""
    pulleys: Table
    """Speed, torque and hub load of each pulley."""


class Watcher:
    """Reads a growing result file at intervals that hardly slow the run."""

    def __init__(self, result: Path) -> None:
        self._result = result
        self._next = 0.0
        self._seen = -1.0

    def look(self) -> Glimpse | None:
        """Return the latest instant with fields along the belt; None if it is too early, or not new."""
        begun = time.perf_counter()
        if begun < self._next or not self._result.exists():
            return None
        run = open_run(self._result)
        try:
            times = run.dataset["field_time"].values
            if not len(times) or times[-1] <= self._seen:
                return None
            self._seen = float(times[-1])
            return _glimpse(run)
        finally:
            run.dataset.close()
            spent = time.perf_counter() - begun
            self._next = begun + max(_OFTEN, _SHARE * spent)


def _glimpse(run: Run) -> Glimpse:
    """The latest instant of a run that has fields."""
    instant = run.fields_at()
    places, tension, _ = along_belt(run, instant)
    if not run.drive.ends:
        places, tension = np.vstack([places, places[:1]]), np.append(tension, tension[:1])
    low, high = float(tension.min()), float(tension.max())
    drawn = {"belt": _pieces(places, (tension - low) / max(high - low, 1e-9)), "pulleys": _pulleys(run, instant)}
    return Glimpse(float(instant["time"]), drawn, (low, high), _table(run, instant))


def _pieces(places: Any, shares: Any) -> list[dict[str, str]]:
    """The belt in pieces, each with the color of its tension."""
    drawn, colors = MILLIMETRES * places * (1.0, -1.0), tension_colors()
    bounds = np.linspace(0, len(places) - 1, _PIECES + 1).round().astype(int).tolist()
    return [
        {
            "d": "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in drawn[first : last + 1]),
            "color": to_hex(colors(float(shares[first:last].mean()))),
        }
        for first, last in pairwise(bounds)
        if last > first
    ]


def _pulleys(run: Run, instant: xr.Dataset) -> list[dict[str, float]]:
    """Rims, and how far they have turned, in degrees."""
    centers, angles = instant["pulley_center"].values, instant["pulley_angle"].values
    return [
        {
            "x": MILLIMETRES * float(x),
            "y": -MILLIMETRES * float(y),
            "r": MILLIMETRES * one.radius,
            "angle": -float(np.degrees(angle)),
        }
        for one, (x, y), angle in zip(run.drive.pulleys, centers, angles, strict=True)
    ]


def _table(run: Run, instant: xr.Dataset) -> Table:
    """Numbers of the pulleys."""
    speeds, torques = instant["pulley_speed"].values, instant["pulley_torque"].values
    loads = np.linalg.norm(instant["hub_force"].values, axis=-1)
    rows = [
        (one.name, f"{RPM * speed:z.1f}", f"{torque:z.3g}", f"{load:.1f}")
        for one, speed, torque, load in zip(run.drive.pulleys, speeds, torques, loads, strict=True)
    ]
    return Table("", ("", "speed\nrpm", "torque of belt\nN m", "hub load\nN"), tuple(rows))

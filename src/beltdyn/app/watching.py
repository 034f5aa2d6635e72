"""Snapshots of a run being computed: colored belt, pulley positions and numbers."""

import time
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import xarray as xr
from matplotlib.colors import to_hex

from beltdyn.app.scene import MILLIMETERS
from beltdyn.arrays import FloatArray
from beltdyn.parts.quantity import RPM
from beltdyn.results import RECORDED, Run, open_run
from beltdyn.show.plot.style import tension_colors
from beltdyn.show.report.replay import along_belt
from beltdyn.show.tables import Table

_MIN_INTERVAL = 0.4
"""Least interval of snapshots, s, however little they cost."""
_INTERVAL_OVER_COST = 10.0
"""Interval of snapshots over the time that the last one took: between the limits, they take a tenth of the time."""
_MAX_INTERVAL = 3.0
"""Interval of snapshots after which one is taken, whatever it costs: the first one loads libraries, s."""
_SEEN = (
    *("pulley_speed", "pulley_angle", "pulley_torque", "hub_force", "pulley_center"),
    *("nodal_coordinates", "body_position", "belt_tension", "normal_force"),
)
"""What is read."""
_PIECE_COUNT = 60
"""Number of pieces of the belt in a picture, each of one color."""


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
        self._first: Run | None = None

    def look(self) -> Glimpse | None:
        """Return the latest instant with fields along the belt; None if it is too early, or not new."""
        begun = time.perf_counter()
        if begun < self._next or not self._result.exists():
            return None
        try:
            with h5py.File(self._result, "r") as file:
                times = file["field_time"][:]
                if not len(times) or times[-1] <= self._seen:
                    return None
                self._seen = float(times[-1])
                values = _latest(file)
            return _glimpse(self._run(values))
        finally:
            spent = time.perf_counter() - begun
            self._next = begun + min(max(_MIN_INTERVAL, _INTERVAL_OVER_COST * spent), _MAX_INTERVAL)

    def _run(self, values: Mapping[str, FloatArray]) -> Run:
        """A run of one instant; what all instants share is read once, which takes longest."""
        if self._first is None:
            run = open_run(self._result)
            shared = run.dataset.isel(time=slice(0, 1), field_time=slice(0, 1), filtered_time=slice(0, 0)).load()
            run.dataset.close()
            self._first = Run(shared, run.drive)
        known = self._first.dataset
        latest = {name: (known[name].dims, one, known[name].attrs) for name, one in values.items()}
        made = Run(known.assign(latest), self._first.drive)
        vars(made)["prepared"] = self._first.prepared
        return made


def _latest(file: h5py.File) -> dict[str, FloatArray]:
    """Values at the latest instant that has fields along the belt."""
    number = int(np.searchsorted(file["time"][:], file["field_time"][-1]))
    places = {"time": number, "field_time": len(file["field_time"]) - 1}
    found = {}
    for name in (*_SEEN, "time", "field_time"):
        place = places[RECORDED[name].dims[0]]
        found[name] = file[name][place : place + 1]
    return found


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
    drawn, colors = MILLIMETERS * places * (1.0, -1.0), tension_colors()
    bounds = np.linspace(0, len(places) - 1, _PIECE_COUNT + 1).round().astype(int).tolist()
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
            "x": MILLIMETERS * float(x),
            "y": -MILLIMETERS * float(y),
            "r": MILLIMETERS * one.radius,
            "angle": -float(np.degrees(angle)),
        }
        for one, (x, y), angle in zip(run.drive.pulleys, centers, angles, strict=True)
    ]


def _table(run: Run, instant: xr.Dataset) -> Table:
    """Numbers of the pulleys."""
    speeds, torques = (run.drive.positive_sense * instant[name].values for name in ("pulley_speed", "pulley_torque"))
    loads = np.linalg.norm(instant["hub_force"].values, axis=-1)
    rows = [
        (one.name, f"{RPM * speed:z.1f}", f"{torque:z.3g}", f"{load:.1f}")
        for one, speed, torque, load in zip(run.drive.pulleys, speeds, torques, loads, strict=True)
    ]
    return Table("", ("", "speed\nrpm", "torque of belt\nN m", "hub load\nN"), tuple(rows))

"""What the page needs to show a run moving: the belt at some instants, in color, and its pulleys."""

import base64
from typing import Any

import numpy as np
import xarray as xr

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Drive
from beltdyn.results import Result, Run
from beltdyn.results.mechanics import centerline, element_lengths, present_lengths, recorded_kind
from beltdyn.show.plot.drive_picture import extent_of
from beltdyn.show.plot.vibration import mode_name, shown_modes, swing, tint_of

_POINTS = 480
"""Number of points along the belt in a picture."""
_MAX_FRAMES = 120
"""Number of pictures of all runs of a page at most, to limit its size."""
_MIN_FRAMES = 30
"""Pictures of a run at least, however many runs share a page: the page interpolates between them."""
_ALONG = ("nodal_coordinates", "body_position", "belt_tension", "belt_coordinate", "normal_force")
"""What pictures are made of."""
_ELEMENT_POINTS = 8
"""Number of points of an element at which its curve is evaluated."""


def motion(run: Run, runs: int = 1) -> dict[str, Any]:
    """The belt at instants of a run, at points that stay in place while the belt passes them, ready for JSON.

    Between two instants the belt may travel far; its shape and its tension at a place change little, so that the page
    can draw any instant between them. Marks on the belt show its travel. Arrays of shape (instants, points) are whole
    numbers over their ``range``, in base64. More `runs` on a page have fewer pictures each.
    """
    times = run.dataset["field_time"].values
    count = min(len(times), max(_MAX_FRAMES // runs, _MIN_FRAMES))
    chosen = times[np.unique(np.linspace(0, len(times) - 1, count).round().astype(int))]
    along = run.fields[list(_ALONG)].sel(time=chosen).load()
    pictures = [along_belt(run, along.isel(time=number)) for number in range(len(chosen))]
    place, tension, pressure = (np.stack(one) for one in zip(*pictures, strict=True))
    fields = run.dataset[["pulley_angle", "pulley_speed", "pulley_center"]].sel(time=chosen)
    extent = extent_of(run.drive, run.drive.path)
    low, high = np.minimum(place.min((0, 1)), extent[0]), np.maximum(place.max((0, 1)), extent[1])
    span = float(np.max(high - low))
    return {
        "time": chosen.tolist(),
        "closed": not run.drive.ends,
        "points": place.shape[1],
        "extent": [low.tolist(), high.tolist()],
        "place": packed((place - low) / span, np.uint16),
        "tension": packed(_share(tension), np.uint8),
        "pressure": packed(_share(pressure), np.uint8),
        "range": {"tension": _range(tension), "pressure": _range(pressure)},
        "angle": fields["pulley_angle"].values.round(5).tolist(),
        "speed": fields["pulley_speed"].values[-1].tolist(),
        "center": fields["pulley_center"].values.round(6).tolist(),
        "travel": _travel(run, chosen).round(6).tolist(),
        "pace": float(np.nan_to_num(run.dataset["belt_speed"].values[-1, 0])),
        "length": run.drive.belt_length,
        "pulleys": _pulleys(run.drive),
    }


def _pulleys(drive: Drive) -> list[dict[str, object]]:
    """Name and radius of each pulley, and the way in which its name has room."""
    return [
        {"name": pulley.name, "radius": pulley.radius, "clear": drive.path.clear_way(number)}
        for number, pulley in enumerate(drive.pulleys)
    ]


def along_belt(run: Run, instant: xr.Dataset) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places (m), tensions (N) and normal forces (N/m) evenly along the belt at one instant, from a fixed place on.

    The last point of an open belt is its end; of a closed belt the first one is not repeated.
    """
    drive = run.drive
    lengths = element_lengths(run.dataset, drive.belt_length)
    kind, present = recorded_kind(run.dataset, run.prepared), present_lengths(instant, drive.belt_length)
    curves = centerline(kind, instant["nodal_coordinates"].values, present, _ELEMENT_POINTS + 1)
    points = curves[:, :-1].reshape(-1, 2)
    starts = np.cumsum(lengths) - lengths
    coordinate = (starts[:, None] + lengths[:, None] * np.arange(_ELEMENT_POINTS) / _ELEMENT_POINTS).ravel()
    tension = np.repeat(instant["belt_tension"].values, len(points) // instant.sizes["element"])
    at, order = instant["belt_coordinate"].values, np.argsort(instant["belt_coordinate"].values)
    pressure = np.interp(coordinate, at[order], np.abs(instant["normal_force"].values[order]), period=drive.belt_length)
    if drive.ends:
        points = np.vstack([points, curves[-1, -1]])
        tension, pressure = np.append(tension, tension[-1]), np.append(pressure, pressure[-1])
    else:
        first = int(np.argmin(np.linalg.norm(points - drive.path.span_points[0].mean(axis=0), axis=1)))
        turned = (np.arange(len(points) + 1) + first) % len(points)
        points, tension, pressure = points[turned], tension[turned], pressure[turned]
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    even = np.linspace(0.0, along[-1], _POINTS + 1)[: _POINTS + bool(drive.ends)]
    x, y, force, load = (np.interp(even, along, values) for values in (*points.T, tension, pressure))
    return np.column_stack([x, y]), force, load


def _travel(run: Run, times: FloatArray) -> FloatArray:
    """How far the belt has travelled at some instants, m."""
    time, speed = run.dataset["time"].values, np.nan_to_num(run.dataset["belt_speed"].values[:, 0])
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)
    return np.asarray(np.interp(times, time, np.append(0.0, np.cumsum(steps))))


def _range(values: FloatArray) -> list[float]:
    return [float(values.min()), float(values.max())]


def _share(values: FloatArray) -> FloatArray:
    """Values as shares of their range."""
    low, high = _range(values)
    return np.asarray((values - low) / (high - low)) if high > low else np.zeros_like(values)


def packed(shares: FloatArray, kind: type[np.unsignedinteger[Any]]) -> str:
    """Shares from 0 to 1 as whole numbers in base64."""
    return base64.b64encode((shares * np.iinfo(kind).max).round().astype(kind).tobytes()).decode()


# What the page needs to show modes swinging: how belt, pulleys and arms move in each

_ROOM = 1.5
"""Room around the drive, over the largest way."""


def swinging(result: Result) -> dict[str, Any]:
    """Give the first modes of a drive, to be drawn at any phase."""
    drive, numbers = result.drive, shown_modes(result)
    swings = [swing(result, one) for one in numbers]
    size, extent = swings[0].size, extent_of(drive, drive.path)
    anchors = ((one.tensioner.anchor, one.pulley) for one in result.prepared.carriers)
    return {
        "extent": [(extent[0] - _ROOM * size).tolist(), (extent[1] + _ROOM * size).tolist()],
        "size": size,
        "place": result.dataset["point_position"].values.round(6).tolist(),
        "center": drive.path.centers.tolist(),
        "pulleys": _pulleys(drive),
        "arms": [[*anchor, pulley] for anchor, pulley in anchors if anchor is not None],
        "modes": [
            {
                "name": mode_name(result, number).replace("\n", "; "),
                "color": tint_of(result, number),
                "center": _parts(one.centers),
                "angle": _parts(one.angles),
                "belt": packed(0.5 + 0.5 * np.stack([one.belt.real, one.belt.imag], axis=-1) / size, np.uint16),
            }
            for number, one in zip(numbers, swings, strict=True)
        ],
    }


def _parts(values: ComplexArray) -> Any:
    """Real and imaginary parts."""
    return np.stack([values.real, values.imag], axis=-1).round(6).tolist()

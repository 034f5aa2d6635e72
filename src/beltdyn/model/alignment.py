"""Alignment of pulleys: fleeting angles of spans from axial offsets and tilts, worst case over tolerances, and limits.

This is geometry alone: the dynamics are planar, and forces out of the plane do not exist in them.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model.drive import Drive
from beltdyn.model.path import Path
from beltdyn.parts.change import tolerances_of
from beltdyn.parts.messages import Finding

_FREEDOMS = ("axial_offset", "tilt[1]", "tilt[2]")
"""Numbers of a pulley that put it out of the plane."""


class Alignment(NamedTuple):
    """Fleeting angles of the spans of a drive.

    The fleeting angle is that between a span and the plane of a pulley which it meets. Spans leave one pulley and reach
    the next, so each has two of them.

    Examples
    --------
    >>> import numpy as np
    >>> moved = drive.with_({"pulley[driven].axial_offset": "2 mm"})
    >>> found = bd.model.alignment(moved)
    >>> bool(np.allclose(np.tan(found.angles[0]), 0.002 / found.span_lengths[0]))
    True
    """

    span_lengths: FloatArray
    """Lengths of the spans, m, shape (spans,)."""
    angles: FloatArray
    """Fleeting angles at the pulley that each span leaves and at that which it reaches, rad, shape (spans, 2)."""
    worst: FloatArray
    """Their largest sizes if all offsets and tilts deviate by their tolerances in the worst senses, rad, shape (spans,
    2)."""
    limit: float
    """Largest fleeting angle of the belt, rad; NaN if unknown."""
    allowed_offset: FloatArray
    """By how much more the pulleys of each span may be offset from each other along their shafts, m; negative where
    the limit is exceeded, NaN without a limit, shape (spans,)."""


def alignment(drive: Drive, path: Path | None = None) -> Alignment:
    """Fleeting angles of all spans, and the axial offsets still allowed.

    With r from the center of a pulley to a tangent point and n the tangents of the tilts, that point lies at
    z = offset − n · r. The span with the unit vector u and the length L between two of them has the slope
    (z₂ − z₁)/L + n · u over the plane of a pulley.

    Parameters
    ----------
    drive : Drive
        The drive, closed; axial offsets, tilts and their tolerances are those of its pulleys.
    path : Path, optional
        The path at rest, such as `Installation.path`; by default that of the drive as given.

    Returns
    -------
    Alignment

    Raises
    ------
    ModelError
        If the belt is open.
    """
    if drive.ends:
        raise ModelError("alignment is that of a closed belt between pulleys; this drive has an open one.")
    path = drive.path if path is None else path
    slopes = _slopes(path)
    nominal, spread = slopes @ _tangents(_given(drive)), np.abs(slopes) @ _tangents(_tolerances(drive))
    limit = drive.belt.largest_fleeting_angle
    most = np.nan if limit is None else np.tan(limit)
    room = (most - (np.abs(nominal) + spread).max(axis=1)) * path.span_lengths
    worst = np.arctan(np.abs(nominal) + spread)
    return Alignment(path.span_lengths, np.arctan(nominal), worst, np.nan if limit is None else limit, room)


def is_given(drive: Drive) -> bool:
    """Whether the drive has an axial offset, a tilt, or a tolerance of them."""
    return bool(_given(drive).any() or _tolerances(drive).any())


def _given(drive: Drive) -> FloatArray:
    """Axial offset (m) and tilts (rad) of each pulley, shape (pulleys, 3)."""
    return np.array([(one.axial_offset, *one.tilt) for one in drive.pulleys])


def _tolerances(drive: Drive) -> FloatArray:
    """Their tolerances."""
    known = tolerances_of(drive)
    return np.array([[known.get(f"pulley[{one.name}].{key}", 0.0) for key in _FREEDOMS] for one in drive.pulleys])


def _tangents(numbers: FloatArray) -> FloatArray:
    """Offsets and the tangents of tilts, one after the other."""
    return np.concatenate([numbers[:, :1], np.tan(numbers[:, 1:])], axis=1).ravel()


def _slopes(path: Path) -> FloatArray:
    """Slopes of the spans over the planes of their pulleys by each offset and tangent of a tilt.

    Shape (spans, 2, 3 pulleys): at the pulley that a span leaves, and at that which it reaches.
    """
    spans = path.spans
    found = np.zeros((spans, 2, path.count, 3))
    for span, (first, last) in enumerate(path.span_pulleys.tolist()):
        length, along = path.span_lengths[span], path.span_directions[span]
        for number, point, sense in ((last, 1, 1.0), (first, 0, -1.0)):
            x, y = path.span_points[span, point] - path.centers[number]
            found[span, :, number] += sense / length * np.array([1.0, y, -x])
        for end, number in enumerate((first, last)):
            found[span, end, number, 1:] += np.array([-along[1], along[0]])
    return found.reshape(spans, 2, -1)


def judge_alignment(drive: Drive, path: Path) -> Iterator[Finding]:
    """Check the fleeting angles against the limit of the belt."""
    if drive.ends or not is_given(drive):
        return
    found = alignment(drive, path)
    if np.isnan(found.limit) or not np.any(found.worst > found.limit * (1.0 + 1e-9)):
        return
    span, end = map(int, np.unravel_index(np.argmax(found.worst), found.worst.shape))
    worst, limit = np.degrees(found.worst[span, end]), np.degrees(found.limit)
    first, last = drive.spans[span]
    too_far = -1e3 * found.allowed_offset[span]
    tolerances = " with tolerances" if found.worst[span, end] > abs(found.angles[span, end]) * (1.0 + 1e-9) else ""
    yield Finding(
        f"the span {first} to {last} meets {drive.spans[span][end]} at a fleeting angle of {worst:.3g}°{tolerances}, "
        f"but the belt allows {limit:.3g}°.",
        "The belt wears on its sides, is noisy, and may climb or turn over; no result shows it, as the dynamics are "
        "planar.",
        f"Reduce the axial offset between both by {too_far:.3g} mm, or the tilts and tolerances.",
    )

"""How the belt of a drive is tensioned on the machine, and how that is checked."""

import numpy as np

from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, install

_DEFLECTION = 0.016
"""Deflection over the length of a span at which a force is measured, by custom of belt makers."""
_QUARTER = 4.0


def tensioning(drive: Drive, specified: float | None = None) -> list[tuple[str, str]]:
    """Say how to tension a belt at rest: its tension, and how a span vibrates and deflects with it."""
    try:
        found = install(drive)
    except (BeltdynError, ValueError):
        return []
    number = int(np.argmax(found.path.span_lengths))
    length, frequency = float(found.path.span_lengths[number]), float(found.span_frequencies[number])
    if not (found.tension > 0.0 and frequency > 0.0):
        return []
    tension = found.tension if specified is None else specified
    frequency *= float(np.sqrt(tension / found.tension))
    fixed = [one for one in drive.tensioners if one.kind == "fixed"]
    centers = [(one.pulley, drive.centers[drive.carried(one)]) for one in fixed]
    holds = "held by its tensioner" if drive.moving_tensioners else "mean of all spans"
    start, end = drive.spans[number]
    deflection = _DEFLECTION * length
    force = _QUARTER * tension * _DEFLECTION
    return [
        ("tension at rest", f"{tension:.4g} N, {holds}"),
        *((f"center of {name}", f"[{x:.5g}, {y:.5g}] m after take-up") for name, (x, y) in centers),
        ("frequency meter", f"{frequency:.3g} Hz, span {start} to {end} of {length:.4g} m, plucked at rest"),
        (
            "force and deflection",
            f"{force:.3g} N across the middle of that span deflects it by {1e3 * deflection:.3g} mm",
        ),
    ]

"""What the page needs to show modes swinging: how belt, pulleys and arms move in each."""

from typing import Any

import numpy as np

from beltdyn.arrays import ComplexArray
from beltdyn.plot.drive import extent_of
from beltdyn.plot.modes import mode_name, shown_modes, swing, tint_of
from beltdyn.report.motion import packed
from beltdyn.results import Result

_ROOM = 1.5
"""Room around the drive, over the largest way."""


def swinging(result: Result) -> dict[str, Any]:
    """Give the first modes of a drive, to be drawn at any phase.

    Parameters
    ----------
    result : Result
        Of `modes`.

    Returns
    -------
    dict
        Ready for JSON, lengths in m. ``modes`` has of each its ``name`` and ``color``, and ways as real and imaginary
        parts: of the ``center`` of each pulley in x and y, its ``angle``, rad, and of the ``belt`` in x and y at each
        ``place``, as whole numbers of 16 bits between minus and plus ``size``, in base64.
    """
    drive, numbers = result.drive, shown_modes(result)
    swings = [swing(result, one) for one in numbers]
    size, extent = swings[0].size, extent_of(drive, drive.path)
    anchors = ((one.tensioner.anchor, one.pulley) for one in drive.carriers)
    return {
        "extent": [(extent[0] - _ROOM * size).tolist(), (extent[1] + _ROOM * size).tolist()],
        "size": size,
        "place": result.dataset["point_position"].values.round(6).tolist(),
        "center": drive.path.centers.tolist(),
        "pulleys": [{"name": pulley.name, "radius": pulley.radius} for pulley in drive.pulleys],
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

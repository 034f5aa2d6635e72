"""Whether belt and pulleys mesh: their teeth, and the pitches of the path."""

from collections.abc import Sequence

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley


def check_teeth(belt: Belt, pulleys: Sequence[Pulley], path_length: float | None) -> None:
    """Refuse teeth that no groove holds, and a belt with teeth that is too short for its path, unless that moves."""
    if belt.teeth is None or belt.toothing is None:
        return
    if not any(pulley.teeth for pulley in pulleys):
        raise ValueError(
            f"the belt has {belt.teeth} teeth, but no pulley has any. Give pulleys their teeth, or omit belt.teeth and "
            "belt.toothing for a flat belt"
        )
    pitches = 0.0 if path_length is None else path_length / belt.given_pitch
    if pitches > belt.teeth + 1:
        raise ValueError(
            f"belt.teeth = {belt.teeth} is too short to mesh: the path around the pulleys has {pitches:.2f} pitches of "
            f"{1e3 * belt.toothing.pitch:.5g} mm. Give {round(pitches)} teeth, or move the pulleys closer together"
        )


def teeth_in_mesh(belt: Belt, path: Path) -> FloatArray:
    """Pitches of the belt on the arc of each pulley, shape (pulleys,)."""
    return np.asarray(np.abs(path.radii) * path.wrap_angles / belt.given_pitch)

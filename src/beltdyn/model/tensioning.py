"""Checks of a belt's tension in the workshop: the frequency of a span, and the force that deflects its middle."""

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.carrying import swinging_lengths
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation, span_frequencies
from beltdyn.theory.span import deflection_force, stretching

DEFLECTION = 0.016
"""Deflection of the middle over the length of a span, by custom of belt makers (1/64 inch per inch)."""
NEW, RUN_IN = 1.5, 1.3
"""Tension of a new and of a run-in belt over the least one that carries the load (GB/T 13575.1)."""
STATES = MappingProxyType({"new": NEW / RUN_IN, "run in": 1.0, "least": 1.0 / RUN_IN})
"""Tension over that of the drive, a run-in belt's: of a new belt, and the least before it is tensioned again."""
HELD = MappingProxyType({"at rest": 1.0})
"""The only state of a belt whose tension a spring-loaded tensioner or a pulled end holds."""


class TensionCheck(NamedTuple):
    """What is measured on the s spans of a belt in a state."""

    state: str
    tension: float
    """Mean of the spans, N."""
    frequencies: FloatArray
    """First frequency across each span, shape (s,), Hz."""
    forces: FloatArray
    """Force across the middle that deflects it by `DEFLECTION` of its length, on each of V-belts side by side, N."""


def tension_checks(
    drive: Drive, installation: Installation, specified: float | None = None
) -> tuple[TensionCheck, ...]:
    """Frequencies and deflection forces of the spans of a belt at rest, new, run in, and before it is tensioned again.

    The span is a string with the bending stiffness of the belt between hinges, and stretched by its deflection where
    the pulleys are fixed; see `beltdyn.theory.span`.
    """
    if not installation.span_tensions.min() > 0.0:
        return ()
    held = bool(drive.layout.given.springs) or any(not end.held for end in drive.ends)
    scale = 1.0 if specified is None else specified / installation.tension
    return tuple(
        _check(drive, installation, state, scale * factor, held) for state, factor in (HELD if held else STATES).items()
    )


def _check(drive: Drive, installation: Installation, state: str, factor: float, held: bool) -> TensionCheck:
    """The spans with their tensions times a factor."""
    path, belt, tensions = installation.path, drive.completed.belt, factor * installation.span_tensions
    forces = []
    for length, tension in zip(path.span_lengths.tolist(), tensions.tolist(), strict=True):
        if length == 0.0:  # in a nip
            forces.append(np.inf)
            continue
        deflection = DEFLECTION * length
        more = 0.0 if held else belt.local_stiffness(tension) * stretching(deflection, length) / belt.given_length
        forces.append(deflection_force(deflection, length, tension + more, belt.bending_stiffness) / drive.belt.v_belts)
    swinging = swinging_lengths(drive.supports, drive.spans, path)
    frequencies = span_frequencies(belt, path, tensions, drive.gravity, swinging)
    return TensionCheck(state, float(tensions.mean()), frequencies, np.array(forces))

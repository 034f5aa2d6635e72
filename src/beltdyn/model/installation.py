"""The belt at rest on its pulleys, and the checks of its tension in the workshop."""

from dataclasses import dataclass
from math import inf
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.carrying import swinging_lengths
from beltdyn.model.drive import Drive
from beltdyn.model.path import Path
from beltdyn.theory.rating import NEW, RUN_IN
from beltdyn.theory.span import deflection_force, lowest_frequency, sag_parameter, stretching


@dataclass(frozen=True)
class Installation:
    """The belt at rest, without friction.

    Examples
    --------
    >>> installed = bd.model.install(drive)
    >>> print(f"{installed.tension:.2f} N, {installed.span_frequencies[0]:.1f} Hz")
    26.56 N, 21.0 Hz
    """

    strain: float
    """Strain of the belt laid on its path, path / length - 1."""
    laid_tension: float
    """Tension of the laid belt, N."""
    tension: float
    """Mean tension of the spans with the penetration into the pulleys, N."""
    span_tensions: FloatArray
    """Mean tension of each of s spans: the same in all, but for weight and the mesh, N, shape (s,)."""
    end_tensions: FloatArray
    """Tension at start and end of each span, N, shape (s, 2)."""
    extreme_tensions: FloatArray
    """Least and largest tension of each span, N, shape (s, 2)."""
    penetrations: FloatArray
    """Penetration into each pulley, in the middle of the arc, m, shape (n,)."""
    tensioner_positions: FloatArray
    """Equilibrium positions of the sliding and rotary tensioners, m or rad, shape (K,)."""
    path: Path
    """The path with the tensioners there, without penetration."""
    hub_loads: FloatArray
    """Force of the belt on each pulley; without weight T (u_out - u_in), of size 2 T sin(wrap angle / 2), N, shape
    (n, 2)."""
    span_frequencies: FloatArray
    """Lowest natural frequency of transverse vibration of each span, including bending stiffness and sag, Hz, shape
    (s,)."""
    limitation: str = ""
    """Why closed forms leave out bending stiffness and weight; empty where they do not, and where the belt is slack."""


def hanging_extremes(ends: FloatArray, path: Path, weight: FloatArray, lengths: FloatArray) -> FloatArray:
    """Least and largest tension of spans that hang between their ends, N, shape (s, 2).

    The largest is at the higher end. The least is at the lower one; or, where a shallow parabola falls below that with
    the slope s there, by T s^2 / 2 below its tension.

    Parameters
    ----------
    ends : ndarray, shape (s, 2)
        Tensions at start and end, N.
    path : Path
        The path.
    weight : ndarray, shape (2,)
        Of a meter of belt, N/m.
    lengths : ndarray, shape (s,)
        Lengths that hang freely, m; shorter than the span where supports carry it.
    """
    found = np.stack([ends.min(axis=1), ends.max(axis=1)], axis=1)
    along = np.abs(path.span_directions @ weight)
    across = np.abs(path.span_directions @ np.array([-weight[1], weight[0]]))
    size = float(np.hypot(*weight))
    hangs = (lengths >= path.span_lengths) & (across > 0.0) & (found[:, 0] > 0.0)
    for span in np.flatnonzero(hangs).tolist():
        pull = float(ends[span].mean()) * across[span] / size
        slope = size * path.span_lengths[span] / (2.0 * pull) - along[span] / across[span]
        found[span, 0] -= 0.5 * pull * max(slope, 0.0) ** 2
    return found


def span_frequencies(
    belt: Belt, path: Path, tensions: FloatArray, gravity: tuple[float, float], lengths: FloatArray
) -> FloatArray:
    """First frequencies of the spans of a belt of given length, Hz; see `theory.span`.

    The mass of a meter is that of the stretched belt. `lengths` are those that swing, m, shape (s,). A slack belt does
    not swing: zero. Where supports hold all of it, the frequency is infinite.
    """
    if not tensions.min() > 0.0:
        return np.zeros(path.spans)
    mass = belt.mass_per_length * belt.given_length / path.length
    across = np.abs(path.span_directions @ np.array([-gravity[1], gravity[0]]))
    found = [
        lowest_frequency(
            length,
            tension,
            mass,
            bending=belt.bending_stiffness,
            sag_parameter=sag_parameter(mass * weight, length, tension, belt.local_stiffness(tension)),
        )
        if length > 0.0
        else inf
        for length, weight, tension in zip(lengths.tolist(), across.tolist(), tensions.tolist(), strict=True)
    ]
    return np.array(found)


DEFLECTION = 0.016
"""Deflection of the middle over the length of a span, by custom of belt makers (1/64 inch per inch)."""
FITTING, TENSIONING = 0.015, 0.03
"""Least travel of a center to fit V-belts, and to tension them over their life, over the nominal length (GB/T 13575.1).
Makers whose belts stretch less ask for less: Optibelt for 20 and 45 mm, not 60 and 120 mm, with SPB 4000."""
STATES = MappingProxyType({"new": NEW / RUN_IN, "run in": 1.0, "least": 1.0 / RUN_IN})
"""Tension over that of the drive, a run-in belt's: of a new belt, and the least before it is tensioned again, where the
load that requires it is unknown."""
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
    drive: Drive, installation: Installation, specified: float | None = None, least: float | None = None
) -> tuple[TensionCheck, ...]:
    """Frequencies and deflection forces of the spans of a belt at rest, new, run in, and before it is tensioned again.

    `specified` is the tension of the drive, and `least` that which its load requires, N. The span is a string with the
    bending stiffness of the belt between hinges, and stretched by its deflection where the pulleys are fixed; see
    `beltdyn.theory.span`.
    """
    if not installation.span_tensions.min() > 0.0:
        return ()
    held = bool(drive.layout.given.springs) or any(not end.held for end in drive.ends)
    scale = 1.0 if specified is None else specified / installation.tension
    factors = {state: scale * factor for state, factor in (HELD if held else STATES).items()}
    if least is not None and not held:
        factors["least"] = least / installation.tension
    return tuple(_check(drive, installation, state, factor, held) for state, factor in factors.items())


def _check(drive: Drive, installation: Installation, state: str, factor: float, held: bool) -> TensionCheck:
    """The spans with their tensions times a factor."""
    path, belt, tensions = installation.path, drive.completed.belt, factor * installation.span_tensions
    forces = []
    swinging = swinging_lengths(drive.supports, drive.spans, path)
    for length, tension in zip(swinging.tolist(), tensions.tolist(), strict=True):
        if length == 0.0:  # in a nip, or on a guide
            forces.append(np.inf)
            continue
        deflection = DEFLECTION * length
        more = 0.0 if held else belt.local_stiffness(tension) * stretching(deflection, length) / belt.given_length
        forces.append(deflection_force(deflection, length, tension + more, belt.bending_stiffness) / drive.belt.v_belts)
    frequencies = span_frequencies(belt, path, tensions, drive.gravity, swinging)
    return TensionCheck(state, float(tensions.mean()), frequencies, np.array(forces))

"""The belt at rest on its pulleys: closed-form estimates, or static equilibrium."""

from dataclasses import dataclass
from math import inf

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.path import Path
from beltdyn.theory.span import lowest_frequency, sag_parameter


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
    """Tension of each of s spans: the same in all, but for weight and the mesh, N, shape (s,)."""
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

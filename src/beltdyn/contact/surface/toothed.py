"""Pulleys with teeth: smooth circles whose grooves hold the teeth of the belt.

A system of a belt with teeth has rims of one of the types here, so that the kernels of smooth drives know of none.  A
place on the belt is told by its material coordinate X, the length of unstretched belt from node 0; the belt passes z
pitches p_b a turn of a pulley.  Its groove is ahead of a tooth by the angle

    a = theta - psi + r X,    r = +-2 pi / (z p_b),

up to whole grooves, with psi the direction of the tooth from the shaft.  The sign is that of the sense in which the
belt runs around the pulley.
"""

from typing import Any, Final, NamedTuple

from beltdyn.arrays import FloatArray, IntArray, Records, record
from beltdyn.kernel import kernel

TEETH = record(
    stiffness="f8",  # force along the belt per length of belt and misfit, N/m^2; zero of a pulley without teeth
    damping="f8",  # the same per rate of the misfit, N s/m^2
    half_gap="f8",  # half of the backlash, m
    pitch_radius="f8",  # p z / 2 pi, m
    rate="f8",  # r, rad/m
    groove="f8",  # angle of a groove, 2 pi / z, rad
    flank="f8",  # tangent of the angle of the flanks to the normal
    spacing="f8",  # pitch of teeth that act at their middles alone, m; zero of spread teeth
    land="f8",  # radius of the lands between which single teeth leave the belt straight, m; zero of circles
    height="f8",  # lift of the belt off the rim at which teeth are out of their grooves, m
    phase="f8",  # angle of the grooves where the pulley has the angle zero, rad
)
"""Teeth of a pulley against those of the belt."""

SPEED: Final = 0
"""Unknown of a body in steady running: its speed."""
PHASE: Final = 1
"""Unknown of a body in steady running: the phase of its grooves; its speed follows from that of the belt."""
FOLLOWS: Final = 2
"""Unknown of a body in steady running: that of a toothed pulley with which it turns; its own speed follows."""


class ToothedRims(NamedTuple):
    """Pulleys some of which have teeth, at the angles of a state."""

    radius: FloatArray
    """Effective radii, m, shape (P,)."""
    table: Records
    """Rows of `TEETH`, shape (P,)."""
    start: FloatArray
    """Material coordinates at which the elements begin, m, shape (elements,)."""


class MeshingRims(NamedTuple):
    """Pulleys some of which have teeth, in steady running: phases of their grooves in place of angles."""

    radius: FloatArray
    """Effective radii, m, shape (P,)."""
    table: Records
    """Rows of `TEETH`, shape (P,)."""
    start: FloatArray
    """Material coordinates at which the elements begin, m, shape (elements,)."""
    phase: FloatArray
    """Phases of the grooves, rad, shape (P,); unknowns, and changed in place."""
    unknown: IntArray
    """What the unknown of each body is, `SPEED`, `PHASE` or `FOLLOWS`, shape (D,)."""
    leader: int
    """Pulley whose speed is known, and whose phase is the last unknown."""
    kept: FloatArray
    """Scratch, shape (m, m)."""


class Toothed(NamedTuple):
    """A pulley of a belt with teeth; its own row may have none."""

    radius: float
    """Effective radius R, m."""
    stiffness: float
    damping: float
    half_gap: float
    pitch_radius: float
    rate: float
    groove: float
    flank: float
    spacing: float
    height: float
    """All as in `TEETH`."""
    phase: float
    """Angle of the grooves, less r times the length of belt that has passed the mesh, rad."""
    by_flow: float
    """Derivative of the phase by that length over -r: 1, or 0 in steady running."""
    by_speed: float
    """Whether its speed is unknown: 1, or 0 where the phase is in its place."""


@kernel(inline=True)
def _toothed(rims: Any, pulley: int, phase: float, by_flow: float, by_speed: float) -> Toothed:
    """A pulley with its row of the table."""
    row, radius = rims.table[pulley], rims.radius[pulley]
    return Toothed(
        radius,
        row.stiffness,
        row.damping,
        row.half_gap,
        row.pitch_radius,
        row.rate,
        row.groove,
        row.flank,
        row.spacing,
        row.height,
        phase,
        by_flow,
        by_speed,
    )


@kernel
def toothed_at(rims: ToothedRims, pulley: int, angle: float, passed: float = 0.0) -> Toothed:
    """A pulley at an angle (rad), when a length of belt (m) has passed the mesh."""
    row = rims.table[pulley]
    return _toothed(rims, pulley, row.phase + angle - row.rate * passed, 1.0, 1.0)


@kernel
def meshing_at(rims: MeshingRims, pulley: int, angle: float, passed: float = 0.0) -> Toothed:
    """A pulley in steady running, at the phase that it has."""
    by_speed = 0.0 if rims.table[pulley].stiffness > 0.0 else 1.0
    return _toothed(rims, pulley, rims.phase[pulley], 0.0, by_speed)

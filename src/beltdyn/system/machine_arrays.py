"""The machines around the belt as arrays: functions of time, loads on shafts, hub chains, tensioners."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

POLYNOMIAL, TABLE, KLOSS = 0, 1, 2
"""Kinds of loads: see `shaft_torque`."""
ISOLATOR, ONE_WAY_CLUTCH, FRICTION_CLUTCH = 0, 1, 2
"""Kinds of couplings: see `coupling_torque`."""
NO_SCHEDULE = -1
"""Stands for the number of a profile where there is none."""


class Profiles(NamedTuple):
    """Functions of time: one of each pulley (speed if prescribed, torque if free, zero if none), then schedules."""

    first: IntArray
    """First segment of each, shape (n + 1,)."""
    start: FloatArray
    """Instants from which the segments hold, s, shape (S,)."""
    segment: FloatArray
    """c0, c1, amplitude, omega, phase of each segment, shape (S, 5)."""
    angle: FloatArray
    """Integral of the profile from time zero to the start of the segment (of the first one: to time zero as if it held
    there), rad for speeds, shape (S,)."""
    harmonic_first: IntArray
    """First harmonic of each, shape (n + 1,)."""
    harmonic: FloatArray
    """Order, amplitude over the value, phase (rad), shape (H, 3)."""


class Torques(NamedTuple):
    """The n loads on the shafts, sorted by pulley."""

    first: IntArray
    """First load of each pulley, shape (P + 1,)."""
    schedule: IntArray
    """Number of the profile that multiplies it, or `NO_SCHEDULE`; shape (n,)."""
    kind: IntArray
    """`POLYNOMIAL`, `TABLE` or `KLOSS`, shape (n,)."""
    constants: FloatArray
    """Constants of its kind, shape (n, 4): see `shaft_torque`."""
    table_first: IntArray
    """First point of each load's table, shape (n + 1,)."""
    table: FloatArray
    """Speed (rad/s) and torque (N m), shape (T, 2)."""
    harmonic_first: IntArray
    """First harmonic of each load, shape (n + 1,)."""
    harmonic: FloatArray
    """Order over the shaft angle, amplitude over the torque, phase (rad), shape (H, 3)."""


class Couplings(NamedTuple):
    """The L links of the hub chains."""

    front: IntArray
    """Body on the belt's side: 0 to P - 1 are the rims, then come the hub bodies; shape (L,)."""
    back: IntArray
    """Body behind it, shape (L,)."""
    kind: IntArray
    """`ISOLATOR`, `ONE_WAY_CLUTCH` or `FRICTION_CLUTCH`, shape (L,)."""
    constants: FloatArray
    """Constants of its kind, shape (L, 3): see `coupling_torque`."""
    schedule: IntArray
    """Number of the profile that multiplies a capacity, or `NO_SCHEDULE`; shape (L,)."""


class Tensioners(NamedTuple):
    """The K sliding and rotary tensioners; q is in m or rad, forces in N or N m, all arrays of shape (K,) but two."""

    pulley: IntArray
    """The pulley that it carries."""
    rotary: BoolArray
    """Whether it turns about a pivot; otherwise it slides along a line."""
    origin: FloatArray
    """Nominal center of the pulley, or pivot, m, shape (K, 2)."""
    direction: FloatArray
    """Unit vector of the line, or from the pivot to the nominal center, shape (K, 2)."""
    arm: FloatArray
    """Length of the arm, m; zero of a sliding one."""
    sense: FloatArray
    """+1 where turning the arm counter-clockwise lengthens the path, -1 where it shortens it; +1 of a sliding one."""
    preload: FloatArray
    """Spring force at q = 0."""
    rate: FloatArray
    """Spring force lost in a unit of q."""
    viscous: FloatArray
    """Viscous damping."""
    tensioning_friction: FloatArray
    """Dry friction while q grows."""
    yielding_friction: FloatArray
    """Dry friction while q falls."""
    creep_speed: FloatArray
    """Speed over which dry friction builds up."""
    lower: FloatArray
    """Lower stop, -inf where there is none."""
    upper: FloatArray
    """Upper stop, inf where there is none."""
    stop_stiffness: FloatArray
    """Stiffness of the stops."""
    stop_damping: FloatArray
    """Damping of the stops."""

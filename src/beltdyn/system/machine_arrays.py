"""The machines around the belt as arrays: functions of time, loads on shafts, hub chains, tensioners."""

from typing import NamedTuple

from beltdyn.arrays import IntArray
from beltdyn.records import Records, record

POLYNOMIAL, TABLE, KLOSS = 0, 1, 2
"""Kinds of loads: see `shaft_torque`."""
ISOLATOR, ONE_WAY_CLUTCH, FRICTION_CLUTCH = 0, 1, 2
"""Kinds of couplings: see `coupling_torque`."""
NO_SCHEDULE = -1
"""Stands for the number of a profile where there is none."""


HARMONIC = record(
    order="f8",  # over an angle
    amplitude="f8",  # over the value
    phase="f8",  # rad
)
"""A harmonic of a speed or of a torque."""

SEGMENT = record(
    start="f8",  # instant from which the segment holds, s
    coefficients="5f8",  # c0, c1, amplitude, omega, phase
    angle="f8",  # integral of the profile from time zero to the start (of the first: to time zero as if it held there)
)
"""A piece of a function of time."""

PROFILE = record(
    segment="i8",  # its first segment; the last is that before the first of the next row
    harmonic="i8",  # its first harmonic, alike
)
"""A function of time."""


class Profiles(NamedTuple):
    """Functions of time: one of each pulley (speed if prescribed, torque if free, zero if none), then schedules."""

    table: Records
    """Rows of `PROFILE`, one more than there are profiles."""
    segment: Records
    """Rows of `SEGMENT`."""
    harmonic: Records
    """Rows of `HARMONIC`."""


LOAD = record(
    schedule="i8",  # number of the profile that multiplies it, or `NO_SCHEDULE`
    kind="i8",  # `POLYNOMIAL`, `TABLE` or `KLOSS`
    constants="4f8",  # constants of its kind: see `shaft_torque`
    point="i8",  # its first point; the last is that before the first of the next row
    harmonic="i8",  # its first harmonic over the shaft angle, alike
)
"""A load on a shaft."""

POINT = record(
    speed="f8",  # rad/s
    torque="f8",  # N m
)
"""A point of a table of torque over speed."""


class Torques(NamedTuple):
    """The loads on the shafts, sorted by pulley."""

    first: IntArray
    """First load of each pulley, shape (P + 1,)."""
    table: Records
    """Rows of `LOAD`, one more than there are loads."""
    point: Records
    """Rows of `POINT`."""
    harmonic: Records
    """Rows of `HARMONIC`."""


COUPLING = record(
    front="i8",  # body on the belt's side: 0 to P - 1 are the rims, then come the hub bodies
    back="i8",  # body behind it
    kind="i8",  # `ISOLATOR`, `ONE_WAY_CLUTCH` or `FRICTION_CLUTCH`
    constants="3f8",  # constants of its kind: see `coupling_torque`
    schedule="i8",  # number of the profile that multiplies a capacity, or `NO_SCHEDULE`
)
"""A link of a hub chain."""

TENSIONER = record(
    pulley="i8",  # the pulley that it carries
    rotary="?",  # whether it turns about a pivot; otherwise it slides along a line
    origin="2f8",  # nominal centre of the pulley, or pivot, m
    direction="2f8",  # unit vector of the line, or from the pivot to the nominal centre
    arm="f8",  # length of the arm, m; zero of a sliding one
    sense="f8",  # +1 where turning the arm counter-clockwise lengthens the path, -1 where it shortens it; else +1
    preload="f8",  # spring force at q = 0
    rate="f8",  # spring force lost in a unit of q
    viscous="f8",  # viscous damping
    tensioning_friction="f8",  # dry friction while q grows
    yielding_friction="f8",  # dry friction while q falls
    creep_speed="f8",  # speed over which dry friction builds up
    lower="f8",  # lower stop, -inf where there is none
    upper="f8",  # upper stop, inf where there is none
    stop_stiffness="f8",  # stiffness of the stops
    stop_damping="f8",  # damping of the stops
    weight="2f8",  # force of gravity on tensioner and pulley, as if at the centre of the pulley, N
)
"""A sliding or rotary tensioner; q is in m or rad, forces in N or N m."""

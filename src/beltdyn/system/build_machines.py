"""From the machines of the model to the arrays, on which the kernels work."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import (
    FixedTensioner,
    FrictionClutch,
    Harmonic,
    Isolator,
    LoadTable,
    Motor,
    OneWayClutch,
    Path,
    Profile,
    Pulley,
    Resistance,
    RotaryTensioner,
    SlidingTensioner,
)
from beltdyn.model.tensioner import AnyTensioner, path_gradient
from beltdyn.records import Records, records
from beltdyn.system.machine_arrays import (
    COUPLING,
    FRICTION_CLUTCH,
    HARMONIC,
    ISOLATOR,
    KLOSS,
    LOAD,
    NO_SCHEDULE,
    ONE_WAY_CLUTCH,
    POINT,
    POLYNOMIAL,
    PROFILE,
    SEGMENT,
    TABLE,
    TENSIONER,
    Profiles,
    Torques,
)

_NO_CONSTANTS = (0.0, 0.0, 0.0, 0.0)


class Machines(NamedTuple):
    """The machines around a belt as arrays."""

    profiles: Profiles
    torques: Torques
    couplings: Records
    tensioners: Records


def machine_arrays(
    pulleys: Sequence[Pulley],
    tensioners: Sequence[AnyTensioner] = (),
    path: Path | None = None,
    gravity: tuple[float, float] = (0.0, 0.0),
) -> Machines:
    """Arrays of everything on and behind the pulleys.

    Parameters
    ----------
    pulleys
        The pulleys.
    tensioners
        What carries some of them; fixed ones leave no trace.
    path
        The path around the pulleys, with signed radii; needed where there are tensioners.
    gravity
        Acceleration of gravity, m/s^2.

    Returns
    -------
    Machines
        Profile p is that of pulley p; schedules follow, those of a pulley's loads before those of its hub chain.

    Raises
    ------
    ModelError
        If there are tensioners but no path.
    """
    moving = [item for item in tensioners if isinstance(item, SlidingTensioner | RotaryTensioner)]
    if moving and path is None:
        raise ModelError("the path is missing: a tensioner needs it, to know which way the belt gets longer.")
    return Machines(
        _profiles(pulleys), _torques(pulleys), _couplings(pulleys), _tensioners(pulleys, moving, path, gravity)
    )


def shaft_bodies(pulleys: Sequence[Pulley]) -> IntArray:
    """Number of each pulley's shaft among the bodies: the P rims, then the bodies of the hub chains; shape (P,)."""
    chains = np.array([len(pulley.hub) for pulley in pulleys], dtype=np.int64)
    last = len(pulleys) + np.cumsum(chains) - 1
    return np.where(chains > 0, last, np.arange(len(pulleys)))


def body_inertias(pulleys: Sequence[Pulley]) -> FloatArray:
    """Moments of inertia of the rims, then of the bodies of the hub chains, kg m^2."""
    rims = [pulley.inertia for pulley in pulleys]
    return np.array([*rims, *(link.inertia for pulley in pulleys for link in pulley.hub)], dtype=float)


def tensioner_inertias(pulleys: Sequence[Pulley], tensioners: Sequence[AnyTensioner]) -> FloatArray:
    """Inertia of each moving tensioner with its pulley: kg along a line, kg m^2 about a pivot; shape (K,)."""
    return np.array(
        [item.moved_inertia(np.array(pulley.center), pulley.mass) for item, pulley in _carriers(pulleys, tensioners)],
        dtype=float,
    )


def carried_masses(pulleys: Sequence[Pulley], tensioners: Sequence[AnyTensioner]) -> FloatArray:
    """Mass at the center of each carried pulley that has the weight of tensioner and pulley, kg, shape (K,).

    An arm of mass m with its center of mass at the part c of its length weighs on its coordinate as c m does at the
    pulley's center.
    """
    return np.array(
        [
            pulley.mass + item.mass * (item.center_of_mass if isinstance(item, RotaryTensioner) else 1.0)
            for item, pulley in _carriers(pulleys, tensioners)
        ],
        dtype=float,
    )


def _carriers(
    pulleys: Sequence[Pulley], tensioners: Sequence[AnyTensioner]
) -> list[tuple[SlidingTensioner | RotaryTensioner, Pulley]]:
    """Tensioners that move, each with its pulley."""
    named = {pulley.name: pulley for pulley in pulleys}
    return [(item, named[item.pulley]) for item in tensioners if not isinstance(item, FixedTensioner)]


def _profiles(pulleys: Sequence[Pulley]) -> Profiles:
    """Profiles of the pulleys and schedules laid end to end."""
    own = [pulley.speed if pulley.prescribed else pulley.torque for pulley in pulleys]
    schedules = [item for pulley in pulleys for item in pulley.schedules if item is not None]
    pieces = [_segments(profile) for profile in (*own, *schedules)]
    first, harmonic = _harmonics([*(pulley.harmonics for pulley in pulleys), *([()] * len(schedules))])
    return Profiles(
        table=records(PROFILE, segment=_offsets(len(start) for start, _, _ in pieces), harmonic=first),
        segment=records(
            SEGMENT,
            start=np.concatenate([np.empty(0), *(start for start, _, _ in pieces)]),
            coefficients=np.concatenate([np.empty((0, 5)), *(segment for _, segment, _ in pieces)]),
            angle=np.concatenate([np.empty(0), *(angle for _, _, angle in pieces)]),
        ),
        harmonic=harmonic,
    )


def _segments(profile: Profile | None) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Starts and coefficients of a profile, and its integral from time zero to the starts."""
    if profile is None:
        return np.array([-np.inf]), np.zeros((1, 5)), np.zeros(1)
    start, segment = profile.segments()
    begin = np.concatenate([[0.0], start[1:]])
    angle = np.concatenate([[0.0], np.cumsum(_integrals(segment[:-1], begin[:-1], start[1:]))])
    zero = max(int(np.searchsorted(start, 0.0, side="left")) - 1, 0)
    return start, segment, angle - angle[zero] - _integrals(segment[zero], begin[zero], np.zeros(()))


def _integrals(segments: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
    """Integrals of segments, shape (..., 5), from where they begin to an instant each."""
    constant, slope, amplitude, omega, phase = np.moveaxis(segments, -1, 0)
    since = end - begin
    wave = np.sinc(0.5 * omega * since / np.pi) * np.cos(0.5 * omega * (begin + end) + phase)
    return np.asarray(since * (constant + 0.5 * slope * since + amplitude * wave))


def _torques(pulleys: Sequence[Pulley]) -> Torques:
    """Loads of all pulleys laid end to end."""
    loads = [load for pulley in pulleys for load in pulley.load]
    points = [
        tuple(zip(load.speeds, load.torques, strict=True)) if isinstance(load, LoadTable) else () for load in loads
    ]
    first, harmonic = _harmonics([load.harmonics for load in loads])
    kinds = [*(_load_constants(load) for load in loads), (POLYNOMIAL, _NO_CONSTANTS)]
    return Torques(
        first=_offsets(len(pulley.load) for pulley in pulleys),
        table=records(
            LOAD,
            schedule=[*_schedule_numbers(pulleys)[0], NO_SCHEDULE],
            kind=[kind for kind, _ in kinds],
            constants=[constants for _, constants in kinds],
            point=_offsets(len(group) for group in points),
            harmonic=first,
        ),
        point=records(
            POINT,
            speed=[speed for group in points for speed, _ in group],
            torque=[torque for group in points for _, torque in group],
        ),
        harmonic=harmonic,
    )


def _load_constants(load: Resistance | LoadTable | Motor) -> tuple[int, tuple[float, float, float, float]]:
    """Kind and constants of a load."""
    if isinstance(load, Resistance):
        return POLYNOMIAL, (load.constant, load.creep_speed, load.linear, load.quadratic)
    if isinstance(load, Motor):
        return KLOSS, (load.breakdown_torque, load.breakdown_slip, load.synchronous_speed, 0.0)
    return TABLE, _NO_CONSTANTS


def _couplings(pulleys: Sequence[Pulley]) -> Records:
    """Links of the hub chains, pulley after pulley, from the rim inwards."""
    fronts, backs, kinds = [], [], []
    body = len(pulleys)
    for p, pulley in enumerate(pulleys):
        front = p
        for link in pulley.hub:
            fronts.append(front)
            backs.append(body)
            kinds.append(_link_constants(link, pulley.turning))
            front, body = body, body + 1
    return records(
        COUPLING,
        front=fronts,
        back=backs,
        kind=[kind for kind, _ in kinds],
        constants=np.array([constants for _, constants in kinds], dtype=float).reshape(-1, 3),
        schedule=_schedule_numbers(pulleys)[1],
    )


def _link_constants(
    link: Isolator | OneWayClutch | FrictionClutch, turning: float
) -> tuple[int, tuple[float, float, float]]:
    """Kind and constants of a link of a hub chain; a belt that advances turns the rim in the sense `turning`."""
    if isinstance(link, Isolator):
        return ISOLATOR, (link.stiffness, link.damping, 0.0)
    if isinstance(link, OneWayClutch):
        sense = turning if link.drives == "forward" else -turning
        return ONE_WAY_CLUTCH, (link.locking_damping, link.drag_torque, sense)
    return FRICTION_CLUTCH, (link.locking_damping, link.capacity, 0.0)


def _schedule_numbers(pulleys: Sequence[Pulley]) -> tuple[IntArray, IntArray]:
    """Numbers of the profiles that are the schedules of loads and of links, or `NO_SCHEDULE`."""
    loads, links = [], []
    following = len(pulleys)
    for pulley in pulleys:
        numbers = []
        for schedule in pulley.schedules:
            numbers.append(NO_SCHEDULE if schedule is None else following)
            following += schedule is not None
        loads += numbers[: len(pulley.load)]
        links += numbers[len(pulley.load) :]
    return np.array(loads, dtype=np.int64), np.array(links, dtype=np.int64)


def _tensioners(
    pulleys: Sequence[Pulley],
    moving: Sequence[SlidingTensioner | RotaryTensioner],
    path: Path | None,
    gravity: tuple[float, float],
) -> Records:
    """Sliding and rotary tensioners as arrays."""
    names = [pulley.name for pulley in pulleys]
    carried = [names.index(item.pulley) for item in moving]
    places = [_place(item, path, number) for item, number in zip(moving, carried, strict=True) if path is not None]

    def each(name: str) -> FloatArray:
        return np.array([getattr(item, name) or 0.0 for item in moving], dtype=float)

    stops = np.array([item.stops or (-np.inf, np.inf) for item in moving], dtype=float).reshape(-1, 2)
    return records(
        TENSIONER,
        pulley=carried,
        rotary=[isinstance(item, RotaryTensioner) for item in moving],
        origin=np.array([origin for origin, _, _, _ in places], dtype=float).reshape(-1, 2),
        direction=np.array([direction for _, direction, _, _ in places], dtype=float).reshape(-1, 2),
        arm=[arm for _, _, arm, _ in places],
        sense=[sense for _, _, _, sense in places],
        preload=each("preload"),
        rate=each("rate"),
        viscous=each("damping"),
        tensioning_friction=each("tensioning_friction"),
        yielding_friction=each("yielding_friction"),
        creep_speed=each("creep_speed"),
        lower=stops[:, 0],
        upper=stops[:, 1],
        stop_stiffness=each("stop_stiffness"),
        stop_damping=each("stop_damping"),
        weight=carried_masses(pulleys, moving)[:, None] * np.array(gravity),
    )


def _place(
    item: SlidingTensioner | RotaryTensioner, path: Path, number: int
) -> tuple[FloatArray, FloatArray, float, float]:
    """Origin, direction, length of the arm and sense of a tensioner."""
    center, gradient = path_gradient(path, number)
    sense = float(np.sign(item.leverage(center, gradient)))
    if isinstance(item, SlidingTensioner):
        return center, np.array(item.direction), 0.0, sense
    pivot, arm = np.array(item.pivot), item.arm_length(center)
    return pivot, (center - pivot) / arm, arm, sense


def _harmonics(groups: Sequence[Sequence[Harmonic]]) -> tuple[IntArray, Records]:
    """Harmonics laid end to end: the first of each group, and all of them."""
    found = [item for group in groups for item in group]
    table = records(
        HARMONIC,
        order=[item.order for item in found],
        amplitude=[item.amplitude for item in found],
        phase=[item.phase for item in found],
    )
    return _offsets(len(group) for group in groups), table


def _offsets(counts: Iterable[int]) -> IntArray:
    """Where groups begin that are laid end to end, and where the last one ends."""
    return np.cumsum([0, *counts]).astype(np.int64)

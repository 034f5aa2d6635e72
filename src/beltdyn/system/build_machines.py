"""From pulleys, machines and tensioners of the model to the arrays, on which the kernels work."""

from collections.abc import Sequence
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray, Records, as_values, offsets, records
from beltdyn.errors import ModelError
from beltdyn.machines import Goods, MovingTensioner, Tensioner
from beltdyn.machines.carrying import GOODS, SUPPORT_ROWS
from beltdyn.machines.links import PlacedLink, link_rows
from beltdyn.machines.loads.shaft import Sensor, ShaftLoads, shaft_loads
from beltdyn.machines.profiles.functions import NO_SCHEDULE, Profiles, profile_rows
from beltdyn.machines.tensioners import TENSIONER_ROWS
from beltdyn.model import Path, Prepared, Pulley
from beltdyn.model.carrier import carriers_of
from beltdyn.model.carrying import Stretch, normal_load, stiffness_of, upper_side
from beltdyn.quadrature import gauss_points
from beltdyn.system.arrays import BODY, PULLEY, Bare, Carrying


class Machines(NamedTuple):
    """The machines around a belt as arrays."""

    profiles: Profiles
    shaft_loads: ShaftLoads
    links: Records
    tensioners: Records


def machine_arrays(
    pulleys: Sequence[Pulley],
    tensioners: Sequence[Tensioner] = (),
    path: Path | None = None,
    gravity: tuple[float, float] = (0.0, 0.0),
    goods: Sequence[Goods] = (),
) -> Machines:
    """Arrays of everything on and behind the pulleys, and of the schedules of goods."""
    of_loads, of_links = _switching_numbers(pulleys)
    return Machines(
        profile_arrays(pulleys, goods),
        shaft_loads(
            [pulley.load for pulley in pulleys],
            of_loads,
            body_inertias(pulleys).size,
            _sensors(pulleys, tensioners),
        ),
        link_rows(_placed(pulleys, of_links)),
        _tensioners(pulleys, tensioners, path, gravity),
    )


def profile_arrays(pulleys: Sequence[Pulley], goods: Sequence[Goods] = ()) -> Profiles:
    """Arrays of all that is prescribed over time."""
    own = [pulley.speed if pulley.prescribed else pulley.torque for pulley in pulleys]
    switching = [item for pulley in pulleys for item in pulley.switching if item is not None]
    switching += [one.schedule for one in goods if one.schedule is not None]
    return profile_rows([*own, *switching], [*(pulley.harmonics for pulley in pulleys), *([()] * len(switching))])


def scheduled(pulleys: Sequence[Pulley]) -> int:
    """Number of profiles of pulleys, behind which those of goods come."""
    return len(pulleys) + sum(item is not None for pulley in pulleys for item in pulley.switching)


def pulley_arrays(
    pulleys: Sequence[Pulley], radii: FloatArray, frictions: Sequence[float], rolling: FloatArray, tensioners: Records
) -> Records:
    """Arrays of the pulleys: centers and radii (m), friction, rolling resistance, shafts among the bodies, carriers."""
    carrier = np.full(len(pulleys), -1, dtype=np.int64)
    carrier[tensioners.pulley] = np.arange(tensioners.size)
    return records(
        PULLEY,
        center=np.array([pulley.center for pulley in pulleys], dtype=float).reshape(-1, 2),
        radius=radii,
        friction=np.array(frictions, dtype=float),
        rolling=rolling,
        shaft=shaft_bodies(pulleys),
        carrier=carrier,
        foundation=np.ones(len(pulleys)),
        damping=np.ones(len(pulleys)),
        rim_ratio=np.ones(len(pulleys)),
        unloading=np.ones(len(pulleys)),
        beside=np.zeros(len(pulleys), dtype=np.int64),
    )


def body_arrays(
    pulleys: Sequence[Pulley],
    radii: FloatArray,
    tensioners: Sequence[Tensioner],
) -> Records:
    """Arrays of what moves: inertia and unknowns of rims, hub chains, states of controllers and tensioners."""
    masses, carried = body_inertias(pulleys), tensioner_inertias(pulleys, tensioners)
    lags = [[load.state_lag for load in pulley.load if load.state_lag is not None] for pulley in pulleys]
    inertia = np.concatenate([masses, *lags, carried])
    free = np.ones(inertia.size, dtype=bool)
    free[[shaft for shaft, pulley in zip(shaft_bodies(pulleys), pulleys, strict=True) if pulley.prescribed]] = False
    chains = [radius for radius, pulley in zip(radii, pulleys, strict=True) for _ in pulley.hub]
    states = [radius for radius, own in zip(radii, lags, strict=True) for _ in own]
    return records(
        BODY,
        inertia=inertia,
        kinetic=np.concatenate([masses, *(np.zeros(len(one)) for one in lags), carried]),
        unknown=np.where(free, np.cumsum(free) - 1, -1).astype(np.int64),
        reach=np.concatenate([radii, chains, states, tensioner_reaches(pulleys, tensioners)]),
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


def tensioner_inertias(pulleys: Sequence[Pulley], tensioners: Sequence[Tensioner]) -> FloatArray:
    """Inertia of each moving tensioner with its pulley: kg along a line, kg m^2 about a pivot; shape (K,)."""
    moving = _moving(pulleys, tensioners)
    return np.array([item.moved_inertia(np.array(pulley.center), pulley.mass) for item, pulley in moving], dtype=float)


def tensioner_reaches(pulleys: Sequence[Pulley], tensioners: Sequence[Tensioner]) -> FloatArray:
    """Way of the carried pulley's center in a unit of each moving tensioner's coordinate, shape (K,)."""
    return np.array([item.reach(np.array(pulley.center)) for item, pulley in _moving(pulleys, tensioners)], dtype=float)


def carried_masses(pulleys: Sequence[Pulley], tensioners: Sequence[Tensioner]) -> FloatArray:
    """Mass at the center of each carried pulley that has the weight of tensioner and pulley, kg, shape (K,)."""
    return np.array([item.weighing_mass(pulley.mass) for item, pulley in _moving(pulleys, tensioners)], dtype=float)


def _moving(pulleys: Sequence[Pulley], tensioners: Sequence[Tensioner]) -> list[tuple[MovingTensioner, Pulley]]:
    """Tensioners that move, each with its pulley."""
    named = {pulley.name: pulley for pulley in pulleys}
    return [(item, named[item.pulley]) for item in tensioners if isinstance(item, MovingTensioner)]


def _sensors(pulleys: Sequence[Pulley], tensioners: Sequence[Tensioner]) -> dict[str, Sensor]:
    """Moving tensioners as loads see them, by the names of their pulleys."""
    moving = _moving(pulleys, tensioners)
    return {
        pulley.name: Sensor(len(moving) - number, item, item.reach(np.array(pulley.center)))
        for number, (item, pulley) in enumerate(moving)
    }


def _placed(pulleys: Sequence[Pulley], schedules: Sequence[int]) -> list[PlacedLink]:
    """Links of the hub chains, pulley after pulley, from the rim inwards."""
    placed = list[PlacedLink]()
    for p, pulley in enumerate(pulleys):
        front = p
        for link in pulley.hub:
            body, schedule = len(pulleys) + len(placed), schedules[len(placed)]
            placed.append(PlacedLink(link, front, body, pulley.turning, schedule))
            front = body
    return placed


def _switching_numbers(pulleys: Sequence[Pulley]) -> tuple[list[tuple[int, int]], list[int]]:
    """Numbers of the profiles that are factor and command of loads, and factors of links, or `NO_SCHEDULE`."""
    loads, links = list[tuple[int, int]](), list[int]()
    following = len(pulleys)
    for pulley in pulleys:
        numbers = []
        for profile in pulley.switching:
            numbers.append(NO_SCHEDULE if profile is None else following)
            following += profile is not None
        of_loads = numbers[: 2 * len(pulley.load)]
        loads += zip(of_loads[::2], of_loads[1::2], strict=True)
        links += numbers[len(of_loads) :]
    return loads, links


def _tensioners(
    pulleys: Sequence[Pulley], tensioners: Sequence[Tensioner], path: Path | None, gravity: tuple[float, float]
) -> Records:
    """Rows of those that move."""
    moving = _moving(pulleys, tensioners)
    if moving and path is None:
        raise ModelError("the path is missing: a tensioner needs it for its direction of take-up.")
    carriers = carriers_of(tensioners, [pulley.name for pulley in pulleys], path) if path else []
    kinds = TENSIONER_ROWS.row_type(type(carrier.tensioner) for carrier in carriers)
    table = records(kinds, pulley=[carrier.pulley for carrier in carriers])
    for number, (carrier, mass) in enumerate(zip(carriers, carried_masses(pulleys, tensioners), strict=True)):
        TENSIONER_ROWS.fill(table[number], type(carrier.tensioner), as_values(carrier.constants))
        table.weight[number] = mass * np.array(gravity)
    return table


_POINTS = 6
"""Gauss points of an element: exact for mass and stiffness of a quintic."""
_BEYOND = 0.02
"""How far elements may move along a span, over its length, on either side."""


def carrying_arrays(prepared: Prepared, lengths: FloatArray) -> Bare | Carrying:
    """Supports and goods on a staying mesh with elements of lengths (m)."""
    if not prepared.carries:
        return Bare()
    supports, goods = _supports(prepared), _goods(prepared)
    of_supports = _by_element(prepared, lengths, [prepared.stretch(one) for one in prepared.supports])
    of_goods = _by_element(prepared, lengths, [prepared.stretch(one) for one in prepared.goods])
    return Carrying(supports, goods, *of_supports, *of_goods, np.array(prepared.gravity), gauss_points(_POINTS))


def on_other_lengths(prepared: Prepared, carrying: Bare | Carrying, lengths: FloatArray) -> Bare | Carrying:
    """The same supports and goods on another mesh."""
    if isinstance(carrying, Bare):
        return carrying
    mesh = carrying_arrays(prepared, lengths)
    assert isinstance(mesh, Carrying)
    return mesh._replace(supports=carrying.supports, goods=carrying.goods)


def with_resistance(carrying: Bare | Carrying, factor: float) -> Bare | Carrying:
    """The same supports with a factor on their resistances."""
    if isinstance(carrying, Bare) or np.all(carrying.supports.resisting == factor):
        return carrying
    supports = carrying.supports.copy()
    supports["resisting"] = factor
    return carrying._replace(supports=supports)


def with_stiffer_supports(carrying: Bare | Carrying, factor: float) -> Bare | Carrying:
    """The same supports with a factor on their stiffness, in which the belt without goods lies as straight."""
    if isinstance(carrying, Bare) or factor == 1.0:
        return carrying
    supports = carrying.supports.copy()
    supports["stiffness"] *= factor
    supports["raised"] /= factor
    return carrying._replace(supports=supports)


def with_clamping_supports(carrying: Bare | Carrying) -> Bare | Carrying:
    """The same supports, all of which hold the belt on both sides."""
    if isinstance(carrying, Bare) or np.all(carrying.supports.both_sides == 1):
        return carrying
    supports = carrying.supports.copy()
    supports["both_sides"] = 1
    return carrying._replace(supports=supports)


def _line(stretch: Stretch) -> dict[str, Any]:
    return {
        "origin": tuple(stretch.origin),
        "direction": tuple(stretch.direction),
        "first": stretch.start,
        "last": stretch.end,
    }


def _supports(prepared: Prepared) -> Records:
    """Rows of supports."""
    belt_mass, weight = prepared.belt.mass_per_length, float(np.hypot(*prepared.gravity))
    kinds = [type(one) for one in prepared.supports]
    table = records(SUPPORT_ROWS.row_type(kinds), resisting=np.ones(len(kinds)))
    for row, kind, one in zip(table, kinds, prepared.supports, strict=True):
        stretch = prepared.stretch(one)
        load = normal_load(one, prepared.goods, belt_mass, stretch.direction, prepared.gravity)
        tension, bending = prepared.installation.tension, prepared.belt.bending_stiffness
        stiffness = stiffness_of(one, load, tension, bending, stretch.length)
        for name, value in _line(stretch).items():
            row.line[name] = value
        row.normal = upper_side(stretch.direction, prepared.gravity)
        row.curvature = 0.0 if one.curve_radius is None else 1.0 / one.curve_radius
        own = normal_load(one, (), belt_mass, stretch.direction, prepared.gravity)
        row.raised = own / stiffness
        row.stiffness, row.rotating = stiffness, one.rotating_mass
        row.damping = 2.0 * sqrt(stiffness * belt_mass) if one.damping is None else one.damping
        row.both_sides = not one.needs_weight
        SUPPORT_ROWS.fill(row, kind, one.values(weight))
    return table


def _goods(prepared: Prepared) -> Records:
    """Rows of goods."""
    table = records(GOODS, mass=[one.mass_per_length for one in prepared.goods])
    table.schedule = NO_SCHEDULE
    number = scheduled(prepared.pulleys)
    for row, one in zip(table, prepared.goods, strict=True):
        for name, value in _line(prepared.stretch(one)).items():
            row.line[name] = value
        row.rear, row.front = (-np.inf, np.inf) if one.batch is None else one.batch
        row.stretch = prepared.laid.stretch
        if one.schedule is not None:
            row.schedule, number = number, number + 1
    return table


def _by_element(prepared: Prepared, lengths: FloatArray, stretches: Sequence[Stretch]) -> tuple[IntArray, IntArray]:
    """Where the rows of each element begin, and the rows of one element after the other."""
    laid, path = prepared.laid, prepared.installation.path
    ends = np.cumsum(lengths)
    middles = ends - 0.5 * lengths
    rows: list[list[int]] = [[] for _ in lengths]
    for number, stretch in enumerate(stretches):
        start, stop = _near(path, stretch)
        first = (path.span_start(stretch.span) + start - laid.start) / laid.stretch
        size = (stop - start) / laid.stretch
        along = (middles - first) % prepared.belt_length
        near = (along <= size + 0.5 * lengths) | (along >= prepared.belt_length - 0.5 * lengths)
        for element in np.flatnonzero(near):
            rows[element].append(number)
    return offsets(map(len, rows)), np.array([number for own in rows for number in own], dtype=np.int64)


def _near(path: Path, stretch: Stretch) -> tuple[float, float]:
    """Between which places along a span elements may come to lie on a stretch of it, m from its start.

    Arcs of the mesh stay at their pulleys. A drum that a take-up moves towards a support would press on it.
    """
    length = float(path.span_lengths[stretch.span])
    margin = _BEYOND * length
    return max(stretch.start - margin, 0.0), min(stretch.end + margin, length)

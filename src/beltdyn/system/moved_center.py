"""Pulleys whose centers are moved: each slides on a carrier of prescribed speed along a line, without a spring."""

from math import hypot

import numpy as np

from beltdyn.machines.tensioners.registry import TENSIONER, free_slide
from beltdyn.records import records
from beltdyn.system.arrays import BODY, System
from beltdyn.system.pulley_state import pulley_center
from beltdyn.system.state import State


def with_movers(system: System, pulleys: list[int]) -> System:
    """Put pulleys on carriers whose motion is prescribed, behind the tensioners.

    Parameters
    ----------
    system
        A system.
    pulleys
        Numbers of pulleys that nothing carries.

    Returns
    -------
    System
        A coordinate more for each of them, at the end of states.
    """
    table, count = system.pulleys.copy(), len(system.tensioners)
    carriers = np.resize(system.tensioners, count + len(pulleys)) if count else records(TENSIONER, pulley=pulleys)
    for number, pulley in enumerate(pulleys, count):
        carriers[number] = free_slide(pulley, tuple(system.pulleys.center[pulley]))
        table.carrier[pulley] = number
    own = records(BODY, inertia=np.zeros(len(pulleys)), kinetic=0.0, unknown=-1, reach=1.0)
    return system._replace(
        pulleys=table,
        tensioners=carriers.view(np.recarray),
        bodies=np.concatenate([system.bodies, own]).view(np.recarray),
    )


def moving_to(
    system: System, state: State, first: int, centers: dict[int, tuple[float, float]], time: float
) -> tuple[System, State]:
    """Let carriers begin to move at constant speed, so that centers are reached after a time; the others stand still.

    Parameters
    ----------
    system
        From `with_movers`.
    state
        Where it is.
    first
        Number of the first such carrier.
    centers
        By the number of a pulley, m.
    time
        s.

    Returns
    -------
    system, state
        The same places, and other speeds of centers.
    """
    table, position, velocity = system.tensioners.copy(), state.position.copy(), state.velocity.copy()
    for carrier in range(first, len(table)):
        pulley, place = int(table.pulley[carrier]), position.size - len(table) + carrier
        x, y = pulley_center(system, pulley, position)
        to_x, to_y = centers.get(pulley, (x, y))
        way = hypot(to_x - x, to_y - y)
        slide = table["sliding"][carrier]
        slide["center"] = x, y
        if way > 0.0:
            slide["direction"] = (to_x - x) / way, (to_y - y) / way
        position[place], velocity[place] = 0.0, way / time
    return system._replace(tensioners=table), State(position, velocity, state.acceleration)

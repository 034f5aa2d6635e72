"""Nips that are loaded by forces, in steady running: their rollers are moved until they press with them."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared
from beltdyn.model.nip import Pair
from beltdyn.system.arrays import System

_ACCURACY = 1e-9
"""Of a move that ends the search, over the smallest radius."""


class NipLoad(NamedTuple):
    """A nip that is loaded by a force."""

    roller: int
    pulley: int
    force: float
    """N."""
    stiffness: float
    """Growth of the force over the way of the roller, N/m."""
    pair: Pair
    """Of which the lasting compression of the belt follows from the overlap."""


def nip_loads(prepared: Prepared) -> list[NipLoad]:
    """The nips of a drive that are loaded by forces."""
    found, path, contact = list[NipLoad](), prepared.path, prepared.contact_stiffness
    for nip, (roller, pulley), depth in zip(prepared.drive.nips, path.nips, path.indentations.tolist(), strict=True):
        if nip.force is not None:
            pair = Pair.of(prepared.pulleys[roller], prepared.pulleys[pulley], prepared.belt, contact)
            found.append(NipLoad(roller, pulley, nip.force, pair.slope(depth), pair))
    return found


def with_own_rollers(system: System) -> System:
    """The same system, with an array of its own for the centers of rollers that move."""
    return system._replace(pulleys=system.pulleys.copy()) if np.any(system.pulleys.beside) else system


def pressed_on(system: System, loads: list[NipLoad], hub: FloatArray, size: float) -> bool:
    """Move rollers by what forces of the belt on hubs, shape (P, 2), miss; False if all moves are small."""
    centers, radii, far = system.pulleys.center, system.pulleys.radius, False
    for one in loads:
        way = centers[one.pulley] - centers[one.roller]
        way /= np.hypot(*way)
        step = (one.force + float(hub[one.roller] @ way)) / one.stiffness
        centers[one.roller] += step * way
        depth = radii[one.roller] + radii[one.pulley] - np.hypot(*(centers[one.pulley] - centers[one.roller]))
        system.pulleys.lasting[one.roller] = one.pair.lasting * one.pair.peak(float(depth))
        far = far or abs(step) > _ACCURACY * size
    return far

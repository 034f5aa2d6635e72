"""Steady running from that of a neighbour: the same drive under other speeds, torques or loads, or one much like it."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.recorded import runs_steadily
from beltdyn.solve.rest.staying import carried
from beltdyn.solve.steady_running.search import SteadySearch
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import rigid_links


def require_neighbour(drive: Drive, start: Run, elements: int | None) -> None:
    """Make sure that steady running of a drive can begin with that of another one.

    Parameters
    ----------
    drive
        The drive.
    start
        Results of the other one.
    elements
        Number of equal elements that is asked for, if any.

    Raises
    ------
    ModelError
        If they are not those of steady running, or of other pulleys and tensioners, or a mesh is asked for.
    """
    if elements is not None:
        raise ModelError(f"elements = {elements} cannot be given with start, which has its own mesh. Omit one of them.")
    if not runs_steadily(start.dataset):
        raise ModelError("start is a run over time, not steady running. Give a result of `steady_state`.")
    mine, other = ([pulley.name for pulley in one.pulleys] for one in (drive, start.drive))
    if mine != other or len(drive.moving_tensioners) != len(start.drive.moving_tensioners):
        raise ModelError(
            f"start has the pulleys {', '.join(other)} and {len(start.drive.moving_tensioners)} moving "
            f"tensioners; the drive has {', '.join(mine)} and {len(drive.moving_tensioners)}. Give the steady "
            "running of a drive that differs only in values, or omit start."
        )


def with_length_of(drive: Drive, start: Run) -> Drive | None:
    """The drive with the length of the belt, or the take-up, that is known; None if it must be found.

    Parameters
    ----------
    drive
        The drive.
    start
        Steady running of a drive. If it is that of this one, at whatever instant, the length found then is known.
    """
    if drive.belt.installed_tension is None:
        return drive
    return start.drive if start.dataset.attrs["drive_as_given"] == drive.text else None


def search_from(drive: Drive, start: Run, time: float) -> SteadySearch:
    """A search for steady running that begins with that of a neighbour, on its mesh.

    Its speeds are changed in proportion to those that are prescribed.

    Parameters
    ----------
    drive
        A drive with a length.
    start
        What `require_neighbour` lets pass.
    time
        At which speeds, torques and schedules are taken, s.
    """
    found = start.dataset
    lengths = np.diff(found.node_coordinate.values, append=start.drive.belt_length)
    system, state = carried(drive, start.drive, lengths, found.nodal_coordinates.values[-1].ravel())
    if system.tensioners.size:
        state.position[-system.tensioners.size :] += found.tensioner_position.values[-1]
    bodies, speeds = state.velocity[system.first_body :], found.pulley_speed.values[-1]
    bodies[: speeds.size] = speeds
    take_along(system, bodies, found.shaft_speed.values[-1])
    search = SteadySearch(drive, system, state, time)
    faster = _faster(search.constant, bodies)
    bodies *= faster
    system.frame.speed[0] = faster * found.attrs["belt_parameter"]
    return search


def take_along(system: System, bodies: FloatArray, shafts: FloatArray) -> None:
    """Give the bodies of hub chains their speeds, from those of the rims, which are in place, and of the shafts."""
    for link in system.links:
        bodies[link.back] = bodies[link.front]
    bodies[system.pulleys.shaft] = shafts
    for link, rigid in zip(system.links[::-1], rigid_links(system)[::-1], strict=True):
        if rigid:
            bodies[link.front] = bodies[link.back]


def _faster(system: System, bodies: FloatArray) -> float:
    """Speeds of prescribed shafts over those that they have; 1 without such shafts."""
    shafts, wanted = system.pulleys.shaft, system.profiles.segment.offset
    for p in np.flatnonzero(system.bodies.unknown[shafts] < 0):
        if wanted[p] * bodies[shafts[p]] > 0.0:
            return float(wanted[p] / bodies[shafts[p]])
    return 1.0

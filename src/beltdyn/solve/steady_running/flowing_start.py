"""Where a run on a mesh that stays begins: at rest, or in the steady running of its first instant."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.defaults import MOST
from beltdyn.model.graded_mesh import FINENESS
from beltdyn.solve.progress import Progress, Report
from beltdyn.solve.rest.staying import Standing, anchor_at, bring_to_stand, stand
from beltdyn.solve.steady import require_steady
from beltdyn.solve.steady_running.refinement import errors_at_rest
from beltdyn.solve.steady_running.search import SteadySearch
from beltdyn.system.arrays import System
from beltdyn.system.build_staying import flowing_system, smoothed_over_time
from beltdyn.system.state import State


class Beginning(NamedTuple):
    """Where a run begins."""

    drive: Drive
    """With the length, or the take-up, that gives the installed tension."""
    system: System
    state: State
    unstable: tuple[str, ...] = ()
    """Names of the pulleys whose tensioners are not in stable balance at rest."""
    mesh_errors: Mapping[str, float] = MappingProxyType({})
    """What a mesh that stays makes wrong at rest, relative, where a finer one has told."""


def begin_flowing(drive: Drive, progress: Report | None) -> Beginning:
    """Find the state in which a run on a mesh that stays begins, and the mesh.

    Parameters
    ----------
    drive
        The drive; `simulation.start` says whether it begins at rest or in steady running.
    progress
        Whom to tell.

    Raises
    ------
    ModelError
        If the belt is open, or the drive cannot run steadily where it is to begin so.
    ConvergenceError
        If there is no such state.
    """
    if drive.ends:
        raise ModelError(
            'simulation.frame = "staying" does not fit an open belt: no belt flows past its ends. '
            'Set simulation.frame = "travelling".'
        )
    steady = drive.simulation.start == "steady"
    if steady:
        _require_steady(drive)
    if progress is not None:
        progress(Progress(0.0, drive.simulation.duration, 0.0, 0, "equilibrium"))
    rest = _meshed(drive)
    direction = anchor_at(rest.system, rest.state, True).direction
    state = _running(rest) if steady else rest.state
    speed = float(rest.system.frame.speed[0])
    flowing = flowing_system(smoothed_over_time(rest.system), direction)
    errors = errors_at_rest(rest)
    return Beginning(rest.drive, flowing, with_passage(rest.system, state, speed), mesh_errors=errors)


def _require_steady(drive: Drive) -> None:
    """Make sure that a drive may run steadily at time zero."""
    try:
        require_steady(drive)
    except ModelError as error:
        raise ModelError(
            f'simulation.start = "steady" needs steady running, and {error} Or set simulation.start = "equilibrium".'
        ) from error


def _meshed(drive: Drive) -> Standing:
    """The drive at rest on a graded mesh of about the number of elements that it asks for."""
    rest = bring_to_stand(drive)
    given = drive.belt.elements
    fineness = rest.fineness * (given or MOST) / rest.system.nodes
    return stand(rest.drive, fineness=fineness if given else min(FINENESS, fineness))


def _running(rest: Standing) -> State:
    """Steady running at time zero."""
    search = SteadySearch(rest.drive, rest.system, rest.state, 0.0)
    search.run(rest)
    return search.running()


def with_passage(system: System, state: State, speed: float) -> State:
    """Add the length of belt that has passed, zero, and its speed (m/s) to a state on a mesh that stays."""
    at = system.first_body + system.bodies.size - system.tensioners.size

    vectors = zip((state.position, state.velocity, state.acceleration), (0.0, speed, 0.0), strict=True)
    return State(*(np.insert(vector, at, value) for vector, value in vectors))

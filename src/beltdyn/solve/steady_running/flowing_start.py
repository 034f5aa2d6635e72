"""Where a run on a staying mesh begins: at rest, or in the steady running of its first instant."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from beltdyn.model import Drive
from beltdyn.model.defaults import MOST
from beltdyn.model.graded_mesh import FINENESS
from beltdyn.results import mesh_error_attribute
from beltdyn.solve.integrators.settling import with_angles
from beltdyn.solve.progress import Progress, Report
from beltdyn.solve.rest.staying import FINER, Standing, anchor_at, bring_to_stand, stand
from beltdyn.solve.steady_running.refinement import MeshRule, errors_at_rest, refine_at_rest, steady_from_rest
from beltdyn.solve.steady_running.search import SteadySearch
from beltdyn.system.arrays import System
from beltdyn.system.build_staying import flowing_system, on_other_mesh
from beltdyn.system.state import State

DIRECTION = "mesh_direction"
"""Attribute of results on a staying mesh: the direction along which node 0 does not move, a unit vector."""


class Beginning(NamedTuple):
    """Where a run begins."""

    drive: Drive
    """With the length, or the take-up, that gives the installed tension."""
    system: System
    state: State
    unstable: tuple[str, ...] = ()
    """Names of the pulleys whose tensioners are not in stable balance at rest."""
    attributes: Mapping[str, Any] = MappingProxyType({})
    """What is said of it, global attributes of the dataset."""


def begin_flowing(drive: Drive, progress: Report | None) -> Beginning:
    """Find the state in which a run on a staying mesh begins, and the mesh.

    Parameters
    ----------
    drive
        The drive; `simulation.start` says whether it begins at rest or in steady running.
    progress
        Whom to tell.

    Raises
    ------
    ModelError
        If the drive cannot run steadily where it is to begin so.
    ConvergenceError
        If there is no such state.
    """
    if progress is not None:
        progress(Progress(0.0, drive.simulation.duration, 0.0, 0, "equilibrium"))
    meshed = _meshed(drive)
    if drive.simulation.start == "steady":
        meshed = _running(meshed, drive.simulation.force_tolerance)
    system, direction = meshed.system, anchor_at(meshed.state, True).direction
    flowing = with_angles(meshed.drive, flowing_system(system, direction))
    errors = meshed.errors or {"peak pressure": float("nan")}  # not known
    said = {mesh_error_attribute(name): error for name, error in errors.items()} | {DIRECTION: direction}
    return Beginning(meshed.drive, flowing, with_passage(system, meshed.state, meshed.speed), attributes=said)


class _Meshed(NamedTuple):
    """A state on a staying mesh."""

    rest: Standing
    """The belt at rest on that mesh, or on one from which it was refined."""
    system: System
    state: State
    speed: float
    """Of the belt, m/s."""
    errors: Mapping[str, float]
    """Of the mesh, relative, as far as they are known."""

    @property
    def drive(self) -> Drive:
        """With the length, or the take-up, that gives the installed tension."""
        return self.rest.drive


def _meshed(drive: Drive) -> _Meshed:
    """The drive at rest, on a mesh as it asks for."""
    settings, given = drive.simulation, drive.belt.elements
    if settings.mesh == "uniform":
        rest = bring_to_stand(drive, drive.elements)
        errors = errors_at_rest(rest, drive.elements)
    elif settings.force_tolerance is not None:
        rest, errors = refine_at_rest(stand(bring_to_stand(drive).drive), settings.force_tolerance)
    else:
        rest = bring_to_stand(drive)
        fineness = rest.fineness * (given or MOST) / rest.system.nodes
        rest = stand(rest.drive, fineness=fineness if given else min(FINENESS, fineness))
        errors = errors_at_rest(rest)
    return _Meshed(rest, rest.system, rest.state, 0.0, errors)


def _running(meshed: _Meshed, force_tolerance: float | None) -> _Meshed:
    """Steady running at the beginning, on the same mesh, or on one that is refined up to a tolerance."""
    rest, time = meshed.rest, meshed.drive.simulation.begin
    if force_tolerance is None:
        search, system, errors = SteadySearch(rest.drive, rest.system, rest.state, time), rest.system, meshed.errors
        search.run(rest)
    else:
        search, rest, _, errors, _ = steady_from_rest(rest, time, _same_mesh, force_tolerance, bands=False)
        system = on_other_mesh(rest.drive, rest.system, search.constant.length)
    return meshed._replace(rest=rest, system=system, state=search.running(), speed=search.belt_parameter, errors=errors)


def _same_mesh(rest: Standing) -> MeshRule:
    """The rule of which the next finer mesh is that at rest, refined already."""
    return MeshRule(rest.layer, rest.fineness / FINER)


def with_passage(system: System, state: State, speed: float) -> State:
    """Add the length of belt that has passed, zero, and its speed (m/s) to a state on a staying mesh."""
    at = system.first_body + system.bodies.size - system.tensioners.size

    vectors = zip((state.position, state.velocity, state.acceleration), (0.0, speed, 0.0), strict=True)
    return State(*(np.insert(vector, at, value) for vector, value in vectors))

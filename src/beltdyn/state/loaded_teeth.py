"""Where a toothed belt stands under the loads of the first instant of a run, held by the teeth of a driver.

Friction holds no belt at rest, but teeth do: a drive that starts without its constant torques would be struck by them.
The torque of the driver balances the others,

    sum over pulleys of M_p r_p  +  F u . t  =  0,

with r = +-2 pi / (z p_b) of `TEETH`, and on a linear axis the force F on the carriage along u, where the belt runs
along t: the elastic energy of a belt does not change as it moves along itself with its grooves.
"""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.surface import MeshingRims, ToothedRims
from beltdyn.errors import ConvergenceError
from beltdyn.kernel import interpreted
from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.machines.profiles.functions import profile_value
from beltdyn.model import Prepared
from beltdyn.state.static import find_equilibrium
from beltdyn.state.staying import under_torques
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import constant_drive, rigid_links, rim_of_bodies, twists
from beltdyn.system.guide import Guided
from beltdyn.system.meshing import at_phases, phases, toothed_pulleys
from beltdyn.system.state import State


def with_loads_on_teeth(prepared: Prepared, system: System, state: State) -> tuple[System, State]:
    """A belt at rest where its teeth hold the torques of the first instant, or as it was if no such state is found."""
    torque = _balanced_torques(prepared, system)
    if not np.any(torque):
        return system, state
    loaded = State(state.position.copy(), state.velocity.copy(), state.acceleration.copy())
    meshes = isinstance(system.rims, MeshingRims)
    if meshes:
        if not under_torques(prepared, system, loaded, torque):
            return system, state
        phase = phases(system).copy()
    else:
        try:
            found = find_equilibrium(system, state, torque=torque)
        except ConvergenceError:
            return system, state
        loaded.position[:], phase = found.state.position, found.phases
    angles = twists(constant_drive(system, prepared.simulation.begin), -torque, loaded)
    first = system.first_body
    loaded.position[first : first + angles.size] = angles
    return (system if meshes else at_phases(system, phase - angles[: phase.size])), loaded


def _balanced_torques(prepared: Prepared, system: System) -> FloatArray:
    """Torques on toothed pulleys at the first instant at rest, N m, shape (P,), with that of the driver.

    Zero without a toothed pulley of prescribed speed, which stands against the others.
    """
    torque, toothed = np.zeros(system.pulleys.size), toothed_pulleys(system)
    driven = [p for p in toothed.tolist() if prepared.pulleys[p].prescribed]
    if not driven:
        return torque
    held = constant_drive(system, prepared.simulation.begin)
    rims, rigid = rim_of_bodies(system), rigid_links(held)
    clutched = {int(rims[link.front]) for link, stiff in zip(system.links, rigid, strict=True) if not stiff}
    still = np.zeros(system.bodies.size)
    for p in toothed.tolist():
        if not prepared.pulleys[p].prescribed and p not in clutched:
            at_rest = interpreted(shaft_torque)(held.profiles, held.shaft_loads, p, 0.0, 0.0, 0.0, still)
            torque[p] = at_rest.torque
    assert isinstance(system.rims, MeshingRims | ToothedRims)
    rate = np.asarray(system.rims.table.rate)
    torque[driven[0]] = -(float(torque @ rate) + _pull_of_carriage(prepared, system)) / rate[driven[0]]
    return torque


def _pull_of_carriage(prepared: Prepared, system: System) -> float:
    """Force on a carriage in the direction in which the belt runs there, N; zero without one."""
    carriage = system.carriage
    if not isinstance(carriage, Guided):
        return 0.0
    row = carriage.table[0]
    push = interpreted(profile_value)(carriage.push, 0, prepared.simulation.begin)[0]
    along = float(prepared.path.tangent(np.zeros(1))[0] @ row.direction)
    return along * float(row.spring.preload + push)

"""Why a drive has no steady running: which pulley slips through, and what it transmits at most."""

import numpy as np

from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import own_torque
from beltdyn.system.discretization import curve_lengths
from beltdyn.system.observe import observe
from beltdyn.system.state import State

_FULL = 0.9
"""Use of friction of a pulley that slips through, at least."""
_ALIKE = 0.98
"""Of pulleys that use so much of the friction that the worst one does, the one that takes most power is named."""


def slips_through(drive: Drive, system: System, state: State, load: float, asked: System) -> str:
    """Say how much the drive transmits.

    Parameters
    ----------
    drive, system
        The drive.
    state
        The last steady running on the way to the loads that are asked for.
    load
        Factor on the loads there.
    asked
        The drive under the loads that are asked for.
    """
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    touched, normal, friction = (one[0] for one in (seen.contact_pulley, seen.normal_force, seen.friction_force))
    weights = np.outer(curve_lengths(system), system.contact.weights).ravel()
    used = np.zeros(system.pulleys.size)
    for p, coefficient in enumerate(system.pulleys.friction):
        here = touched == p
        limit = coefficient * float(np.sum((weights * normal)[here]))
        used[p] = abs(float(np.sum((weights * friction)[here]))) / limit if limit > 0.0 else 0.0
    taken = seen.pulley_torque[0] * state.velocity[system.first_body :][: used.size]
    worst = int(np.argmax(np.where(used > _ALIKE * used.max(), taken, -np.inf)))
    name, torque = drive.pulleys[worst].name, abs(float(seen.pulley_torque[0, worst]))
    speed = RPM * abs(float(state.velocity[system.first_body + worst]))
    shaft = int(system.pulleys.shaft[worst])
    held = system.bodies.unknown[shaft] < 0
    wanted = abs(own_torque(asked, state, worst, float(state.velocity[system.first_body + shaft])))
    if used[worst] >= _FULL and held:
        return (
            f"the search ends where the belt slides on the whole arc of {name}, with {torque:.4g} N m at {speed:.4g} "
            "rpm. Its speed is prescribed: let it slip less, or raise the tension, the friction or the wrap angle."
        )
    if used[worst] < _FULL or torque >= wanted:
        return (
            f"the search ends at {load:.1%} of the loads, where {name} uses {used[worst]:.0%} of its friction. Look at "
            "a run over time with `beltdyn run`."
        )
    return (
        f"the belt slips through on {name}, which transmits at most {torque:.4g} N m at {speed:.4g} rpm; "
        f"{wanted:.4g} N m is asked for. Raise the tension, the friction or the wrap angle, or reduce the load."
    )

"""Why a drive has no steady running: which pulley slips, and the torque that it transmits at most.

Beyond gross slip a solution may go on: a belt that slows down while its driver turns is pressed to the pulleys by what
its inertia took before.  What a pulley transmits is told where its slip becomes gross.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared
from beltdyn.parts.quantity import RPM
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import own_torque
from beltdyn.system.nips import seen_nips
from beltdyn.system.observe import observe
from beltdyn.system.state import State, curve_lengths

_FULL = 0.9
"""Use of friction of a pulley that slips as a whole, at least."""
_ALIKE = 0.98
"""Of pulleys that use so much of the friction that the worst one does, the one that takes most power is named."""
_MOST = 0.99
"""Largest slip from which the speed without slip is extrapolated."""
GROSS = 0.05
"""Slip that is gross: creep is a few strains of the belt."""


class Setting(NamedTuple):
    """Distance of a drive from the required one."""

    speed: float = 1.0
    """Factor on prescribed speeds."""
    load: float = 1.0
    """Factor on torques and loads."""
    smoothing: float = 1.0
    """Factor on the slip velocity at which friction is fully used."""
    support: float = 0.0
    """Part of the torque that keeps a motor at the speed at which it was held."""
    stretch_length: float = 1.0
    """Factor on the length over which hysteresis smoothes slow changes of the stretch; small, it is viscous damping."""
    bending_loss: float = 1.0
    """Factor on the hysteresis of bending."""


class Passed(NamedTuple):
    """Steady running during the increase of the loads."""

    setting: Setting
    state: State
    belt_parameter: float
    """Length of unstretched belt that passes in a second, m/s."""
    unknowns: FloatArray
    """As from `SteadySearch.unknowns`."""


def slip_limit(prepared: Prepared, system: System, asked: System, passed: Sequence[Passed]) -> str:
    """Name the pulley that slips, and say how much it transmits."""
    slips = np.array([_slips(prepared, system, one) for one in passed])
    last, (at, slip) = passed[-1], gross_slip(prepared, system, passed)
    here = passed[at] if slip > GROSS else last
    torques, used = _transmitted(system, here)
    used[[_idles(asked, here, p) for p in range(used.size)]] = 0.0
    used[prepared.drive.guides] = 0.0
    taken = torques * here.state.velocity[system.first_body :][: used.size]
    most = np.where(used > _ALIKE * used.max(), taken, -np.inf)
    worst = int(np.argmax(most if slip <= GROSS else np.where(slips[0] > GROSS, -1.0, slips[at])))
    if slip <= GROSS and used[worst] < _FULL:
        return (
            f"the search ends at {last.setting.load:.1%} of the loads, where `{prepared.pulleys[worst].name}` uses "
            f"{used[worst]:.0%} of its friction. Simulate the drive over time with `beltdyn simulate`."
        )
    torque = abs(float(torques[worst]))
    wanted = abs(_asked_of(prepared, asked, last, slips[-1], worst))
    of = f" of the {wanted:.4g} N m required" if wanted > torque else ""
    speed = RPM * abs(float(here.state.velocity[system.first_body + worst]))
    if worst in prepared.path.beside:
        return (
            f"the belt slips in the nip of `{prepared.pulleys[worst].name}`, which transmits at most {torque:.4g} N m"
            f"{of} by this force of the nip. Raise it or the friction, or reduce the load."
        )
    return (
        f"the belt slips on `{prepared.pulleys[worst].name}`, which transmits at most {torque:.4g} N m{of} at this "
        f"tension ({speed:.4g} rpm). Raise the tension, the friction or the wrap angle, or reduce the load."
    )


def gross_slip(prepared: Prepared, system: System, passed: Sequence[Passed]) -> tuple[int, float]:
    """Find the first of the solutions in which a pulley slips as a whole that did not at first, and its slip.

    Without one, 0 and 0. An idler that slips at the least loads already limits nothing.
    """
    if not passed:
        return 0, 0.0
    slips = np.array([_slips(prepared, system, one) for one in passed])
    slips[:, slips[0] > GROSS] = 0.0
    beyond = np.flatnonzero(np.max(slips, axis=1) > GROSS)
    return (int(beyond[0]), float(np.max(slips[beyond[0]]))) if beyond.size else (0, 0.0)


def _slips(prepared: Prepared, system: System, one: Passed) -> FloatArray:
    """Difference of speed of each rim and the belt, over the larger of them."""
    rims = np.abs(one.state.velocity[system.first_body :][: system.pulleys.size] * prepared.rolling_radii)
    belt = abs(one.belt_parameter) * prepared.path.length / prepared.belt_length
    return np.asarray(np.abs(rims - belt) / np.maximum(rims, belt))


def _transmitted(system: System, one: Passed) -> tuple[FloatArray, FloatArray]:
    """Torque of the belt on each pulley, N m, and the part of its friction that is used."""
    seen = observe(system, np.zeros(1), one.state.position[None], one.state.velocity[None])
    touched, normal, friction = (given[0] for given in (seen.contact_pulley, seen.normal_force, seen.friction_force))
    weights = np.outer(curve_lengths(system), system.contact.weights).ravel()
    used = np.zeros(system.pulleys.size)
    for p, coefficient in enumerate(system.pulleys.friction):
        here = touched == p
        limit = coefficient * float(np.sum((weights * normal)[here]))
        used[p] = abs(float(np.sum((weights * friction)[here]))) / limit if limit > 0.0 else 0.0
    nips = seen_nips(system, one.state.position[None], one.state.velocity[None])
    for row, p in enumerate(np.flatnonzero(system.pulleys.beside).tolist() if nips else ()):
        assert nips is not None
        pressed, along = (float(weights @ force[0, row]) for force in (nips.nip_normal_force, nips.nip_friction_force))
        limit = float(system.pulleys.friction[p]) * pressed
        used[p] = abs(along) / limit if limit > 0.0 else 0.0
    return np.asarray(seen.pulley_torque[0]), used


def _idles(asked: System, here: Passed, pulley: int) -> bool:
    """Whether a pulley has neither load nor motor nor prescribed speed."""
    shaft = int(asked.pulleys.shaft[pulley])
    speed = float(here.state.velocity[asked.first_body + shaft])
    return bool(asked.bodies.unknown[shaft] >= 0 and own_torque(asked, here.state, pulley, speed) == 0.0)


def _asked_of(prepared: Prepared, asked: System, last: Passed, slips: FloatArray, pulley: int) -> float:
    """Torque of the loads of a pulley without slip, or else what those of the others need of it, N m."""
    shafts = asked.pulleys.shaft
    speeds = last.state.velocity[asked.first_body + shafts] / (1.0 - np.minimum(slips, _MOST))
    torques = np.array([own_torque(asked, last.state, p, float(speed)) for p, speed in enumerate(speeds)])
    if asked.bodies.unknown[shafts[pulley]] >= 0:
        return float(torques[pulley])
    free = asked.bodies.unknown[shafts] >= 0
    return float(np.sum((torques / prepared.path.radii)[free])) * float(prepared.path.radii[pulley])

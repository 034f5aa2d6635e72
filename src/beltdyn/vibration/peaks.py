"""Amplitudes of tensions and hub loads under the harmonics of speeds and loads, by the lumped drive."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Drive, Prepared
from beltdyn.model.path import span_directions
from beltdyn.points.quasi_steady import Running
from beltdyn.vibration.excitation import LOAD, SPEED, Excitation, own_excitations, speed_waves, torque_waves
from beltdyn.vibration.lumped import LumpedDrive, lumped_drive
from beltdyn.vibration.response_answers import friction_dashpots

_ROUNDS, _SETTLED = 30, 1e-3
"""Rounds in which dashpots for dry friction settle, at most, and the relative change that ends them."""


class Amplitudes(NamedTuple):
    """Sums of the amplitudes of all excitations."""

    tension: FloatArray
    """Of spans, N."""
    hub_load: FloatArray
    """Of pulleys, N, along the mean hub load."""
    positions: FloatArray
    """Of tensioners, m or rad."""


def excitations_of(drive: Drive, driver: int) -> list[Excitation]:
    """Harmonics of prescribed speeds and of loads that excite a drive whose driver's speed is prescribed."""
    prescribed = {driver, *(number for number, one in enumerate(drive.pulleys) if one.prescribed)}
    return [
        one
        for one in own_excitations(drive)
        if one.cause == SPEED or (one.cause == LOAD and one.pulley not in prescribed)
    ]


def lumped_at(prepared: Prepared, states: Running, row: int) -> LumpedDrive:
    """The lumped drive in a state."""
    return lumped_drive(
        prepared, states.tension[row], states.centers[row], states.positions[row], float(states.speed[row])
    )


def amplitudes(
    prepared: Prepared, drive: Drive, excitations: Sequence[Excitation], states: Running, row: int
) -> Amplitudes:
    """Find the amplitudes in a state.

    Parameters
    ----------
    prepared
        The drive, with constant torques and speeds.
    drive
        With the harmonics.
    excitations
        As of `excitations_of`.
    states, row
        Steady running.
    """
    lumped, radii = lumped_at(prepared, states, row), np.asarray(prepared.path.radii)
    given = [_wave(drive, one, float(states.speed[row] / radii[one.pulley])) for one in excitations]
    given = [one for one in given if one[0] > 0.0]
    springs = [one.tensioner.spring for one in prepared.carriers]
    friction = np.array([0.5 * (one["tensioning_friction"] + one["yielding_friction"]) for one in springs])
    creep = np.array([one["creep_speed"] for one in springs])
    answers, dashpots = [lumped.answer(*one) for one in given], np.zeros(friction.size)
    for _ in range(_ROUNDS if friction.any() and given else 0):
        rates = [
            one[0] * np.abs(moved[moved.size - friction.size :]) for one, (_, moved) in zip(given, answers, strict=True)
        ]
        before, dashpots = dashpots, friction_dashpots(friction, creep, np.sqrt(np.sum(np.square(rates), axis=0)))
        answers = [lumped.answer(*one, dashpots) for one in given]
        if np.all(np.abs(dashpots - before) <= _SETTLED * dashpots):
            break
    tension, hub_load, positions = np.zeros(radii.size), np.zeros(radii.size), np.zeros(friction.size)
    directions, means = span_directions(states.centers[row], radii), states.hub_force[row]
    sizes = np.maximum(np.linalg.norm(means, axis=1), 1e-12)
    for change, moved in answers:
        along = change[:, None] * directions
        hub: ComplexArray = np.sum((along - np.roll(along, 1, axis=0)) * means, axis=1) / sizes
        tension += np.abs(change)
        hub_load += np.abs(hub)
        positions += np.abs(moved[moved.size - friction.size :])
    return Amplitudes(tension, hub_load, positions)


def _wave(drive: Drive, one: Excitation, speed: float) -> tuple[float, dict[int, complex], dict[int, complex]]:
    """Angular frequency, rad/s, and amplitudes of angles (rad) and torques (N m) of an excitation at a shaft speed."""
    if one.cause == SPEED:
        return one.order * abs(speed), {one.pulley: speed_waves(drive, one.pulley)[one.order]}, {}
    return one.order * abs(speed), {}, {one.pulley: torque_waves(drive, one.pulley, speed).get(one.order, 0.0j)}

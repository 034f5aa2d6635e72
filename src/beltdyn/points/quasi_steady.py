"""Steady running without a mesh: the balance of tensions about rest, under torques, accelerations and losses."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Installation, Prepared
from beltdyn.model.hysteresis import compression_losses
from beltdyn.model.nip import refuse_nips
from beltdyn.model.path import span_directions
from beltdyn.points.changed_drive import driver_of
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.sag import sag_of, turned, weight_of_meter
from beltdyn.results.slip_safety import SlipSafety, slip_safety_of_states
from beltdyn.results.tension_balance import TensionBalance
from beltdyn.theory.nip import bending_loss

Torques = Callable[[float], FloatArray]
"""Torques on the shafts of all pulleys, N m, counter-clockwise positive, at a belt speed, m/s; zero on the driver."""


class Running(NamedTuple):
    """Quasi-steady states, a row for each."""

    speed: FloatArray
    """Of the belt, m/s, negative against the order of the pulleys, shape (n,)."""
    torque: FloatArray
    """On the shafts, N m, that of the driver from the balance, shape (n, P)."""
    belt_torque: FloatArray
    """Of the friction of the belt on pulleys, N m, shape (n, P)."""
    tension: FloatArray
    """Mean of spans, N, shape (n, spans); NaN where there is no balance."""
    ends: FloatArray
    """Tension at start and end of spans, N, shape (n, spans, 2)."""
    positions: FloatArray
    """Of tensioners, m or rad, shape (n, K)."""
    centers: FloatArray
    """Of pulleys, m, shape (n, P, 2)."""
    hub_force: FloatArray
    """Of the belt on pulleys, N, shape (n, P, 2)."""


class QuasiSteady:
    """Steady running of a drive about its rest.

    `prepared`: the drive, with a closed belt of known length, and with constant torques; `rest`: it at rest.
    """

    def __init__(self, prepared: Prepared, rest: Installation) -> None:
        refuse_nips(prepared.drive.nips, "the quasi-steady model of a drive")
        self.prepared, self.rest, self.drive = prepared, rest, prepared.drive
        self.driver = driver_of(self.drive)
        still = np.zeros((1, prepared.path.spans))
        mean, points = SpanTension.uniform(rest.span_tensions[None]), rest.path.span_points
        below = (points.mean(axis=1, keepdims=True) - points) @ weight_of_meter(prepared, mean)[0]
        tension = SpanTension(mean.mean + below[:, 0], mean.mean + below[:, 1], mean.mean)
        self.balance = TensionBalance(prepared, tension, still, rest.path.centers[None])
        belt, self._radii = prepared.belt, np.asarray(prepared.path.radii)
        self._drag = compression_losses(prepared) + bending_loss(
            belt.bending_stiffness, belt.bending_loss_factor, np.abs(self._radii)
        )
        self.inertia = np.array([one.inertia + sum(link.inertia for link in one.hub) for one in prepared.pulleys])

    def belt_speed(self, drive: Drive, torques: Torques) -> float:
        """Belt speed by the driver's prescribed speed, or where its motors balance the torques, m/s."""
        pulley, radius = drive.counter_clockwise_pulleys[self.driver], float(self._radii[self.driver])
        if pulley.speed is not None:
            return float(pulley.speed.at([0.0])[0]) * radius
        from scipy.optimize import brentq

        limit = max((load.driven_speed for load in pulley.load), key=abs)

        def excess(speed: float) -> float:
            belt = speed * radius
            taken = float(np.sum(torques(belt) / self._radii)) - float(np.sum(self._drag)) * float(np.sign(limit))
            return torque_of(drive, self.driver, speed) / radius + taken

        try:
            found = float(brentq(excess, 0.2 * limit, limit, xtol=1e-9))
        except ValueError as error:
            raise ModelError(
                f"the motor of {pulley.name} does not carry the loads between a fifth of {limit:.4g} rad/s and that "
                "speed. Use a larger motor, or give the pulley a speed."
            ) from error
        return found * radius

    def at(self, speed: FloatArray, torque: FloatArray, acceleration: FloatArray) -> Running:
        """Find states.

        `speed`: of the belt, m/s, shape (n,); `torque`: on the shafts, N m; that of the driver does not count, shape
        (n, P); `acceleration`: of the belt, m/s^2, in the sense of its speed, shape (n,).
        """
        running = np.sign(speed)[:, None]
        braked = torque - self.inertia * (running * acceleration[:, None]) / self._radii
        pull = braked / self._radii - running * self._drag
        pull[:, self.driver] = 0.0
        pull[:, self.driver] = -pull.sum(axis=1)
        differences = -np.cumsum(pull, axis=1)
        differences -= differences.mean(axis=1, keepdims=True)
        found = self.balance.under(differences, speed).states()
        driven = (pull[:, self.driver] + running[:, 0] * self._drag[self.driver]) * self._radii[self.driver]
        whole = torque.copy()
        whole[:, self.driver] = (
            driven + self.inertia[self.driver] * running[:, 0] * acceleration / self._radii[self.driver]
        )
        ends = np.stack(found.tension[:2], axis=2)
        lifted = self.prepared.belt.mass_per_length * speed[:, None] ** 2
        along = span_directions(found.centers, self._radii)
        sag = sag_of(self.prepared, found.tension, lifted, along)
        turn = np.zeros_like(ends) if sag is None else np.stack([sag.start, sag.end], axis=2)
        directions = along[:, :, None] + turn[..., None] * turned(along)[:, :, None]
        pulls = (ends - lifted[..., None])[..., None] * directions
        weight = weight_of_meter(self.prepared, found.tension)
        arcs = (found.wrap * np.abs(self._radii))[:, :, None] * weight[:, None]
        hub = pulls[:, :, 0] - np.roll(pulls[:, :, 1], 1, axis=1) + arcs
        carried = -(pull + running * self._drag) * self._radii
        return Running(speed, whole, carried, found.tension.mean, ends, found.positions, found.centers, hub)

    def slip_safety(self, states: Running, factors: FloatArray) -> SlipSafety:
        """Slip safety of each pulley with factors on all coefficients of friction, shape (factors, n, P)."""
        shape, known = (factors.size, *states.torque.shape), np.isfinite(states.tension).all(axis=1)

        def tiled(values: FloatArray) -> FloatArray:
            return np.tile(values[known], (factors.size, *[1] * (values.ndim - 1)))

        tension = SpanTension(tiled(states.ends[..., 0]), tiled(states.ends[..., 1]), tiled(states.tension))
        speed = tiled(np.repeat(states.speed[:, None], states.tension.shape[1], axis=1))
        frictions = np.repeat(factors[:, None] * self.prepared.frictions, known.sum(), axis=0)
        centers, torque = tiled(states.centers), tiled(states.belt_torque)
        safety = slip_safety_of_states(tension, speed, centers, self.prepared, torque, frictions)
        found = SlipSafety(np.full(shape, np.nan), np.full(shape, np.nan))
        for place, values in zip(found, safety, strict=True):
            place[:, known] = values.reshape(factors.size, -1, shape[2])
        return found


def torque_of(drive: Drive, number: int, speed: float) -> float:
    """Torque of a shaft and its loads at its speed (rad/s), N m, with schedules as they are held."""
    pulley = drive.counter_clockwise_pulleys[number]
    found = 0.0 if pulley.torque is None else float(pulley.torque.at([0.0])[0])
    for load in pulley.load:
        factor = 1.0 if load.factor is None else float(load.factor.at([0.0])[0])
        found += factor * float(load.torque_over(np.zeros(1), speed)[0])
    return found


def torques_of(drive: Drive, driver: int) -> Torques:
    """Torques of all pulleys but the driver."""
    radii = np.asarray(drive.path.radii)
    others = [number for number in range(radii.size) if number != driver]
    fixed = [drive.pulleys[number].name for number in others if drive.pulleys[number].prescribed]
    if fixed:
        raise ModelError(
            f"the torque of {fixed[0]} is unknown, since its speed is prescribed beside that of "
            f"{drive.pulleys[driver].name}. Give its torque or loads instead."
        )

    def torques(belt: float) -> FloatArray:
        found = np.zeros(radii.size)
        for number in others:
            found[number] = torque_of(drive, number, belt / float(radii[number]))
        return found

    return torques


def torques_between(rows: Sequence[tuple[float, FloatArray]], pulleys: Sequence[int], others: Torques) -> Torques:
    """Torques over the belt speed: of some pulleys by straight lines between rows, the largest ones of equal speed.

    `rows`: belt speed, m/s, and torques, N m, of operating points; `pulleys`: numbers of those whose torques these rows
    give; `others`: of the other pulleys.
    """
    largest: dict[float, FloatArray] = {}
    for speed, torque in rows:
        before = largest.get(speed, np.zeros(torque.size))
        largest[speed] = np.where(np.abs(torque) > np.abs(before), torque, before)
    speeds = np.array(sorted(largest, key=abs))
    table = np.array([largest[one] for one in speeds.tolist()])

    def torques(belt: float) -> FloatArray:
        found = others(belt)
        for number in pulleys:
            found[number] = np.interp(abs(belt), np.abs(speeds), table[:, number])
        return found

    return torques

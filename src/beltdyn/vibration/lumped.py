r"""A drive of lumped bodies on elastic spans: its first modes, and its response to harmonics, in milliseconds.

Unknowns x are the angles of rims and of the bodies of hub chains, and the places of tensioners. Span i stretches by
e_i = (B x)_i: the ways of the rims at its ends along the belt, and that of a carried pulley along the span, as the belt
rolls on and off the rims. A running belt takes its strain along: what passes a pulley is as long unstretched as where
it reaches that pulley, and so, with the length l_i, the belt speed v and the span before in running direction,

    T_i' = k_i e_i' - |v| / l_i (T_i - T_before),        k_i = (dN/dg) g / l_i,

of which the second term is elastic creep: it damps rotations. The bodies obey

    M x'' + C x' + K x + B^T T = f.

l_i is longer than the span: bending lifts the belt off the ends of arcs over sqrt(EI / T'), T' = T - m v^2, and where
the belt slides, before it leaves a loaded pulley, all tensions follow that of the span as exp(mu phi) (Euler and
Eytelwein), as if it were R |T1 - T2| / (mu T') longer, and R EA v_c / (v mu T') by a friction law that saturates at
v_c. M has the belt's mass, that of spans as of rods; K has the
springs of hubs and tensioners, the pull T' / l across a span whose pulley moves sideways, and what turns an arm back.
Transverse vibrations of spans are left out.
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.kernel import interpreted
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, span_points, wrap_angles
from beltdyn.records import blank, fill

_STEP = 1e-4
"""Relative step of speed with which torques of loads are differenced."""
_LEAST = 1e-3
"""Least friction, and least tension that presses over the largest one."""
_STILL = 1e-6
"""Angular frequency over the largest one below which a motion is none."""


class Mode(NamedTuple):
    """A mode of vibration."""

    frequency: float
    """Hz."""
    damping_ratio: float
    shares: FloatArray
    """Of bodies and tensioners in the kinetic energy, shape (n,)."""


class LumpedDrive(NamedTuple):
    """A drive in steady running, as bodies on elastic spans."""

    mass: FloatArray
    """M, shape (n, n): P rims, bodies of hub chains, K tensioners."""
    damping: FloatArray
    stiffness: FloatArray
    stretches: FloatArray
    """B, shape (spans, n)."""
    spans: FloatArray
    """k, N/m."""
    transport: FloatArray
    """Rate at which tensions follow those of the spans before, shape (spans, spans), 1/s."""
    loss_factor: float
    """Of stretch."""
    damping_time: float
    """Of stretch, s."""
    shafts: IntArray
    """Body of the shaft of each pulley."""
    free: BoolArray
    """Which unknowns are not prescribed, shape (n,)."""
    owners: tuple[str, ...]
    """What each unknown belongs to: a pulley by its name, or the arm or slide of one."""

    def modes(self, count: int) -> list[Mode]:
        """The first modes, by ascending frequency; tensioners slide without dry friction."""
        free, spans = self.free, self.spans.size
        size = int(free.sum())
        inverse = np.linalg.inv(self.mass[np.ix_(free, free)])
        stretches = self.stretches[:, free]
        strained = self.spans[:, None] * stretches
        damping = self.damping[np.ix_(free, free)] + self.damping_time * stretches.T @ strained
        rates = np.block(
            [
                [np.zeros((size, size)), np.eye(size), np.zeros((size, spans))],
                [-inverse @ self.stiffness[np.ix_(free, free)], -inverse @ damping, -inverse @ stretches.T],
                [np.zeros((spans, size)), strained, -self.transport],
            ]
        )
        values, vectors = np.linalg.eig(rates)
        swing = np.flatnonzero(values.imag > _STILL * np.abs(values).max())
        first = swing[np.argsort(values[swing].imag)][:count]
        return [self._mode(complex(values[one]), vectors[size : 2 * size, one]) for one in first]

    def _mode(self, value: complex, velocity: ComplexArray) -> Mode:
        whole = np.zeros(self.free.size, complex)
        whole[self.free] = velocity
        energy = np.maximum((whole.conj() * (self.mass @ whole)).real, 0.0)
        return Mode(value.imag / (2.0 * np.pi), -value.real / abs(value), energy / energy.sum())

    def answer(
        self,
        frequency: float,
        angles: Mapping[int, complex],
        torques: Mapping[int, complex],
        dashpots: FloatArray | None = None,
    ) -> tuple[ComplexArray, ComplexArray]:
        """Complex amplitudes of exp(i w t) of the span tensions, N, and of all unknowns.

        Parameters
        ----------
        frequency
            w, rad/s.
        angles, torques
            Number of a pulley -> amplitude of the angle of its prescribed shaft, rad, or of a torque on it, N m.
        dashpots : ndarray, shape (K,), optional
            Damping of tensioners in addition.
        """
        rate = 1j * frequency
        spans = self.spans * (1.0 + 1j * self.loss_factor + rate * self.damping_time)
        followed = np.linalg.solve(rate * np.eye(spans.size) + self.transport, np.diag(rate * spans)) @ self.stretches
        damping = self.damping.copy()
        if dashpots is not None and dashpots.size:
            places = np.arange(self.free.size - dashpots.size, self.free.size)
            damping[places, places] += dashpots
        matrix = self.stiffness + rate * damping - frequency**2 * self.mass + self.stretches.T @ followed
        moved, force = np.zeros((2, self.free.size), complex)
        for target, given in ((moved, angles), (force, torques)):
            for pulley, amplitude in given.items():
                target[self.shafts[pulley]] += amplitude
        free = self.free
        moved[free] = np.linalg.solve(matrix[np.ix_(free, free)], (force - matrix @ moved)[free])
        return followed @ moved, moved


def lumped_drive(
    prepared: Prepared, tension: FloatArray, centers: FloatArray, positions: FloatArray, speed: float
) -> LumpedDrive:
    """Lump a drive in steady running.

    Parameters
    ----------
    prepared : Prepared
        The drive, with constant speeds and torques.
    tension : ndarray, shape (spans,)
        Of the spans, N.
    centers : ndarray, shape (pulleys, 2)
        Where the pulleys are, m.
    positions : ndarray, shape (K,)
        Places of the tensioners, m or rad.
    speed : float
        Of the belt, m/s, negative against the order of the pulleys.
    """
    return _Lumping(prepared, tension, centers, positions, speed).made()


class _Lumping:
    """Collects the parts of a lumped drive."""

    def __init__(
        self, prepared: Prepared, tension: FloatArray, centers: FloatArray, positions: FloatArray, speed: float
    ) -> None:
        self._prepared, self._tension, self._positions, self._speed = prepared, tension, positions, speed
        self._radii = np.asarray(prepared.path.radii)
        self._pressing = tension - prepared.belt.mass_per_length * speed**2
        self._directions = span_directions(centers, self._radii)
        points = span_points(centers, self._radii)
        self._lengths = np.linalg.norm(points[:, 1] - points[:, 0], axis=-1)
        self._wraps = wrap_angles(self._directions, self._radii)
        pulleys, self._count = prepared.pulleys, len(prepared.pulleys)
        names = [one.name for one in pulleys]
        self._owners = [*names, *(one.name for one in pulleys for _ in one.hub)]
        self._first = len(self._owners)
        arms = ("arm" if one.tensioner.turns else "slide" for one in prepared.carriers)
        self._owners += [f"{arm} of {one.tensioner.pulley}" for arm, one in zip(arms, prepared.carriers, strict=True)]
        size = len(self._owners)
        self._mass, self._damping, self._stiffness = np.zeros((3, size, size))
        self._shafts = np.arange(self._count)

    def made(self) -> LumpedDrive:
        """All parts together."""
        prepared, law = self._prepared, self._prepared.belt.stretch_parameters
        stretch = np.asarray(law.stretch(self._tension))
        yielding = self._yielding_lengths()
        spans = np.asarray(law.tangent_stiffness(stretch)) * stretch / yielding
        stretches = self._stretches()
        self._add_belt()
        self._add_chains()
        self._add_tensioners()
        free = np.ones(len(self._owners), dtype=bool)
        free[[self._shafts[number] for number, one in enumerate(prepared.pulleys) if one.prescribed]] = False
        before = np.roll(np.eye(spans.size), 1 if self._speed < 0.0 else -1, axis=1)
        transport = (abs(self._speed) / yielding)[:, None] * (np.eye(spans.size) - before)
        return LumpedDrive(
            mass=self._mass,
            damping=self._damping,
            stiffness=self._stiffness,
            stretches=stretches,
            spans=spans,
            transport=transport,
            loss_factor=prepared.belt.stretch_loss_factor,
            damping_time=prepared.belt.stretch_damping_time,
            shafts=self._shafts,
            free=free,
            owners=tuple(self._owners),
        )

    def _yielding_lengths(self) -> FloatArray:
        """Lengths of belt that stretch with each span, m: with what is lifted off, and what slides behind it."""
        prepared, arcs = self._prepared, np.abs(self._radii) * self._wraps
        pressing = np.maximum(self._pressing, _LEAST * float(np.max(np.abs(self._tension))))
        lifted = np.sqrt(prepared.belt.bending_stiffness / pressing)
        longer = np.minimum(lifted, 0.5 * arcs) + np.minimum(lifted, 0.5 * np.roll(arcs, -1))
        entry = np.roll(pressing, 1) if self._speed >= 0.0 else pressing
        leaving = pressing if self._speed >= 0.0 else np.roll(pressing, 1)
        grip = np.maximum(prepared.frictions, _LEAST)
        held = grip * leaving
        creep = prepared.friction_parameters.saturation(leaving / np.abs(self._radii), grip, abs(self._speed))
        reach = prepared.belt.axial_stiffness * creep / abs(self._speed) if self._speed else np.zeros(arcs.size)
        slid = np.minimum(np.abs(self._radii) * (np.abs(entry - leaving) + reach) / held, arcs)
        return np.asarray(self._lengths + longer + (slid if self._speed >= 0.0 else np.roll(slid, -1)))

    def _stretches(self) -> FloatArray:
        """B: span i leads from pulley i to the next one."""
        found = np.zeros((self._lengths.size, len(self._owners)))
        ahead = (np.arange(self._count) + 1) % self._count
        for span in range(self._count):
            found[span, span] -= self._radii[span]
            found[span, ahead[span]] += self._radii[ahead[span]]
        for place, _, along, _ in self._carried():
            pulley = self._prepared.carriers[place - self._first].pulley
            found[pulley, place] -= self._directions[pulley] @ along
            found[pulley - 1, place] += self._directions[pulley - 1] @ along
        return found

    def _carried(self) -> Iterator[tuple[int, float, FloatArray, FloatArray]]:
        """Unknown and position of each tensioner, and first and second derivatives of the center of its pulley."""
        for number, (one, position) in enumerate(zip(self._prepared.carriers, self._positions.tolist(), strict=True)):
            center = interpreted(type(one.tensioner).center_at)(one.constants, position)
            yield (
                *(self._first + number, position),
                *(np.array([center.dx, center.dy]), np.array([center.ddx, center.ddy])),
            )

    def _add_belt(self) -> None:
        """Mass of the belt: arcs turn with their rims, spans are rods between them."""
        mass, radii, count = self._prepared.belt.mass_per_length, self._radii, self._count
        for span, length in enumerate(self._lengths.tolist()):
            ends = np.array([span, (span + 1) % count])
            both = mass * length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
            self._mass[np.ix_(ends, ends)] += both * np.outer(radii[ends], radii[ends])
        rims = np.arange(count)
        self._mass[rims, rims] += mass * np.abs(radii) ** 3 * self._wraps

    def _add_chains(self) -> None:
        """Rims, the links and bodies behind them, and how loads change with the speed of their shafts."""
        body = self._count
        for number, pulley in enumerate(self._prepared.pulleys):
            self._mass[number, number] += pulley.inertia
            front = number
            for link in pulley.hub:
                constants = blank(link.constants)
                fill(constants, link.values(pulley.turning))
                scale = 1.0 if link.factor is None else float(link.factor.at([0.0])[0])
                torque = interpreted(type(link).torque_at)(constants, scale, 0.0, 0.0)
                both, ends = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.ix_([front, body], [front, body])
                self._stiffness[ends] += torque.by_twist * both
                self._damping[ends] += torque.by_rate * both
                self._mass[body, body] += link.inertia
                front, body = body, body + 1
            self._shafts[number] = front
            self._damping[front, front] -= self._load_slope(number)

    def _load_slope(self, number: int) -> float:
        """Derivative of the loads of a pulley with respect to its speed, N m s/rad."""
        speed = self._speed / float(self._radii[number])
        step = _STEP * abs(speed)
        if step == 0.0:
            return 0.0
        slope = 0.0
        for load in self._prepared.pulleys[number].load:
            factor = 1.0 if load.factor is None else float(load.factor.at([0.0])[0])
            more, less = (float(load.torque_over(np.zeros(1), speed + sense * step)[0]) for sense in (1.0, -1.0))
            slope += factor * (more - less) / (2.0 * step)
        return slope

    def _add_tensioners(self) -> None:
        """Inertia, spring, stops and damper of tensioners, and what the tensions of their spans add."""
        prepared = self._prepared
        for place, position, along, bend in self._carried():
            carrier = prepared.carriers[place - self._first]
            one, pulley = carrier.tensioner, carrier.pulley
            spring, nominal = one.spring, prepared.path.centers[pulley]
            self._mass[place, place] += one.moved_inertia(nominal, prepared.pulleys[pulley].mass)
            self._damping[place, place] += spring["damping"]
            self._stiffness[place, place] += spring["rate"]
            if not spring["lower"] <= position <= spring["upper"]:
                self._stiffness[place, place] += spring["stop_stiffness"]
            for span, sense in ((pulley, -1.0), (pulley - 1, 1.0)):
                across = along @ along - (self._directions[span] @ along) ** 2
                turned = sense * float(self._directions[span] @ bend)
                self._stiffness[place, place] += self._pressing[span] * (across / self._lengths[span] + turned)

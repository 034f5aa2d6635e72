r"""A drive of lumped bodies on elastic spans: its first modes, and its response to harmonics, in milliseconds.

Unknowns x are the angles of rims and of the bodies of hub chains, and the places of tensioners. Span i stretches by
e_i = (B x)_i: the ways of the rims at its ends along the belt, and that of a carried pulley along the span, as the belt
rolls on and off the rims. A running belt takes its strain along: what leaves a pulley is as long unstretched as where
it reached that pulley, and so, with the length l_i, the belt speed v and the span before in running direction,

    T_i' = k_i e_i' - |v| / l_i (T_i - T_before(t - t_i)),        k_i = (dN/dg) g / l_i,

of which the second term is elastic creep: it damps rotations. Where the belt adheres, over the length a of the arc, its
strain is frozen, and arrives after the passage t_i = a / |v|. The bodies obey

    M x'' + C x' + K x + B^T T = f.

l_i is longer than the span: bending lifts the belt off the ends of arcs over sqrt(EI / T'), T' = T - m v^2, and where
the belt slides, before it leaves a loaded pulley, all tensions follow that of the span as exp(mu phi) (Euler and
Eytelwein), as if it were R |T1 - T2| / (mu T') longer. By a friction law that saturates at the slip velocity v_c, as
much strain creeps as diffuses along the arc with D = |v| b,

    b = R EA v_c / (|v| mu T'):

the span is longer by b, and strain that passes is smeared. A chain of n = a / (2 b) cells, each filled by the one
before, has that delay and that variance 2 D a / |v|^3 of it,

    T_before(t - t_i)  ->  (1 + s t_i / n)^-n.

M has the belt's mass, that of spans as of rods; K has the springs of hubs and tensioners, the pull T' / l across a span
whose pulley moves sideways, and what turns an arm back. Transverse vibrations of spans are left out, and so are waves
of strain that go round with the belt, whose damping ratio is above 1/2: they amplify nothing.
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple, TypeVar

import numpy as np

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.kernel import interpreted
from beltdyn.model import Prepared
from beltdyn.model.path import span_directions, span_points, wrap_angles
from beltdyn.records import blank, fill

Given = TypeVar("Given")
_STEP = 1e-4
"""Relative step of speed with which torques of loads are differenced."""
_LEAST = 1e-3
"""Least friction, and least tension that presses over the largest one."""
_STILL = 1e-6
"""Angular frequency over the largest one below which a motion is none."""
_RESONANT = 0.5
"""Damping ratio from which on a mode amplifies nothing at its resonance."""
_CELLS = 40
"""Cells of an arc at most."""
_THIN = 1e-3
"""Least length in which friction saturates, over that of the arc."""


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
    passing: FloatArray
    """|v| / l, rate at which the belt of each span is replaced, shape (spans,), 1/s."""
    before: IntArray
    """Number of the span before each one in running direction, shape (spans,)."""
    delay: FloatArray
    """Time in which strain passes the arc between them, shape (spans,), s."""
    cells: IntArray
    """Of a chain that has this delay, shape (spans,)."""
    creep: FloatArray
    """Rate at which tensions of neighboring spans balance by creep over whole arcs, shape (spans, spans), 1/s."""
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
        """The first modes that resonate, by ascending frequency; tensioners slide without dry friction."""
        free, spans = self.free, self.spans.size
        size, carried = int(free.sum()), spans + int(self.cells.sum())
        inverse = np.linalg.inv(self.mass[np.ix_(free, free)])
        stretches = self.stretches[:, free]
        strained = self.spans[:, None] * stretches
        damping = self.damping[np.ix_(free, free)] + self.damping_time * stretches.T @ strained
        rates = np.zeros((2 * size + carried, 2 * size + carried))
        turning, tension = slice(size, 2 * size), slice(2 * size, 2 * size + spans)
        rates[:size, turning] = np.eye(size)
        rates[turning, :size] = -inverse @ self.stiffness[np.ix_(free, free)]
        rates[turning, turning] = -inverse @ damping
        rates[turning, tension] = -inverse @ stretches.T
        rates[tension, turning] = strained
        rates[2 * size :, 2 * size :] = self._carrying(carried)
        values, vectors = np.linalg.eig(rates)
        resonant = -values.real < _RESONANT * np.abs(values)
        swing = np.flatnonzero((values.imag > _STILL * np.abs(values).max()) & resonant)
        first = swing[np.argsort(values[swing].imag)][:count]
        return [self._mode(complex(values[one]), vectors[turning, one]) for one in first]

    def _carrying(self, size: int) -> FloatArray:
        """Rates of the tensions of spans and cells as the belt carries strain through them, 1/s."""
        found, cell = np.zeros((size, size)), self.spans.size
        for span, (rate, before) in enumerate(zip(self.passing.tolist(), self.before.tolist(), strict=True)):
            for _ in range(self.cells[span]):
                filling = float(self.cells[span] / self.delay[span])
                found[cell, [cell, before]] = -filling, filling
                before, cell = cell, cell + 1
            found[span, [span, before]] += -rate, rate
        found[: self.spans.size, : self.spans.size] -= self.creep
        return found

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
        arriving = (1.0 + rate * self.delay / np.maximum(self.cells, 1)) ** -self.cells
        carrying = np.diag(rate + self.passing) + self.creep
        carrying[np.arange(spans.size), self.before] -= self.passing * arriving
        followed = np.linalg.solve(carrying, np.diag(rate * spans)) @ self.stretches
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


class _AlongTheBelt(NamedTuple):
    """Spans, with the arcs before them in running direction; each of shape (spans,)."""

    yielding: FloatArray
    """Lengths of belt that stretch with spans, m: with what is lifted off, and what slides behind them."""
    delay: FloatArray
    """Of strain on an arc, s."""
    cells: IntArray
    """Of a chain that has this delay."""
    leak: FloatArray
    """Change of strain at the entry of an arc over that along it, as its pulley drags the belt."""


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
        along = self._along_the_belt()
        passing = abs(self._speed) / along.yielding
        spans = np.asarray(law.tangent_stiffness(stretch)) * stretch / along.yielding
        stretches = self._stretches()
        self._add_belt()
        self._add_chains()
        self._add_tensioners()
        free = np.ones(len(self._owners), dtype=bool)
        free[[self._shafts[number] for number, one in enumerate(prepared.pulleys) if one.prescribed]] = False
        return LumpedDrive(
            mass=self._mass,
            damping=self._damping,
            stiffness=self._stiffness,
            stretches=stretches,
            spans=spans,
            passing=passing,
            before=np.roll(np.arange(spans.size), self._behind(1, -1)),
            delay=along.delay,
            cells=along.cells,
            creep=passing[:, None] * self._creep(along.leak),
            loss_factor=prepared.belt.stretch_loss_factor,
            damping_time=prepared.belt.stretch_damping_time,
            shafts=self._shafts,
            free=free,
            owners=tuple(self._owners),
        )

    def _behind(self, forwards: Given, backwards: Given) -> Given:
        """The one of two that holds in the sense of running."""
        return forwards if self._speed >= 0.0 else backwards

    def _along_the_belt(self) -> "_AlongTheBelt":
        """What spans and the arcs that the belt passes before them do to strain."""
        prepared, speed, radii = self._prepared, abs(self._speed), np.abs(self._radii)
        arcs = radii * self._wraps
        pressing = np.maximum(self._pressing, _LEAST * float(np.max(np.abs(self._tension))))
        lifted = np.sqrt(prepared.belt.bending_stiffness / pressing)
        ends = np.minimum(lifted, 0.5 * arcs), np.minimum(np.roll(lifted, 1), 0.5 * arcs)
        entry = self._behind(np.roll(pressing, 1), pressing)
        leaving = self._behind(pressing, np.roll(pressing, 1))
        grip = np.maximum(prepared.frictions, _LEAST)
        reach = radii / (grip * leaving)
        creep = prepared.friction_parameters.saturation(leaving / radii, grip, speed)
        layer = prepared.belt.axial_stiffness * creep * reach / speed if speed else np.zeros(arcs.size)
        slid = np.minimum(reach * np.abs(entry - leaving) + layer, arcs)
        adhering = np.maximum(arcs - ends[0] - ends[1] - radii * np.abs(np.log(entry / leaving)) / grip, 0.0)
        cells = np.clip(np.rint(adhering / np.maximum(2.0 * layer, _THIN * arcs)), 1, _CELLS)
        delay = adhering / speed if speed else np.zeros(arcs.size)
        decay = np.exp(-arcs / np.maximum(layer, _THIN * arcs))
        leak = decay / (1.0 - decay)
        of_arcs = (slid, delay, np.where(delay > 0.0, cells, 0).astype(np.int64), leak)
        slid, delay, cells, leak = (self._behind(one, np.roll(one, -1)) for one in of_arcs)
        return _AlongTheBelt(self._lengths + ends[0] + np.roll(ends[1], -1) + slid, delay, cells, leak)

    def _creep(self, leak: FloatArray) -> FloatArray:
        """What the slip at entries of arcs takes from each span and gives to its neighbors, shape (spans, spans)."""
        count = leak.size
        across = leak[:, None] * (np.eye(count) - np.roll(np.eye(count), self._behind(-1, 1), axis=1))
        return np.asarray(across - np.roll(across, self._behind(-1, 1), axis=0))

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

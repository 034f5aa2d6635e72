"""Amplitudes of tensions and hub loads under the harmonics of speeds and loads, by the lumped drive.

A drive of lumped bodies on elastic spans: its first modes, and its response to harmonics, in milliseconds.

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

the span is longer by b, and of strain that grows as exp(s t)

    exp(-2 s t_i / (1 + sqrt(1 + 4 s b / |v|)))

arrives. M has the belt's mass, that of spans as of rods; K has the springs of hubs and tensioners, the pull T' / l
across a span whose pulley moves sideways, and what turns an arm back. Transverse vibrations of spans are left out.

Modes are those of the drive whose strain does not flow, followed as it begins to. So waves of strain that go round with
the belt, strongly damped, are left out.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray, blank, fill
from beltdyn.kernel import interpreted
from beltdyn.model import Drive, Prepared
from beltdyn.model.nip import refuse_nips
from beltdyn.model.path import span_directions, span_points, wrap_angles
from beltdyn.points.quasi_steady import Running
from beltdyn.vibration.excitation import LOAD, SPEED, Excitation, own_excitations, speed_waves, torque_waves
from beltdyn.vibration.response_answers import friction_dashpots

Given = TypeVar("Given")
_STEP = 1e-4
"""Relative step of speed with which torques of loads are differenced."""
_LEAST = 1e-3
"""Least friction, and least tension that presses over the largest one."""
_STILL = 1e-6
"""Angular frequency over the largest one below which a motion is none."""
_DIFFERENCE = 1e-6
"""Relative step of a root."""
_RESONANT = 0.5
"""Damping ratio from which on a mode amplifies nothing at its resonance."""
_PATHS = (16, 64, 256)
"""Steps in which modes are followed; more if two have met."""
_SWEEPS, _FOUND, _MET = 30, 1e-8, 1e-6
"""Rounds of Newton's method at most, the relative change that ends them, and the one between modes that have met."""
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
    smearing: FloatArray
    """b / |v| of this arc, shape (spans,), s."""
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
        free = self.free
        size, inverse = int(free.sum()), np.linalg.inv(self.mass[np.ix_(free, free)])
        stiffness, both = (self._elastic(rate) for rate in (0.0, 1.0))
        first_order = np.zeros((2 * size, 2 * size))
        first_order[:size, size:] = np.eye(size)
        first_order[size:, :size] = -inverse @ stiffness[np.ix_(free, free)]
        first_order[size:, size:] = -inverse @ (both - stiffness)[np.ix_(free, free)]
        values = np.linalg.eigvals(first_order)
        still = values[values.imag > _STILL * np.abs(values).max(initial=0.0)]
        roots = still
        for steps in _PATHS if still.size and self.passing.any() else ():
            roots = self._followed(still, steps)
            apart = np.abs(roots[:, None] - roots) + np.diag(np.full(roots.size, np.inf))
            if np.all(apart > _MET * np.abs(roots)):
                break
        resonant = np.isfinite(roots) & (roots.imag > 0.0) & (-roots.real < _RESONANT * np.abs(roots))
        first = roots[resonant][np.argsort(roots[resonant].imag)][:count]
        return [self._mode(complex(one)) for one in first]

    def _elastic(self, rate: float) -> FloatArray:
        """K + s C of a drive whose strain does not flow."""
        spans = self.spans * (1.0 + rate * self.damping_time)
        return np.asarray(self.stiffness + rate * self.damping + self.stretches.T @ (spans[:, None] * self.stretches))

    def _followed(self, roots: ComplexArray, steps: int) -> ComplexArray:
        """Roots of det A(s) as more and more strain flows, by secants between s (1 - d) and s (1 + d)."""
        for part in np.linspace(0.0, 1.0, steps + 1)[1:].tolist():
            for _ in range(_SWEEPS):
                signs, logarithms = np.linalg.slogdet(
                    self._dynamic(roots * np.array([[1.0 - _DIFFERENCE], [1.0 + _DIFFERENCE]]), part)
                )
                ratio = signs[1] / signs[0] * np.exp(logarithms[1] - logarithms[0])
                away = _DIFFERENCE * roots * (ratio + 1.0) / (ratio - 1.0)
                roots = roots - away
                if np.all(np.abs(away) <= _FOUND * np.abs(roots)):
                    break
        return roots

    def _dynamic(self, rates: ComplexArray, part: float = 1.0) -> ComplexArray:
        """M s^2 + C s + K of what is free at each s, with a part of the strain that flows."""
        free, rate = self.free, rates[..., None, None]
        own = [one[np.ix_(free, free)] for one in (self.mass, self.damping, self.stiffness)]
        spans = np.asarray(self.spans * (1.0 + rates[..., None] * self.damping_time))
        followed = self._tensions(rates, spans, part)
        found = own[0] * rate**2 + own[1] * rate + own[2] + self.stretches[:, free].T @ followed[..., free]
        return np.asarray(found)

    def _tensions(self, rates: ComplexArray, spans: ComplexArray, part: float = 1.0) -> ComplexArray:
        """Tensions of spans over the unknowns at each s."""
        rate, numbers = rates[..., None], np.arange(self.before.size)
        arriving = np.exp(-2.0 * rate * self.delay / (1.0 + np.sqrt(1.0 + 4.0 * rate * self.smearing)))
        flowing = (rate + part * self.passing)[..., None] * np.eye(numbers.size) + part * self.creep
        flowing[..., numbers, self.before] -= part * self.passing * arriving
        return np.asarray(np.linalg.solve(flowing, (rate * spans)[..., None] * self.stretches))

    def _mode(self, root: complex) -> Mode:
        whole = np.zeros(self.free.size, complex)
        whole[self.free] = np.linalg.svd(self._dynamic(np.array(root)))[2][-1].conj()
        energy = np.maximum((whole.conj() * (self.mass @ whole)).real, 0.0)
        return Mode(root.imag / (2.0 * np.pi), -root.real / abs(root), energy / energy.sum())

    def answer(
        self,
        frequency: float,
        angles: Mapping[int, complex],
        torques: Mapping[int, complex],
        dashpots: FloatArray | None = None,
    ) -> tuple[ComplexArray, ComplexArray]:
        """Complex amplitudes of exp(i w t) of the span tensions, N, and of all unknowns.

        `frequency`: w, rad/s; `angles`, `torques`: number of a pulley -> amplitude of the angle of its prescribed
        shaft, rad, or of a torque on it, N m; `dashpots`: damping of tensioners in addition, shape (K,), optional.
        """
        rate = 1j * frequency
        spans: ComplexArray = (self.spans * (1.0 + 1j * self.loss_factor + rate * self.damping_time)).astype(
            np.complex128
        )
        followed = self._tensions(np.array(rate), spans)
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
        return np.asarray(followed @ moved), moved


def lumped_drive(
    prepared: Prepared, tension: FloatArray, centers: FloatArray, positions: FloatArray, speed: float
) -> LumpedDrive:
    """Lump a drive in steady running.

    `prepared`: the drive, with constant speeds and torques; `tension`: of the spans, N, shape (spans,); `centers`:
    where the pulleys are, m, shape (pulleys, 2); `positions`: places of the tensioners, m or rad, shape (K,); `speed`:
    of the belt, m/s, negative against the order of the pulleys.
    """
    refuse_nips(prepared.drive.nips, "the lumped model of a drive")
    return _Lumping(prepared, tension, centers, positions, speed).made()


class _AlongTheBelt(NamedTuple):
    """Spans, with the arcs before them in running direction; each of shape (spans,)."""

    yielding: FloatArray
    """Lengths of belt that stretch with spans, m: with what is lifted off, and what slides behind them."""
    delay: FloatArray
    """Of strain on an arc, s."""
    smearing: FloatArray
    """Length on which strain diffuses there, over the belt speed, s."""
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
            smearing=along.smearing,
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
        delay, smearing = (one / speed if speed else np.zeros(arcs.size) for one in (adhering, layer))
        with np.errstate(under="ignore"):
            decay = np.exp(-arcs / np.maximum(layer, _THIN * arcs))
        slid, delay, smearing, leak = (
            self._behind(one, np.roll(one, -1)) for one in (slid, delay, smearing, decay / (1.0 - decay))
        )
        return _AlongTheBelt(self._lengths + ends[0] + np.roll(ends[1], -1) + slid, delay, smearing, leak)

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
            self._stiffness[place, place] += carrier.stiffness(position)
            for span, sense in ((pulley, -1.0), (pulley - 1, 1.0)):
                across = along @ along - (self._directions[span] @ along) ** 2
                turned = sense * float(self._directions[span] @ bend)
                self._stiffness[place, place] += self._pressing[span] * (across / self._lengths[span] + turned)


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

    `prepared`: the drive, with constant torques and speeds; `drive`: with the harmonics; `excitations`: as of
    `excitations_of`; `states`, `row`: steady running.
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

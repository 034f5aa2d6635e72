"""Amplitudes and phases of results over speed, of each excitation.

The range of a linear response: where what it leaves out counts, and by how much amplitudes may err.

A linear response has no bounds: spans push, arcs transmit any torque, tensioners slide without dry friction and pass
their stops. In the equations of motion

- spans go slack, and before that arcs and spans are no longer linear in the tension. Runs over time of six drives with
  fixed centers and with spring-loaded arms, idle to fully loaded, near and off resonance, differ from the linear
  response by up to 0.4 q^3, with q the amplitude of a span tension over its mean (`docs/verification/vibrations.md`);
- the whole arc of a pulley slides where the tensions on its sides meet Euler's ratio, which bounds the torque. The
  amplitude is between that at which this begins and that of the linear response; a pulley counts with its share of the
  largest tension amplitude;
- dry friction f damps a tensioner with the velocity amplitude V as a dashpot 4 f / (pi V) does, of the same work in a
  period (Den Hartog 1931), or holds it;
- a stop ends the motion of a tensioner.
"""

from collections.abc import Mapping, Sequence
from math import ceil, tau
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Prepared
from beltdyn.parts.quantity import RPM
from beltdyn.points.operating_points import Axes, labels_of
from beltdyn.results import Run, Variable
from beltdyn.results.belt_history import mid_span_displacements
from beltdyn.results.mechanics import SpanTension, across
from beltdyn.results.schema import SPAN_TENSIONS
from beltdyn.results.slip_safety import grip_of_states
from beltdyn.state.linearized import SmallMotions
from beltdyn.system.build import drive_system
from beltdyn.system.constant_drive import dry_friction_of
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe
from beltdyn.vibration.excitation import LOAD, SPEED, Excitation, own_excitations, speed_waves, torque_waves
from beltdyn.vibration.small_motions import about_steady, dry_tensioners

if TYPE_CHECKING:
    from scipy.sparse import csc_array


RIPPLE_ERROR = 0.4
"""Error of amplitudes over q^3."""
SMALL_ERROR = 0.05
"""Estimated error of amplitudes up to which a linear response is within its range."""
_SCALES = np.linspace(0.0, 1.0, 41)[1:]
"""Parts of the vibration at which the friction used is computed."""
_SLIDES = 0.99
"""Friction used in steady running from which on an arc slides as a whole already."""
_PERIODS = 12
"""Periods of the slowest vibration in which several that never meet alike are followed."""
_PER_PERIOD, _MOST_INSTANTS = 24, 192
"""Instants in a period of the fastest vibration, and in all."""
_MEET = 1e-4
"""Relative difference of frequencies in ratios of whole numbers."""
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
"""Step between instants over their time, which spreads them evenly and never aligns with periods."""


class SteadyValues(NamedTuple):
    """What vibrations are about."""

    tension: SpanTension
    """N."""
    speed: FloatArray
    """Of the belt in spans, m/s."""
    centers: FloatArray
    """Of pulleys, m, shape (P, 2)."""
    positions: FloatArray
    """Of tensioners, m or rad."""


class Range(NamedTuple):
    """How far vibrations at a speed are from what a linear response holds for."""

    ripple: FloatArray
    """Sum of the amplitudes of each span tension over its least value: slack from 1 on."""
    friction_used: FloatArray
    """Largest part of its friction that each pulley uses: the whole arc slides from 1 on, inf where a span is slack."""
    stop_used: FloatArray
    """Amplitude of each tensioner over its way to the nearer stop: 1 and more where it is reached."""
    friction_change: float
    """Change of the largest tension amplitude by dry friction of tensioners, relative."""
    error: float
    """Estimated error of amplitudes, relative to the largest one."""


def range_of(
    prepared: Prepared,
    still: SteadyValues,
    frequencies: Sequence[float],
    tensions: ComplexArray,
    positions: ComplexArray,
    rubbed: FloatArray,
) -> Range:
    """How far vibrations of span tensions (N) and tensioners (m or rad) are from the range of a linear response.

    Amplitudes of exp(i w t) have a row for each frequency w (rad/s); `rubbed` are sums of them with dry friction, N.
    """
    times = instants(frequencies)
    waves = np.exp(1j * np.outer(times, frequencies))
    swing, sums = (waves @ tensions).real, np.abs(tensions).sum(axis=0)
    largest = float(np.nanmax(sums, initial=0.0))
    least = np.minimum.reduce(still.tension)
    ripple = np.divide(sums, least, out=np.full_like(sums, np.nan), where=least > 0.0)
    used = np.array([_most_used(prepared, still, scale * swing) for scale in _SCALES])
    stop_used = _stop_used(prepared, still.positions, np.abs(positions).sum(axis=0))
    change = float(np.nanmax(np.abs(rubbed - sums), initial=0.0)) / largest if largest > 0.0 else 0.0
    begins = _most_used(prepared, still, np.zeros((1, sums.size)))
    before, after = across(swing, prepared)
    shares = np.abs(before - after).max(axis=0) / (largest or 1.0)
    slides = max(
        (
            min(1.0, shares[pulley]) * (1.0 / scale - 1.0)
            for pulley, scale in enumerate(_scale_of_sliding(used))
            if begins[pulley] < _SLIDES
        ),
        default=0.0,
    )
    worst = float(np.nanmax(ripple, initial=0.0))
    stops = max(float(np.nanmax(stop_used, initial=0.0)) - 1.0, 0.0)
    error = RIPPLE_ERROR * worst**3 + max(slides, worst - 1.0, 0.0) + stops + change
    return Range(ripple, used[-1], stop_used, change, error)


def friction_dashpots(friction: FloatArray, creep_speed: FloatArray, velocity: FloatArray) -> FloatArray:
    """Dashpots that take the work of dry friction in a period: 4 f / (pi V), and f / v_c of tensioners at rest."""
    with np.errstate(divide="ignore", invalid="ignore"):
        held = np.where(friction > 0.0, friction / creep_speed, 0.0)
        slides = np.where(friction > 0.0, 4.0 * friction / (np.pi * velocity), 0.0)
    return np.minimum(held, slides)


def instants(frequencies: Sequence[float]) -> FloatArray:
    """Instants, s, at which vibrations of some frequencies (rad/s) meet in all phases."""
    slowest, fastest = min(frequencies), max(frequencies)
    ratios = np.array(frequencies) / slowest
    meeting = (k for k in range(1, _PERIODS) if np.all(np.abs(k * ratios - np.round(k * ratios)) < _MEET * k * ratios))
    periods = next(meeting, _PERIODS)
    count = ceil(_PER_PERIOD * periods * fastest / slowest - 1e-6)
    parts = np.arange(count) / count if count <= _MOST_INSTANTS else _GOLDEN * np.arange(_MOST_INSTANTS) % 1.0
    return np.asarray(periods * tau / slowest * parts)


def _most_used(prepared: Prepared, still: SteadyValues, swing: FloatArray) -> FloatArray:
    """Largest part of its friction that each pulley uses in a vibration of the tensions, shape (instants, spans)."""
    tension, shape = still.tension.each(lambda values: values + swing), (len(swing), 1)
    grip = grip_of_states(tension, np.tile(still.speed, shape), np.tile(still.centers, (*shape, 1)), prepared)
    used, (before, after) = grip.used, tension.at_arcs(prepared)
    slack = np.minimum(before, after) <= 0.0
    return np.asarray(np.where(slack, np.inf, used).max(axis=0))


def _scale_of_sliding(used: FloatArray) -> FloatArray:
    """Part of the vibration at which each whole arc begins to slide, 1 where it does not."""
    slides = used >= 1.0
    return np.where(slides.any(axis=0), _SCALES[np.argmax(slides, axis=0)], 1.0)


def _stop_used(prepared: Prepared, positions: FloatArray, amplitudes: FloatArray) -> FloatArray:
    """Amplitudes of tensioners over their ways to the nearer stop, NaN without stops."""
    found = np.full(amplitudes.size, np.nan)
    for number, one in enumerate(prepared.moving_tensioners):
        if one.stops is not None:
            way = min(abs(positions[number] - stop) for stop in one.stops)
            found[number] = amplitudes[number] / way if way > 0.0 else np.inf
    return found


# Small motions of a drive in steady running under forces and motions that repeat themselves

_SMALL = 1e-6
"""Largest displacement of a node with which results are differenced, over the smallest radius."""
_OBSERVED = ("pulley_torque", "shaft_torque", "hub_force", *SPAN_TENSIONS, "belt_speed", "pulley_center")
_ROUNDS, _SETTLED = 60, 1e-3
"""Rounds in which amplitudes with dry friction settle, at most, and the relative change that ends them."""


class Excited(NamedTuple):
    """A harmonic excitation."""

    frequency: float
    """Angular frequency w, rad/s."""
    angles: Mapping[int, complex]
    """Number of a pulley of prescribed speed -> amplitude of exp(i w t) of the angle of its shaft, rad."""
    torques: Mapping[int, complex]
    """Number of another pulley -> amplitude of a torque on its shaft, N m."""


class ForcedMotion:
    """A drive in steady running, excited by small motions of shafts and small torques on them.

    Dry friction of tensioners holds them (`stuck`), or is left out.
    """

    def __init__(self, run: Run, stuck: bool) -> None:
        self._motions = about_steady(run, all_shafts=True)
        self._held = self._motions.with_stuck(dry_tensioners(run.prepared)) if stuck else self._motions
        self._pulley_shafts = np.asarray(self._motions.system.pulleys.shaft)
        self._driven = np.flatnonzero([one.prescribed for one in run.drive.pulleys])
        state = self._motions.state
        self._still = self._seen(state.position[None].copy(), state.velocity[None].copy())

    def answer(self, excited: Excited) -> dict[str, ComplexArray]:
        """Complex amplitudes of results."""
        moved, forces, _ = self._solved(self._held, excited)
        found = self._results(self._held, moved, excited.frequency)
        for pulley, amplitude in excited.torques.items():
            found["shaft_torque"][pulley] += amplitude
        found["shaft_torque"][self._driven] = forces[self._held.bodies[self._pulley_shafts[self._driven]]]
        return found

    def range_of(self, excitations: Sequence[Excited], answers: Sequence[Mapping[str, ComplexArray]]) -> Range:
        """How far the answers to excitations that act together are from what the linear equations hold for."""
        tensions, positions = (
            np.array([one[name] for one in answers]) for name in ("span_tension", "tensioner_position")
        )
        still, state = self._still, self._motions.state
        prepared, last = self._motions.prepared, state.position.size - self._motions.system.tensioners.size
        tension = SpanTension.of(lambda name: still[name][0])
        values = SteadyValues(tension, still["belt_speed"][0], still["pulley_center"][0], state.position[last:])
        rubbed = np.abs(tensions).sum(axis=0)
        if dry_tensioners(prepared).size:
            rubbed = np.abs(self._rubbed(excitations)).sum(axis=0)
        return range_of(prepared, values, [one.frequency for one in excitations], tensions, positions, rubbed)

    def _rubbed(self, excitations: Sequence[Excited]) -> ComplexArray:
        """Amplitudes of span tensions with dry friction of tensioners, as dashpots that take the same work."""
        motions, tensioners = self._motions, drive_system(self._motions.prepared).tensioners
        senses = ("tensioning_friction", "yielding_friction")
        friction = np.mean([dry_friction_of(tensioners, one) for one in senses], axis=0)
        creep = dry_friction_of(tensioners, "creep_speed")
        places = motions.bodies[motions.system.bodies.size - tensioners.size :]
        solved = [self._solved(motions, one, places) for one in excitations]
        dashpots = np.zeros(friction.size)
        for _ in range(_ROUNDS):
            slowed = [
                moved
                - by_force
                @ np.linalg.solve(
                    np.eye(places.size) + 1j * one.frequency * dashpots[:, None] * by_force[places],
                    1j * one.frequency * dashpots * moved[places],
                )
                for (moved, _, by_force), one in zip(solved, excitations, strict=True)
            ]
            velocity = np.sqrt(
                sum(np.abs(one.frequency * moved[places]) ** 2 for moved, one in zip(slowed, excitations, strict=True))
            )
            before, dashpots = dashpots, friction_dashpots(friction, creep, velocity)
            if np.all(np.abs(dashpots - before) <= _SETTLED * dashpots):
                break
        return np.array(
            [
                self._results(motions, moved, one.frequency)["span_tension"]
                for moved, one in zip(slowed, excitations, strict=True)
            ]
        )

    def _solved(
        self, motions: SmallMotions, excited: Excited, places: ArrayLike = ()
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Amplitudes of the unknowns, the forces on them, and what unit forces on some of them move, in columns."""
        from scipy.sparse.linalg import splu

        frequency, shafts = excited.frequency, motions.bodies[self._pulley_shafts]
        matrix: csc_array = (motions.stiffness + 1j * frequency * motions.damping - frequency**2 * motions.mass).tocsr()
        free = np.setdiff1d(np.arange(matrix.shape[0]), shafts[self._driven])
        moved, load = np.zeros((2, matrix.shape[0]), complex)
        for target, given in ((moved, excited.angles), (load, excited.torques)):
            for pulley, amplitude in given.items():
                target[shafts[pulley]] += amplitude
        try:
            factors = splu(matrix[free][:, free].tocsc())
        except RuntimeError as error:  # SuperLU's word for a motion without stiffness, damping or inertia
            raise ConvergenceError(
                f"the drive has no response at {frequency / tau:.4g} Hz: some part moves there without any "
                "force, such as a pulley that nothing holds. Hold it by a load, or vary the speed."
            ) from error
        moved[free] = factors.solve((load - matrix @ moved)[free])
        chosen = np.asarray(places, dtype=int)
        by_force = np.zeros((matrix.shape[0], chosen.size), complex)
        unit = (free[:, None] == chosen).astype(complex)
        by_force[free] = factors.solve(unit) if chosen.size else unit
        return moved, matrix @ moved, by_force

    def _results(self, motions: SmallMotions, moved: ComplexArray, frequency: float) -> dict[str, ComplexArray]:
        """Amplitudes of results from those of the unknowns: derivatives of what is observed, along both parts."""
        system = self._motions.system
        position = np.zeros(system.first_body + system.bodies.size, complex)
        position[: system.first_body] = moved[: system.first_body]
        position[system.first_body :] = np.where(motions.bodies >= 0, moved[motions.bodies], 0.0)
        velocity = 1j * frequency * position
        real = self._derivative(position.real, velocity.real)
        imaginary = self._derivative(position.imag, velocity.imag)
        found = {name: real[name] + 1j * imaginary[name] for name in real}
        ways = position[system.first_body :]
        speeds, pulleys = 1j * frequency * ways, system.pulleys.size
        direction = self._still["hub_force"][0]
        return found | {
            "hub_load": np.sum(found["hub_force"] * direction, axis=1) / np.linalg.norm(direction, axis=1),
            "pulley_speed": speeds[:pulleys],
            "shaft_speed": speeds[np.asarray(system.pulleys.shaft)],
            "tensioner_position": ways[ways.size - system.tensioners.size :],
        }

    def _derivative(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """Change of what is observed with a change of the state."""
        system, state = self._motions.system, self._motions.state
        largest = float(np.max(np.abs(position[: system.first_body]))) or 1.0
        step = _SMALL * float(np.min(system.rims.radius)) / largest
        steps = step * np.array([[1.0], [-1.0]])
        seen = self._seen(state.position + steps * position, state.velocity + steps * velocity)
        return {name: (values[0] - values[1]) / (2.0 * step) for name, values in seen.items()}

    def _seen(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """What is observed at states, a row each."""
        seen: Observations = observe(self._motions.system, np.zeros(len(position)), position, velocity)
        aside = mid_span_displacements(
            self._motions.prepared, seen.pulley_center, seen.contact_position, seen.contact_pulley
        )
        return {name: getattr(seen, name) for name in _OBSERVED} | {"mid_span_displacement": aside}


RESPONSES = {
    "span_tension": Variable(("span",), "N", "Span tension"),
    "mid_span_displacement": Variable(("span",), "m", "Mid-span displacement"),
    "belt_speed": Variable(("span",), "m/s", "Belt speed"),
    "pulley_speed": Variable(("pulley",), "rad/s", "Pulley speed"),
    "shaft_speed": Variable(("pulley",), "rad/s", "Shaft speed"),
    "pulley_torque": Variable(("pulley",), "N m", "Torque of the belt on the pulley"),
    "shaft_torque": Variable(("pulley",), "N m", "Shaft torque"),
    "hub_load": Variable(("pulley",), "N", "Hub load"),
    "tensioner_position": Variable(("tensioner",), "m or rad", "Tensioner position"),
}
"""Results whose amplitudes are found, with the dimension that comes after speed and excitation."""
_ABOUT = ("speed", "excitation")


class Answers:
    """Collects responses at speeds (rad/s, ascending) of the pulley whose speed is prescribed.

    Dry friction of tensioners holds them (`stuck`), or is left out. ModelError if nothing excites the drive.
    """

    def __init__(self, drive: Drive, number: int, speeds: FloatArray, *, stuck: bool = False) -> None:
        self._drive, self._speeds, self._labels, self._stuck = drive, speeds, labels_of(drive), stuck
        count = speeds.size
        driven = {number, *(place for place, one in enumerate(drive.pulleys) if one.prescribed)}
        self.excitations = [
            one
            for one in own_excitations(drive)
            if one.cause == SPEED or (one.cause == LOAD and one.pulley not in driven)
        ]
        if not self.excitations:
            raise ModelError(
                "the drive has no excitation: no prescribed speed and no load of a free pulley has harmonics. "
                "Give a pulley `harmonics = [{ order = 2, amplitude = 0.02 }]`, or a load a torque over its "
                "angle."
            )
        known = {name: one for name, one in RESPONSES.items() if self._labels[one.dims[0]]}
        self._variables = known
        self._found: dict[str, ComplexArray] = {
            name: np.full((count, len(self.excitations), len(self._labels[one.dims[0]])), complex(np.nan, np.nan))
            for name, one in known.items()
        }
        self._frequency = np.full((count, len(self.excitations)), np.nan)
        self._ranges: list[Range | None] = [None] * count

    def take(self, row: int, run: Run, motion: ForcedMotion) -> None:
        """Take the responses at a speed."""
        excitations, answers = list[Excited](), list[dict[str, ComplexArray]]()
        for place, one in enumerate(self.excitations):
            hertz = one.frequency(run)
            speed = float(run.dataset[one.turning][-1, one.pulley])
            backward = speed < 0.0  # the angle falls: exp(i k theta) is exp(-i w t)
            wave = self._wave(one, speed)
            given = {one.pulley: wave.conjugate() if backward else wave}
            excited = Excited(2.0 * np.pi * hertz, *((given, {}) if one.cause == SPEED else ({}, given)))
            found = motion.answer(excited)
            self._frequency[row, place] = hertz
            for name, values in self._found.items():
                values[row, place] = np.conj(found[name]) if backward else found[name]
            excitations.append(excited)
            answers.append(found)
        self._ranges[row] = motion.range_of(excitations, answers)

    def _wave(self, one: Excitation, speed: float) -> complex:
        """Amplitude of an excitation over the angle of its shaft, rad or N m, at a speed of the shaft, rad/s."""
        if one.cause == SPEED:
            return speed_waves(self._drive, one.pulley)[one.order]
        return torque_waves(self._drive, one.pulley, speed).get(one.order, 0.0j)

    @property
    def coordinates(self) -> Axes:
        """Names of the excitations, and their orders."""
        return {
            "excitation": (Variable(("excitation",), "1", "Excitation", "str"), [one.name for one in self.excitations]),
        }

    def variables(self) -> Axes:
        """Amplitudes and phases, and for each span, pulley and tensioner the largest sum of all amplitudes."""
        found: dict[str, tuple[Variable, ArrayLike]] = {
            "order": (
                Variable(("excitation",), "1", "Order, cycles per turn of the exciting shaft"),
                [one.order for one in self.excitations],
            ),
            "excitation_frequency": (
                Variable(("speed", "excitation"), "Hz", "Excitation frequency"),
                self._frequency,
            ),
        }
        for name, one in self._variables.items():
            values, units = self._found[name], self._units(one.units)
            dims = ("speed", "excitation", *one.dims)
            found[f"{name}_amplitude"] = Variable(dims, units, f"{one.long_name}, amplitude"), np.abs(values)
            found[f"{name}_phase"] = Variable(dims, "rad", f"{one.long_name}, phase"), np.angle(values)
        for name, one in self._variables.items():
            total = np.abs(self._found[name]).sum(axis=1)
            label = f"Amplitude of {one.long_name[0].lower()}{one.long_name[1:]}: maximum sum of all orders"
            largest = np.fmax.reduce(total, axis=0)
            found[f"largest_{name}_amplitude"] = Variable(one.dims, self._units(one.units), label), largest
        return {**found, **self._range_variables()}

    def _range_variables(self) -> Axes:
        """How far the vibrations at each speed are from what a linear response holds for."""
        known = {
            "tension_ripple": Variable(("speed", "span"), "1", "Tension amplitude, sum of all orders, over its mean"),
            "largest_friction_used": Variable(("speed", "pulley"), "1", "Maximum share of friction used"),
            "stop_used": Variable(("speed", "tensioner"), "1", "Amplitude of the tensioner over its way to a stop"),
            "friction_change": Variable(("speed",), "1", "Change of tension amplitudes by dry friction of tensioners"),
            "amplitude_error": Variable(("speed",), "1", "Estimated error of amplitudes"),
        }
        own = dict(zip(known, Range._fields, strict=True))
        found = dict[str, tuple[Variable, ArrayLike]]()
        for name, one in known.items():
            size = [len(self._labels[dim]) for dim in one.dims[1:]]
            if 0 not in size:
                blank = np.full(size, np.nan)
                values = [blank if there is None else getattr(there, own[name]) for there in self._ranges]
                found[name] = one, np.array(values)
        return found

    def warnings(self, means: Mapping[str, NDArray[Any]]) -> list[str]:
        """Where vibrations are too large for a linear response, why, and by how much amplitudes may err."""
        errors = np.array([np.nan if one is None else one.error for one in self._ranges])
        beyond = np.flatnonzero(errors > SMALL_ERROR)
        if not beyond.size:
            return []
        row = int(np.nanargmax(errors))
        first, last = RPM * self._speeds[beyond[[0, -1]]]
        where = f"between {first:.4g} and {last:.4g} rpm" if beyond.size > 1 else f"at {first:.4g} rpm"
        error = errors[row]
        much = f"by about {100.0 * error:.2g}%" if error < 1.0 else "by more than their own size"
        return [
            f"the linear response is beyond its range at {beyond.size} of {np.count_nonzero(np.isfinite(errors))} "
            f"speeds, {where}. Worst at {RPM * self._speeds[row]:.4g} rpm, where amplitudes may err {much}: "
            f"{'; '.join(self._causes(row, means))}. Simulate a run-up with `beltdyn sweep` and add it with --compare."
        ]

    def _causes(self, row: int, means: Mapping[str, NDArray[Any]]) -> list[str]:
        """What a linear response leaves out at a speed, in words."""
        there, found = self._ranges[row], list[str]()
        assert there is not None
        span = int(np.nanargmax(there.ripple))
        slack = ", so that the span goes slack" if there.ripple[span] > 1.0 else ""
        found.append(
            f"the tension of {self._labels['span'][span]} oscillates by {100.0 * there.ripple[span]:.3g}% of its mean "
            f"{means['span_tension'][row, span]:.4g} N{slack}"
        )
        slides = [name for name, used in zip(self._labels["pulley"], there.friction_used, strict=True) if used >= 1.0]
        if slides:
            found.append(f"the whole arc of {' and '.join(slides)} slides during part of each period")
        stops = [name for name, used in zip(self._labels["tensioner"], there.stop_used, strict=True) if used >= 1.0]
        if stops:
            found.append(f"the tensioner of {' and '.join(stops)} reaches a stop")
        if there.friction_change > SMALL_ERROR:
            found.append(
                f"dry friction of tensioners, which this response {'assumes to hold' if self._stuck else 'neglects'}, "
                f"changes tension amplitudes by {100.0 * there.friction_change:.2g}%"
            )
        return found

    def _units(self, units: str) -> str:
        """The unit of a result, for tensioners that of those of the drive."""
        turning = {one.turns for one in self._drive.moving_tensioners}
        return ("rad" if turning.pop() else "m") if units == "m or rad" and len(turning) == 1 else units

"""Campbell diagram: modes about steady running over speed, and critical speeds.

Modes tracked from state to state by the agreement of their shapes.

Speeds of all parts in a mode, times the roots of their masses, make a vector.  Of two such vectors a and b the modal
assurance |a* b|^2 / (|a|^2 |b|^2) is 1 where the shapes agree, and 0 where they share no motion.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from beltdyn.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.parts.options import ForceTolerance, RangeCount, takes_options
from beltdyn.parts.quantity import RPM, Count, Numbers, numbers_in
from beltdyn.points.changed_drive import at_instant, at_speed, driver_of, held_at, sense_of
from beltdyn.points.operating_points import Axes, OperatingPoints
from beltdyn.results import Result, Run, Variable
from beltdyn.solvers.eigenvalues import lightly_damped
from beltdyn.solvers.flutter import Vibrations, flutter_shift
from beltdyn.solvers.run_progress import Report
from beltdyn.state.linearized import SmallMotions
from beltdyn.theory.creep import SlidingBelt, fastest_flutter
from beltdyn.vibration.excitation import Excitation, averaged, given_excitations, one_line_each, own_excitations
from beltdyn.vibration.mode_shapes import Shares, even_points, part_names, shares_of, speeds_of
from beltdyn.vibration.modes import SLIDING, STUCK, eigenmodes
from beltdyn.vibration.small_motions import about_steady, dry_tensioners, require_closed

# Critical speeds: where the frequency of an excitation meets that of a mode


class Crossing(NamedTuple):
    """Where lines meet."""

    speed: float
    frequency: float
    mode: int
    """Number of the mode."""
    line: int
    """Number of the excitation."""
    damping_ratio: float


def crossings(speed: FloatArray, frequency: FloatArray, damping_ratio: FloatArray, lines: FloatArray) -> list[Crossing]:
    """Intersections of modes and excitations by ascending speed, linear between neighboring speeds."""
    found = list[Crossing]()
    for line in range(lines.shape[1]):
        apart = frequency - lines[:, [line]]
        with np.errstate(invalid="ignore"):
            meets = (apart[:-1] * apart[1:] < 0.0) | (apart[:-1] == 0.0)
        meets &= np.isfinite(apart[1:])
        for row, mode in zip(*np.nonzero(meets), strict=True):
            part = apart[row, mode] / (apart[row, mode] - apart[row + 1, mode]) if apart[row, mode] else 0.0
            at, hertz, damping = (
                float((1.0 - part) * values[row] + part * values[row + 1])
                for values in (speed, frequency[:, mode], damping_ratio[:, mode])
            )
            found.append(Crossing(at, hertz, int(mode), line, damping))
        (last,) = np.nonzero(apart[-1] == 0.0)
        found += [
            Crossing(float(speed[-1]), float(frequency[-1, mode]), int(mode), line, float(damping_ratio[-1, mode]))
            for mode in last
        ]
    return sorted(found)


_LEAST, _LEAST_OF_PAUSED = 0.3, 0.6
"""Least modal assurance times frequency ratio (lower over higher) for the continuation of a mode, and the same for a
mode that was missing in the previous state."""


class SeenModes(NamedTuple):
    """Modes of a drive in a state, from the lowest frequency on."""

    values: ComplexArray
    """Growth rate and angular frequency, 1/s, shape (k,)."""
    speeds: ComplexArray
    """Vectors of length 1 that tell what moves, shape (k, m)."""
    shares: Shares


def seen_modes(motions: SmallMotions, count: int) -> SeenModes:
    """Modes of a drive about a state, as they are compared with those of other states."""
    values, coordinates = eigenmodes(motions, count, counted=lightly_damped)
    points = even_points(motions)
    found = [
        np.concatenate(speeds_of(motions, points, value, vector))
        for value, vector in zip(values, coordinates.T, strict=True)
    ]
    speeds = np.array([one / np.linalg.norm(one) for one in found])
    return SeenModes(values, speeds, shares_of(motions, points, values, coordinates))


def assurance(speeds: ComplexArray, others: ComplexArray) -> FloatArray:
    """Modal assurance of modes of shape (k, m) with others of shape (j, m), vectors of length 1; shape (k, j)."""
    return np.asarray(np.abs(speeds.conj() @ others.T) ** 2)


class Tracks:
    """Modes over states that follow each other: a row of a table for each state, a column for each mode.

    A mode with which none of a state agrees pauses there, and one that agrees with none begins a column, if it is among
    the `lowest` lightly damped ones of a state or lies between them. Modes that are heavily damped in all states come
    last.
    """

    def __init__(self, lowest: int) -> None:
        self._lowest = lowest
        self._last = list[ComplexArray]()
        self._frequency = list[float]()
        self._paused = np.zeros(0, dtype=bool)
        self._seen = list[SeenModes | None]()
        self._places = list[IntArray]()
        self._agreed = list[FloatArray]()

    def take(self, seen: SeenModes | None) -> None:
        """Take the modes of the next state; None where they are not known."""
        from scipy.optimize import linear_sum_assignment

        places, agreed = np.full(len(self._last), -1), np.full(len(self._last), np.nan)
        if seen is not None:
            if self._last:
                table = assurance(np.array(self._last), seen.speeds)
                ratio = np.array(self._frequency)[:, None] / seen.values.imag
                score = table * np.minimum(ratio, 1.0 / ratio)
                score[score < np.where(self._paused, _LEAST_OF_PAUSED, _LEAST)[:, None]] = 0.0
                columns, modes = linear_sum_assignment(-score)
                good = score[columns, modes] > 0.0
                places[columns[good]] = modes[good]
                agreed[columns[good]] = table[columns[good], modes[good]]
            begun = np.setdiff1d(np.arange(seen.values.size), places)
            places, agreed = np.append(places, begun), np.append(agreed, np.full(begun.size, np.nan))
            self._last.extend(seen.speeds[begun])
            self._frequency.extend(seen.values.imag[begun])
            self._paused = places < 0
            for column in np.flatnonzero(places >= 0):
                self._last[column] = seen.speeds[places[column]]
                self._frequency[column] = seen.values.imag[places[column]]
        self._places.append(places)
        self._agreed.append(agreed)
        self._seen.append(seen)

    @property
    def found(self) -> bool:
        """Whether there are modes of any state."""
        return bool(self._last)

    def table(self, states: int) -> "ModeTable":
        """The modes: columns in the order in which they begin, those of lower frequency first."""
        places = np.full((states, len(self._last)), -1)
        agreed = np.full(places.shape, np.nan)
        for row, (own, agreement) in enumerate(zip(self._places, self._agreed, strict=True)):
            places[row, : own.size], agreed[row, : own.size] = own, agreement
        counted = np.zeros(states, dtype=int)
        counted[: len(self._seen)] = [0 if seen is None else self._counted(seen.values) for seen in self._seen]
        columns = np.flatnonzero(np.any((places >= 0) & (places < counted[:, None]), axis=0))
        places, agreed = places[:, columns], agreed[:, columns]
        first = np.argmax(places >= 0, axis=0)
        order = np.lexsort((np.take_along_axis(places, first[None], axis=0)[0], first, self._heavy(places)))
        places, agreed = places[:, order], agreed[:, order]
        seen = [one for one in self._seen if one is not None]
        values = np.full(places.shape, complex(np.nan, np.nan))
        shares = Shares(*(np.full((*places.shape, *part.shape[1:]), np.nan) for part in seen[0].shares))
        for row, one in enumerate(self._seen):
            there = np.flatnonzero(places[row] >= 0)
            if one is not None:
                values[row, there] = one.values[places[row, there]]
                for part, given in zip(shares, one.shares, strict=True):
                    part[row, there] = given[places[row, there]]
        return ModeTable(values, agreed, shares)

    def _counted(self, values: ComplexArray) -> int:
        """Number of modes of a state up to the last of the lowest lightly damped ones."""
        return int(np.searchsorted(np.cumsum(lightly_damped(values)), self._lowest)) + 1

    def _heavy(self, places: IntArray) -> BoolArray:
        """Whether modes are heavily damped in all states."""
        heavy = np.ones(places.shape[1], dtype=bool)
        for row, seen in zip(places, self._seen, strict=False):  # states to come are not known
            known = np.flatnonzero(row >= 0)
            if seen is not None:
                heavy[known] &= ~lightly_damped(seen.values[row[known]])
        return heavy


class ModeTable(NamedTuple):
    """Modes over states, n of them, in columns, k of them; NaN where a mode is not found."""

    values: ComplexArray
    """Growth rate and angular frequency, 1/s, shape (n, k)."""
    assurance: FloatArray
    """Agreement with the mode where it was seen before; NaN where it begins; shape (n, k)."""
    shares: Shares
    """Of arrays of shape (n, k, ...)."""

    @property
    def frequency(self) -> FloatArray:
        """Hz, shape (n, k)."""
        return np.asarray(self.values.imag / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> FloatArray:
        """Shape (n, k)."""
        return np.asarray(-self.values.real / np.abs(self.values))

    def mean_shares(self, mode: int) -> Shares:
        """Shares of a mode, on an average over states."""
        return Shares(*(np.nanmean(part[:, mode], axis=0) for part in self.shares))


# The lines of a Campbell diagram: modes over speed, excitations, where they meet, and what grows by itself

_RESONATES = 0.5**0.5
"""Damping ratio below which a vibration becomes larger near the frequency of its mode."""
_SPARE = 4
"""Additional modes above the requested ones, to track modes that move into their range."""
_GROWS = 1e-6
"""Growth rate of an unstable mode, over its angular frequency."""
_DOUBTFUL = 0.5
"""Modal assurance below which the tracking of modes is uncertain."""
_SPEED, _MODE, _EXCITATION, _CRITICAL = ("speed",), ("mode",), ("excitation",), ("critical",)
_BOTH = (*_SPEED, *_MODE)

VARIABLES = {
    "growth": Variable(_SPEED, "1/s", "Growth rate, maximum over the modes"),
    "flutter_rate": Variable(_SPEED, "1/s", "Flutter rate, maximum near the contact resonance of the belt"),
    "flutter_frequency": Variable(_SPEED, "Hz", "Flutter frequency"),
    "flutter_bound": Variable(("pulley",), "1/s", "Flutter rate, for an infinitely long sliding arc"),
    "order": Variable(_EXCITATION, "1", "Order, cycles per turn of the pulley"),
    "excitation_frequency": Variable((*_SPEED, *_EXCITATION), "Hz", "Excitation frequency"),
    "kind": Variable(_MODE, "1", "Kind, by shares of kinetic energy", "str"),
    "moving_parts": Variable(_MODE, "1", "Parts with most of the energy", "str"),
    "lowest_frequency": Variable(_MODE, "Hz", "Lowest frequency"),
    "highest_frequency": Variable(_MODE, "Hz", "Highest frequency"),
    "least_damping_ratio": Variable(_MODE, "1", "Least damping ratio"),
    "frequency": Variable(_BOTH, "Hz", "Frequency"),
    "damping_ratio": Variable(_BOTH, "1", "Damping ratio"),
    "growth_rate": Variable(_BOTH, "1/s", "Growth rate, negative for decaying modes"),
    "assurance": Variable(_BOTH, "1", "Modal assurance with the previous speed"),
    "span_share": Variable((*_BOTH, "span"), "1", "Share of kinetic energy, transverse motion of the span"),
    "pulley_share": Variable((*_BOTH, "pulley"), "1", "Share of kinetic energy, rotation of the pulley"),
    "belt_share": Variable(_BOTH, "1", "Share of kinetic energy, longitudinal motion of the belt"),
    "tensioner_share": Variable((*_BOTH, "tensioner"), "1", "Share of kinetic energy, tensioner"),
    "critical_speed": Variable(_CRITICAL, "rad/s", "Speed, critical"),
    "critical_excitation": Variable(_CRITICAL, "1", "Excitation", "str"),
    "critical_mode": Variable(_CRITICAL, "1", "Mode", "int64"),
    "critical_frequency": Variable(_CRITICAL, "Hz", "Frequency"),
    "critical_damping_ratio": Variable(_CRITICAL, "1", "Damping ratio"),
    "critical_parts": Variable(_CRITICAL, "1", "Parts of the mode, with most of its energy", "str"),
}
"""What is known beside operating points."""


class CampbellDiagram:
    """Collects modes from speed to speed; dry friction may hold tensioners (`stuck`)."""

    def __init__(
        self, drive: Drive, speeds: FloatArray, excitations: Sequence[Excitation], count: int, stuck: bool
    ) -> None:
        self._drive, self._speeds, self._excitations, self._count = drive, speeds, excitations, count
        self._stuck = dry_tensioners(prepare(drive)) if stuck else None
        self._tracks = Tracks(count)
        self._lines = list[list[float]]()
        self._flutter = list[complex]()
        self._bounds = list[float]()

    def take(self, run: Run | None) -> None:
        """Take steady running at the next speed, or none."""
        seen, flutter, lines = None, complex(np.nan, np.nan), [np.nan] * len(self._excitations)
        try:
            if run is not None:
                motions = about_steady(run)
                vibrating = motions if self._stuck is None else motions.with_stuck(self._stuck)
                own, around = [one.frequency(run) for one in self._excitations], _flutter(motions)
                self._bounds = self._bounds or _flutter_bounds(motions)
                seen, flutter, lines = seen_modes(vibrating, self._count + _SPARE), around, own
        finally:
            self._tracks.take(seen)
            self._flutter.append(flutter)
            self._lines.append(lines)

    @property
    def found(self) -> bool:
        """Whether there are modes."""
        return self._tracks.found

    @property
    def coordinates(self) -> Axes:
        """Numbers of modes and critical speeds, and names of excitations."""
        names, _ = self._excited()
        modes, critical = self._modes().values.shape[1], len(self._critical())
        return {
            "excitation": (Variable(_EXCITATION, "1", "Excitation", "str"), names),
            "mode": (Variable(_MODE, "1", "Mode", "int64"), np.arange(1, modes + 1)),
            "critical": (Variable(_CRITICAL, "1", "Critical speed", "int64"), np.arange(1, critical + 1)),
        }

    def variables(self, _: Mapping[str, Any]) -> Axes:
        """All that is known beside operating points, by the names of `VARIABLES`."""
        arrays = self._of_modes() | self._of_excitations() | self._of_critical_speeds()
        held = arrays if self._drive.moving_tensioners else arrays.keys() - {"tensioner_share"}
        return {name: (one, arrays[name]) for name, one in VARIABLES.items() if name in held}

    @property
    def warnings(self) -> list[str]:
        """Unstable modes, and speeds at which the tracking of modes is uncertain."""
        return [*self._growing(), *self._doubtful()]

    def _modes(self) -> ModeTable:
        """Modes at all speeds, those to come unknown."""
        return self._tracks.table(len(self._speeds))

    def _excited(self) -> tuple[list[str], FloatArray]:
        """Names and frequencies of excitations, shape (n, j)."""
        lines = np.full((len(self._speeds), len(self._excitations)), np.nan)
        lines[: len(self._lines)] = self._lines
        return one_line_each(self._excitations, lines)

    def _critical(self) -> list[Crossing]:
        """Critical speeds: those of modes that are not damped so much that nothing resonates."""
        modes = self._modes()
        found = crossings(self._speeds, modes.frequency, modes.damping_ratio, self._excited()[1])
        return [one for one in found if one.damping_ratio < _RESONATES]

    def _of_modes(self) -> dict[str, ArrayLike]:
        """Variables along the modes."""
        modes, names = self._modes(), part_names(self._drive)
        means = [modes.mean_shares(number) for number in range(modes.values.shape[1])]
        return {
            "growth": np.nanmax(modes.values.real, axis=1, initial=-np.inf),
            "kind": [one.kind for one in means],
            "moving_parts": [one.parts(names) for one in means],
            "lowest_frequency": np.nanmin(modes.frequency, axis=0),
            "highest_frequency": np.nanmax(modes.frequency, axis=0),
            "least_damping_ratio": np.nanmin(modes.damping_ratio, axis=0),
            "frequency": modes.frequency,
            "damping_ratio": modes.damping_ratio,
            "growth_rate": modes.values.real,
            "assurance": modes.assurance,
            "span_share": modes.shares.span,
            "pulley_share": modes.shares.pulley,
            "belt_share": modes.shares.belt,
            "tensioner_share": modes.shares.tensioner,
        }

    def _of_excitations(self) -> dict[str, ArrayLike]:
        """Variables along the excitations, and what flutters."""
        lines = self._excited()[1]
        flutter = np.full(len(self._speeds), complex(np.nan, np.nan))
        flutter[: len(self._flutter)] = self._flutter
        return {
            "flutter_rate": flutter.real,
            "flutter_frequency": np.abs(flutter.imag) / (2.0 * np.pi),
            "flutter_bound": self._bounds,
            "order": np.nanmean(2.0 * np.pi * lines / self._speeds[:, None], axis=0),
            "excitation_frequency": lines,
        }

    def _of_critical_speeds(self) -> dict[str, ArrayLike]:
        """Variables along the critical speeds, with kind and parts of the mode at the nearest speed."""
        found, (names, _), modes = self._critical(), self._excited(), self._modes()
        rows = [self._nearest(one.speed, modes, one.mode) for one in found]
        shares = [Shares(*(part[row, one.mode] for part in modes.shares)) for row, one in zip(rows, found, strict=True)]
        parts = part_names(self._drive)
        return {
            "critical_speed": [one.speed for one in found],
            "critical_excitation": [names[one.line] for one in found],
            "critical_mode": np.array([one.mode + 1 for one in found], dtype=int),
            "critical_parts": [one.parts(parts) for one in shares],
            "critical_frequency": [one.frequency for one in found],
            "critical_damping_ratio": [one.damping_ratio for one in found],
        }

    def _nearest(self, speed: float, modes: ModeTable, mode: int) -> int:
        """Row of the nearest speed at which a mode is known."""
        return int(np.nanargmin(np.abs(self._speeds - speed) + 0.0 * modes.frequency[:, mode]))

    def _growing(self) -> Iterator[str]:
        """Unstable modes."""
        modes = self._modes()
        for number, values in enumerate(modes.values.T):
            grows = np.flatnonzero(values.real > _GROWS * values.imag)
            if grows.size:
                first, last = (RPM * self._speeds[grows[k]] for k in (0, -1))
                rate = float(values.real[grows].max())
                yield (
                    f"mode {number + 1} is unstable at {grows.size} of {len(self._speeds)} speeds, from "
                    f"{first:.4g} to {last:.4g} rpm, by up to {rate:.3g} 1/s: the drive does not remain in "
                    "steady running there. Add damping, or simulate it over time with `beltdyn simulate`."
                )

    def _doubtful(self) -> Iterator[str]:
        """Speeds at which modes change so much that their tracking is uncertain."""
        agreed = self._modes().assurance
        unsure = np.flatnonzero(np.any(agreed < _DOUBTFUL, axis=1))
        if unsure.size:
            places = ", ".join(f"{RPM * self._speeds[row]:.4g}" for row in unsure)
            yield (
                f"mode shapes change strongly from the previous speed to {places} rpm, so the modes cannot be "
                "tracked reliably. Add points there, and check slip: a pulley may be in gross slip."
            )


def _flutter(motions: SmallMotions) -> complex:
    """The vibration that grows fastest near the frequency of the belt on its penalty springs, 1/s; NaN if none is."""
    system, state = motions.system, motions.state
    return Vibrations(system).fastest_growing(0.0, state.position, state.velocity, flutter_shift(system))


def _flutter_bounds(motions: SmallMotions) -> list[float]:
    """Growth of flutter on each pulley if its whole arc slid, 1/s."""
    system, belt = motions.system, motions.drive.belt
    normal, mass = system.law.normal, system.element.section.mass
    return [
        fastest_flutter(
            SlidingBelt(mass, belt.axial_stiffness, float(radius), normal.stiffness, normal.damping, float(friction))
        ).rate
        for radius, friction in zip(system.rims.radius, system.pulleys.friction, strict=True)
    ]


_KEPT = (
    *("belt_speed", "largest_tension", "least_slip_safety"),
    *("pulley_speed", "span_tension", "tensioner_position", "failure"),
)
"""Variables of operating points that are kept."""


@takes_options
def campbell(
    drive: Drive,
    *,
    speed: Numbers,
    pulley: str | None = None,
    points: RangeCount = 40,
    count: Annotated[Count, Field(ge=1)] = 8,
    orders: Numbers | None = None,
    dry_tensioners: str = SLIDING,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute a Campbell diagram: the modes of a drive over speed, and the critical speeds at which orders excite them.

    Modes are those of `modes`, about steady running, and are tracked over speed by their shapes. Loads are those of the
    drive file at one instant; speed-dependent loads follow the speed. Speeds without steady running are marked as
    failed.

    Parameters
    ----------
    drive
        The drive.
    speed
        Speeds of the pulley: a range such as "700..6000 rpm", a list "700, 1500, 3000 rpm", or an array in rad/s;
        positive in its sense of rotation.
    pulley
        The pulley whose speed is prescribed, in place of its motor; by default the driver.
    points
        Number of speeds of a range.
    count
        Number of lightly damped modes at each speed, from the lowest frequency, as for `modes`. Heavily damped modes
        between them come last.
    orders
        Exciting orders of the pulley's rotation, such as "1, 2, 4" or [1, 2, 4]. By default the harmonics of speeds
        and loads in the drive file, and the rotation of all pulleys and of the belt.
    dry_tensioners
        "sliding" for tensioners without dry friction, as in large vibrations, or "stuck" for tensioners held by it, as
        in small ones.
    at
        Instant at which loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
        simulation.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    output
        Result file (NetCDF4), updated point by point; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Result
        Variables along ``speed`` (rad/s, of the pulley in the attribute ``pulley``) and ``mode``; ``critical`` speeds,
        and the frequencies of each ``excitation``.

    Raises
    ------
    ModelError
        If options are invalid, or the drive cannot run steadily.
    ConvergenceError
        If no speed has steady running.

    Examples
    --------
    >>> found = bd.campbell(drive, speed="80, 120 rpm", count=2)
    >>> found.dataset.frequency.dims
    ('speed', 'mode')
    """
    if dry_tensioners not in (SLIDING, STUCK):
        raise ModelError(f'dry_tensioners = {dry_tensioners!r} must be "{SLIDING}" or "{STUCK}".')
    require_closed(drive, web=True)
    text, drive = drive.text, drive.with_slides()
    held = held_at(averaged(drive), at)
    number = driver_of(held) if pulley is None else held.number_of(pulley)
    name, sense = held.pulleys[number].name, sense_of(held, number)
    excitations = own_excitations(at_instant(drive, at)) if orders is None else given_excitations(orders, held, number)
    speeds = numbers_in("speed", speed, "rad/s", points)
    if speeds[0] < 0.0:
        raise ModelError(
            f"speed = {speed!r} must not be negative: speeds are positive in the pulley's sense of rotation."
        )
    axes: Axes = {"speed": (Variable(("speed",), "rad/s", f"Speed of {name}"), speeds)}
    with OperatingPoints("campbell", held, axes, output, progress, overwrite, names=_KEPT) as table:
        title = f"Campbell diagram of {drive.title} over the speed of {name}"
        table.attributes = {
            "title": title,
            "drive_as_given": text,
            "pulley": name,
            "dry_tensioners": dry_tensioners,
        }
        diagram = CampbellDiagram(held, speeds, excitations, count, dry_tensioners == STUCK)

        def take(_: tuple[int, ...], run: Run | None) -> None:
            diagram.take(run)
            if diagram.found:
                table.more, table.derive, table.notes = diagram.coordinates, diagram.variables, diagram.warnings

        def drive_at(value: float) -> Drive:
            return at_speed(held, number, sense * value)

        table.each(drive_at, force_tolerance, then=take, found_then="modes")
    return table.result()

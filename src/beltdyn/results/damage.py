"""Fatigue of a belt in steady running and in a run: damage of cords and ribs by each pulley, and lives."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Drive, Prepared
from beltdyn.model.rating import CordFatigue
from beltdyn.results.belt_history import BeltHistory, belt_history, turn_history
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.run import Run
from beltdyn.results.schema import Variable, runs_steadily


class Cycles(NamedTuple):
    """Cycles of a history."""

    low: FloatArray
    """Least value, shape (cycles,)."""
    high: FloatArray
    """Largest value, shape (cycles,)."""
    number: FloatArray
    """1, or 0.5 for a half cycle, shape (cycles,)."""
    at: IntArray
    """Place of the largest value in the history, shape (cycles,)."""

    @property
    def range(self) -> FloatArray:
        """Largest less least value."""
        return self.high - self.low

    def above(self, share: float) -> "Cycles":
        """The cycles whose range is at least a share of the largest range."""
        kept = self.range >= share * self.range.max(initial=0.0)
        return Cycles(self.low[kept], self.high[kept], self.number[kept], self.at[kept])


def turning_points(history: FloatArray) -> IntArray:
    """Indices of peaks, valleys and both ends of a history; of equal values the first."""
    moved = np.flatnonzero(np.diff(history, prepend=np.nan) != 0.0)
    slopes = np.sign(np.diff(history[moved]))
    turned = np.flatnonzero(slopes[1:] != slopes[:-1]) + 1
    return moved[np.unique(np.concatenate([[0], turned, [len(moved) - 1]]))] if moved.size else moved


def rainflow(history: FloatArray) -> Cycles:
    """Count the cycles of a history; what remains at its ends counts as half cycles."""
    points, found, kept = turning_points(history), list[tuple[int, int, float]](), list[int]()
    for point in points.tolist():
        kept.append(point)
        while len(kept) > 2:
            (first, second, last), whole = kept[-3:], len(kept) > 3
            if abs(history[last] - history[second]) < abs(history[second] - history[first]):
                break
            found.append((first, second, 1.0 if whole else 0.5))
            del kept[-3 : -1 if whole else -2]
    found += [(first, second, 0.5) for first, second in pairwise(kept)]
    return _cycles(history, found)


def rainflow_of_turn(history: FloatArray) -> Cycles:
    """Count the cycles of a history that repeats: from its largest value on there are whole cycles only."""
    if not len(history):
        return rainflow(history)
    begin = int(np.argmax(history))
    cycles = rainflow(np.concatenate([history[begin:], history[: begin + 1]]))
    return cycles._replace(at=(cycles.at + begin) % len(history))


def _cycles(history: FloatArray, found: list[tuple[int, int, float]]) -> Cycles:
    """Cycles from the places of their two ends and their counts."""
    if not found:
        return Cycles(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros(0, dtype=int))
    ends, number = np.array([one[:2] for one in found]), np.array([one[2] for one in found])
    values = history[ends]
    return Cycles(values.min(axis=1), values.max(axis=1), number, ends[np.arange(len(ends)), values.argmax(axis=1)])


HOUR = 3600.0
"""Seconds in an hour."""
_LEAST_RANGE = 0.05
"""Range of a cycle over the largest one below which it does not count: the mesh has ripples, and they are no cycles."""

_PULLEY = ("pulley",)
VARIABLES = {
    "cord_force": Variable((), "N", "Largest force in the cords"),
    "cord_damage_rate": Variable((), "1/h", "Damage of the cords, in an hour"),
    "cord_life": Variable((), "h", "Life of the cords"),
    "cord_damage": Variable(_PULLEY, "1/h", "Damage of the cords by the pulley, in an hour"),
    "rib_damage_rate": Variable((), "1/h", "Damage of the ribs, in reference passages in an hour"),
    "rib_life": Variable((), "h", "Life of the ribs"),
    "rib_damage": Variable(_PULLEY, "1/h", "Damage of the ribs by the pulley, in reference passages in an hour"),
}
"""What steady running does to the belt, by name."""


def known_variables(drive: Drive) -> list[str]:
    """Those of `VARIABLES` for which a belt has data."""
    belt, has_life = drive.belt, drive.belt.rib_fatigue is not None and drive.belt.rib_fatigue.passages is not None
    known = {"cord": belt.cord_fatigue is not None, "rib": belt.rib_fatigue is not None}
    return [name for name in VARIABLES if known[name[: name.index("_")]] and (name != "rib_life" or has_life)]


class Damage(NamedTuple):
    """Damage of a belt by each pulley."""

    cord: FloatArray
    """Sum of cycles over cycles to failure (Miner); NaN without an S-N line, shape (pulleys,)."""
    rib: FloatArray
    """Passages, in those of the reference condition; NaN without data, shape (pulleys,)."""
    turns: float
    """Turns of the belt."""
    force: float
    """Largest equivalent force in the cords, N; NaN without an S-N line."""

    def times(self, factor: float) -> "Damage":
        """So many times the damage."""
        return Damage(factor * self.cord, factor * self.rib, factor * self.turns, self.force)

    def plus(self, other: "Damage") -> "Damage":
        """The sum of both."""
        force = max(self.force, other.force)
        return Damage(self.cord + other.cord, self.rib + other.rib, self.turns + other.turns, force)


def hourly_damage(run: Run) -> Damage:
    """Damage in an hour of steady running of a closed belt."""
    speed = abs(float(np.squeeze(run.dataset.attrs["belt_parameter"])))
    turns = HOUR * speed / run.prepared.belt_length
    cord, force = _cord_damage(run.drive, turn_history(run), rainflow_of_turn)
    rib = _rib_passages(run.prepared, SpanTension.of(lambda name: run.dataset[name].values[-1]))
    return Damage(cord, rib, 1.0, force).times(turns)


def damage_of_tensions(prepared: Prepared, ends: FloatArray, speed: float) -> Damage:
    """Damage in an hour of a closed belt on rims of its path, by tensions at both ends of spans (N) and speed (m/s).

    A material point meets two tensions without and with bending at each pulley: those of the spans beside it.

    Parameters
    ----------
    ends : ndarray, shape (spans, 2)
    """
    path, order = prepared.path, np.asarray(prepared.path.order)
    pulley = np.repeat(path.span_pulleys[order, 1], 4)
    curvature = np.repeat(1.0 / np.abs(path.radii[path.span_pulleys[order, 1]]), 4) * np.tile(
        [0.0, 1.0, 1.0, 0.0], len(order)
    )
    tension = np.column_stack([ends[order, 1], ends[order, 1], *[np.roll(ends[order, 0], -1)] * 2]).ravel()
    places = np.arange(tension.size, dtype=float)
    history = BeltHistory(places, places, tension[:, None], curvature[:, None], pulley[:, None])
    cord, force = _cord_damage(prepared.drive, history, rainflow_of_turn)
    rib = _rib_passages(prepared, SpanTension(ends[:, 0], ends[:, 1], ends.mean(axis=1)))
    return Damage(cord, rib, 1.0, force).times(HOUR * abs(speed) / prepared.belt_length)


def damage_of_run(run: Run) -> Damage:
    """Damage in a run over time, the mean over material points of the belt, which begin in different places."""
    if runs_steadily(run.dataset):
        return hourly_damage(run).times(float(np.ptp(run.dataset["time"].values)) / HOUR)
    history = belt_history(run)
    cord, force = _cord_damage(run.drive, history, rainflow)
    time, dataset = run.dataset["time"].values, run.dataset
    rate = np.abs(dataset["belt_speed"].values.mean(axis=1)) / run.prepared.path.length
    passages = _rib_passages(run.prepared, SpanTension.of(lambda name: dataset[name].values))
    turns = float(np.trapezoid(rate, time))
    return Damage(cord, np.trapezoid(passages * rate[:, None], time, axis=0), turns, force)


def fatigue_by_name(run: Run) -> dict[str, Any]:
    """The values of `VARIABLES` in steady running for which the belt has data."""
    names = known_variables(run.drive)
    if not names:
        return {}
    damage = hourly_damage(run)
    lives = Lives(run.drive, damage)
    values = {
        "cord_force": damage.force,
        "cord_damage_rate": damage.cord.sum(),
        "cord_life": lives.cord,
        "cord_damage": damage.cord,
        "rib_damage_rate": damage.rib.sum(),
        "rib_life": lives.rib,
        "rib_damage": damage.rib,
    }
    return {name: values[name] for name in names}


class Lives:
    """Lives of a belt, h, under a damage per hour that goes on.

    The life of cords ends with the S-N line: where all forces are below its last point, that gives a lower bound.
    """

    def __init__(self, drive: Drive, damage: Damage) -> None:
        line, law = drive.belt.cord_fatigue, drive.belt.rib_fatigue
        with np.errstate(divide="ignore"):
            self.cord = float(np.nan if line is None else 1.0 / damage.cord.sum())
            self.rib = float(np.nan if law is None or law.passages is None else law.passages / damage.rib.sum())
        self.is_bound = line is not None and damage.force < line.forces[-1]
        """Whether the life of the cords is a lower bound."""
        if line is not None and self.is_bound and damage.turns > 0.0:
            self.cord = min(self.cord, line.cycles[-1] / damage.turns)


def cord_force(line: CordFatigue, history: BeltHistory) -> FloatArray:
    """Force in the cords, N, shape of the history: T + B |κ|, with the tension that S-N lines take."""
    return np.asarray(history.tension + line.bending_force * np.abs(history.curvature))


def _cord_damage(drive: Drive, history: BeltHistory, count: Callable[[FloatArray], Cycles]) -> tuple[FloatArray, float]:
    """Damage by each pulley, the mean over material points, and the largest equivalent force, N."""
    line = drive.belt.cord_fatigue
    damage = np.zeros(len(drive.pulleys))
    if line is None:
        return damage * np.nan, np.nan
    forces, largest = cord_force(line, history), 0.0
    for force, pulley in zip(forces.T, history.pulley.T, strict=True):
        part, most = miner(line, count(force).above(_LEAST_RANGE), pulley, damage.size)
        damage, largest = damage + part / forces.shape[1], max(largest, most)
    return damage, largest


def miner(line: CordFatigue, cycles: Cycles, pulley: IntArray, pulleys: int) -> tuple[FloatArray, float]:
    """Damage by each pulley by Miner's rule, and the largest equivalent force, N.

    A cycle belongs to the pulley of its largest force; cycles that never pull do no damage.
    """
    pulls = cycles.high > 0.0
    force = line.equivalent_force(cycles.low[pulls], cycles.high[pulls])
    part = cycles.number[pulls] / line.cycles_to_failure(force)
    damage = np.bincount(pulley[cycles.at[pulls]], weights=part, minlength=pulleys)
    return np.asarray(damage, dtype=float), float(force.max(initial=0.0))


def _rib_passages(prepared: Prepared, tension: SpanTension) -> FloatArray:
    """Reference passages for which one passage over each pulley counts, shape (..., pulleys)."""
    law = prepared.belt.rib_fatigue
    if law is None:
        return np.full((*tension.mean.shape[:-1], len(prepared.pulleys)), np.nan)
    largest = np.maximum(*tension.at_arcs(prepared))
    diameters, sides = [2.0 * one.radius for one in prepared.pulleys], [one.side for one in prepared.pulleys]
    return law.passages_at(largest, diameters, prepared.belt.temperature, sides)

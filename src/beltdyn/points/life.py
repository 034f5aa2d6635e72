"""Life of a belt: damage of cords and ribs over a duty table and in runs, share of each pulley, and lives."""

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, load
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.parts.quantity import Ratio
from beltdyn.points.changed_drive import held_at, require_belt
from beltdyn.points.duty import Column, at_row, durations_of, duty_of
from beltdyn.points.operating_points import PULLEY, Axes, OperatingPoints
from beltdyn.results import Result, Run, Variable, open_result
from beltdyn.results.belt_history import BeltHistory, turn_history
from beltdyn.results.damage import HOUR, Damage, Lives, cord_force, damage_of_run, known_variables, turning_points
from beltdyn.results.dataset import is_result
from beltdyn.results.run import run_of
from beltdyn.solvers.run_progress import Report

_KEPT = ("belt_speed", "span_tension", "cord_force", "cord_damage_rate", "cord_damage", "rib_damage_rate", "rib_damage")
"""Variables of operating points in the table."""
_PLACES = (np.arange(400) + 0.5) / 400
"""Middles of the cells of a turn of which histories keep the extremes, in turns of the belt."""
_HISTORY = ("row", "place")
_OF_HISTORY = {
    "tension": Variable(_HISTORY, "N", "Tension of a material point"),
    "bending_strain": Variable(_HISTORY, "1", "Bending strain of the inside surface"),
}


@takes_options
def life(
    drive: Drive,
    *,
    table: Path | str | None = None,
    run: Run | Path | str | None = None,
    repeats: Annotated[Ratio, Field(ge=0)] = 1.0,
    reference: Drive | Result | Path | str | None = None,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    r"""Compute the damage of cords and ribs of the belt, the share of each pulley, and lives.

    In steady running at each row of a duty table, tension and bending of a material point over a turn of the belt give
    cycles of the force in the cords (rainflow, ASTM E1049), and these a share of the life by the S-N line of the belt
    (Miner). Ribs fail by passages over pulleys, by diameter, tension and temperature. What the belt has no data for is
    not computed.

    Parameters
    ----------
    drive
        The drive; its belt has `cord_fatigue` or `rib_fatigue`, as some profiles have.
    table
        The duty table, a CSV file as for `duty`; by default the groups ``[[duty]]`` of the drive file, and without
        these the drive as it is, for an hour.
    run
        A run over time of this drive, such as a start or a run-up, or its result file. Its damage is added.
    repeats
        How often that run occurs in one pass of the table.
    reference
        A drive, its file, or results of `life` to which the lives are relative, under the same table.
    at
        Instant at which the rest of the drive is evaluated, such as "0.5 s", or in s; by default the end of the
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
        Damage in an hour of each row and pulley; ``cord_share`` and ``rib_share`` of the pulleys, ``cord_life`` and
        ``rib_life`` of the duty, each if the belt has the data, ``relative_cord_life`` and ``relative_rib_life``; and
        along ``place`` the tension and the bending strain of a material point over a turn.

    Raises
    ------
    ModelError
        If the belt has no fatigue data, the file is not a duty table, or the drive cannot run steadily.
    ConvergenceError
        If no row has steady running.

    Examples
    --------
    >>> line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
    >>> found = bd.life(drive.replace(belt=drive.belt.replace(cord_fatigue=line)))
    >>> found.dataset.cord_share.sum().round(6).item()
    1.0
    """
    require_belt(drive, "the fatigue life", "`beltdyn steady-state`")
    _require_data(drive)
    if run is None and repeats != 1.0:
        raise ModelError(f"repeats = {repeats:g} needs a run that occurs so often. Give run, or omit repeats.")
    columns = duty_of(drive, table) or [Column("duration", "", [HOUR])]
    held, durations = held_at(drive, at), durations_of(columns)
    event = None if run is None else damage_of_run(_run_of(drive, run)).times(repeats)
    compared = None if reference is None else _reference(reference, partial(life, table=table, at=at))
    axes = {"row": (Variable(("row",), "1", "Row", "int64"), np.arange(1, durations.size + 1))}
    with OperatingPoints("life", held, axes, output, progress, overwrite, names=(*_KEPT, "failure")) as points:
        points.more = {
            "duration": (Variable(("row",), "s", "Duration"), durations),
            "place": (Variable(("place",), "1", "Length of belt that has passed, in turns"), _PLACES),
        }
        sums = _Sums(held, columns, event, compared)
        points.derive, points.attributes = sums.derive, {"drive_as_given": drive.text}
        points.each(lambda row: at_row(held, columns, row - 1), force_tolerance, then=sums.take)
        points.notes = list(sums.warnings(points.arrays))
    return points.result()


class _Sums:
    """Histories of the rows, and what follows from all of them."""

    def __init__(
        self, drive: Drive, columns: list[Column], event: Damage | None, compared: Mapping[str, float] | None
    ) -> None:
        self._drive, self._event, self._compared = drive, event, compared
        self._durations, self._heated = durations_of(columns), any(one.what == "temperature" for one in columns)
        durations = self._durations
        self._history = {name: np.full((durations.size, _PLACES.size), np.nan) for name in _OF_HISTORY}
        self._turns = np.full(durations.size, np.nan)
        self._reached = np.full((durations.size, len(drive.pulleys)), np.nan)

    def take(self, index: tuple[int, ...], run: Run | None) -> None:
        """Note the history of a row."""
        if run is None:
            return
        drive, history = run.drive, turn_history(run)
        length = drive.belt_length
        kept = _extremes(drive, history)
        self._history["tension"][index] = history.tension[kept, 0]
        self._history["bending_strain"][index] = -history.curvature[kept, 0] * _inside_depth(drive)
        self._turns[index] = HOUR / history.time[-1] * history.passed[-1] / length
        bends = np.abs(history.curvature[:, 0])
        for number in range(len(drive.pulleys)):
            weight = np.where(history.pulley[:, 0] == number, bends, 0.0)
            turn = np.sum(weight * np.exp(2j * np.pi * history.passed / length))
            self._reached[(*index, number)] = np.angle(turn) / (2.0 * np.pi) % 1.0

    def derive(self, arrays: Mapping[str, NDArray[Any]]) -> Axes:
        """Variables beside those of the rows."""
        found: Axes = {name: (_OF_HISTORY[name], values) for name, values in self._history.items()}
        middle = Variable(("row", *PULLEY), "1", "Middle of the arc of the pulley, in turns of the belt")
        return {**found, "arc_place": (middle, self._reached), **dict(self._totals(arrays))}

    def _hours(self) -> FloatArray:
        """Durations of the rows that have steady running, h; others have none."""
        return np.where(np.isfinite(self._turns), self._durations / HOUR, 0.0)

    def _mean(self, arrays: Mapping[str, NDArray[Any]]) -> Damage | None:
        """Damage in an hour of the duty, on average over the rows that have steady running."""
        hours = self._hours()
        if not hours.sum() > 0.0:
            return None
        unknown, done = np.full(self._reached.shape, np.nan), hours > 0.0
        cord, rib = (hours[done] @ arrays.get(f"{what}_damage", unknown)[done] for what in ("cord", "rib"))
        force = float(np.max(arrays.get("cord_force", unknown)[done]))
        total = Damage(cord, rib, float(hours[done] @ self._turns[done]), force)
        total = total if self._event is None else total.plus(self._event)
        return total.times(1.0 / hours.sum())

    def _totals(self, arrays: Mapping[str, NDArray[Any]]) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        """Shares of the pulleys, and lives."""
        mean = self._mean(arrays)
        if mean is None:
            return
        lives, names, belt = Lives(self._drive, mean), known_variables(self._drive), self._drive.belt
        for what, damage, data in (("cord", mean.cord, belt.cord_fatigue), ("rib", mean.rib, belt.rib_fatigue)):
            if data is None:
                continue
            total = float(damage.sum())
            if self._event is not None:
                of_run = Variable((), "1", f"Share of the run in the damage of the {what}s")
                part = float(getattr(self._event, what).sum()) / (total * float(self._hours().sum()))
                yield f"{what}_share_of_run", (of_run, part)
            yield f"mean_{what}_damage_rate", (Variable((), "1/h", f"Damage of the {what}s in an hour, mean"), total)
            if f"{what}_life" in names:
                kind = data.life_name
                bound = ", at least" if what == "cord" and lives.is_bound else ""
                name = f"{kind[0].upper()}{kind[1:]} of the {what}s{bound}"
                yield f"{what}_life", (Variable((), "h", name), getattr(lives, what))
            if self._compared is not None and what in self._compared:
                relative = Variable((), "1", f"Life of the {what}s over that of the reference")
                yield f"relative_{what}_life", (relative, self._compared[what] / total)
            share = damage / total if total > 0.0 else np.full(damage.size, np.nan)
            yield f"{what}_share", (Variable(PULLEY, "1", f"Share in the damage of the {what}s"), share)

    def warnings(self, arrays: Mapping[str, NDArray[Any]]) -> Iterator[str]:
        """What limits the meaning of the lives."""
        mean, belt = self._mean(arrays), self._drive.belt
        if mean is None:
            return
        line, law = belt.cord_fatigue, belt.rib_fatigue
        if line is not None and mean.force < line.forces[-1]:
            yield (
                f"the largest force in the cords, {mean.force:.4g} N, is below the last point of the S-N line, "
                f"{line.forces[-1]:.4g} N at {line.cycles[-1]:.3g} cycles. The life is a lower bound: so many turns of "
                "the belt. Relative lives and shares continue the line."
            )
        if line is not None and mean.force > line.forces[0]:
            yield (
                f"the largest force in the cords, {mean.force:.4g} N, is above the first point of the S-N line, "
                f"{line.forces[0]:.4g} N at {line.cycles[0]:.3g} cycles. The life continues the line there, and is not "
                "covered by its source. Use more or larger belts, or larger pulleys."
            )
        if law is not None and belt.temperature is None and not self._heated:
            yield (
                f"no temperature of the belt is given, so ribs are at {law.temperature:.4g} °C; each "
                f"{law.halving_difference:.3g} K more would halve their life. Give belt.temperature, or a column "
                '"temperature [°C]" of the table.'
            )


def _extremes(drive: Drive, history: BeltHistory) -> IntArray:
    """Numbers of the points of a history that are kept: in each cell of a turn that of an extreme of the cord force.

    Of several extremes that which is farthest from the middle of the range; the nearest point in cells without any.
    """
    line = drive.belt.cord_fatigue
    force = (np.abs(history.curvature) if line is None else cord_force(line, history))[:, 0]
    turns = history.passed / drive.belt_length
    excess = force - 0.5 * (force.min() + force.max())
    cells = np.minimum((turns * _PLACES.size).astype(int), _PLACES.size - 1)
    kept = np.abs(turns[:, None] - _PLACES).argmin(axis=0)
    turns_back = np.isin(np.arange(force.size), turning_points(force))
    ascending = np.lexsort((np.abs(excess), turns_back))
    kept[cells[ascending]] = ascending  # the last of a cell stays
    return np.asarray(kept)


def _inside_depth(drive: Drive) -> float:
    """Distance from the tension line to the inside surface, m."""
    belt = drive.belt
    return belt.thickness - (belt.back_offset or 0.5 * belt.thickness)


def _require_data(drive: Drive) -> None:
    """Make sure that the belt has fatigue data, and turns."""
    if not known_variables(drive):
        profile = drive.belt.value_of("profile")
        whose = f'profile = "{profile}" has' if profile else "the belt has"
        raise ModelError(
            f"{whose} no fatigue data. Give [belt.cord_fatigue] or [belt.rib_fatigue] with their source, or a profile "
            "with such data: `beltdyn catalogue A` shows one."
        )


def _run_of(drive: Drive, given: Run | Path | str) -> Run:
    """The run whose damage is added, of the same pulleys and with the fatigue data of the drive."""
    run = run_of("run", given)
    mine, other = ([one.name for one in owner.pulleys] for owner in (drive, run.drive))
    if mine != other:
        raise ModelError(
            f"the run has the pulleys {', '.join(other)}, the drive {', '.join(mine)}. Give a run of this drive."
        )
    belt = drive.belt
    data = {key: getattr(belt, key) for key in ("cord_fatigue", "rib_fatigue", "temperature")}
    if data != {key: getattr(run.drive.belt, key) for key in data}:
        changed = run.drive.replace(belt=run.drive.belt.replace(**data))
        return Run(run.dataset, changed, None)
    return run


def _reference(given: Drive | Result | Path | str, compute: Any) -> dict[str, float]:
    """Damage in an hour of the reference, of cords and ribs."""
    if isinstance(given, Path | str):
        given = open_result(given) if is_result(Path(given)) else load(Path(given))
    result = compute(given) if isinstance(given, Drive) else given
    if result.kind != "life":
        raise ModelError(f"reference holds results of {result.kind}. Give a drive file, or results of `beltdyn life`.")
    names = {what: f"mean_{what}_damage_rate" for what in ("cord", "rib")}
    return {what: float(result.dataset[name]) for what, name in names.items() if name in result.dataset}

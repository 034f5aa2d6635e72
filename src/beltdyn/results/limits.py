"""Key numbers of a drive, each at its worst place, against the limits of the drive file."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.analyses import EQUILIBRIUM, RUN
from beltdyn.arrays import FloatArray
from beltdyn.model import Limits
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.schema import (
    SLIP_SAFETIES,
    SUBSTITUTES,
    in_words,
    least_safeties,
    names,
    runs_steadily,
    variable_of,
)
from beltdyn.results.tooth_loads import loads_over_time

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True)
class KeyNumber:
    """A key number of a drive at its worst place."""

    key: str
    """Key of its limit in the group ``[limits]`` of the drive file."""
    value: float
    """The value; NaN if undefined, such as the slip safety of an unloaded drive."""
    unit: str
    """Its SI unit, "1" for a pure number; "%" for a share shown in per cent."""
    where: str
    """Pulley or span, and when or at which operating point."""
    limit: float | None
    """The limit of the drive file, or None."""

    @property
    def name(self) -> str:
        """The key in words."""
        return self.key.replace("_", " ")

    @property
    def at_most(self) -> bool:
        """Whether the limit is an upper limit."""
        return self.key.startswith("largest")

    @property
    def is_outside_rating(self) -> bool:
        """Whether it is a utilization outside the rating."""
        return self.key in _UNBOUNDED and np.isinf(self.value)

    @property
    def passes(self) -> bool | None:
        """Whether the value is within its limit; None without a limit or a value."""
        if self.limit is None or np.isnan(self.value):
            return None
        return self.value <= self.limit if self.at_most else self.value >= self.limit


def key_numbers(result: Result) -> tuple[KeyNumber, ...]:
    """Compare the key numbers of a drive with its limits.

    In a run, hub loads and tensions are the worst of all outputs; slip and slip safety are the worst mean over the
    averaging window. In a table of operating points all are the worst of all points.

    Examples
    --------
    >>> [number.name for number in bd.results.key_numbers(run)][:2]
    ['largest slip', 'largest hub load']
    """
    limits, found = result.drive.limits, _FINDERS.get(result.kind)
    return tuple(KeyNumber(*one, _limit(limits, *one)) for one in found(result)) if found else ()


LEAST_BELT_SAFETY, LEAST_MOTION_SAFETY = "least_belt_safety", "least_motion_safety"
"""Keys of the limits of the safety factors of a conveyor belt."""
_JUDGED_BY = {
    "largest_utilization": "`beltdyn sheet`, of a belt whose profile has a rating",
    "least_cord_life": "`beltdyn life`, of a belt with cord_fatigue",
    "least_rib_life": "`beltdyn life`, of a belt with rib_fatigue",
    "largest_tooth_load": "`beltdyn sheet`, of a toothed belt",
    "least_jump_margin": "`beltdyn sheet`, of a toothed belt",
    LEAST_BELT_SAFETY: "`beltdyn sheet`, of a belt with a strength",
    LEAST_MOTION_SAFETY: "`beltdyn sheet`, of a conveyor whose belt has a strength",
    "least_tension": "`beltdyn sheet`",
    "largest_tension": "`beltdyn sheet`",
    "largest_hub_load": "`beltdyn sheet`",
    "largest_slip": "`beltdyn sheet`, of a loaded drive",
    "least_slip_safety": "`beltdyn sheet`, of a loaded drive",
    "largest_carriage_error": "`beltdyn simulate`, of an axis with [carriage]",
}
"""Key of a limit -> the command that always judges it, and of what."""


def judging_commands(limits: Limits) -> dict[str, str]:
    """Limits of a drive file: key -> the command that always judges it."""
    return {key: command for key, command in _JUDGED_BY.items() if getattr(limits, key) is not None}


_UNBOUNDED = ("largest_utilization",)
"""Keys of numbers that are infinite where a limit is exceeded: outside the rating."""
Found = tuple[str, float, str, str]
"""Key, value, unit, and where."""
_SHOWN = {"h": 1.0 / 3600.0, "µm": 1e6}
"""Unit of a key number that is not SI -> its factor."""


def _limit(limits: Limits, key: str, _value: float, unit: str, _where: str) -> float | None:
    """A limit of the drive file in the unit of its key number."""
    limit: float | None = getattr(limits, key)
    return None if limit is None else limit * _SHOWN.get(unit, 1.0)


def _of_run(run: Result) -> Iterator[Found]:
    assert isinstance(run, Run)
    run.require_output()
    carriage = run.drive.carriage
    with run.recorded() as recorded:
        means = run.pulley_means
        hub_load = np.linalg.norm(np.asarray(recorded["hub_force"]), axis=2)
        largest, least = (np.asarray(recorded[name]) for name in ("largest_span_tension", "least_span_tension"))
        pulleys, spans = names(recorded, "pulley"), names(recorded, "span")
        lasts = runs_steadily(recorded) or len(recorded["time"]) == 1
        loads = list(loads_over_time(recorded, run.prepared))
        time = [""] * len(hub_load) if lasts else [f"at {one:.4g} s" for one in np.asarray(recorded["time"])]
        errors = _SHOWN["µm"] * np.abs(np.asarray(recorded["carriage_error"])) if carriage else None
    over, slips = "" if lasts else "mean at the end", run.drive.belt.teeth is None
    if carriage is not None and errors is not None:
        yield _worst("largest_carriage_error", errors, "µm", time, [carriage.name])
    if slips:
        slip = np.array([[one.slip for one in means]])
        yield _worst("largest_slip", _of_turning(run, slip), "%", [over], pulleys)
    yield _worst("largest_hub_load", hub_load, "N", time, pulleys)
    yield _worst("largest_tension", largest, "N", time, spans)
    yield _worst("least_tension", least, "N", time, spans)
    force = run.drive.belt.breaking_force
    if force is not None:
        key = LEAST_BELT_SAFETY if lasts else LEAST_MOTION_SAFETY
        yield _worst(key, _over(force, largest), "1", time, spans)
    if slips:
        yield _worst("least_slip_safety", np.array([[one.least_safety for one in means]]), "1", [over], pulleys)
    for key, field in (("largest_tooth_load", "largest"), ("least_jump_margin", "jump_margin")) if loads else ():
        when = [""] * len(loads) if lasts else [f"at {instant:.4g} s" for instant, _ in loads]
        by_name = [{one.name: getattr(one, field) for one in teeth} for _, teeth in loads]
        values = np.array([[found.get(name, np.nan) for name in pulleys] for found in by_name])
        yield _worst(key, values, "N" if field == "largest" else "1", when, pulleys)
    if run.drive.rated_belt is not None:
        yield _worst("largest_utilization", np.array([[one.utilization for one in means]]), "%", [over], pulleys)


def _of_turning(result: Result, slips: FloatArray) -> FloatArray:
    """Magnitudes of slip on pulleys that turn: a belt always slips over guides that stand still."""
    return np.where(result.drive.guides, np.nan, np.abs(slips))


_OF_SLIP = ("largest_slip", "least_slip_safety")
"""Keys of numbers that belts without teeth have."""
_OF_TABLES = {
    "largest_slip": ("pulley_slip", "pulley", "%"),
    "largest_hub_load": ("hub_load", "pulley", "N"),
    "largest_tension": ("largest_span_tension", "span", "N"),
    "least_tension": ("least_span_tension", "span", "N"),
    "least_slip_safety": ("slip_safety", "pulley", "1"),
    "largest_utilization": ("utilization", "pulley", "%"),
    "largest_tooth_load": ("tooth_load", "pulley", "N"),
    "least_jump_margin": ("jump_margin", "pulley", "1"),
}
"""Key -> variable of operating points, the dimension of its names, and the unit."""


def _of_table(
    result: Result, variables: Mapping[str, tuple[str, str, str]] = MappingProxyType(_OF_TABLES)
) -> Iterator[Found]:
    dataset = result.dataset
    places = _places(dataset)
    for key, (name, of, unit) in variables.items():
        if key in _OF_SLIP and result.drive.belt.teeth is not None:
            continue
        if {name, SUBSTITUTES.get(name)} & set(dataset):
            variable = least_safeties(dataset) if name in SLIP_SAFETIES else variable_of(dataset, name)
            values = variable.transpose(..., of).values.reshape(len(places), -1)
            values = _of_turning(result, values) if key == "largest_slip" else values
            yield _worst(key, values, unit, places, list(map(str, dataset[of].values)))
            force = result.drive.belt.breaking_force
            if key == "largest_tension" and force is not None and result.kind != EQUILIBRIUM:
                yield _worst(LEAST_BELT_SAFETY, _over(force, values), "1", places, list(map(str, dataset[of].values)))
    yield from _lives(dataset)


def _over(force: float, tensions: FloatArray) -> FloatArray:
    """Safety factors of a belt of a breaking force at tensions, N; not a number where it is slack."""
    return force / np.where(tensions > 0.0, tensions, np.nan)


def _lives(dataset: "xr.Dataset") -> Iterator[Found]:
    for what in ("cord", "rib"):
        if f"{what}_life" in dataset:
            share, most = dataset.get(f"{what}_share"), ""
            if share is not None and share.notnull().any():
                most = str(share["pulley"].values[int(share.values.argmax())])
            yield f"least_{what}_life", float(dataset[f"{what}_life"]), "h", f"{most}, largest share" if most else ""


_OF_SHEETS = _OF_TABLES | {
    "largest_hub_load": ("peak_hub_load", "pulley", "N"),
    "largest_tension": ("peak_tension", "span", "N"),
    "least_slip_safety": ("least_slip_safety", "pulley", "1"),
}
"""Of sheets, whose operating points have peaks."""


def _of_sheet(result: Result) -> Iterator[Found]:
    yield from _of_table(result, _OF_SHEETS if "peak_tension" in result.dataset else _OF_TABLES)
    if "motion_belt_safety" in result.dataset:
        factors = result.dataset["motion_belt_safety"]
        yield _worst(LEAST_MOTION_SAFETY, factors.values, "1", _places(result.dataset), list(factors["motion"].values))


def _places(dataset: "xr.Dataset") -> list[str]:
    """The operating points in words, in the order of the table; one empty text at rest."""
    axes = [dataset[name] for name in str(dataset.attrs.get("axes", "")).split()]
    shape = [axis.size for axis in axes]
    return [
        ", ".join(f"{axis.name} {in_words(axis[number])}" for axis, number in zip(axes, index, strict=True))
        for index in np.ndindex(*shape)
    ]


def _worst(key: str, values: FloatArray, unit: str, places: Sequence[str], of: Sequence[str]) -> Found:
    """The worst of values of shape (places, names), and where it is."""
    if np.isnan(values).all() or not (np.isfinite(values).any() or key in _UNBOUNDED):
        return key, np.nan, unit, ""
    flat = int(np.nanargmax(values) if key.startswith("largest") else np.nanargmin(values))
    place, name = np.unravel_index(flat, values.shape)
    return key, float(values.flat[flat]), unit, ", ".join(filter(None, (of[int(name)], places[int(place)])))


_FINDERS: dict[str, Callable[[Result], Iterator[Found]]] = {
    RUN: _of_run,
    **dict.fromkeys((EQUILIBRIUM, "operating_map", "duty", "life", "rating"), _of_table),
    "sheet": _of_sheet,
}
"""Kind of result -> what finds its key numbers."""

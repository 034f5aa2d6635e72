"""Study files of optimization and calibration: free numbers, operating points, goals and requirements."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from beltdyn.analyses import ANALYSES, SIMULATE
from beltdyn.parts.messages import apart, suggest
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    AngularSpeed,
    Coordinate,
    Count,
    Length,
    Name,
    Power,
    Ratio,
    Temperature,
    Time,
    Title,
    Words,
)

PASS = 3600.0
"""Duration of a pass of a duty given by shares of time, s."""


class DutyPoint(Part):
    """An operating point of the duty of a drive.

    What it leaves open is that of the drive file.

    Examples
    --------
    >>> bd.model.DutyPoint(share="25 %", speed="800 rpm", power={"alternator": "1.2 kW"}).power
    {'alternator': 1200.0}
    """

    name: Title | None = Field(None, description="the name of the operating point, such as idle")
    share: Ratio | None = Field(None, ge=0, le=1, description="the share of time, such as 25 %")
    duration: Time | None = Field(None, ge=0, description="the duration, instead of the share, in s")
    speed: AngularSpeed | None = Field(
        None, gt=0, description="the speed of the driver, in its sense of rotation, in rad/s"
    )
    power: dict[Name, Annotated[Power, Field(ge=0)]] = Field(
        default_factory=dict,
        description='the power that pulleys take, { alternator = "1.2 kW" }, in W; in place of their torque and loads',
    )
    load: Ratio | None = Field(
        None,
        ge=0,
        description="the factor on goods, and on all torques and loads of the drive file but for motors",
    )
    temperature: Temperature | None = Field(None, description="the temperature of the belt, in °C")

    @model_validator(mode="after")
    def _has_a_weight(self) -> Self:
        if (self.share is None) == (self.duration is None):
            raise ValueError("needs either share or duration. Give one of them")
        return self

    @property
    def weight(self) -> float:
        """Duration in a pass of the duty, s."""
        if self.duration is not None:
            return self.duration
        assert self.share is not None
        return self.share * PASS


def check_duty(duty: Sequence[DutyPoint], pulleys: Sequence[str]) -> None:
    """Check that operating points have the same measure of time, and name pulleys of the drive."""
    for number, point in enumerate(duty, 1):
        unknown = [name for name in point.power if name not in pulleys]
        if unknown:
            raise ValueError(
                f'duty[{number}].power names "{unknown[0]}", which is not a pulley. Choose from {", ".join(pulleys)}'
            )
    if len({point.share is None for point in duty}) > 1:
        raise ValueError("duty has points with share and points with duration. Give all of them the same")
    if duty and not sum(point.weight for point in duty) > 0.0:
        raise ValueError("duty has no time: all shares or durations are zero. Give some of them")


def columns_of(duty: Sequence[DutyPoint]) -> Mapping[tuple[str, str], list[float | None]]:
    """What the points of a duty give: quantity and pulley (empty of others) -> values, None where one is open."""
    powers = dict.fromkeys(name for point in duty for name in point.power)
    given: dict[tuple[str, str], list[float | None]] = {("duration", ""): [point.weight for point in duty]}
    open_: dict[tuple[str, str], list[float | None]] = {
        (key, ""): [getattr(point, key) for point in duty] for key in ("load", "temperature", "speed")
    }
    open_ |= {("power", name): [point.power.get(name) for point in duty] for name in powers}
    return given | {key: values for key, values in open_.items() if any(one is not None for one in values)}


# The study file of a parameter study: values of a drive at many points, an analysis, and the results to keep

Value = bool | int | float | str
"""A number in SI units, text with a unit, or any other value of a drive file."""

Sampling = Literal["factorial", "together", "one_at_a_time", "latin_hypercube", "sobol", "saltelli"]
SAMPLED = ("latin_hypercube", "sobol", "saltelli")
"""Samplings between bounds."""


class VariedNumber(Part):
    """A varied value of the drive file."""

    path: Words = Field(description='the path of the value, such as "belt.length" or "pulley[driven].center[1]"')
    values: Words | Annotated[tuple[Value, ...], Field(min_length=1)] = Field(
        description='the values: a range such as "10..20 mm", numbers with a unit such as "10, 15, 20 mm", or a list '
        "as in a drive file"
    )
    steps: Count = Field(5, ge=2, le=100_000, description="the number of values of a range")


class ParameterStudy(Part):
    """A parameter study: variants of a drive, their analysis, and the results to keep.

    The constructor's arguments are the keys and groups of a study file.

    Examples
    --------
    >>> width = {"path": "belt.width", "values": "10, 12, 14 mm"}
    >>> study = bd.ParameterStudy(analysis="equilibrium", results=["hub_load"], number=[width])
    >>> study.sampling
    'factorial'
    """

    fills_a_file: ClassVar[bool] = True

    drive: Words | None = Field(None, description="the drive file, relative to the study file")
    analysis: Words = Field(SIMULATE, description='the analysis by its name, such as "steady_state" or "simulate"')
    options: dict[str, Any] = Field(
        default_factory=dict, description="the group [options], options of the analysis by their Python names"
    )
    results: tuple[Words, ...] = Field(
        ("all",),
        min_length=1,
        description='the results to keep, such as "hub_load", "pulley_slip[driven]" or "largest(span_tension)"; by '
        "default all single numbers",
    )
    sampling: Sampling = Field(
        "factorial",
        description='the sampling: "factorial", "together", "one_at_a_time", "latin_hypercube", "sobol" or "saltelli"',
    )
    points: Count = Field(
        64, ge=2, le=10_000_000, description="the number of points of a sampling between bounds; the base of saltelli"
    )
    seed: Count = Field(0, ge=0, description="the random seed of samplings")
    table: Words | None = Field(
        None, description="the CSV file of points, a column per number and a row per point, instead of [[number]]"
    )
    numbers: tuple[VariedNumber, ...] = Field(
        (), alias="number", description="the groups [[number]], the varied numbers of the drive"
    )
    keep_files: bool = Field(False, description="whether to keep the result file of every point, in a folder")

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if self.analysis not in ANALYSES:
            raise ValueError(f'analysis = "{self.analysis}" does not exist. {suggest(self.analysis, list(ANALYSES))}')
        if (self.table is None) == (not self.numbers):
            raise ValueError("needs points from a table or from groups [[number]]. Give one of the two")
        paths = [one.path for one in self.numbers]
        twice = [path for path in paths if paths.count(path) > 1]
        if twice:
            raise ValueError(f'number "{twice[0]}" is given twice. Remove one')
        if self.sampling == "together" and len({len(one.values) for one in self.numbers if not _is_text(one)}) > 1:
            raise ValueError(
                'sampling = "together" needs the same number of values for each [[number]]. Add or remove values'
            )
        return self


def _is_text(number: VariedNumber) -> bool:
    return isinstance(number.values, str)


Bound = float | str
"""A number in SI units, or text with a unit of the drive's number or of the result."""


class FreeNumber(Part):
    """A free number of the drive file."""

    path: Words = Field(description='the path of the number, such as "belt.length" or "pulley[driven].center[1]"')
    least: Bound = Field(description="the least value, in SI units or as text with a unit")
    largest: Bound = Field(description="the largest value, in SI units or as text with a unit")


class Points(Part):
    """The operating points: those of a duty cycle or of a map."""

    table: Words | None = Field(None, description="the duty cycle, a CSV file, relative to the study file")
    speed: Words | None = Field(
        None, description='the speeds of a pulley, such as "700..6000 rpm" or "800, 1500 rpm"; by default its own'
    )
    load: Words | None = Field(None, description='the factors on torques and loads, such as "0.2..1.2"; by default 1')
    count: Count = Field(5, ge=2, le=1000, description="the number of speeds of a range")
    load_count: Count = Field(3, ge=2, le=1000, description="the number of factors of a range")
    pulley: Name | None = Field(None, description="the pulley of prescribed speed; by default the driver")
    at: Time | None = Field(
        None, description="the instant of all other prescribed values, in s; by default the end of the simulation"
    )

    @model_validator(mode="after")
    def _stand_in_one_place(self) -> Self:
        if self.table is not None and (self.speed, self.load, self.pulley) != (None, None, None):
            raise ValueError("table excludes speed and load: it has its own. Give either table, or speed and load")
        if self.pulley is not None and self.speed is None:
            raise ValueError("pulley is given without speed. Give the speed of the pulley")
        return self


class Goal(Part):
    """The objective of an optimization."""

    result: Words = Field(
        description='the result of steady running, such as "hub_load" of all pulleys, or "hub_load[driven]"'
    )
    sense: Literal["minimize", "maximize"] = Field("minimize", description="whether to minimize or maximize it")
    over: Literal["worst", "mean"] = Field(
        "worst",
        description="whether to use the worst of all pulleys and operating points, or the mean weighted by durations",
    )


class Requirement(Part):
    """A limit of a result at every operating point."""

    result: Words = Field(description='the result of steady running, such as "slip_safety" or "span_tension[a-b]"')
    at_least: Bound | None = Field(None, description="the least value, in SI units or as text with a unit")
    at_most: Bound | None = Field(None, description="the largest value, in SI units or as text with a unit")

    @model_validator(mode="after")
    def _has_a_limit(self) -> Self:
        if self.at_least is None and self.at_most is None:
            raise ValueError("has no limit. Give at_least, at_most, or both")
        return self


class Order(Part):
    """An excitation order of a pulley from which modes keep a distance, between two speeds."""

    order: Ratio = Field(gt=0, description="the number of excitations per turn of the pulley")
    pulley: Name | None = Field(None, description="the pulley; by default the driver")
    least_speed: AngularSpeed = Field(gt=0, description="the least speed of the pulley, in rad/s")
    largest_speed: AngularSpeed = Field(gt=0, description="the largest speed of the pulley, in rad/s")
    distance: Ratio = Field(0.15, gt=0, lt=1, description="the least distance of modes over the frequency of the order")
    kinds: tuple[Literal["span", "rotational", "tensioner", "coupled"], ...] = Field(
        ("span", "rotational", "tensioner", "coupled"), min_length=1, description="the kinds of modes considered"
    )

    @model_validator(mode="after")
    def _rises(self) -> Self:
        least, largest = self.least_speed, self.largest_speed
        if not least <= largest:
            low, high = apart(least, largest)
            raise ValueError(f"least_speed = {low} rad/s is above largest_speed = {high} rad/s. Swap them")
        return self


class Obstacle(Part):
    """A round obstacle near the belt, such as a bolt or a rib of the housing."""

    name: Name = Field(description="the name of the part")
    center: tuple[Coordinate, Coordinate] = Field(description="the center as [x, y], in m")
    radius: Length = Field(0.0, ge=0, description="the radius, in m")
    clearance: Length = Field(gt=0, description="the least distance from the surface of the belt, in m")


class OptimizationStudy(Part):
    """An optimization of a drive: parameters, goal and requirements.

    The constructor's arguments are the groups of a study file, each a part or a mapping of its arguments.

    Examples
    --------
    >>> tension = {"path": "belt.installed_tension", "least": "200 N", "largest": "900 N"}
    >>> safe = {"result": "slip_safety", "at_least": 1.5}
    >>> study = bd.OptimizationStudy(number=[tension], goal={"result": "hub_load"}, requirement=[safe])
    >>> study.goal
    Goal(result='hub_load')
    """

    fills_a_file: ClassVar[bool] = True

    numbers: Annotated[tuple[FreeNumber, ...], Field(min_length=1)] = Field(
        alias="number", description="the groups [[number]], the free numbers of the drive"
    )
    goal: Goal = Field(description="the group [goal], the objective")
    points: Points = Field(default_factory=Points, description="the group [points], the operating points")
    requirements: tuple[Requirement, ...] = Field(
        (), alias="requirement", description="the groups [[requirement]], limits of results"
    )
    orders: tuple[Order, ...] = Field((), alias="order", description="the groups [[order]], orders for modes to avoid")
    obstacles: tuple[Obstacle, ...] = Field(
        (), alias="obstacle", description="the groups [[obstacle]], round parts that the belt must clear"
    )

    @model_validator(mode="after")
    def _says_each_once(self) -> Self:
        for key, given in (
            ("number", [one.path for one in self.numbers]),
            ("obstacle", [one.name for one in self.obstacles]),
        ):
            twice = [name for name in given if given.count(name) > 1]
            if twice:
                raise ValueError(f'{key} "{twice[0]}" is given twice. Remove one')
        return self


class Measurement(Part):
    """Measured results in a table of operating points or other drives."""

    table: Words = Field(description="the table, a CSV file with a line of headings, relative to the study file")
    state: Literal["steady", "rest"] = Field(
        "steady", description="whether the results were measured in steady running or at rest"
    )
    at: Time | None = Field(
        None, description="the instant of all other prescribed values, in s; by default the end of the simulation"
    )


class CalibrationStudy(Part):
    """A calibration: parameters of a drive to fit, and measurements.

    The constructor's arguments are the groups of a study file, each a part or a mapping of its arguments.

    Examples
    --------
    >>> friction = {"path": "contact.friction", "least": 0.2, "largest": 0.8}
    >>> study = bd.CalibrationStudy(number=[friction], measurement=[{"table": "slip.csv"}])
    >>> study.confidence
    0.95
    """

    fills_a_file: ClassVar[bool] = True

    numbers: Annotated[tuple[FreeNumber, ...], Field(min_length=1)] = Field(
        alias="number", description="the groups [[number]], the fitted numbers of the drive"
    )
    measurements: Annotated[tuple[Measurement, ...], Field(min_length=1)] = Field(
        alias="measurement", description="the groups [[measurement]], tables of measured results"
    )
    confidence: Ratio = Field(0.95, gt=0, lt=1, description="the confidence level of the intervals")

    @model_validator(mode="after")
    def _fits_each_once(self) -> Self:
        paths = [one.path for one in self.numbers]
        twice = [path for path in paths if paths.count(path) > 1]
        if twice:
            raise ValueError(f'number "{twice[0]}" is given twice. Remove one')
        return self

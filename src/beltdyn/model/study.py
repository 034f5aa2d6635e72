"""What a study file says: numbers of a drive that may change, operating points, goals and requirements."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from beltdyn.parts.messages import apart
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import AngularSpeed, Coordinate, Count, Length, Name, Ratio, Time, Words

Bound = float | str
"""A number in SI units, or text with a unit; which one, the drive's number or the result decides."""


class FreeNumber(Part):
    """A number of the drive file that may change."""

    path: Words = Field(description='the path of the number, such as "belt.length" or "pulley[driven].center[1]"')
    least: Bound = Field(description="the least value, in SI units or as text with a unit")
    largest: Bound = Field(description="the largest value, in SI units or as text with a unit")


class Points(Part):
    """The operating points at which results are taken: those of a duty table, or of a map."""

    table: Words | None = Field(None, description="the duty table, a CSV file, by its path from the study file")
    speed: Words | None = Field(
        None, description='the speeds of a pulley, such as "700..6000 rpm" or "800, 1500 rpm"; as the drive has it'
    )
    load: Words | None = Field(None, description='the factors on torques and loads, such as "0.2..1.2"; 1 by default')
    count: Count = Field(5, ge=2, le=1000, description="the number of speeds of a range")
    load_count: Count = Field(3, ge=2, le=1000, description="the number of factors of a range")
    pulley: Name | None = Field(None, description="the pulley whose speed is prescribed; the one that drives")
    at: Time | None = Field(
        None, description="the instant at which the rest of the drive is taken, in s; the end of the simulation"
    )

    @model_validator(mode="after")
    def _stand_in_one_place(self) -> Self:
        if self.table is not None and (self.speed, self.load, self.pulley) != (None, None, None):
            raise ValueError("table has its own speeds and loads. Give either table, or speed and load")
        if self.pulley is not None and self.speed is None:
            raise ValueError("pulley names whose speed to prescribe, and there is no speed. Give speed")
        return self


class Goal(Part):
    """What is to become as small, or as large, as can be."""

    result: Words = Field(
        description='the result of steady running, such as "hub_load", of all pulleys, or "hub_load[driven]"'
    )
    sense: Literal["minimize", "maximize"] = Field("minimize", description="whether less or more of it is better")
    over: Literal["worst", "mean"] = Field(
        "worst",
        description="whether the worst of all pulleys and operating points counts, or the mean, weighted by durations",
    )


class Requirement(Part):
    """What a result must keep to at every operating point."""

    result: Words = Field(description='the result of steady running, such as "slip_safety" or "span_tension[a-b]"')
    at_least: Bound | None = Field(None, description="the least value, in SI units or as text with a unit")
    at_most: Bound | None = Field(None, description="the largest value, in SI units or as text with a unit")

    @model_validator(mode="after")
    def _has_a_limit(self) -> Self:
        if self.at_least is None and self.at_most is None:
            raise ValueError("has no limit. Give at_least, at_most, or both")
        return self


class Order(Part):
    """An order of a pulley's rotation near which no mode may be, between two speeds."""

    order: Ratio = Field(gt=0, description="the number of excitations in a turn of the pulley")
    pulley: Name | None = Field(None, description="the pulley; the one that drives")
    least_speed: AngularSpeed = Field(gt=0, description="the least speed of the pulley at which it counts, in rad/s")
    largest_speed: AngularSpeed = Field(gt=0, description="the largest speed at which it counts, in rad/s")
    distance: Ratio = Field(0.15, gt=0, lt=1, description="how far away modes must be, over the frequency of the order")
    kinds: tuple[Literal["span", "rotational", "tensioner", "coupled"], ...] = Field(
        ("span", "rotational", "tensioner", "coupled"), min_length=1, description="the kinds of modes that count"
    )

    @model_validator(mode="after")
    def _rises(self) -> Self:
        least, largest = self.least_speed, self.largest_speed
        if not least <= largest:
            low, high = apart(least, largest)
            raise ValueError(f"least_speed = {low} rad/s is above largest_speed = {high} rad/s. Exchange them")
        return self


class Obstacle(Part):
    """A round part near the belt, such as a bolt or a rib of the housing."""

    name: Name = Field(description="the name of the part")
    center: tuple[Coordinate, Coordinate] = Field(description="the center as [x, y], in m")
    radius: Length = Field(0.0, ge=0, description="the radius, in m")
    clearance: Length = Field(gt=0, description="the least distance from the surface of the belt, in m")


class OptimizationStudy(Part):
    """What to improve in a drive: numbers that may change, a goal, and what must be kept.

    The constructor's arguments are the groups of a study file, each a part or a mapping of its arguments.

    Examples
    --------
    >>> tension = {"path": "belt.installed_tension", "least": "200 N", "largest": "900 N"}
    >>> safe = {"result": "slip_safety", "at_least": 1.5}
    >>> study = bd.OptimizationStudy(number=[tension], goal={"result": "hub_load"}, requirement=[safe])
    >>> study.goal
    Goal(result='hub_load', sense='minimize', over='worst')
    """

    fills_a_file: ClassVar[bool] = True

    numbers: Annotated[tuple[FreeNumber, ...], Field(min_length=1)] = Field(
        alias="number", description="the groups [[number]], numbers of the drive that may change"
    )
    goal: Goal = Field(description="the group [goal], what is to become small or large")
    points: Points = Field(default_factory=Points, description="the group [points], the operating points")
    requirements: tuple[Requirement, ...] = Field(
        (), alias="requirement", description="the groups [[requirement]], limits of results"
    )
    orders: tuple[Order, ...] = Field((), alias="order", description="the groups [[order]], near which no mode may be")
    obstacles: tuple[Obstacle, ...] = Field(
        (), alias="obstacle", description="the groups [[obstacle]], round parts that the belt keeps away from"
    )

    @model_validator(mode="after")
    def _says_each_once(self) -> Self:
        for key, given in (
            ("number", [one.path for one in self.numbers]),
            ("obstacle", [one.name for one in self.obstacles]),
        ):
            twice = [name for name in given if given.count(name) > 1]
            if twice:
                raise ValueError(f'{key} "{twice[0]}" stands twice. Remove one')
        return self


class Measurement(Part):
    """Measured results, in a table whose rows are operating points or other drives."""

    table: Words = Field(description="the table, a CSV file with a line of headings, by its path from the study file")
    state: Literal["steady", "rest"] = Field(
        "steady", description="whether results were measured in steady running or with the belt at rest"
    )
    at: Time | None = Field(
        None, description="the instant at which the rest of the drive is taken, in s; the end of the simulation"
    )


class CalibrationStudy(Part):
    """Which numbers of a drive to fit, and what was measured.

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
        alias="number", description="the groups [[number]], numbers of the drive that are fitted"
    )
    measurements: Annotated[tuple[Measurement, ...], Field(min_length=1)] = Field(
        alias="measurement", description="the groups [[measurement]], tables of measured results"
    )
    confidence: Ratio = Field(0.95, gt=0, lt=1, description="the confidence of the intervals")

    @model_validator(mode="after")
    def _fits_each_once(self) -> Self:
        paths = [one.path for one in self.numbers]
        twice = [path for path in paths if paths.count(path) > 1]
        if twice:
            raise ValueError(f'number "{twice[0]}" stands twice. Remove one')
        return self

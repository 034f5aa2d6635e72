"""The study file of a parameter study: values of a drive at many points, an analysis, and the results to keep."""

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from beltdyn.analyses import ANALYSES, RUN
from beltdyn.parts.messages import suggest
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Count, Words

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
    >>> study = bd.ParameterStudy(analysis="static", results=["hub_load"], number=[width])
    >>> study.sampling
    'factorial'
    """

    fills_a_file: ClassVar[bool] = True

    drive: Words | None = Field(None, description="the drive file, relative to the study file")
    analysis: Words = Field(RUN, description='the analysis by its command, such as "steady" or "run"')
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

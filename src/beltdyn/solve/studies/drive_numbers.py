"""The numbers of a drive file that can be changed a little."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.change import value_at
from beltdyn.parts.error_location import entry_name
from beltdyn.parts.messages import suggest
from beltdyn.parts.part import Part
from beltdyn.results.schema import AXIS_NAMES
from beltdyn.solve.studies.named_results import listed

PART = 0.01
"""Of a number, for which effects are told."""
_MOVE = 1e-3
"""Of a coordinate, whose zero is a matter of convention, for which effects are told, m."""
_COORDINATES = ("center", "pivot", "point")
_KEPT = ("simulation", "steady", "limits", "contact.stiffness", "contact.damping")
"""Where numbers stand that have no effect on a state that stays, or are those of the method."""
_SWITCHES = ("schedule",)
"""Keys of what lies between 0 and 1."""


class Number(NamedTuple):
    """A number of a drive file."""

    path: str
    """As `Drive.with_` takes it."""
    value: float
    step: float
    """Change for which effects are told."""


def numbers_of(part: Part, path: str = "") -> Iterator[Number]:
    """The numbers of a drive that can be changed a little, with their paths; zeros only where they are coordinates.

    Parameters
    ----------
    part
        A drive, or a part of one.
    path
        Of the part.
    """
    for key, value in part.arguments.items():
        yield from _numbers_in(value, f"{path}.{key}" if path else key)


def _numbers_in(value: object, path: str) -> Iterator[Number]:
    """The numbers in a value of a drive."""
    key = path.rpartition(".")[2]
    if path in _KEPT or key in _SWITCHES or isinstance(value, bool | int | str):
        return
    if isinstance(value, Part):
        yield from numbers_of(value, path)
    elif isinstance(value, float):
        if key.partition("[")[0] in _COORDINATES:
            yield Number(path, value, _MOVE)
        elif value != 0.0:
            yield Number(path, value, PART * value)
    elif isinstance(value, Sequence) and (len(value) == len(AXIS_NAMES) or any(isinstance(one, Part) for one in value)):
        for number, one in enumerate(value, 1):
            yield from _numbers_in(one, f"{path}[{entry_name(one) or number}]")


def chosen_numbers(drive: Drive, numbers: str | None, tolerances: Mapping[str, float]) -> list[Number]:
    """The numbers that are asked for; those with tolerances are numbers of the drive whatever they stand for.

    Beside numbers that are given there are those that follow from them and may be given in their place, such as the
    axial stiffness of a belt.

    Parameters
    ----------
    drive
        The drive.
    numbers
        Paths with commas between; by default all numbers of `numbers_of`.
    tolerances
        Path -> tolerance.

    Raises
    ------
    ModelError
        If one of them is no number of the drive.
    """
    known = {one.path: one for one in numbers_of(drive)}
    for path, size in tolerances.items():
        value = float(value_at(drive, path))
        known.setdefault(path, Number(path, value, PART * value or size))
    if numbers is None:
        return list(known.values())
    return [known.get(path) or _number_in_place(drive, path, list(known)) for path in listed(numbers)]


def _number_in_place(drive: Drive, path: str, known: Sequence[str]) -> Number:
    """A number that may be given in place of others.

    Raises
    ------
    ModelError
        If there is none at the path.
    """
    try:
        value = value_at(drive, path)
    except ModelError:
        value = None
    if path == "belt.axial_stiffness" and drive.belt.stretch_curve is not None:
        raise ModelError(
            f"{path} = {value:.4g} N is the initial slope of belt.stretch_curve, not an independent parameter. "
            "Remove the curve, or omit the stiffness."
        )
    if not isinstance(value, float) or value == 0.0 or path.startswith(_KEPT):
        raise ModelError(f"{path} is not a continuous parameter of this drive. {suggest(path, list(known))}")
    return Number(path, value, PART * value)

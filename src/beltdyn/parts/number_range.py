"""Numbers with a unit as text: a single one, a range "700..6000 rpm", or a list "700, 1500, 3000 rpm"."""

import re
from math import isfinite

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.quantity import to_si

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*\.\.\s*({_NUMBER})\s*(.*?)\s*")
_LIST = re.compile(rf"\s*({_NUMBER}(?:\s*,\s*{_NUMBER})*)\s*(.*?)\s*")
_MOST = 10_000


def number_in(name: str, value: float | str, unit: str) -> float:
    """Read a number with or without its unit.

    Parameters
    ----------
    name : str
        What it is, for messages.
    value : float or str
        In SI units, or a text such as ``"800 rpm"``.
    unit : str
        The SI unit.

    Returns
    -------
    float
        In SI units.

    Raises
    ------
    ModelError
        If the text is no such quantity, or the number is not finite.
    """
    try:
        number = to_si(value, unit) if isinstance(value, str) else float(value)
        if not isfinite(number):
            raise ValueError("must be a finite number")
    except ValueError as error:
        raise ModelError(f"{name} = {value!r} {error}.") from error
    return number


def numbers_in(name: str, text: str, unit: str, count: int) -> FloatArray:
    """Read a range as equally spaced numbers, or a list of numbers.

    Parameters
    ----------
    name : str
        What it is, for messages.
    text : str
        Such as ``"700..6000 rpm"`` or ``"700, 1500 rpm"``; the unit belongs to all numbers.
    unit : str
        The SI unit; the empty string for pure numbers, which may be in %.
    count : int
        How many numbers to take out of a range.

    Returns
    -------
    ndarray
        Ascending, in SI units.

    Raises
    ------
    ModelError
        If the text is neither, its unit is not known, or there are no different numbers.
    """
    ranged, listed = _RANGE.fullmatch(str(text)), _LIST.fullmatch(str(text))
    example = "700..6000 rpm" if unit == "rad/s" else f"0.2..1.2 {unit}".rstrip()
    if ranged is not None:
        if not 2 <= count <= _MOST:
            raise ModelError(f"{count} points of {name} = {text!r} are not possible. Give 2 to {_MOST:,}.")
        first, last, given = ranged.groups()
        found = np.linspace(_number(name, first, given, unit), _number(name, last, given, unit), count)
    elif listed is not None:
        given = listed[2]
        found = np.array([_number(name, one.strip(), given, unit) for one in listed[1].split(",")])
    else:
        raise ModelError(f"{name} = {text!r} must be a range such as {example!r}, or numbers separated by commas.")
    ascending = np.sort(found)
    if np.any(np.diff(ascending) == 0.0):
        raise ModelError(f"{name} = {text!r} contains the same number twice. Write a range such as {example!r}.")
    return ascending


def _number(name: str, number: str, given: str, unit: str) -> float:
    """A number of a range in SI units."""
    if not unit and given in ("", "%"):
        return float(number) * (0.01 if given else 1.0)
    if not given:
        example = "800 rpm" if unit == "rad/s" else f"{float(number):g} {unit}"
        raise ModelError(f'{name} = {number!r} has no unit. Write it after the last number, such as "{example}".')
    try:
        return to_si(f"{number} {given}", unit)
    except ValueError as error:
        raise ModelError(f"{name} = {number!r} {error}.") from error

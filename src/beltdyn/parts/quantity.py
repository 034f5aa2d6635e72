"""Numbers in SI units, also as text with a unit: ``"25 mm"``."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import isfinite
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Literal, SupportsFloat, TypeAlias, get_args

import numpy as np
from pydantic import BeforeValidator, Strict, StringConstraints

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    import pint

# A number, then a unit made of names with one-digit exponents, so that no text makes the unit parser compute.
_NUMBER = re.compile(r"\s*(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>.*?)\s*", re.DOTALL)
_UNIT = re.compile(r"(?:1 ?/)?(?:[^\W\d]+(?:(?:\*\*|\^)-?\d(?!\d))?|[*/·() ])+")
_TOLERANCE = re.compile(r"\s*(?:±|\+/?-)\s*(?P<size>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?P<percent>%?)\s*")
_MARKS = re.compile(r"±|\+/?-")
_MORE_UNITS = (
    "newton_meter = newton * meter = Nm",
    "newton_millimeter = newton * millimeter = Nmm",
    "kilopond = kilogram_force = kp",
    "pferdestaerke = metric_horsepower = PS",
    "foot_per_minute = foot / minute = fpm",
)
"""Spellings of drive engineers; kNm etc. follow."""
_HYPHEN = re.compile(r"(?<=[^\W\d])-(?=[^\W\d])")
_POWER = re.compile(r"(?<=[^\W\d])([23])(?!\d)")
_POUNDS = re.compile(r"\b(lb|oz)s?\b")
"""Pounds and ounces, which are forces where a force is wanted."""
_DECIMAL_COMMA = re.compile(r"\s*(?P<whole>[+-]?\d+),(?P<rest>\d+\b.*)", re.DOTALL)
_TURNS = re.compile(r"(?:U|rev|1) ?/ ?min|min(?:\^|\*\*)?-1|min⁻¹")
"""Other spellings of rpm for angular speeds."""
_SENSE = re.compile(r"(?P<rest>.*?)\s+(?P<sense>clockwise|cw|counter-clockwise|ccw)\s*", re.DOTALL)
"""The sense of a speed or torque, for clockwise drives with positive numbers."""
_CLOCKWISE = ("clockwise", "cw")
_WITH_SENSE = frozenset({"rad/s", "N*m"})
_CELSIUS = re.compile("°\\s?C")
_DEGREE = re.compile("°(?!\\s?[CF])")
"""Degrees of temperature and of angle, whose sign no name of a unit has."""
_LONGEST_TEXT = 60
"""Characters of a number with its unit, at most; a safeguard against long texts, which patterns and units never
need."""
_LARGEST_MAGNITUDE = 1e15
"""Largest magnitude of a number, in its SI unit: no drive has a larger one, and arithmetic with it would overflow."""
_DUST = 1e-30
"""Magnitudes below it are zero, as rounding leaves them in coordinates and tables: their powers would underflow."""
_REMEMBERED = 4096
"""Numbers with units whose value is remembered: the page reads a file anew with each step of a drag."""

RPM = 30.0 / math.pi
"""Revolutions a minute in 1 rad/s."""

_USUAL = MappingProxyType(
    {
        ("mm", "m"): 1e-3,
        ("cm", "m"): 1e-2,
        ("m", "m"): 1.0,
        ("s", "s"): 1.0,
        ("ms", "s"): 1e-3,
        ("rpm", "rad/s"): math.pi / 30.0,
        ("rad/s", "rad/s"): 1.0,
        ("rpm/s", "rad/s^2"): math.pi / 30.0,
        ("deg", "rad"): math.pi / 180.0,
        ("rad", "rad"): 1.0,
        ("N m/deg", "N*m/rad"): 180.0 / math.pi,
        ("N", "N"): 1.0,
        ("kN", "N"): 1e3,
        ("N m", "N*m"): 1.0,
        ("kW", "W"): 1e3,
        ("W", "W"): 1.0,
        ("kg", "kg"): 1.0,
        ("g", "kg"): 1e-3,
        ("kg cm^2", "kg*m^2"): 1e-4,
        ("kg m^2", "kg*m^2"): 1.0,
        ("um", "m"): 1e-6,
        ("us", "s"): 1e-6,
        ("Hz", "Hz"): 1.0,
        ("m/s", "m/s"): 1.0,
        ("m/s^2", "m/s^2"): 1.0,
        ("turn/s", "rad/s"): 2.0 * math.pi,
        ("turn/s^2", "rad/s^2"): 2.0 * math.pi,
        ("turn/s^3", "rad/s^3"): 2.0 * math.pi,
        ("N/m", "N/m"): 1.0,
        ("N/mm", "N/m"): 1e3,
        ("N s/m", "N*s/m"): 1.0,
        ("N m/rad", "N*m/rad"): 1.0,
        ("kN m/rad", "N*m/rad"): 1e3,
        ("N m s/rad", "N*m*s/rad"): 1.0,
        ("N m^2", "N*m^2"): 1.0,
        ("kg/m", "kg/m"): 1.0,
        ("g/m", "kg/m"): 1e-3,
        ("MPa", "Pa"): 1e6,
        ("bar", "Pa"): 1e5,
    }
)
"""(Unit, SI unit) -> factor of the units of most drive files, which so need no unit library; it takes 0.4 s to load."""

SHOWN_UNITS = MappingProxyType({"rad/s": ("rpm", RPM), "rad": ("°", math.degrees(1.0))})
"""SI unit -> the one that readers are shown, and the factor on numbers."""


_DESCRIBED_UNIT = re.compile(
    r", in ((?:rad|m|s|N|Pa|kg|Hz|W)(?:\^\d)?(?:[ *^/\d]+(?:rad|m|s|kg)(?:\^?\d)?)*)(?=$|[;,])"
)


def described_unit(description: str) -> str:
    """The SI unit of bare numbers that the description of a key names; empty without one."""
    unit = _DESCRIBED_UNIT.search(description)
    return unit[1] if unit else ""


def printed_unit(unit: str) -> str:
    """An SI unit as it is printed."""
    powers = unit.replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
    return powers.replace("*", " ")


@lru_cache(maxsize=1)
def _registry() -> "pint.UnitRegistry[float]":
    import pint

    registry: pint.UnitRegistry[float] = pint.UnitRegistry(on_redefinition="ignore")  # Nm is a unit of yarn there
    for definition in _MORE_UNITS:
        registry.define(definition)
    return registry


def to_si(text: str, unit: str) -> float:
    """Convert a text such as ``"25 mm"``, or ``"800 rpm clockwise"``, into a number in `unit`."""
    if unit in _WITH_SENSE and len(text) <= _LONGEST_TEXT and (match := _SENSE.fullmatch(text)):
        return to_si(match["rest"], unit) * (-1.0 if match["sense"] in _CLOCKWISE else 1.0)
    nominal, tolerance = _without_tolerance(text, unit)
    match = _NUMBER.fullmatch(nominal) if len(text) <= _LONGEST_TEXT else None
    if match is not None and (comma := _DECIMAL_COMMA.fullmatch(nominal)):
        raise ValueError(f'has a decimal comma. Write "{comma["whole"]}.{comma["rest"].strip()}"')
    if match is None:
        raise ValueError(f"must be a number{f' in {unit}' if unit else ''}")
    number, given = float(match["number"]), match["unit"]
    if unit == "rad/s" and _TURNS.fullmatch(given):
        given = "rpm"
    given = _spelled(given)
    if not unit and given == "%":
        if tolerance is not None and tolerance["percent"]:
            raise ValueError(
                f"is ambiguous: the tolerance could be relative or in percentage points. Write {number / 100.0:g} and "
                "the tolerance as a plain number"
            )
        return number / 100.0
    if not unit and tolerance is not None and not given:
        return number
    if not unit:
        raise ValueError('must be a number without a unit. Omit the quotation marks, or write a fraction as "1 %"')
    if not given:
        raise ValueError(f'has no unit. Write {number:g} (in {unit}), or with a unit, such as "{number:g} {unit}"')
    if not _UNIT.fullmatch(given):
        raise ValueError(f'has an unreadable unit. Write for example "{number:g} {unit}"')
    return _convert(number, given, unit)


def _spelled(unit: str) -> str:
    """A unit as the unit library reads it: "lb-ft", "cm2", "°"."""
    unit = _DEGREE.sub("deg", _CELSIUS.sub("degC", unit))
    return _POWER.sub(r"^\1", _HYPHEN.sub(" ", unit))


def with_other_sense(text: str) -> str:
    """A number and its unit with the opposite sense behind it; any other text as it is."""
    match = _SENSE.fullmatch(text) if len(text) <= _LONGEST_TEXT else None
    if match is None or not _NUMBER.fullmatch(match["rest"]):
        return text
    return f"{match['rest']} {'counter-clockwise' if match['sense'] in _CLOCKWISE else 'clockwise'}"


def is_unit(text: str) -> bool:
    """Whether a text is a known unit, such as ``"N m"``."""
    try:
        text = _spelled(text)
        known = _TURNS.fullmatch(text) or _UNIT.fullmatch(text)
        return bool(known and len(text) <= _LONGEST_TEXT and _registry().parse_units(text))
    except Exception:  # see _convert
        return False


def has_tolerance(text: str) -> bool:
    """Whether a text may be a number with a tolerance."""
    return len(text) <= _LONGEST_TEXT and _MARKS.search(text) is not None


def tolerance_in(text: str, unit: str) -> float | None:
    """The tolerance of a text such as ``"12.5 ± 0.1 mm"``, ``"12.5 +- 0.1 mm"`` or ``"12.5 mm ± 1 %"``, in `unit`."""
    _, match = _without_tolerance(text, unit)
    if match is None:
        return None
    value, size = to_si(text, unit), float(match["size"])
    if match["percent"]:
        return abs(value) * size / 100.0
    there = _NUMBER.fullmatch(_without_tolerance(text, unit)[0])
    assert there is not None
    return to_si(f"{size} {there['unit']}", unit) if there["unit"] else size


def _without_tolerance(text: str, unit: str) -> tuple[str, re.Match[str] | None]:
    """A text without its tolerance, and the tolerance if there is one."""
    if len(text) > _LONGEST_TEXT or not _MARKS.search(text):
        return text, None
    match = _TOLERANCE.search(text)
    rest = "" if match is None else f"{text[: match.start()]} {text[match.end() :]}".strip()
    if match is None or _MARKS.search(rest) or not float(match["size"]) > 0.0:
        raise ValueError(
            f'has an unreadable tolerance. Write for example "{f"12.5 ± 0.1 {unit}".strip()}", or '
            f'"{f"12.5 {unit}".strip()} ± 1 %"'
        )
    return rest, match


def written_like(value: float, given: object, unit: str, digits: int = 7) -> float | str:
    """Format a number in the unit of another one."""
    if isinstance(given, str) and len(given) <= _LONGEST_TEXT:
        try:
            nominal, tolerance = _without_tolerance(given, unit)
            match = _NUMBER.fullmatch(nominal)
            if match is not None and (match["unit"] or tolerance):
                scaled = value / to_si("1 " + match["unit"], unit) if match["unit"] else value
                return _written(f"{scaled:.{digits}g}", match["unit"], tolerance)
        except ValueError:
            pass  # an unknown unit is no use
    return float(f"{value:.{digits}g}")


def _written(number: str, unit: str, tolerance: re.Match[str] | None) -> str:
    """A number with its unit and a tolerance."""
    if tolerance is None:
        return f"{number} {unit}"
    if tolerance["percent"]:
        return f"{number} {unit}".strip() + f" ± {tolerance['size']} %"
    return f"{number} ± {tolerance['size']} {unit}".strip()


@lru_cache(maxsize=_REMEMBERED)
def _convert(number: float, given: str, unit: str) -> float:
    usual = _USUAL.get((given, unit))
    if usual is not None:
        return number * usual
    try:
        parsed = _registry().parse_units(given)
        same = parsed.is_compatible_with(unit)
        if not same and _POUNDS.search(given):
            parsed = _registry().parse_units(_POUNDS.sub(r"\1f", given).replace("ozf", "force_ounce"))
            same = parsed.is_compatible_with(unit)
        value = float(_registry().convert(number, parsed, unit)) if same else 0.0
    except Exception as error:  # the parser raises many unrelated types, down to those of Python's tokenizer
        raise ValueError(f'has an unknown unit "{given}". Write for example "{number:g} {unit}"') from error
    if not same:
        raise ValueError(f'must be in units of {unit}, not "{given}"')
    if unit == "Hz" and "hertz" not in str(parsed):
        raise ValueError(f'must be a frequency in Hz, not "{given}"')
    if unit == "rad/s" and "hertz" in str(parsed):
        raise ValueError(f'is ambiguous: Hz could mean rev/s or rad/s. Write "{60 * value:g} rpm" or rad/s')
    return value


@dataclass(frozen=True)
class _Reader:
    """Reads numbers, and texts with units."""

    unit: str
    smallest: float
    words: tuple[tuple[str, float], ...]

    def __call__(self, value: object, /) -> object:
        """A number in SI units."""
        if isinstance(value, bool):
            raise ValueError(f"must be a number{f' in {self.unit}' if self.unit else ''}")
        number = self._read(value) if isinstance(value, str) else value
        if isinstance(number, int | float):
            _check_size(number, self.smallest)
            if abs(number) < _DUST:
                return type(number)(0)
        return number

    def _read(self, text: str) -> float:
        if (number := dict(self.words).get(text.strip())) is not None:
            return number
        if self.words and text.strip().isalpha():
            raise ValueError(f"must be a number, or one of {', '.join(dict(self.words))}")
        return to_si(text, self.unit)


def unit_of(annotation: object) -> str | None:
    """The SI unit of a field, or of the numbers in a list; None without numbers."""
    if isinstance(annotation, BeforeValidator) and isinstance(annotation.func, _Reader):
        return annotation.func.unit
    inner = (*getattr(annotation, "__metadata__", ()), *get_args(annotation))
    return next((unit for one in inner if (unit := unit_of(one)) is not None), None)


def _check_size(number: float, smallest: float) -> None:
    """Refuse numbers that no drive has, and with which the arithmetic would overflow."""
    if _LARGEST_MAGNITUDE < abs(number) < math.inf:
        raise ValueError(f"is too large: the limit is {_LARGEST_MAGNITUDE:g}")
    if 0 < abs(number) < smallest:
        raise ValueError(f"is too small: the limit is {smallest:g}")


def _read_count(value: object) -> object:
    if isinstance(value, bool | float | str):
        raise ValueError("must be a whole number")
    return value


_Toleranced = Annotated[str, StringConstraints(pattern=r"±|\+/?-|%")]
"""A dimensionless number, also with a tolerance, ``"0.31 ± 0.02"``, or in percent, ``"1 %"``."""


def quantity(unit: str, smallest: float = 1e-15, words: Mapping[str, float] = MappingProxyType({})) -> BeforeValidator:
    """Annotate a field that takes a number in `unit`, text with any unit of the same dimension, or a word for one."""
    shape: Any = float | (str if unit else _Toleranced)
    if words:
        shape = shape | Literal[tuple(words)]
    return BeforeValidator(_Reader(unit, smallest, tuple(words.items())), json_schema_input_type=shape)


Coordinate = Annotated[float, quantity("m", smallest=0)]
Length = Annotated[float, quantity("m")]
Time = Annotated[float, quantity("s")]
Speed = Annotated[float, quantity("m/s")]
AngularSpeed = Annotated[float, quantity("rad/s", smallest=0)]
AngularAcceleration = Annotated[float, quantity("rad/s^2", smallest=0)]
AngularJerk = Annotated[float, quantity("rad/s^3", smallest=0)]
Acceleration = Annotated[float, quantity("m/s^2", smallest=0)]
Angle = Annotated[float, quantity("rad", smallest=0)]
Frequency = Annotated[float, quantity("Hz", smallest=0)]
Torque = Annotated[float, quantity("N*m", smallest=0)]
Power = Annotated[float, quantity("W", smallest=0)]
Pressure = Annotated[float, quantity("Pa", smallest=0)]
TorsionalStiffness = Annotated[float, quantity("N*m/rad")]
TorsionalDamping = Annotated[float, quantity("N*m*s/rad")]
QuadraticDamping = Annotated[float, quantity("N*m*s^2/rad^2")]
Force = Annotated[float, quantity("N", smallest=0)]
Stiffness = Annotated[float, quantity("N/m")]
Damping = Annotated[float, quantity("N*s/m")]
Mass = Annotated[float, quantity("kg")]
Inertia = Annotated[float, quantity("kg*m^2")]
Density = Annotated[float, quantity("kg/m^3")]
Stress = Annotated[float, quantity("Pa")]
AxialStiffness = Annotated[float, quantity("N")]
BendingStiffness = Annotated[float, quantity("N*m^2")]
MassPerLength = Annotated[float, quantity("kg/m")]
MassFlowRate = Annotated[float, quantity("kg/s")]
LineStiffness = Annotated[float, quantity("N/m^2")]
LineDamping = Annotated[float, quantity("N*s/m^2")]
Temperature = Annotated[float, quantity("degC", smallest=0)]
ThermalExpansion = Annotated[float, quantity("1/K")]
TemperatureDifference = Annotated[float, quantity("K")]
Ratio = Annotated[float, quantity("")]
Count = Annotated[int, BeforeValidator(_read_count, json_schema_input_type=int)]
Flag = Annotated[bool, Strict()]
Title = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=100, pattern=r"^[^\r\n]+$")]
"""A line of text, for titles."""
Words = Annotated[str, StringConstraints(strip_whitespace=True, max_length=4000)]
"""Text of some lines."""
Name = Annotated[str, StringConstraints(max_length=60, pattern=r"^\w[\w .-]*$")]


# Numbers with a unit as text: a single one, a range "700..6000 rpm", or a list "700, 1500, 3000 rpm"

_RANGE_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_RANGE = re.compile(rf"\s*({_RANGE_NUMBER})\s*\.\.\s*({_RANGE_NUMBER})\s*(.*?)\s*")
_MAX_NUMBERS = 10_000
"""Numbers of a range or list, at most; more are refused, a safeguard since each is a point of an analysis."""


def number_in(name: str, value: float | str, unit: str) -> float:
    """Read a number with or without its unit."""
    try:
        number = to_si(value, unit) if isinstance(value, str) else float(value)
        if not isfinite(number):
            raise ValueError("must be a finite number")
    except ValueError as error:
        raise ModelError(f"{name} = {value!r} {error}.") from error
    return number


Number: TypeAlias = str | SupportsFloat
"""A text with a unit, or a number in SI units."""
Numbers: TypeAlias = str | Sequence[float] | FloatArray
"""A range or list as text with its unit, or numbers in SI units."""


def numbers_in(name: str, given_numbers: Numbers, unit: str, count: int) -> FloatArray:
    """Numbers in ascending order: those of an array or list in SI units, of a text, or equally spaced in its range."""
    example = "700..6000 rpm" if unit == "rad/s" else f"0.2..1.2 {unit}".rstrip()
    text = given_numbers
    found = _numbers_of_text(name, text, unit, count, example) if isinstance(text, str) else _finite(name, text, unit)
    ascending = np.sort(found)
    if np.any(np.diff(ascending) == 0.0):
        raise ModelError(f"{name} = {text!r} contains the same number twice. Write a range such as {example!r}.")
    return ascending


def _finite(name: str, given: Sequence[float] | FloatArray, unit: str) -> FloatArray:
    """Numbers that are given as such."""
    try:
        found = np.atleast_1d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        found = np.full(1, np.nan)
    if found.ndim != 1 or not 1 <= found.size <= _MAX_NUMBERS or not np.all(np.isfinite(found)):
        in_unit = f" in {unit}" if unit else ""
        raise ModelError(
            f"{name} = {given!r} must be 1 to {_MAX_NUMBERS:,} finite numbers{in_unit}, or a text with a unit."
        )
    return found


def _numbers_of_text(name: str, text: str, unit: str, count: int, example: str) -> FloatArray:
    """Numbers of a range or of a list."""
    ranged, listed = _RANGE.fullmatch(text), [_NUMBER.fullmatch(each) for each in text.split(",")]
    if ranged is not None:
        if not 2 <= count <= _MAX_NUMBERS:
            raise ModelError(f"{count} points of {name} = {text!r} are not possible. Give 2 to {_MAX_NUMBERS:,}.")
        first, last, given = ranged.groups()
        return np.linspace(_number(name, first, given, unit), _number(name, last, given, unit), count)
    matches = [match for match in listed if match is not None]
    if len(matches) == len(listed):
        last = matches[-1]["unit"]
        return np.array([_number(name, match["number"], match["unit"] or last, unit) for match in matches])
    raise ModelError(f"{name} = {text!r} must be a range such as {example!r}, or numbers separated by commas.")


def _number(name: str, number: str, given: str, unit: str) -> float:
    """A number of a range or a list in SI units."""
    if not unit and given in ("", "%"):
        return float(number) * (0.01 if given else 1.0)
    if not given:
        example = "800 rpm" if unit == "rad/s" else f"{float(number):g} {unit}"
        raise ModelError(f'{name} = {number!r} has no unit. Write it after the last number, such as "{example}".')
    try:
        return to_si(f"{number} {given}", unit)
    except ValueError as error:
        raise ModelError(f"{name} = {number!r} {error}.") from error

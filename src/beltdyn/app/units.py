"""Units of the page: millimetres, rpm and newtons, or SI; drive files may have any."""

import math
import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from beltdyn.parts.quantity import to_si

System = Literal["mm", "SI"]

SYSTEMS: Mapping[System, str] = MappingProxyType({"mm": "mm, rpm, N", "SI": "SI units"})
"""Names of the systems."""
_PLAIN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_NOT_CONVERTED = re.compile(r"±|\+/?-|\b(?:c?cw|(?:counter-)?clockwise)$")
"""Tolerances and senses of rotation are shown as they are given."""
_DIGITS = 7


class Unit(NamedTuple):
    """A unit of the page."""

    shown: str
    """As a label has it."""
    written: str
    """As a drive file has it; empty for SI units, whose numbers stand alone."""
    size: float
    """Its size in the SI unit."""


_OF_SHOPS: Mapping[str, Unit] = MappingProxyType(
    {
        "m": Unit("mm", "mm", 1e-3),
        "m^2": Unit("mm²", "mm^2", 1e-6),
        "m^3": Unit("cm³", "cm^3", 1e-6),
        "rad": Unit("°", "deg", math.pi / 180.0),
        "rad/s": Unit("rpm", "rpm", math.pi / 30.0),
        "kg*m^2": Unit("kg cm²", "kg cm^2", 1e-4),
        "N/m": Unit("N/mm", "N/mm", 1e3),
        "Pa": Unit("MPa", "MPa", 1e6),
    }
)


def unit_in(system: System, si: str) -> Unit:
    """The unit of a system for an SI unit."""
    other = _OF_SHOPS.get(si) if system == "mm" else None
    return other or Unit(_printed(si), "", 1.0)


def _printed(si: str) -> str:
    """An SI unit as it is printed."""
    powers = si.replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
    return powers.replace("*", " ")


def shown(value: Any, si: str, system: System) -> str:
    """A value of a drive file as a field shows it; several separated by commas."""
    if isinstance(value, list):
        return ", ".join(shown(one, si, system) for one in value)
    number = _number(value, si)
    if number is None or not si:
        return "" if value is None else repr(value) if isinstance(value, float) else str(value)
    return f"{number / unit_in(system, si).size:.{_DIGITS}g}"


def _number(value: Any, si: str) -> float | None:
    """A value in SI units; None for one that is shown as it is."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    if not isinstance(value, str):
        return float(value)
    if not si or _NOT_CONVERTED.search(value):
        return None
    try:
        return to_si(value, si)
    except ValueError:
        return None


def with_unit(text: str, si: str, system: System) -> str:
    """What was typed as a drive file has it: plain numbers get the unit of the page."""
    unit = unit_in(system, si)
    return f"{text} {unit.written}" if unit.written and _PLAIN.fullmatch(text) else text

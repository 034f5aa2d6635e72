"""Display units of results."""

from typing import TYPE_CHECKING

from beltdyn.parts.quantity import SHOWN_UNITS

if TYPE_CHECKING:
    import xarray as xr

VARIOUS = "various"
"""Unit of a variable whose numbers have different ones, which another variable names."""
_MILLIMETRES = 0.1
"""Size of lengths, m, below which they are written in mm."""
_SHOWN = {**SHOWN_UNITS, **dict.fromkeys(("1", VARIOUS), ("", 1.0))}


def shown_unit(variable: "xr.DataArray") -> tuple[str, float]:
    """Give the display unit of a variable and its factor.

    Parameters
    ----------
    variable : DataArray
        A variable of a result.

    Returns
    -------
    unit : str
        rpm for rad/s, degrees for rad, mm for short lengths, nothing for a pure number; others as they are.
    factor : float
        What its numbers are multiplied by.
    """
    unit = str(variable.attrs.get("units", ""))
    if unit == "m" and not (abs(variable) >= _MILLIMETRES).any():
        return "mm", 1e3
    return _SHOWN.get(unit, (unit, 1.0))


def in_words(variable: "xr.DataArray") -> str:
    """Write a single value with its unit, such as "1500 rpm"; a text as it is."""
    if variable.dtype.kind != "f":
        return str(variable.item())
    unit, factor = shown_unit(variable)
    return f"{factor * float(variable):z.4g} {unit}".rstrip()

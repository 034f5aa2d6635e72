"""How numbers are printed on the page."""

from math import isfinite, log10

from validation.paper.statement import Value

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_THIN_SPACE = "\u202f"


def shown(value: Value, unit: str = "", digits: int = 3) -> str:
    """Print a value with its unit.

    Parameters
    ----------
    value : float, int or str
        A float is rounded; an integer and a text are printed as they are.
    unit : str
        "%" prints a fraction in per cent.
    digits : int
        Significant digits of a float; digits before the point are never lost.

    Returns
    -------
    str
        Such as "0.0123 rad/s", "1.20×10⁻⁵ N" or "15.0 %".
    """
    if isinstance(value, float) and unit == "%":
        value = 100.0 * value
    text = value if isinstance(value, str) else f"{value:d}" if isinstance(value, int) else _rounded(value, digits)
    return f"{text}{_THIN_SPACE}{unit}".rstrip(_THIN_SPACE).replace("-", "−")


def power_of_ten(value: float) -> str:
    """Print a power of ten, such as "10⁴".

    Parameters
    ----------
    value : float
        The power.
    """
    return f"10{str(round(log10(value))).translate(_SUPERSCRIPT)}"


def _rounded(value: float, digits: int) -> str:
    if not isfinite(value):
        return "not known"
    if value == 0.0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = int(exponent)
    if not -4 < power < 6:
        return f"{mantissa}×10{str(power).translate(_SUPERSCRIPT)}"
    return f"{value:.{max(0, digits - 1 - power)}f}"

"""Ranges of closed forms: a number outside is refused by its name."""

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.errors import ModelError

LARGEST_EXPONENT = 700.0
"""Exponents up to here have a power of e that a computer holds."""


def require_above(least: float = 0.0, /, **values: ArrayLike) -> None:
    """Refuse values that are not above a limit, or not finite, with ModelError; NaN is one of them."""
    for name, value in values.items():
        _refuse(name, value, np.greater(value, least), f"finite and above {least:g}")


def require_at_least(least: float = 0.0, /, **values: ArrayLike) -> None:
    """Refuse values below a limit, or not finite, with ModelError; NaN is one of them."""
    for name, value in values.items():
        _refuse(name, value, np.greater_equal(value, least), f"finite and at least {least:g}")


def require_at_most(largest: float, /, **values: ArrayLike) -> None:
    """Refuse values above a limit, or not finite, with ModelError; NaN is one of them."""
    for name, value in values.items():
        _refuse(name, value, np.less_equal(value, largest), f"finite and at most {largest:g}")


def _refuse(name: str, value: ArrayLike, within: ArrayLike, rule: str) -> None:
    fits = np.asarray(within) & np.isfinite(value)
    if not np.all(fits):
        worst = np.asarray(value)[~fits].flat[0] if np.ndim(value) else value
        raise ModelError(f"{name} = {worst:g} is outside the range of this closed form: it must be {rule}.")

"""Columns of numbers with as many decimals each."""

import math
from collections.abc import Sequence

_NOTHING = 1e-9
"""Size of numbers, in any unit shown, that are rounding."""


def aligned(values: Sequence[float], digits: int = 4) -> list[str]:
    """Write the numbers of a column with as many decimals each, so that the largest has so many digits; – for none."""
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    whole = math.floor(math.log10(largest)) + 1 if largest > _NOTHING else digits
    decimals = max(digits - whole, 0)
    return [f"{value:z.{decimals}f}" if math.isfinite(value) else "–" for value in values]

"""Columns of numbers with equal decimals."""

import math
from collections.abc import Sequence

_NOTHING = 1e-9
"""Magnitude below which a displayed number is rounding error, in any unit."""


def aligned(values: Sequence[float], digits: int = 4) -> list[str]:
    """Format a column with equal decimals, with the given digits for the largest number; – for a missing one."""
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    whole = math.floor(math.log10(largest)) + 1 if largest > _NOTHING else digits
    decimals = max(digits - whole, 0)
    return [f"{value:z.{decimals}f}" if math.isfinite(value) else "–" for value in values]

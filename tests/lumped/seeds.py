"""Seeds of a family in blocks, which end before a test counts as hanging and are shared among processes."""

from collections.abc import Sequence

import pytest


def blocks(quick: Sequence[int], last: int, size: int) -> pytest.MarkDecorator:
    """Parameter ``seeds``: some for every run of the tests, and in slow blocks the others up to the last."""
    others = [seed for seed in range(min(quick), last) if seed not in quick]
    slow = [pytest.param(others[first : first + size], marks=pytest.mark.slow) for first in range(0, len(others), size)]
    return pytest.mark.parametrize("seeds", [quick, *slow], ids=lambda seeds: f"{seeds[0]}-{seeds[-1]}")

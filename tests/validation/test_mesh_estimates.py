"""What runs estimate of the errors of their meshes, against converged meshes of drives made at random.

The documentation has the same for 30 drives (`docs/verification/resolution.md`); here are some of them.
"""

from collections.abc import Callable
from functools import cache

import pytest
from random_drives import SEEDS, Judged, judge

from beltdyn.model import ERROR_LIMITS

DRIVES = SEEDS[:8]
FACTOR = 2.0
"""Within which a true error keeps to its estimate in nine of ten meshes (losses) to all (tension)."""
EXCEPTIONS = 3
"""Of 24 meshes, one of ten and one more."""
OVER, MOST = 10.0, 0.5
"""Times the true error is an estimate at most where it finds a mesh too coarse, in at least this part of them."""


@cache
def judged() -> list[Judged]:
    return [one for seed in DRIVES for one in judge(seed)]


def of_mesh(mesh: str) -> list[Judged]:
    return [one for one in judged() if one.mesh == mesh]


@pytest.mark.slow
@pytest.mark.parametrize("name", ERROR_LIMITS)
def test_true_errors_keep_to_their_estimates(measured: Callable[..., None], name: str) -> None:
    ratios = sorted(one.true[name] / one.estimated[name] for one in judged())
    measured(median=ratios[len(ratios) // 2], largest=ratios[-1])
    assert sum(ratio > FACTOR for ratio in ratios) <= EXCEPTIONS


@pytest.mark.slow
@pytest.mark.parametrize("name", ERROR_LIMITS)
def test_there_is_little_false_alarm(name: str) -> None:
    """Where an estimate is above the limit, most true errors are more than a tenth of it."""
    alarms = [one for one in judged() if one.estimated[name] > ERROR_LIMITS[name]]
    assert len(alarms) >= 3
    assert sum(OVER * one.true[name] >= one.estimated[name] for one in alarms) >= MOST * len(alarms)


@pytest.mark.slow
def test_the_named_meshes_keep_to_the_limits() -> None:
    assert all(one.true["tension"] <= ERROR_LIMITS["tension"] for one in of_mesh("for the tension"))
    assert all(one.true[name] <= limit for one in of_mesh("for all") for name, limit in ERROR_LIMITS.items())


@pytest.mark.slow
def test_all_meshes_of_a_drive_ask_for_the_same() -> None:
    for first, second, third in zip(*map(of_mesh, ("coarse", "for the tension", "for all")), strict=True):
        for name, needed in first.needed.items():
            assert {needed, second.needed[name], third.needed[name]} <= {needed - 1, needed, needed + 1}

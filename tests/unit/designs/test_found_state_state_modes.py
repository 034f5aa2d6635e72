"""Modes that are followed to states nearby, against modes that are found anew there."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.designs import found_state as state_modes
from beltdyn.designs.found_state import FoundState, Resting, Running, rest_near
from beltdyn.designs.named_results import MODES
from beltdyn.model import Drive, prepare
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import steady_on_mesh, steady_state
from validation.published.cases import better, loaded_two_pulley

MODULUS = "belt.youngs_modulus"
NAMES = [f"mode_{what}[{number}]" for what in ("frequency", "damping_ratio") for number in (1, 2, 3, 6)]


@pytest.fixture(scope="module")
def drive() -> Drive:
    return better(loaded_two_pulley())


@pytest.fixture(scope="module")
def running(drive: Drive) -> Running:
    return Running(steady_state(drive))


@pytest.fixture(scope="module")
def resting(drive: Drive) -> Resting:
    return Resting(bring_to_stand(prepare(drive)))


def slopes(found: Callable[[float], FoundState], step: float) -> FloatArray:
    """Derivatives of results of modes by a relative change of a number."""
    up, down = (found(sense * step) for sense in (1.0, -1.0))
    return np.array([up.value(name) - down.value(name) for name in NAMES]) / (2.0 * step)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("path", "step"), [pytest.param(MODULUS, 1e-5, marks=pytest.mark.slow), ("contact.friction", 1e-5)]
)
def test_derivatives_against_modes_found_anew(drive: Drive, running: Running, path: str, step: float) -> None:
    """By Richardson's extrapolation from two steps, to 1e-5 of derivative or result.

    Where the belt moves, wider steps would let further points of the mesh come into contact, at which tangents jump.
    Over the small ones the rounding of eigenvalues, 1e-12, is at most 1.5e-7 in extrapolated derivatives of damping
    ratios: 4/3 of 1e-12 / 1e-5, and 1/3 of half of that.
    """
    value = drive_value(drive, path)

    def anew(part: float) -> Running:
        return Running(steady_on_mesh(drive.with_({path: value * (1.0 + part)}), running.run))

    wide, narrow = slopes(anew, 2.0 * step), slopes(anew, step)
    expected = (4.0 * narrow - wide) / 3.0
    followed = slopes(lambda part: running.neighbour(drive.with_({path: value * (1.0 + part)})), 1e-5)
    allowed = 1e-5 * np.maximum(np.abs(expected), np.abs([running.value(name) for name in NAMES]))
    allowed[len(NAMES) // 2 :] += 1.5e-7
    assert np.all(np.abs(followed - expected) <= allowed)
    assert np.any(np.abs(expected) > 100.0 * allowed)  # there is an effect to be compared


def drive_value(drive: Drive, path: str) -> float:
    """A number of the drive, one for all pulleys where it may differ."""
    known = {MODULUS: drive.belt.youngs_modulus, "contact.friction": drive.contact.friction}
    return float(known.get(path) or drive.pulleys[1].inertia or 0.0)


@pytest.mark.slow
def test_derivatives_at_rest_over_wide_steps(drive: Drive, resting: Resting) -> None:
    """Where no point comes into contact: Richardson's extrapolation from 0.2 and 0.1 %, to 1e-5 of derivatives."""
    modulus = drive_value(drive, MODULUS)

    def anew(part: float) -> Resting:
        return Resting(rest_near(prepare(drive.with_({MODULUS: modulus * (1.0 + part)})), resting.rest))

    expected = (4.0 * slopes(anew, 1e-3) - slopes(anew, 2e-3)) / 3.0
    followed = slopes(lambda part: resting.neighbour(drive.with_({MODULUS: modulus * (1.0 + part)})), 1e-5)
    count = len(NAMES) // 2
    np.testing.assert_allclose(followed[:count], expected[:count], rtol=1e-5)


def test_modes_of_one_eigenvalue_change_by_their_mean(
    drive: Drive, resting: Resting, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The two spans at rest differ by 1e-4 of their frequency, and count as one where that is little."""
    beside = resting.neighbour(drive.with_({"pulley[driven].inertia": 1.01 * drive_value(drive, "inertia")}))
    before = [mode.value for mode in resting._first(MODES)[1:3]]
    alone = [mode.value - was for mode, was in zip(beside._first(MODES)[1:3], before, strict=True)]
    monkeypatch.setattr(state_modes, "_ALIKE", 1e-3)
    base = state_modes.FoundModes(resting.motions)
    assert [mode.alike for mode in base.first(MODES)[:3]] == [1, 2, 2]
    together = state_modes.FollowedModes(base, beside.motions).first(MODES)[1:3]
    for mode, was in zip(together, before, strict=True):
        assert mode.value.imag - was.imag == pytest.approx(np.mean(alone).imag, rel=1e-3)

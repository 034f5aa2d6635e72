"""How far vibrations grow: which states are looked at, and how their growth adds up."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from beltdyn.contact.friction import CommonFriction
from beltdyn.model import Drive, prepare
from beltdyn.solvers import flutter
from beltdyn.solvers.flutter import FlutterWatch, growth_rates, growth_within, longest_pieces
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.transient.simulate import simulate
from validation.published import better, two_pulley

Change = Callable[..., Drive]
FREQUENCY = 1500.0
POINTS = 5
"""Of an element."""
INTERVAL = 1e-3
SPEED = 2.0
"""Of the belt, m/s."""


class Vibrations:
    """Vibrations that grow at a rate which the state itself tells, and what was asked for."""

    asked: list[float]

    def __init__(self, system: System) -> None:
        Vibrations.asked = []

    def fastest_growing(self, time: float, position: NDArray[Any], velocity: NDArray[Any], shift: complex) -> complex:
        Vibrations.asked.append(time)
        return complex(position[0], 2.0 * np.pi * FREQUENCY)


@pytest.fixture
def system(change: Change) -> System:
    return drive_system(prepare(change()))


@pytest.fixture
def watch(system: System, monkeypatch: pytest.MonkeyPatch) -> Callable[..., FlutterWatch]:
    """A watch that has seen pieces of sliding belt, in contact points, while vibrations grow at some rates (1/s)."""
    monkeypatch.setattr(flutter, "Vibrations", Vibrations)

    def watched(pieces: Any, rates: Any, chunk: int = 7, part: float = 1.0) -> FlutterWatch:
        result, count = FlutterWatch(system), len(pieces)
        size, points = system.first_body + system.bodies.size, POINTS * system.length.size
        time, position, velocity = INTERVAL * np.arange(float(count)), np.zeros((count, size)), np.zeros((count, size))
        position[:, 0] = rates
        velocity[:, : system.first_body : len(system.scale)] = SPEED
        pulley = np.full((count, points), -1)
        pulley[:, : points // 2] = 0
        normal = np.where(pulley == 0, 300.0, 0.0)
        assert isinstance(system.law.friction, CommonFriction)
        saturation = system.pulleys.friction[0] * normal / system.law.friction.force_slope.creep_rate_factor
        slip = -part * saturation
        slip[np.arange(points) >= np.asarray(pieces)[:, None]] *= 0.9
        seen = {"normal_force": normal, "slip_velocity": slip, "contact_pulley": pulley}
        for first in range(0, count, chunk):
            some = slice(first, first + chunk)
            result.take(time[some], position[some], velocity[some], {name: seen[name][some] for name in seen})
        return result

    return watched


def test_growth_is_the_integral_over_the_time_of_sliding(watch: Callable[..., FlutterWatch]) -> None:
    """Ten outputs of sliding, nine intervals of 1 ms, and then the pause in which a vibration lives on."""
    found = watch([0] * 5 + [20] * 10 + [0] * 20, np.where(np.arange(35) < 15, 500.0, -500.0)).find()
    assert found is not None
    assert found.growth == pytest.approx(500.0 * 9 * INTERVAL)
    assert (found.start, found.end) == pytest.approx((5 * INTERVAL, 14 * INTERVAL))
    assert (found.rate, found.frequency) == pytest.approx((500.0, FREQUENCY))
    assert found.attributes["flutter_growth"] == found.growth


def test_a_pause_of_some_periods_is_bridged(watch: Callable[..., FlutterWatch]) -> None:
    """Ten periods are 6.4 ms: growth goes on after a pause of 5 ms, and begins anew after one of 10 ms."""
    short, long = (watch([20] * 6 + [0] * pause + [20] * 6, 100.0).find() for pause in (5, 10))
    assert short is not None
    assert long is not None
    assert short.growth == pytest.approx(100.0 * 16 * INTERVAL)
    assert long.growth == pytest.approx(100.0 * 11 * INTERVAL)


def test_the_belt_carries_vibrations_away(watch: Callable[..., FlutterWatch], system: System) -> None:
    """Within the length of belt that slides, at its speed."""
    found = watch([20] * 400, 100.0).find()
    transit = 20 / (POINTS * system.length.size) * np.sum(system.length) / SPEED
    assert found is not None
    assert transit < 400 * INTERVAL
    assert found.growth == pytest.approx(100.0 * transit, abs=100.0 * INTERVAL)


@pytest.mark.parametrize(("piece", "part"), [(POINTS, 1.0), (20, 0.98)])
def test_nothing_is_looked_for_where_the_belt_creeps(
    watch: Callable[..., FlutterWatch], piece: int, part: float
) -> None:
    """On no more than the length of an element, and below the limit of friction."""
    Vibrations.asked = []
    assert watch([piece] * 50, 1e4, part=part).find() is None
    assert Vibrations.asked == []


def test_decaying_vibrations_are_no_flutter(watch: Callable[..., FlutterWatch]) -> None:
    assert watch([20] * 50, -10.0).find() is None
    assert watch([20] * 50, np.nan).find() is None
    assert watch([0] * 50 + [20], 1e4).find() is None


@pytest.mark.parametrize("count", [16, 17, 33, 1000])
def test_few_states_are_kept_evenly(watch: Callable[..., FlutterWatch], count: int) -> None:
    watch([20] * count, 1.0).find()
    assert 8 < len(Vibrations.asked) <= 16
    kept = sorted(Vibrations.asked)
    np.testing.assert_allclose(np.diff(kept, 2), 0.0, atol=1e-9)
    assert kept[-1] >= 0.9 * (count - 1) * INTERVAL


def test_between_states_without_growth_none_is_looked_for(watch: Callable[..., FlutterWatch]) -> None:
    times = INTERVAL * np.arange(16)
    assert watch([20] * 16, -1.0).find() is None
    np.testing.assert_allclose(Vibrations.asked, np.append(times[::2], times[-1]))
    grows = np.where(np.arange(16) == 6, 5000.0, -500.0)
    found = watch([20] * 16, grows).find()
    assert found is not None
    assert found.rate == 5000.0
    np.testing.assert_allclose(sorted(Vibrations.asked), np.sort(np.append(times[::2], times[[5, 7, 15]])))


def test_chunks_do_not_matter(watch: Callable[..., FlutterWatch]) -> None:
    pieces, rates = [0, 20, 20, 0, 0, 20, 20, 20, 0, 0, 0, 0, 0, 0, 0, 0, 20, 20], np.linspace(100.0, 300.0, 18)
    assert watch(pieces, rates, chunk=1).find() == watch(pieces, rates, chunk=18).find()


def test_longest_pieces_go_around_the_belt() -> None:
    points = np.array([[1, 1, 0, 1, 0, 1], [0, 0, 0, 0, 0, 0], [1, 1, 1, 1, 1, 1], [0, 1, 1, 1, 0, 1]], dtype=bool)
    np.testing.assert_array_equal(longest_pieces(points), [3, 0, 6, 3])
    assert longest_pieces(points[:0]).shape == (0,)


def test_growth_floors_at_zero_and_forgets() -> None:
    time, rates = np.linspace(0.0, 1.0, 1001), np.array([-200.0, -200.0, 100.0, 100.0, -200.0])
    instants = np.array([0.0, 0.4994, 0.4996, 0.9004, 0.9006])
    long = np.full_like(time, np.inf)
    growth, start, end = growth_within(time, long, instants, rates)
    assert (growth, start, end) == pytest.approx((40.0, 0.5, 0.9))
    growth, start, end = growth_within(time, np.full_like(time, 0.1), instants, rates)
    assert growth == pytest.approx(10.0, abs=0.1)  # an output more or less
    assert end - start == pytest.approx(0.1, abs=1.1e-3)


def case_1(elements: int, **contact: float) -> Drive:
    """The beginning of case 1, to the end of the first time of sliding."""
    drive = better(two_pulley(elements), duration=0.13)
    return drive.replace(contact=drive.contact.replace(**contact))


def test_a_run_says_when_its_belt_flutters() -> None:
    """The rate is that of a dense solution within 5 %, the amplification far beyond the limit."""
    run = simulate(case_1(60))
    found = SimpleNamespace(**{key: value for key, value in run.dataset.attrs.items() if key.startswith("flutter")})
    assert found.flutter_growth > 15.0
    assert found.flutter_rate == pytest.approx(711.0, rel=0.05)
    assert found.flutter_frequency == pytest.approx(1500.0, rel=0.02)
    assert 0.07 < found.flutter_start < found.flutter_end < 0.13
    assert any(warning.startswith("the belt may flutter where it slides") for warning in run.warnings)


@pytest.mark.slow
@pytest.mark.parametrize(("elements", "contact"), [(20, {}), (60, {"damping": 1000.0}), (60, {"friction": 20.0})])
def test_no_flutter_on_coarse_meshes_with_damping_or_without_sliding(elements: int, contact: dict[str, float]) -> None:
    run = simulate(case_1(elements, **contact))
    assert run.dataset.attrs.get("flutter_growth", 0.0) < 1.0
    assert not any("flutter" in warning for warning in run.warnings)


def test_only_what_swings_counts_as_a_vibration() -> None:
    """A motor or a load may let a drive run away without swinging, and a search may find nothing."""
    eigenvalues = np.array([3.0 + 900.0j, 3.0 - 900.0j, -2.0 + 900.0j, 40.0 + 0.0j, 40.0 - 1e-9j, np.nan + 1j * np.nan])
    np.testing.assert_array_equal(growth_rates(eigenvalues), [3.0, 3.0, -2.0, 0.0, 0.0, 0.0])

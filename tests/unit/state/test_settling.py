"""What goes before a run: transients of a run-up die, and a mesh that stays is found at rest."""

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles.functions import profile_integral, profile_value
from beltdyn.model import Drive, prepare
from beltdyn.results import mesh_error_attribute
from beltdyn.results.checks.ending import SETTLED
from beltdyn.solvers.run_progress import Progress
from beltdyn.solvers.trajectory import Chunk, Integrator
from beltdyn.state import settling
from beltdyn.state.settling import Settling, _Left, begin_flowing, settle, with_angles, with_passage
from beltdyn.system.arrays import BodyForces
from beltdyn.system.build import drive_system, flow_place, staying_system
from beltdyn.system.build_machines import profile_arrays
from beltdyn.system.state import State


@pytest.mark.parametrize(("decay", "left"), [(0.25, 0.02), (0.5, 0.1)])
def test_what_is_left_of_a_decaying_tension(decay: float, left: float) -> None:
    """A tension that falls exponentially to 100 N, by a factor from window to window: what is left is extrapolated."""
    windows = _Left()
    for number in range(5):
        time = np.linspace(number, number + 1.0, 400)
        start = left * 100.0 / decay**4.5  # in the middle of the last window this part is left
        windows.take(time, 100.0 + (start * decay**time)[:, None])
    assert windows.known
    assert windows.part == pytest.approx(left, rel=0.15)


def test_a_steady_ripple_leaves_nothing() -> None:
    """Windows hold two and a half waves, so that they begin at different places of them."""
    windows = _Left()
    for number in range(5):
        time = np.linspace(number, number + 1.0, 400)
        windows.take(time, 100.0 + 20.0 * np.cos(2.0 * np.pi * 4.5 * time)[:, None])
    assert windows.part < 0.01


def test_too_few_windows_tell_nothing() -> None:
    windows = _Left()
    for number in range(4):
        windows.take(np.linspace(number, number + 1.0, 9), np.full((9, 2), 50.0))
    assert not windows.known
    assert np.isnan(windows.part)


@pytest.mark.parametrize("waves", [2, 3, 7])
def test_a_ripple_of_whole_waves_leaves_nothing_at_all(waves: int) -> None:
    """The weight of a window, sin^2, cuts out its second harmonic and all above, wherever waves begin."""
    windows = _Left()
    for number in range(5):
        time = np.linspace(number, number + 1.0, 400)
        ripple = np.cos(2.0 * np.pi * waves * time + 1.3 * number)
        windows.take(time, 100.0 + 20.0 * ripple[:, None])
    assert windows.part < 1e-6


def test_a_constant_tension_leaves_nothing() -> None:
    windows = _Left()
    for number in range(5):
        windows.take(np.linspace(number, number + 1.0, 9), np.full((9, 2), 50.0))
    assert windows.part == 0.0


def test_a_change_that_does_not_get_smaller_is_taken_to_last() -> None:
    """From window to window by 1 N of 100 N: with nine tenths of it left in each, 8.1 N are still to come."""
    windows = _Left()
    for number in range(5):
        windows.take(np.linspace(number, number + 1.0, 9), np.full((9, 1), 96.0 + number))
    assert windows.part == pytest.approx(0.081)


def test_without_tension_nothing_is_told() -> None:
    windows = _Left()
    for number in range(5):
        windows.take(np.linspace(number, number + 1.0, 9), np.zeros((9, 2)))
    assert np.isnan(windows.part)


def chunk(time: FloatArray) -> Chunk:
    """States of a body whose place is the time."""
    place, rows = time[:, None].copy(), np.zeros((time.size, 1))
    forces = BodyForces(*(rows for _ in BodyForces._fields))
    return Chunk(time, rows[:, 0], place, rows, rows, forces, float(time[-1]) if time.size else 0.0)


@pytest.mark.parametrize("decay", [0.5, 0.95], ids=["settles", "does not"])
def test_settling_ends_where_the_transient_has_died_or_with_the_last_stop(
    decay: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tension that falls to 100 N by a factor from window to window; chunks end within windows, too, or are empty.

    What is left at the end of a window is decay^t; that of the changes over windows, weighted by sin^2, is as much of
    the middle of the last one, within 15 %.
    """
    stops, reports = np.arange(1.0, 31.0), list[Progress]()

    def tension(system: object, position: FloatArray, velocity: object, forces: object, shown: object) -> Any:
        assert np.flatnonzero(np.asarray(shown)).tolist() == [0]
        return SimpleNamespace(span_tension=100.0 + 100.0 * decay**position)

    def integrator(task: object) -> Iterator[Chunk]:
        yield chunk(np.zeros(1))
        for stop in stops.tolist():
            yield chunk(np.linspace(stop - 1.0, stop - 0.6, 40)[1:])
            yield replace(chunk(np.zeros(0)), reached=stop - 0.5)
            yield chunk(np.linspace(stop - 0.6, stop, 60)[1:])

    monkeypatch.setattr(settling, "observe_motion", tension)
    task: Any = SimpleNamespace(system=None)
    end, settled = settle(task, cast(Integrator, integrator), stops, 7.0, reports.append)
    assert {(each.time, each.duration, each.outputs_written, each.phase) for each in reports} == {
        (0.0, 7.0, 0, "settling")
    }
    assert end.position[0] == settled.time == len(reports)
    assert np.all(end.acceleration == 0.0)
    assert settled.attributes == {"settling_time": settled.time, "settling_left": settled.left}
    if decay == 0.5:
        assert settled.left == pytest.approx(decay ** (settled.time - 0.5), rel=0.15)
        assert settled.left < SETTLED <= 1.2 * decay ** (settled.time - 1.5)
    else:
        assert settled.time == stops[-1]
        assert settled.left > SETTLED


@pytest.mark.parametrize("longest", [0.05, 4.0, 1e3])
def test_windows_hold_two_turns_and_are_a_twentieth_of_the_longest_time(drive: Drive, longest: float) -> None:
    """Two turns at 10 rad/s take 0.4 pi s."""
    window = Settling(0, 10.0, 0.1, longest)._window(drive.pulleys[0])
    assert window == pytest.approx(np.clip(0.4 * np.pi, longest / 20.0, longest))


def test_a_settling_drive_reaches_the_first_speed_and_stays_there(drive: Drive) -> None:
    first, second = Settling(0, 10.0, 0.1, 1.0)._before(drive).pulleys
    assert second == drive.pulleys[1]
    profile = profile_arrays((first, second), ())
    speeds = [interpreted(profile_value)(profile, 0, time)[0] for time in (0.0, 0.05, 0.1, 0.5, 9.0)]
    np.testing.assert_allclose(speeds, [0.0, 5.0, 10.0, 10.0, 10.0], atol=1e-12)


def test_prescribed_angles_go_on_from_those_of_another_system(drive: Drive) -> None:
    """At the beginning of the run; without another system from zero."""
    prepared = prepare(drive)
    system = drive_system(prepared)
    turning = prepare(Settling(0, 10.0, 0.1, 1.0)._before(drive))
    before = system._replace(profiles=profile_arrays(turning.pulleys, turning.goods))
    angle, begin = interpreted(profile_integral), prepared.simulation.begin
    assert angle(with_angles(prepared, system).profiles, 0, begin) == pytest.approx(0.0, abs=1e-12)
    continued = with_angles(prepared, system, before, 1.1).profiles
    assert angle(continued, 0, begin) == pytest.approx(0.5 * 10.0 * 0.1 + 10.0, rel=1e-9)
    later = angle(system.profiles, 0, begin + 0.5) - angle(system.profiles, 0, begin)
    assert angle(continued, 0, begin + 0.5) - angle(continued, 0, begin) == pytest.approx(later)


@pytest.mark.parametrize("mesh", ["uniform", "auto"])
def test_a_run_on_a_staying_mesh_begins_at_rest(drive: Drive, mesh: str) -> None:
    """Says so, with the elements that are asked for; the length that has passed, its last coordinate, is zero."""
    settings = drive.simulation.replace(frame="staying", mesh=mesh, start="equilibrium")
    staying, reports = (
        prepare(drive.replace(belt=drive.belt.replace(elements=30), simulation=settings)),
        list[Progress](),
    )
    result = begin_flowing(staying, reports.append)
    assert [(each.time, each.outputs_written, each.phase) for each in reports] == [(0.0, 0, "equilibrium")]
    assert bool(np.ptp(result.system.length) < 1e-9) is (mesh == "uniform")
    assert result.system.nodes == pytest.approx(30, abs=0 if mesh == "uniform" else 4)
    assert result.state.position.size == result.system.first_body + result.system.bodies.size
    assert np.all(result.state.velocity == 0.0)
    assert result.state.position[-1] == 0.0
    assert 0.0 < result.attributes[mesh_error_attribute("peak pressure")] < 0.3


def test_the_speed_of_the_belt_is_that_of_the_length_that_has_passed(drive: Drive) -> None:
    prepared = prepare(drive)
    system = staying_system(prepared, prepared.equal_lengths(10))
    rows = np.arange(3.0 * (system.first_body + 2)).reshape(3, -1) + 1.0
    passed, at = with_passage(system, State(*rows), 7.0), system.first_body + flow_place(system)
    vectors = passed.position, passed.velocity, passed.acceleration
    for vector, row, value in zip(vectors, rows, (0.0, 7.0, 0.0), strict=True):
        assert vector[at] == value
        np.testing.assert_array_equal(np.delete(vector, at), row)

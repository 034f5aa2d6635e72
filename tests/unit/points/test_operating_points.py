"""The order in which the points of a table are found, the way from one to the next, and what goes wrong at some."""

from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, example
from beltdyn.points import operating_points
from beltdyn.points.changed_drive import at_speed, held_at
from beltdyn.points.duty import duty
from beltdyn.points.operating_points import OperatingPoints, load_factors, operating_map, serpentine, values_by_name
from beltdyn.points.traction import traction
from beltdyn.results import Result, Run, Variable
from beltdyn.results.summary import means_of
from beltdyn.results.tooth_loads import tooth_loads
from beltdyn.solvers.run_progress import Progress
from beltdyn.state.steady import steady_state
from beltdyn.vibration.campbell import campbell
from beltdyn.vibration.response import response
from validation.published import two_pulley
from validation.published.cases import better, loaded_two_pulley

FIRST, SPAN = 10.0, 8.0
"""Speed of the first point and the way to the second one, rad/s."""


def test_each_point_is_next_to_the_one_before() -> None:
    assert list(serpentine((2, 3))) == [(0, 0), (0, 1), (0, 2), (1, 2), (1, 1), (1, 0)]
    assert list(serpentine((3,))) == [(0,), (1,), (2,)]


def test_factors_on_loads_begin_at_zero() -> None:
    np.testing.assert_allclose(load_factors("0..1", 3), [0.0, 0.5, 1.0])
    with pytest.raises(ModelError, match="contains a negative factor"):
        load_factors("-0.5..1", 3)


@pytest.mark.parametrize(("reach", "is_found"), [(SPAN, True), (0.3 * SPAN, True), (0.01 * SPAN, False)])
def test_a_point_that_is_far_is_found_by_parts_of_the_way(
    monkeypatch: pytest.MonkeyPatch, reach: float, is_found: bool
) -> None:
    """A search that reaches no further than some change of the speed, at once or by halves of the way."""
    drive = held_at(better(two_pulley()), None)

    def speed(of: Drive) -> float:
        return float(of.pulleys[0].driven_speed())

    def search(of: Drive, *, force_tolerance: float | None, start: Run | None) -> Run:
        if start is not None and abs(speed(of) - speed(start.drive)) > reach:
            raise ConvergenceError(f"too far to {speed(of):g}")
        return steady_state(of, force_tolerance=force_tolerance)

    monkeypatch.setattr(operating_points, "steady_state", search)
    axes = {"speed": (Variable(("speed",), "rad/s", "Speed"), [FIRST, FIRST + SPAN])}
    with OperatingPoints("operating_map", drive, axes) as table:
        table.each(lambda speed: at_speed(drive, 0, speed), 0.05, stride=np.inf)
    speeds = table.result().dataset.pulley_speed[:, 0]
    np.testing.assert_allclose(speeds, [FIRST, FIRST + SPAN if is_found else np.nan])
    assert table.arrays["failure"].tolist() == ["", "" if is_found else "too far to 18"]


@pytest.mark.parametrize(("share", "is_found"), [(0.3, True), (0.0626, True), (0.0624, False)])
def test_parts_of_the_way_are_halved_down_to_a_sixteenth(share: float, is_found: bool) -> None:
    """A search that reaches a share of the way from the point found last."""
    table = OperatingPoints("operating_map", example("two_pulley"), {})
    table._near, table._near_at = SimpleNamespace(), (FIRST,)  # type: ignore[assignment]

    def search(there: Sequence[float]) -> Run:
        if abs(there[0] - table._near_at[0]) > share * SPAN:
            raise ConvergenceError("too far")
        return SimpleNamespace(at=there[0])  # type: ignore[return-value]

    if is_found:
        assert table._reach(search, np.array([FIRST + SPAN]), np.inf).at == FIRST + SPAN  # type: ignore[attr-defined]
        return
    with pytest.raises(ConvergenceError, match="too far"):
        table._reach(search, np.array([FIRST + SPAN]), np.inf)


def test_strides_are_no_longer_than_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    drive, asked = held_at(better(two_pulley()), None), list[float]()

    def search(of: Drive, *, force_tolerance: float | None, start: Run | None) -> Run:
        asked.append(float(of.pulleys[0].driven_speed()))
        return steady_state(of, force_tolerance=force_tolerance, start=start)

    monkeypatch.setattr(operating_points, "steady_state", search)
    with OperatingPoints(
        "operating_map", drive, {"speed": (Variable(("speed",), "rad/s", "Speed"), [10.0, 18.0])}
    ) as table:
        table.each(lambda speed: at_speed(drive, 0, speed), 0.05, stride=3.0)
    np.testing.assert_allclose(asked, [10.0, 13.0, 16.0, 18.0])


def test_tensioners_have_the_unit_of_their_motion() -> None:
    axes = {"speed": (Variable(("speed",), "rad/s", "Speed"), [10.0])}
    about = Variable(("tensioner",), "m or rad", "Position")
    table = OperatingPoints("operating_map", example("alternator_drive"), axes)
    assert (table._labelled(about).units, table._labelled(about).dims) == ("rad", ("speed", "tensioner"))
    assert table._labelled(Variable(("tensioner",), "N", "Force")).units == "N"


def test_points_are_counted_and_the_file_is_written_about_once_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    """Points of 0.3 s each: every fourth one writes, and leaving the table."""
    clock, saved, progress = iter(np.arange(0.0, 100.0, 0.3)), list[int](), list[Progress]()
    monkeypatch.setattr(operating_points, "time", SimpleNamespace(perf_counter=lambda: next(clock)))

    class Counted(OperatingPoints):
        def _find(self, *_: object) -> None:
            pass

        def _save(self) -> None:
            saved.append(self._done)
            super()._save()

    axes = {"speed": (Variable(("speed",), "rad/s", "Speed"), np.arange(1.0, 11.0))}
    with Counted("operating_map", example("two_pulley"), axes, progress=progress.append) as table:
        table.each(lambda speed: table._drive, None)
    assert saved == [4, 8, 10]
    assert progress == [Progress(done, 10.0, 0.0, done, "operating points") for done in range(11)]


def test_a_warning_of_many_points_names_the_worst_and_where_it_applies() -> None:
    axes = {"load": (Variable(("load",), "1", "Load"), [0.1, 0.2, 0.3, 0.4, 0.5])}
    table = OperatingPoints("operating_map", example("two_pulley"), axes)
    for place, weight in ((1, 0.5), (2, 2.0), (4, 1.0)):
        table._warn((place,), "slip", f"slip {weight:g}.", weight)
    for place in (0, 2, 3):
        table._warn((place,), "rest", "rest.")
    table._warn((4,), "alone", "alone.", 1.0)
    assert list(table._warnings()) == [
        "at load 0.3: slip 2. This is the worst of 3 points, from load 0.2 to load 0.5.",
        "at load 0.1: rest. The same applies at 2 more points, up to load 0.4.",
        "at load 0.5: alone.",
    ]


def test_loads_of_teeth_are_found_where_some_are_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take further work, and belong to pulleys with teeth alone."""
    run = steady_state(example("timing_drive"), force_tolerance=0.5)
    means, loads = means_of(run), tooth_loads(run)
    found = values_by_name(run, means, ["tooth_load"])
    names = [one.name for one in run.drive.pulleys]
    expected = dict.fromkeys(names, np.nan) | {one.name: one.largest for one in loads}
    np.testing.assert_array_equal(found["tooth_load"], [expected[name] for name in names])
    monkeypatch.setattr(operating_points, "tooth_loads", None)
    assert "tooth_load" not in values_by_name(run, means, ["hub_load"])


Analysis = Callable[[Drive, Path], Result]
SHAKEN = [{"order": 2, "amplitude": 0.02}]


def shaken(drive: Drive) -> Drive:
    return drive.replace(pulley=[drive.pulleys[0].replace(harmonics=SHAKEN), *drive.pulleys[1:]])


def duty_of(drive: Drive, folder: Path) -> Result:
    table = folder / "duty.csv"
    table.write_text("duration [s], load\n1, 0.5\n1, 0.6\n1, 0.7\n", encoding="utf-8")
    return duty(drive, table=table, force_tolerance=0.05)


ANALYSES: dict[str, Analysis] = {
    "map": lambda drive, _: operating_map(drive, load="0.5, 0.6, 0.7", force_tolerance=0.05),
    "duty": duty_of,
    "traction": lambda drive, _: traction(drive, slip="0.01, 0.02, 0.03 %", force_tolerance=0.05),
    "campbell": lambda drive, _: campbell(drive, speed="100, 110, 120 rad/s", count=2, force_tolerance=0.05),
    "response": lambda drive, _: response(shaken(drive), speed="100, 110, 120 rad/s", force_tolerance=0.05),
}


@pytest.fixture(scope="module")
def loaded() -> Drive:
    return better(loaded_two_pulley())


@pytest.mark.parametrize("broken", [{0}, {1}, {0, 1}, {1, 2}], ids=str)
@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=pytest.mark.slow) if one in ("campbell", "response") else one for one in ANALYSES]
)
def test_whatever_goes_wrong_at_points_leaves_the_others(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, loaded: Drive, name: str, broken: set[int]
) -> None:
    """An error that nobody has thought of, at the first point, in the middle, and at all but one."""
    count = iter(range(1000))

    def search(of: Drive, *, force_tolerance: float | None, start: Run | None) -> Run:
        if next(count) in broken:
            raise IndexError("index 0 is out of bounds")
        return steady_state(of, force_tolerance=force_tolerance, start=start)

    monkeypatch.setattr(operating_points, "steady_state", search)
    found = ANALYSES[name](loaded, tmp_path)
    told = "IndexError: index 0 is out of bounds"
    assert found.status == "completed"
    assert [told in text for text in found.dataset.failure.values] == [place in broken for place in range(3)]
    assert found.dataset.belt_speed.isnull().values.tolist() == [place in broken for place in range(3)]
    assert any(told in warning for warning in found.warnings)


@pytest.mark.parametrize(
    ("name", "further"), [("campbell", "beltdyn.vibration.campbell.about_steady"),
                          ("response", "beltdyn.vibration.response.ForcedMotion")],
)  # fmt: skip
def test_vibrations_that_are_not_found_leave_those_of_other_speeds(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, loaded: Drive, name: str, further: str
) -> None:
    module, _, function = further.rpartition(".")
    own, count = getattr(import_module(module), function), iter(range(1000))

    def fails_once(*arguments: Any) -> Any:
        if next(count) == 1:
            raise ValueError("not finite")
        return own(*arguments)

    monkeypatch.setattr(import_module(module), function, fails_once)
    found = ANALYSES[name](loaded, tmp_path).dataset
    assert ["ValueError: not finite" in text for text in found.failure.values] == [False, True, False]
    assert found.belt_speed.notnull().all()
    lines = found.frequency if name == "campbell" else found.span_tension_amplitude
    assert lines.isnull().all(lines.dims[1:]).values.tolist() == [False, True, False]


@pytest.mark.parametrize("name", ANALYSES)
def test_an_interruption_after_points_that_failed_keeps_the_table(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, loaded: Drive, name: str
) -> None:
    count = iter(range(1000))

    def search(of: Drive, *, force_tolerance: float | None, start: Run | None) -> Run:
        if next(count):
            raise KeyboardInterrupt
        raise ModelError("the belt is slack")

    monkeypatch.setattr(operating_points, "steady_state", search)
    found = ANALYSES[name](loaded, tmp_path)
    assert found.status == "interrupted"
    assert found.dataset.failure.values.tolist() == ["the belt is slack", "", ""]


def test_where_no_point_is_found_the_first_error_is_told(loaded: Drive) -> None:
    with pytest.raises(ModelError, match=r"^nothing drives the belt"):
        operating_map(loaded, speed="0 rpm")
    with pytest.raises(ModelError, match=r"^no steady running at any of 2 points\. The first one: nothing drives"):
        operating_map(loaded, speed="0 rpm", load="0.5, 1")


@pytest.mark.parametrize("analysis", [operating_map, partial(campbell, count=2), response])
def test_a_range_may_begin_at_standstill(loaded: Drive, analysis: Callable[..., Result]) -> None:
    found = analysis(shaken(loaded), speed="0, 60, 120 rpm", force_tolerance=0.05)
    reasons = ["nothing drives the belt: every prescribed speed is zero.", "", ""]
    assert found.dataset.failure.values.tolist() == reasons

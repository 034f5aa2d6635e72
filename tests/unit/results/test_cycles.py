"""The window that means are taken over, on a result made by formulas: what repeats drops out."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import Drive, loads
from beltdyn.results import Run, summarize
from beltdyn.results.cycles import mean_window, turn_window

MakeRun = Callable[..., Run]
OUTPUTS = 1001
HARMONICS = "harmonics = [{ order = 2, amplitude = 0.1 }, { order = 3, amplitude = 0.1 }]\n"


def running(make_run: MakeRun, drive: Drive, turn: float, **changed: np.ndarray) -> Run:
    """A belt that takes so long for a turn, s."""
    speed = np.full((OUTPUTS, 2), drive.belt_length / turn)
    made = make_run(outputs=OUTPUTS, belt_speed=speed, **changed)
    return Run(made.dataset, drive)


def steady(drive_text: str, extra: str = "", speed: str = '{ kind = "constant", value = 12.0 }') -> Drive:
    """The drive of the paper at a constant speed."""
    head, _, tail = drive_text.partition("speed = ")
    return loads(f"{head}speed = {speed}\n{extra}{tail.partition(chr(10))[2]}")


@pytest.mark.parametrize(
    ("turn", "turns", "taken"),
    [(0.03, 3, 0.09), (0.07, 1, 0.07), (0.31, 1, 0.31), (0.7, 0, 2 * 0.035), (1e9, 0, 0.1)],
)
def test_whole_turns_that_fit(make_run: MakeRun, drive_text: str, turn: float, turns: int, taken: float) -> None:
    """As many as fit into a tenth, at least one if that is at most half of the run; else whole elements, of 20."""
    run = running(make_run, steady(drive_text), turn)
    window = mean_window(run.dataset, run.prepared)
    assert window.turns == turns
    assert window.end - window.start == pytest.approx(taken, rel=1e-6)


def test_one_turn_has_one_mean(make_run: MakeRun, drive_text: str) -> None:
    """Whatever the wave that repeats in every turn, wherever the turn starts: to rounding for straight pieces."""
    time = np.linspace(0.0, 1.0, OUTPUTS)
    for order in (1, 3, 20):
        wave = 1.0 + np.sin(2.0 * np.pi * order * time / 0.31 + 0.4)
        run = running(make_run, steady(drive_text), 0.31, shaft_torque=np.column_stack([wave, wave]))
        assert summarize(run).pulleys[0].shaft_torque == pytest.approx(1.0, abs=2e-4)


def test_harmonics_and_turns_that_are_no_multiples_of_each_other(make_run: MakeRun, drive_text: str) -> None:
    """Of the orders 2 and 3 the whole turn of the shaft repeats: 0.157 s at 40 rad/s; a turn of the belt is 0.21 s."""
    time = np.linspace(0.0, 1.0, OUTPUTS)
    angle = np.column_stack([40.0 * time, 39.0 * time])
    wave = 1.0 + np.cos(2.0 * angle[:, 0]) + np.cos(3.0 * angle[:, 0] + 1.0) + np.sin(2.0 * np.pi * time / 0.21)
    run = running(
        make_run, steady(drive_text, HARMONICS), 0.21, shaft_angle=angle, shaft_torque=np.column_stack([wave, wave])
    )
    window = mean_window(run.dataset, run.prepared)
    assert window.end - window.start == pytest.approx(2.0 * np.pi / 40.0 + 0.21, rel=1e-4)
    assert summarize(run).pulleys[0].shaft_torque == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("shape", ["saw", "pulses"])
def test_tables_that_repeat(make_run: MakeRun, drive_text: str, shape: str) -> None:
    """A period of 0.05 s, found within 0.2 %."""
    starts = 0.05 * np.arange(21)
    parts, values = ((0.0, 0.03), (11.0, 13.0)) if shape == "saw" else ((0.0, 0.001, 0.002, 0.003), (12, 12, 14, 12))
    times = (starts[:, None] + np.array(parts)).ravel()
    table = f'{{ kind = "table", times = {times.tolist()}, values = {list(map(float, np.tile(values, 21)))} }}'
    run = running(make_run, steady(drive_text, speed=table), 1e9)
    assert mean_window(run.dataset, run.prepared).end == 1.0
    run = running(make_run, steady(drive_text, speed=table), 0.1)
    window = mean_window(run.dataset, run.prepared)
    assert window.end - window.start == pytest.approx(0.15, rel=2e-3)


@pytest.mark.parametrize("values", [[0.0, 5.0, 12.0], [12.0, 9.0, 12.0]])
def test_tables_that_do_not_repeat(make_run: MakeRun, drive_text: str, values: list[float]) -> None:
    table = f'{{ kind = "table", times = [0.0, 0.4, 0.8], values = {values} }}'
    run = running(make_run, steady(drive_text, speed=table), 0.15)
    window = mean_window(run.dataset, run.prepared)
    assert window.start == pytest.approx(0.85)
    run = running(make_run, steady(drive_text, speed=table), 0.25)
    assert mean_window(run.dataset, run.prepared).start > 0.89, "a turn would reach back to before the last change"


def test_the_line_ends_in_the_number_of_the_summary(make_run: MakeRun, drive_text: str) -> None:
    """Where the window is one turn; the trailing means of the line are those of the summary."""
    time = np.linspace(0.0, 1.0, OUTPUTS)
    torque = np.random.default_rng(3).uniform(size=(OUTPUTS, 2)) + time[:, None]
    run = running(make_run, steady(drive_text), 0.2, shaft_torque=torque)
    line = turn_window(run.dataset, run.prepared).running_means(torque)
    np.testing.assert_allclose(line[-1], [one.shaft_torque for one in summarize(run).pulleys], rtol=1e-12)


def test_speeds_are_angles_over_time(make_run: MakeRun, drive_text: str) -> None:
    """Where outputs meet a vibration always in the same phase, their speeds are wrong, and angles are not."""
    time = np.linspace(0.0, 1.0, OUTPUTS)
    angle = np.column_stack([12.0 * time, 11.9 * time])
    run = running(make_run, steady(drive_text), 0.2, pulley_angle=angle, pulley_speed=np.full((OUTPUTS, 2), 12.0))
    assert summarize(run).pulleys[1].slip == pytest.approx(0.1 / 12.0)


def test_a_shaft_that_stands_at_first_keeps_nothing_unknown(make_run: MakeRun, drive_text: str) -> None:
    """As one behind a clutch: its harmonics do not make the windows before reach back to when it turns."""
    time = np.linspace(0.0, 1.0, OUTPUTS)
    angle = np.column_stack([40.0 * np.maximum(time - 0.6, 0.0), 40.0 * time])
    run = running(make_run, steady(drive_text, HARMONICS), 0.1, shaft_angle=angle)
    line = turn_window(run.dataset, run.prepared).running_means(angle)
    assert np.isfinite(line[time > 0.13]).all()
    assert line[time < 0.4][-1, 0] == 0.0

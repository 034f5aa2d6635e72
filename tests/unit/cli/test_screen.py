"""What a run shows on the screen."""

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from beltdyn.cli.app import app
from beltdyn.cli.console import show_table
from beltdyn.cli.output import show_result
from beltdyn.cli.progress import progress_bar, runs_bar
from beltdyn.model import Drive
from beltdyn.results import Run, TensionerSummary, summarize
from beltdyn.solvers.run_progress import BatchProgress, Progress

RunMain = Callable[[list[str]], tuple[int, str, str]]


def test_summary(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    show_result(run)
    output = " ".join(capsys.readouterr().out.split())
    for part in (
        "driver 114.59 2.438 29.25 0.000% 0.000% 180.0° 0.0° 2.00 43 3.66 3.66 90.00",
        "0.500%",
        "180.0°",
        "29.25 W in, 29.1 W out",
        "96.04%",
        "1.2 W: friction 1.08 W, contact damping 0.12 W",
        "driven-driver 60.00 60.00 60.00 60.00 60.00 0.9750",
        "energy balance closes within 1.0e-04 of the energy",
        "time steps 1200 accepted, 14 rejected; 101 outputs",
    ):
        assert part in output
    assert "computing time 0.5 s (0.5 s per simulated second), plus 2.5 s of preparation" in output


def test_the_name_of_a_drive_stands_above(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    show_result(Run(run.dataset, run.drive.replace(name="Fan of the paint shop")))
    assert capsys.readouterr().out.startswith("\nFan of the paint shop\n")


def test_tensioners_stand_in_degrees_or_millimetres(
    run: Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """An arm by its angle from the x axis: it hangs from its pivot at -90°, and turns so that the path lengthens."""
    tensioners = (TensionerSummary("driver", True, 0.2, 0.1, 0.3), TensionerSummary("driven", False, *3 * (2e-3,)))
    summary = replace(summarize(run), tensioners=tensioners)
    monkeypatch.setattr("beltdyn.show.sheet.summarize", lambda _: summary)
    x, y = run.drive.pulleys[0].center
    arm = {"kind": "rotary", "pulley": "driver", "pivot": (x, y + 1.0), "preload": 1.0, "rate": 1e3, "inertia": 1.0}
    slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0, "rate": 1e4}
    show_result(Run(run.dataset, run.drive.replace(tensioner=[arm, slide])))
    output = " ".join(capsys.readouterr().out.split())
    sense = -1.0 if run.drive.pulleys[1].center[0] > x else 1.0
    place, *ends = (np.degrees(sense * angle) - 90.0 for angle in (0.2, 0.1, 0.3))
    low, high = sorted(ends)
    assert f"arm angle of driver {place:.4g}° (range {low:.4g}° to {high:.4g}°) tensioner of driven 2 mm" in output


def test_summary_of_a_static_equilibrium(make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]) -> None:
    """A single output at rest has no mean and no slip."""
    show_result(make_run(outputs=1))
    output = capsys.readouterr().out
    assert "means" not in output
    assert "nan" not in output
    assert "efficiency" not in output


def test_steady_running_is_over_no_time(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    show_result(Run(run.dataset.assign_attrs(belt_parameter=1.0), run.drive))
    output = capsys.readouterr().out
    assert "Pulleys (steady running)" in output
    assert "Spans (steady running)" in output
    assert "means" not in output


@pytest.mark.parametrize(("slip", "written"), [(-1e-9, "0.000%"), (-0.0, "0.000%"), (-1e-5, "-0.001%")])
def test_a_slip_that_rounds_to_zero_has_no_sign(
    run: Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], slip: float, written: str
) -> None:
    summary = summarize(run)
    driver, driven = summary.pulleys
    still = replace(summary, pulleys=(driver, replace(driven, slip=slip)))
    monkeypatch.setattr("beltdyn.show.sheet.summarize", lambda _: still)
    show_result(run)
    row = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("driven "))
    assert row.split()[4] == written


def test_no_load_no_efficiency(make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]) -> None:
    show_result(make_run(shaft_torque=np.tile([1.0, 0.0], (101, 1))))
    assert "none (no power output)" in capsys.readouterr().out


def test_several_shafts_that_put_power_in_are_named(
    make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]
) -> None:
    show_result(make_run(shaft_torque=np.tile([1.0, 2.0], (101, 1))))
    assert "35.88 W in (driver 12 W, driven 23.88 W), 0 W out" in capsys.readouterr().out


def test_large_powers_are_in_kilowatts(
    run: Run, make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]
) -> None:
    show_result(make_run(shaft_torque=1000.0 * run.dataset["shaft_torque"].values))
    output = " ".join(capsys.readouterr().out.split())
    assert "power kW slip" in output.replace("N m kW", "power kW")
    assert "29.25 kW in, 29.1 kW out" in output


def test_nothing_in_a_table_is_cut_off(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, make_run: Callable[..., Run]
) -> None:
    """A narrow terminal breaks lines that are too long for it; a pipe has no width."""
    monkeypatch.setenv("COLUMNS", "60")
    run = make_run()
    run.dataset["pulley"] = ["motor of the machine", "flywheel of the compressor"]
    show_result(run)
    output = capsys.readouterr().out
    assert "flywheel of the compressor" in output
    assert "…" not in output


def test_seven_pulleys_fit_one_screen(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, run: Run
) -> None:
    """100 columns and 45 lines, the warnings of each among them."""
    summary = summarize(run)
    pulley = replace(
        summary.pulleys[1],
        name="power steering pump",
        speed=-1234.567,
        shaft_torque=-123.4,
        power=-12345.6,
        slip_safety=0.5,
    )
    span = replace(summary.spans[0], name="power steering pump-air conditioning", tension=1234.5)
    full = replace(summary, pulleys=(pulley,) * 7, spans=(span,) * 7)
    monkeypatch.setitem(run.__dict__, "warnings", ["a warning."] * 7)  # where a cached property keeps its value
    monkeypatch.setitem(run.drive.__dict__, "guides", np.zeros(7, bool))
    monkeypatch.setattr("beltdyn.show.sheet.summarize", lambda _: full)
    monkeypatch.setenv("COLUMNS", "100")
    show_result(run)
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 45
    assert max(map(len, lines)) <= 100
    assert not any("…" in line for line in lines)
    assert sum("power steering pump " in line for line in lines) == 7


def test_warnings_are_shown(make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]) -> None:
    show_result(make_run(energy_closure=np.full(101, 0.02)))
    assert "warning: " in capsys.readouterr().out


def test_progress(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_bar() as report:
        report(Progress(time=0.25, duration=1.0, step_size=1e-4, outputs_written=3))
    captured = capsys.readouterr()
    assert "0.25 of 1 s, step 1.0e-04 s" in captured.err
    assert captured.out == ""


def test_a_run_that_takes_long_is_told_of_once_and_why(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_bar() as report:
        for time, elapsed in ((0.02, 40.0), (0.06, 120.0), (0.07, 140.0)):
            report(Progress(time, 1.0, 1e-6, 3, elapsed=elapsed, bound="Steps are short."))
    shown = " ".join(capsys.readouterr().err.split())
    assert shown.count("This run will take about 31 minutes more at") == 1
    assert "Steps are short." in shown


def test_a_short_run_is_not_told_of(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_bar() as report:
        report(Progress(0.5, 1.0, 1e-6, 3, elapsed=8.0, bound="Steps are short."))
    assert "will take" not in capsys.readouterr().err


def test_runs_that_take_long_are_told_of_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [0.0]
    monkeypatch.setattr("beltdyn.cli.progress.perf_counter", lambda: now[0])
    with runs_bar() as report:
        for part, now[0] in ((0.0, 0.0), (0.04, 20.0), (0.24, 120.0), (0.28, 140.0)):
            report(BatchProgress(0, 4, {Path("long.nc"): part}))
    shown = " ".join(capsys.readouterr().err.split())
    assert shown.count("These runs will take about 31 minutes more at") == 1


def test_without_a_terminal_a_line_a_minute_tells_of_the_work(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [0.0]
    monkeypatch.setattr("beltdyn.cli.progress.perf_counter", lambda: now[0])
    with runs_bar() as report:
        for done, now[0] in ((0, 0.0), (1, 30.0), (1, 70.0), (2, 100.0), (3, 140.0)):
            report(BatchProgress(done, 4, {}))
    shown = capsys.readouterr().err
    assert "1 of 4 runs; about 2 minutes more\n" in shown
    assert "3 of 4 runs; a minute or two more\n" in shown
    assert "2 of 4 runs;" not in shown
    now[0] = 0.0
    with progress_bar() as report:
        now[0] = 61.0
        report(Progress(0.25, 1.0, 1e-4, 3, elapsed=61.0))
    assert "simulating, 0.25 of 1 s, step 1.0e-04 s; about 3 minutes more\n" in capsys.readouterr().err


def test_runs_of_different_lengths_are_forecast_by_their_share(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Half of the work after two of many runs: as much time is left as has passed, whatever the runs are called."""
    now = [0.0]
    monkeypatch.setattr("beltdyn.cli.progress.perf_counter", lambda: now[0])
    with runs_bar() as report:
        report(BatchProgress(0, 40, {Path("long.nc"): 0.0}, share=0.0))
        now[0] = 300.0
        report(BatchProgress(2, 40, {}, share=0.5, kind="timed runs"))
    assert "2 of 40 timed runs; about 5 minutes more\n" in capsys.readouterr().err


def test_progress_of_many(capsys: pytest.CaptureFixture[str]) -> None:
    """A line for all, and one for each that is on its way."""
    with runs_bar(at_end="writing the page") as report:
        report(BatchProgress(0, 3, {}))
        report(BatchProgress(1, 3, {Path("runs/first.nc"): 0.2, Path("runs/second.nc"): 0.9}))
        report(BatchProgress(2, 3, {Path("runs/second.nc"): 1.0}))
    shown = capsys.readouterr().err
    assert "2 of 3 runs" in shown
    assert "second" in shown
    assert "first" not in shown
    with runs_bar(at_end="writing the page") as report:
        report(BatchProgress(3, 3, {}))
    assert "writing the page" in capsys.readouterr().err


def end_as(monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
    """Let simulations write a run, and give it."""

    def simulate(drive: Drive, output: Path) -> Run:
        run.save(output)
        return run

    app["simulate"].default_command = None  # it is made of the function
    monkeypatch.setattr(import_module("beltdyn.transient.simulate"), "simulate", simulate)


def test_run_with_tables(run_main: RunMain, run: Run, drive_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    end_as(monkeypatch, run)
    code, output, _ = run_main(["simulate", str(drive_file), "--csv"])
    assert code == 0
    assert f"Results: {drive_file.with_suffix('.nc')}" in output
    tables = drive_file.with_name("drive-tables")
    over_time = {"pulleys.csv", "spans.csv", "energy.csv", "contact.csv"}
    assert {path.name for path in tables.iterdir()} == over_time | {
        "pulley_summary.csv",
        "span_summary.csv",
        "losses.csv",
    }


@pytest.mark.parametrize(
    ("warnings", "words", "code", "error"),
    [
        (["the belt is slack."], ["--strict"], 4, "error: 1 warning, which --strict treats as errors."),
        (
            ["the belt is slack.", "it flutters."],
            ["--strict"],
            4,
            "error: 2 warnings, which --strict treats as errors.",
        ),
        (["the belt is slack."], [], 0, ""),
        ([], ["--strict"], 0, ""),
    ],
)
def test_strict_run(
    run_main: RunMain,
    run: Run,
    drive_file: Path,
    monkeypatch: pytest.MonkeyPatch,
    warnings: list[str],
    words: list[str],
    code: int,
    error: str,
) -> None:
    monkeypatch.setitem(run.__dict__, "warnings", warnings)  # where a cached property keeps its value
    end_as(monkeypatch, run)
    found, output, message = run_main(["simulate", str(drive_file), *words])
    assert found == code
    assert message.count("error: ") == (1 if error else 0)
    assert error in message
    assert "Results: " in output


def test_a_wide_table_moves_together_before_it_cuts_names(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Ten columns of six letters are 78 wide with gaps of two, and 69 with gaps of one."""
    monkeypatch.setenv("COLUMNS", "72")
    words = [f"name{number:02}" for number in range(10)]
    show_table("", words, [words])
    assert capsys.readouterr().out.split() == 2 * words

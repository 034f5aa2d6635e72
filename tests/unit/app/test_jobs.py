"""Analyses in processes of their own."""

import math
import time
from pathlib import Path

import pytest

from beltdyn.app.jobs import Job, Outcome, _first_fact, _Teller
from beltdyn.results import open_result
from beltdyn.show.tables import Facts, Table
from beltdyn.solvers.run_progress import Progress


def ended(job: Job) -> Outcome:
    while job.outcome is None:
        time.sleep(0.05)
        job.poll()
    return job.outcome


@pytest.mark.slow
def test_a_duty_table_of_the_folder_is_read(drive_text: str, tmp_path: Path) -> None:
    table = tmp_path / "duty.csv"
    table.write_text("duration [s],driver speed [rad/s]\n10,6\n20,12\n", encoding="utf-8")
    outcome = ended(Job("duty", drive_text, tmp_path, tmp_path / "drive-duty.nc", {"table": table}))
    assert (outcome.status, outcome.error) == ("completed", "")
    assert outcome.best is None


def test_time_that_is_left_is_told_where_an_analysis_does_not_know_its_pace(tmp_path: Path) -> None:
    """By the share that was done since its beginning: of a quarter in one second, three are left."""
    teller = _Teller(None, tmp_path)  # type: ignore[arg-type]
    progress = Progress(0.0, 4.0, 0.0, 0, "operating points")
    assert math.isnan(teller._remaining(progress, 0.0, 10.0))
    assert teller._remaining(progress, 0.25, 11.0) == 3.0


@pytest.mark.slow
def test_a_result_and_its_report_are_written(drive_text: str, tmp_path: Path) -> None:
    outcome = ended(Job("equilibrium", drive_text, tmp_path, tmp_path / "drive-equilibrium.nc", {}))
    assert (outcome.status, outcome.error) == ("completed", "")
    assert outcome.result is not None
    assert outcome.report is not None
    assert open_result(outcome.result).kind == "equilibrium"
    assert outcome.report.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert outcome.parts


def test_what_fails_says_why(drive_text: str, tmp_path: Path) -> None:
    outcome = ended(Job("traction", drive_text, tmp_path, tmp_path / "x.nc", {"pulley": "none"}))
    assert outcome.status == "failed"
    assert '"none"' in outcome.error or "'none'" in outcome.error


@pytest.mark.slow
def test_a_run_that_is_cancelled_keeps_what_was_computed(drive_text: str, tmp_path: Path) -> None:
    job = Job("simulate", drive_text.replace("duration = 1.0", "duration = 50.0"), tmp_path, tmp_path / "drive.nc", {})
    while job.outcome is None and job.step.phase != "integrating":
        time.sleep(0.05)
        job.poll()
    while job.outcome is None and (job.step.glimpse is None or job.step.glimpse.time == 0.0):
        time.sleep(0.05)  # it is watched while it runs
        job.poll()
    job.cancel()
    outcome = ended(job)
    assert (outcome.status, outcome.error) == ("interrupted", "")


def test_a_process_that_is_killed_is_told(drive_text: str, tmp_path: Path) -> None:
    job = Job("equilibrium", drive_text, tmp_path, tmp_path / "x.nc", {})
    job._process.kill()
    outcome = ended(job)
    assert outcome.status == "failed"
    assert "unexpectedly" in outcome.error


def test_closing_ends_the_process(drive_text: str, tmp_path: Path) -> None:
    job = Job("equilibrium", drive_text, tmp_path, tmp_path / "x.nc", {})
    job.close()
    assert not job._process.is_alive()
    assert job.outcome is not None


def test_the_first_fact_is_of_the_drive() -> None:
    facts = Facts(
        (("mesh", "20 elements"), ("computing time", "1 s"), ("Largest torque", "308 N m"), ("mesh errors", ""))
    )
    assert _first_fact((Table("", ("", "N"), ()), facts)) == "Largest torque: 308 N m"
    assert _first_fact((Facts((("mesh", "20 elements"),)),)) == ""

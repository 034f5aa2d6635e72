"""Fleeting angles in a report."""

from pathlib import Path

import pytest

from beltdyn.results import Run
from beltdyn.show.report import write_report

TITLE = "Fleeting angles (geometry only: the dynamics are planar)"


@pytest.mark.slow
def test_a_report_has_the_fleeting_angles_of_a_drive_with_offsets(run: Run, tmp_path: Path) -> None:
    plain = write_report(run, tmp_path / "plain.html").read_text(encoding="utf-8")
    assert TITLE not in plain
    moved = Run(run.dataset, run.drive.with_({"pulley[driven].axial_offset": "2 mm"}))
    text = write_report(moved, tmp_path / "moved.html").read_text(encoding="utf-8")
    assert TITLE in text
    assert text.count("driver to driven") > plain.count("driver to driven")

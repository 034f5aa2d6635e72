"""What a notebook shows of a run: its numbers and its warnings."""

from collections.abc import Callable

import numpy as np

from beltdyn.results import Run


def test_means_and_warnings_are_shown(run: Run, make_run: Callable[..., Run]) -> None:
    shown = run._repr_html_()
    assert "Completed; 101 outputs" in shown
    assert "<td>driven</td>" in shown
    assert "0.500 %" in shown
    slack = make_run(span_tension=np.full((101, 2), -1.0))._repr_html_()
    assert "<strong>Warning:</strong>" in slack
    assert "goes slack" in slack


def test_a_run_without_outputs_shows_its_drive(run: Run) -> None:
    empty = Run(run.dataset.isel(time=slice(0)), run.drive)
    shown = empty._repr_html_()
    assert "<svg" in shown
    assert "nothing was recorded" in shown

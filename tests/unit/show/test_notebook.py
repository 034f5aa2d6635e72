"""What a notebook shows of a result: its numbers and its warnings."""

import re
from collections.abc import Callable

import numpy as np
import xarray as xr

from beltdyn.results import Result, Run


def test_means_and_warnings_are_shown(run: Run, make_run: Callable[..., Run]) -> None:
    shown = run._repr_html_()
    assert "Run, completed." in shown
    assert re.search(r'<th scope="row"[^>]*>driven</th>', shown)
    assert "<td>0.500%</td>" in shown
    assert re.search(r"<tr><th[^>]*>efficiency</th><td[^>]*>[\d.]+%</td></tr>", shown)
    slack = make_run(span_tension=np.full((101, 2), -1.0))._repr_html_()
    assert "<strong>Warning:</strong>" in slack
    assert "goes slack" in slack


def test_a_run_without_outputs_shows_its_drive(run: Run) -> None:
    empty = Run(run.dataset.isel(time=slice(0)), run.drive)
    shown = empty._repr_html_()
    assert "<svg" in shown
    assert "nothing was recorded" in shown


def test_results_of_other_analyses_show_their_tables(run: Run) -> None:
    tension = ("span", [60.0, 30.0], {"units": "N", "long_name": "Span tension"})
    attributes = {"kind": "other", "title": "Belt drive, other", "status": "completed", "warnings": "it is <wrong>."}
    dataset = xr.Dataset({"span_tension": tension}, {"span": ["a", "b"]}, attributes)
    shown = Result(dataset, run.drive)._repr_html_()
    assert "<td>60.000</td>" in shown
    assert "it is &lt;wrong&gt;." in shown

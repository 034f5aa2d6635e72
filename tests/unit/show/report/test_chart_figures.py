"""Figures of a report."""

from dataclasses import replace

import pytest
from matplotlib.figure import Figure

from beltdyn.errors import ModelError, Parts
from beltdyn.results import Run
from beltdyn.show.plot.figures import FIGURES, chosen_by_default
from beltdyn.show.report.chart import charted


@pytest.mark.slow
def test_figures_of_lines_have_charts_and_others_have_none(run: Run) -> None:
    shown, charts = charted([run], Parts())
    assert [one.name.lower().replace(" ", "_") for one in shown] == list(chosen_by_default([run]))
    by_name = {one.name: one for one in shown}
    assert by_name["Speeds"].charts == ["speeds-0"]
    assert by_name["Configuration"].charts == by_name["Hub loads"].charts == []
    assert set(charts) == {place for one in shown for place in one.charts}


def test_a_figure_that_cannot_be_drawn_says_why(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """As contact forces of drives with other pulleys."""

    def refuse(*_: object) -> Figure:
        raise ModelError("the pulley is not in this drive.")

    for name in chosen_by_default([run]):
        monkeypatch.setitem(FIGURES._kinds, name, replace(FIGURES[name], arrange=refuse))
    shown, charts = charted([run], Parts())
    assert {one.missing for one in shown} == {"the pulley is not in this drive."}
    assert charts == {}

"""Figures of a report."""

from beltdyn.plot.figures import chosen_by_default
from beltdyn.report.figures import charted
from beltdyn.results import Run


def test_figures_of_lines_have_charts_and_others_have_none(run: Run) -> None:
    shown, charts = charted([run])
    assert [one.name.lower().replace(" ", "_") for one in shown] == list(chosen_by_default([run]))
    by_name = {one.name: one for one in shown}
    assert by_name["Speeds"].charts == ["speeds-0"]
    assert by_name["Configuration"].charts == by_name["Hub loads"].charts == []
    assert set(charts) == {place for one in shown for place in one.charts}

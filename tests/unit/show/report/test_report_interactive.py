"""Figures for notebooks."""

from html import unescape

import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.show.report import interactive


def test_a_notebook_gets_charts_in_a_frame_that_fetches_nothing(run: Run) -> None:
    shown = interactive(run, "slip", "span_tensions")
    assert repr(shown) == "InteractiveFigures(Slip, Span tensions)"
    html = shown._repr_html_()
    assert html.startswith("<iframe srcdoc=")
    page = unescape(html.partition('srcdoc="')[2].partition('" style=')[0])
    assert page == shown.page
    assert 'id="slip-0"' in page
    assert "Bokeh" in page
    assert "<link" not in page
    assert 'src="http' not in page.partition("<script>")[0]


@pytest.mark.slow
def test_figures_of_a_report_are_drawn_by_default(run: Run) -> None:
    assert {"Speeds", "Configuration"} <= set(interactive([run]).names)


def test_a_figure_that_there_is_not_is_told(run: Run) -> None:
    with pytest.raises(ModelError, match="there is no figure 'nonsense'"):
        interactive(run, "nonsense")
    with pytest.raises(ModelError, match="campbell"):
        interactive(run, "campbell")

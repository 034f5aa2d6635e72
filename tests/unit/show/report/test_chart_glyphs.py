"""What is on a figure is on its chart too."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from beltdyn.results import Run
from beltdyn.show.plot.figures import FIGURES, Choice
from beltdyn.show.report.chart import can_be_charted, charts, thinned


def test_bands_areas_marks_and_words_are_drawn() -> None:
    ax = Figure().add_subplot(xlabel="Speed [rpm]", ylabel="Frequency [Hz]", title="modes")
    ax.plot([0.0, 4.0], [1.0, 2.0], label="first")
    ax.axhspan(0.0, 0.5)
    ax.stairs([0, 1, 1, 0], [0.0, 1.0, 2.0, 3.0, 4.0], transform=ax.get_xaxis_transform(), fill=True)
    ax.fill_between([0.0, 4.0], [1.0, 1.0], [2.0, 2.0], label="between")
    ax.scatter([1.0, 2.0], [1.0, 1.5])
    ax.add_collection(LineCollection([[(0.0, 0.0), (4.0, 1.0)]], label="bound"))
    ax.annotate("1", (4.0, 2.0), (3, 0), textcoords="offset points")
    ax.legend(handles=[Line2D([], [], marker="o", linestyle="", label="critical")])
    (chart,) = charts(ax.figure.figure)
    bounds = ("left", "right", "bottom", "top")
    found = [[getattr(one, name) for name in bounds] for one in chart.center if hasattr(one, "bottom")]
    boxes = [tuple(bound if isinstance(bound, float) else None for bound in box) for box in found]
    assert (None, None, 0.0, 0.5) in boxes
    assert (1.0, 3.0, None, None) in boxes
    assert [one.text.text for one in chart.center if hasattr(one, "x_offset")] == ["1"]
    assert [item.label.value for item in chart.legend[0].items] == ["first", "between", "bound", "critical"]
    points = [one.data_source.data for one in chart.renderers if list(one.data_source.data.get("x", [])) == [1.0, 2.0]]
    np.testing.assert_array_equal(points[0]["y"], [1.0, 1.5])


def test_bars_pictures_and_true_shapes_stay_as_they_are() -> None:
    bars, drawing, plain = (Figure().add_subplot() for _ in range(3))
    for ax in (bars, drawing, plain):
        ax.plot([0.0, 1.0])
    bars.barh([0, 1], [1.0, 2.0])
    drawing.set_aspect("equal")
    assert [can_be_charted(ax) for ax in (bars, drawing, plain)] == [False, False, True]


def test_lines_of_several_results_have_their_names() -> None:
    ax = Figure().add_subplot()
    for result in ("before", "after"):
        ax.plot([0.0, 1.0], label="driver", gid=result)
    (chart,) = charts(ax.figure.figure)
    assert [item.label.value for item in chart.legend[0].items] == ["driver, before", "driver, after"]


@pytest.mark.parametrize("name", ["speeds", "hub_load_sizes"])
def test_each_line_of_several_results_is_named_once(run: Run, name: str) -> None:
    """Also where the name of a result is a part of that of a pulley."""
    other = run.dataset.assign(hub_force=1.5 * run.dataset["hub_force"])
    pair = [Run(run.dataset, run.drive, Path("r.nc")), Run(other, run.drive, Path("e.nc"))]
    (chart,) = charts(FIGURES[name].arrange(pair, Choice()))
    names = [item.label.value for item in chart.legend[0].items]
    assert [(one.split(" ")[0].strip(","), one.split(", ")[-1]) for one in names] == [
        (pulley, result) for result in ("r", "e") for pulley in ("driver", "driven")
    ]


def test_panels_beside_each_other_have_the_label_that_they_share() -> None:
    figure = Figure()
    left, right = figure.subplots(1, 2, sharey=True)
    left.plot([0.0, 1.0])
    right.plot([0.0, 1.0])
    left.set_ylabel("Force [N]")
    assert [chart.yaxis[0].axis_label.text for chart in charts(figure)] == ["Force [N]", "Force [N]"]


@pytest.mark.parametrize("bins", [10, 97])
def test_peaks_survive_thinning(bins: int) -> None:
    x = np.linspace(0.0, 1.0, 10_000)
    values = np.column_stack([np.sin(50.0 * x), x])
    values[1234, 0], values[8765, 1], values[4000, 0] = 9.0, -7.0, np.nan
    thin_x, thin = thinned(x, values, bins)
    assert thin.shape == (2 * bins, 2) == (len(thin_x), 2)
    assert np.all(np.diff(thin_x) >= 0.0)
    np.testing.assert_array_equal(
        [np.nanmax(thin, axis=0), np.nanmin(thin, axis=0)], [np.nanmax(values, axis=0), np.nanmin(values, axis=0)]
    )


def test_few_points_stay() -> None:
    x, values = np.arange(5.0), np.arange(5.0)[:, None]
    assert thinned(x, values) == (x, values)

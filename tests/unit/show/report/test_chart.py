"""Figures as charts: the same lines."""

import numpy as np
from matplotlib.figure import Figure

from beltdyn.show.report.chart import charts


def test_lines_keep_names_numbers_and_labels() -> None:
    figure = Figure()
    ax = figure.add_subplot(xlabel="Time [s]", ylabel="Torque [N·m]")
    ax.plot([0.0, 1.0, 2.0], [3.0, np.nan, 5.0], label="driver")
    ax.plot([0.0, 1.0, 2.0], [1.0, 2.0, 3.0], label="driven", linestyle="--")
    ax.axhline(2.5)
    (chart,) = charts(figure)
    assert (chart.xaxis[0].axis_label.text, chart.yaxis[0].axis_label.text) == ("Time [s]", "Torque [N·m]")
    first, second = chart.renderers
    assert first.data_source is second.data_source  # read out together
    np.testing.assert_array_equal(first.data_source.data["y0"], [3.0, np.nan, 5.0])
    assert [item.label.value for item in chart.legend[0].items] == ["driver", "driven"]
    assert chart.center[-1].location == 2.5 or any(getattr(one, "location", None) == 2.5 for one in chart.center)


def test_a_figure_of_more_than_lines_stays_as_it_is() -> None:
    figure = Figure()
    figure.add_subplot().plot([0.0, 1.0])
    figure.add_subplot().imshow(np.eye(2))
    assert charts(figure) == []
    assert charts(Figure()) == []


def test_a_chart_with_many_names_is_higher_so_that_lines_have_room_below_them() -> None:
    heights = []
    for count in (3, 10):
        figure = Figure()
        ax = figure.subplots()
        for number in range(count):
            ax.plot([0.0, 1.0], [0.0, number], label=f"line {number}")
        heights += [chart.height for chart in charts(figure)]
    assert heights == [340, 340 + 6 * 24]

"""Speeds, torques, tensions and energies over time."""

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.results import Run
from beltdyn.results.energy_balance import losses_of
from beltdyn.show import plot
from beltdyn.show.plot.style import LIMIT


@pytest.mark.parametrize(
    ("draw", "variable", "ylabel"),
    [
        (plot.speeds, "pulley_speed", "Pulley speed [rad/s]"),
        (plot.torques, "pulley_torque", "Torque of the belt on the pulley [N·m]"),
        (plot.span_tensions, "span_tension", "Span tension [N]"),
    ],
)
def test_histories(run: Run, ax: Axes, draw: Callable[..., Axes], variable: str, ylabel: str) -> None:
    assert draw(run, ax) is ax
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Time [s]", ylabel)
    values = run.dataset[variable]
    for number, line in enumerate(ax.lines):
        np.testing.assert_array_equal(line.get_ydata(), values[:, number])
        assert line.get_label() == str(values[values.dims[1]][number].item())


def test_energy(run: Run, ax: Axes) -> None:
    plot.energy(run, ax)
    assert ax.get_ylabel() == "Energy [J]"
    assert [text.get_text() for text in ax.texts] == ["energy balance closes within 1.0e-04 of the energy input"]
    assert {str(line.get_label()) for line in ax.lines} >= {"Kinetic energy", "Work of the drivers", "Losses"}


def test_energy_has_the_sum_of_all_losses_and_nothing_negligible(run: Run, ax: Axes) -> None:
    plot.energy(run, ax)
    drawn = {str(line.get_label()): np.asarray(line.get_ydata()) for line in ax.lines}
    lost = sum(run.dataset[name].values for name in losses_of(run.dataset))
    np.testing.assert_allclose(drawn["Losses"], lost)
    sizes = [np.abs(values).max() for values in drawn.values()]
    assert min(sizes) > 0.01 * max(sizes)


def test_limits_of_the_drive_file_are_drawn(run: Run, ax: Axes) -> None:
    """The least tension is 45 N: a limit of 40 N is a line within the axes, and one of 5 kN is named at the edge."""
    limited = run.drive.replace(limits={"largest_tension": 5e3, "least_tension": 40.0})
    plot.span_tensions(Run(run.dataset, limited), ax)
    words = [text.get_text() for text in ax.texts if text.get_gid() == LIMIT]
    assert words == ["largest tension 5000 N ↑", "least tension 40 N"]
    low, high = ax.get_ylim()
    assert low < 40.0
    assert high < 100.0


def test_single_output_is_a_point(make_run: Callable[..., Run], ax: Axes) -> None:
    plot.speeds(make_run(outputs=1), ax)
    assert all(line.get_marker() == "o" for line in ax.lines)


def test_what_vibrates_is_drawn_without_dashes(make_run: Callable[..., Run], ax: Axes) -> None:
    """Six whole swings as high as the figure do, four do not."""
    time = np.linspace(0.0, 1.0, 101)
    swings = make_run(span_tension=50.0 + 9.0 * np.sin(2.0 * np.pi * np.outer(time, (4.0, 6.0))))
    plot.span_tensions(swings, ax)
    assert [line.get_linewidth() for line in ax.lines] == [1.7, 0.8]


def test_speeds_have_a_scale_in_rpm(run: Run, ax: Axes) -> None:
    plot.speeds(run, ax)
    (scale,) = ax.child_axes
    assert scale.get_ylabel() == "[rpm]"
    ax.figure.canvas.figure.draw_without_rendering()
    np.testing.assert_allclose(scale.get_ylim(), np.multiply(ax.get_ylim(), 30.0 / np.pi))

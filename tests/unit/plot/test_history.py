"""Speeds, torques, tensions and energies over time."""

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn import plot
from beltdyn.results import Run


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
    assert ax.get_title(loc="left") + ax.get_title() == "Closure error up to 1.0e-04 of the energy put in"
    assert {str(line.get_label()) for line in ax.lines} >= {"Kinetic energy", "Work of the drivers", "Friction loss"}


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

"""Order cuts as they are drawn."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.show import plot
from beltdyn.vibration.response import response
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> bd.Result:
    drive = better(loaded_two_pulley())
    driver, driven = drive.pulleys
    shaken = drive.replace(pulley=[driver.replace(harmonics=[{"order": 2, "amplitude": 0.002}]), driven])
    table = tmp_path_factory.mktemp("measured") / "measured.csv"
    table.write_text("speed [rad/s], span_tension driver-driven order 2 [N]\n60, 1\n120, 2\n", encoding="utf-8")
    return response(shaken, speed="60, 120 rad/s", measured=table)


def test_lines_and_marks(found: bd.Result, ax: Axes) -> None:
    plot.response(found, ax=ax)
    line, marks = ax.lines  # one excitation is the sum of all
    expected = found.dataset.span_tension_amplitude.values[:, 0, 0]
    np.testing.assert_allclose(np.asarray(line.get_ydata()), expected)
    assert marks.get_marker() == "o"
    np.testing.assert_allclose(np.asarray(marks.get_ydata()), [1.0, 2.0])
    assert ax.get_title("left") == "Span tension, driver-driven"
    assert ax.get_ylabel() == "Amplitude [N]"


def test_speeds_beyond_the_linear_range_are_shaded(found: bd.Result, ax: Axes) -> None:
    plot.response(found, ax=ax)
    assert not ax.patches
    dataset = found.dataset.copy()
    dataset["amplitude_error"] = found.dataset.amplitude_error.copy(data=[0.01, 0.2])
    ax.clear()
    plot.response(bd.Result(dataset, found.drive), ax=ax)
    (shade,) = ax.patches
    first, last = dataset.speed.values * 30.0 / np.pi
    left, right = shade.get_path().get_extents().transformed(shade.get_patch_transform()).intervalx
    assert (left, right) == pytest.approx((0.5 * (first + last), last))
    assert shade.get_label() == "beyond linear range (error above 5%)"


def test_speeds_in_rpm(found: bd.Result, ax: Axes) -> None:
    plot.response(found, "pulley_speed", "driver", ax=ax)
    np.testing.assert_allclose(np.asarray(ax.lines[0].get_ydata())[-1], 0.002 * 120.0 * 30.0 / np.pi)
    assert ax.get_ylabel() == "Amplitude [rpm]"


@pytest.mark.parametrize(("variable", "of"), [("speeds", 0), ("span_tension", "driver"), ("span_tension", 5)])
def test_what_is_not_there(found: bd.Result, variable: str, of: str | int) -> None:
    with pytest.raises(ModelError, match=r"is not a result of a response|is not in this drive"):
        plot.response(found, variable, of)


def test_all_on_a_page(found: bd.Result, tmp_path: Path) -> None:
    assert [path.name for path in plot.save_all(found, tmp_path)] == ["amplitudes.png", "response.png"]


def test_amplitudes_of_all_spans_over_speed(found: bd.Result, ax: Axes) -> None:
    """Of two excitations that are alike their sum; and the share of friction in per cent."""
    twice = bd.Result(xr.concat([found.dataset] * 2, "excitation", data_vars="minimal"), found.drive)
    plot.amplitudes(twice, "span_tension", ax=ax)
    for line, span in zip(ax.lines, found.dataset.span.values, strict=True):
        expected = 2.0 * found.dataset.span_tension_amplitude.sel(span=span).values[:, 0]
        np.testing.assert_allclose(np.asarray(line.get_ydata()), expected)
        assert line.get_label() == span
    assert (ax.get_title("left"), ax.get_ylabel()) == ("Span tension", "Amplitude [N]")
    ax.clear()
    plot.amplitudes(found, "friction_used", ax=ax)
    used = found.dataset.largest_friction_used.values
    np.testing.assert_allclose(np.asarray(ax.lines[0].get_ydata()), 100.0 * used[:, 0])
    with pytest.raises(ModelError, match="is not a result of a response"):
        plot.amplitudes(found, "speeds")

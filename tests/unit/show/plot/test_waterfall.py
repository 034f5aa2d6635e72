"""Figures of a run-up made by formulas: order 3 of the driver in the tension of its first span."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.show import plot
from beltdyn.show.plot.figures import Choice


@pytest.fixture(scope="module")
def run_up(run: Run) -> Run:
    time = np.arange(0.0, 2.0, 1e-3)
    angle = 20.0 * time + 50.0 * time**2
    dataset = run.dataset[["pulley_speed", "pulley_angle", "span_tension"]].isel(time=np.zeros(len(time), dtype=int))
    turning = np.stack([angle, 0.5 * angle], axis=1)
    tension = 100.0 + np.stack([4.0 * np.cos(3.0 * angle), 0.0 * angle], axis=1)
    values = {
        "pulley_speed": np.gradient(turning, time, axis=0),
        "pulley_angle": turning,
        "span_tension": tension + 0.01 * np.cos(7.0 * angle)[:, None],
    }
    made = dataset.assign_coords(time=("time", time, dataset["time"].attrs))
    made = made.assign({name: made[name].copy(data=array) for name, array in values.items()})
    return Run(made.assign_attrs(swept_pulley="driver"), run.drive)


def test_orders(run_up: Run, ax: Axes) -> None:
    plot.orders(run_up, pulley="driver", ax=ax)
    lines = {str(line.get_label()): np.asarray(line.get_ydata()) for line in ax.lines}
    np.testing.assert_allclose(lines["order 3"], 4.0, rtol=0.03)
    assert ax.get_xlabel() == "Speed of driver [rpm]"
    assert ax.get_title() + ax.get_title(loc="left") == "Span tension, driver-driven"


def test_a_single_order_lies_on_the_overall_level(run_up: Run, ax: Axes) -> None:
    plot.orders(run_up, pulley="driver", ax=ax)
    lines = {str(line.get_label()): np.asarray(line.get_ydata()) for line in ax.lines}
    held = 6  # spectra at lower speeds are of less than four waves, from which the trend takes a part
    np.testing.assert_allclose(lines["overall (√2 RMS)"][held:], 4.0, rtol=0.03)


def test_panels_share_orders_colors_and_levels(run_up: Run) -> None:
    """The second span has order 7 alone, which is a four-hundredth of order 3 in the first."""
    page = plot.FIGURES["orders"].arrange(run_up, Choice())
    drawn = [{str(line.get_label()): line.get_color() for line in ax.lines} for ax in page.axes]
    assert drawn[0] == drawn[1]
    assert {"order 3", "order 7"} <= drawn[0].keys()
    page = plot.FIGURES["waterfall"].arrange(run_up, Choice())
    first, second, bar = page.axes
    (one,), (other,) = first.collections, second.collections
    assert one.get_clim() == other.get_clim()
    assert bar.get_ylabel() == "Amplitude (peak) [dB re 1 N]"
    assert {"3", "7", "elements pass"} <= {text.get_text() for text in first.texts}


def test_orders_of_another_pulley_are_others(run_up: Run, ax: Axes) -> None:
    """The driven one turns half as fast."""
    plot.orders(run_up, pulley=1, ax=ax)
    assert "order 6" in [line.get_label() for line in ax.lines]


def test_waterfall(run_up: Run, ax: Axes) -> None:
    plot.waterfall(run_up, of="driver-driven", ax=ax)
    (mesh,) = ax.collections
    level = np.asarray(mesh.get_array(), dtype=float)
    assert float(level.max()) == pytest.approx(20.0 * np.log10(4.0), abs=3.0)  # a rising frequency smears
    assert float(level.min()) == pytest.approx(float(level.max()) - 60.0)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Frequency [Hz]", "Speed of driver [rpm]")


def test_files_hold_a_panel_for_each_span(run_up: Run, tmp_path: Path) -> None:
    assert [path.stem for path in plot.save_all(run_up, tmp_path, ["waterfall", "orders"])] == ["waterfall", "orders"]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"variable": "energy"}, "Choose from: pulley_speed, pulley_angle, span_tension"),
        ({"of": "driver"}, "Choose one of driver-driven, driven-driver"),
        ({"of": 2}, "Choose one of driver-driven, driven-driver"),
        ({"pulley": "idler"}, "Choose one of driver, driven"),
    ],
)
def test_what_is_not_there_is_a_model_error(run_up: Run, ax: Axes, wrong: dict[str, Any], message: str) -> None:
    for draw in (plot.orders, plot.waterfall):
        with pytest.raises(ModelError, match=message):
            draw(run_up, ax=ax, **wrong)


@pytest.mark.parametrize(("chosen", "shown"), [(None, "driven"), (0, "driver")])
def test_the_swept_pulley_is_shown_unless_another_is_chosen(run_up: Run, chosen: int | None, shown: str) -> None:
    first, last = run_up.drive.pulleys
    pulleys = [first.replace(speed=None, inertia=0.1), last.replace(torque=None, speed=first.speed)]
    swept = Run(run_up.dataset.assign_attrs(swept_pulley="driven"), run_up.drive.replace(pulley=pulleys))
    page = plot.FIGURES["waterfall"].arrange(swept, Choice(pulley=chosen))
    assert f"Speed of {shown} [rpm]" in [ax.get_ylabel() for ax in page.axes]

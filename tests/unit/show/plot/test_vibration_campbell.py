"""Campbell diagrams as they are drawn."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes

import beltdyn as bd
from beltdyn.show import plot
from beltdyn.vibration.campbell import campbell
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def found() -> bd.Result:
    return campbell(better(loaded_two_pulley()), speed="60, 120 rad/s", count=2, orders="1.5, 11")


def texts(ax: Axes) -> list[str]:
    return [one.get_text() for one in ax.texts]


@pytest.mark.slow
def test_modes_orders_and_critical_speeds(found: bd.Result, ax: Axes) -> None:
    plot.campbell(found, ax=ax)
    assert {"order 1.5 of driver", "order 11 of driver", "1", "2"} <= set(texts(ax))
    drawn = np.concatenate([one.get_offsets() for one in ax.collections])
    assert len(drawn) == found.dataset.sizes["critical"]
    assert ax.get_xlabel() == "Speed of driver [rpm]"
    assert ax.get_ylim()[1] > float(found.dataset.frequency.max())


def test_damping_and_what_grows(found: bd.Result, ax: Axes) -> None:
    grown = found.dataset.assign(growth_rate=found.dataset.growth_rate.where(found.dataset.mode != 1, 0.5))
    plot.mode_damping(bd.Result(grown, found.drive), ax=ax)
    crosses = [line for line in ax.lines if line.get_marker() == "x"]
    assert len(np.asarray(crosses[0].get_xdata())) == 2
    legend = ax.get_legend()
    assert legend is not None
    assert "unstable (grows)" in [one.get_text() for one in legend.get_texts()]


def test_both_on_a_page(found: bd.Result, tmp_path: Path) -> None:
    assert [path.name for path in plot.save_all(found, tmp_path)] == ["campbell.png"]

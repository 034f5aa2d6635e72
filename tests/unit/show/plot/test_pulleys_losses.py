"""Where the power goes."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.results import Run
from beltdyn.show import plot

MakeRun = Callable[..., Run]


def texts(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts]


def test_losses_by_cause_and_pulley(run: Run, ax: Axes) -> None:
    """Friction takes 1.08 W, half of it on each pulley, of 29.25 W; what takes nothing is not drawn."""
    plot.losses(run, ax)
    assert [label.get_text() for label in ax.get_yticklabels()] == ["friction", "contact damping"]
    widths = [patch.get_width() for patch in ax.patches[:2]]  # type: ignore[attr-defined]
    assert widths == pytest.approx([0.54, 0.54])
    assert texts(ax)[0] == f"1.08 W ({1.08 / 29.25:.2%})"


def test_losses_that_give_power_stand_left_of_zero(make_run: MakeRun, run: Run, ax: Axes) -> None:
    """The driver loses 2 W in friction, and the driven pulley would give 0.5 W."""
    power = np.ones_like(run.dataset["friction_power"].values) * [2.0, -0.5]
    plot.losses(make_run(friction_power=power), ax)
    driver, driven = ax.patches[:2]
    assert (driver.get_x(), driver.get_width()) == pytest.approx((0.0, 2.0))  # type: ignore[attr-defined]
    assert (driven.get_x(), driven.get_width()) == pytest.approx((0.0, -0.5))  # type: ignore[attr-defined]
    assert ax.get_xlim()[0] < -0.5


def test_losses_of_several_runs_stand_side_by_side(make_run: MakeRun, run: Run, ax: Axes) -> None:
    """A cause that only one run has is a row of both."""
    works = {"friction_loss": 2.0 * run.dataset["friction_loss"], "coupling_loss": run.dataset["friction_loss"]}
    runs = [Run(run.dataset, run.drive, Path("one.nc")), Run(make_run(**works).dataset, run.drive, Path("other.nc"))]
    assert plot.losses(runs, ax) is ax  # type: ignore[arg-type]
    assert [label.get_text() for label in ax.get_yticklabels()] == ["friction", "contact damping", "couplings"]
    widths = [patch.get_width() for patch in ax.patches]  # type: ignore[attr-defined]
    assert widths == pytest.approx([1.08, 0.12, 0.0, 2.16, 0.12, 1.08])
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["one", "other"]

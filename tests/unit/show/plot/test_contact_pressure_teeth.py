"""Figures of toothed drives."""

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.results import Run, ToothLoads
from beltdyn.show import plot
from tests.unit.model.test_toothing import drive
from tests.unit.results.derived.test_spectrum_tooth_variables import RIPPLE
from tests.unit.results.derived.test_spectrum_tooth_variables import run as toothed

LOADS = ToothLoads("driver", 2.0, 30.0, np.nan, 5.0, np.array([0.5, 1.5]), np.array([30.0, 10.0]))


def test_loads_are_drawn_over_the_arc(run: Run, ax: Axes, monkeypatch: pytest.MonkeyPatch) -> None:
    module = import_module("beltdyn.show.plot.contact_pressure")
    monkeypatch.setattr(module, "tooth_loads", lambda *_: (LOADS, replace(LOADS, name="driven")))
    plot.load_sharing(run, ax=ax)
    np.testing.assert_allclose(np.asarray(ax.lines[0].get_ydata()), LOADS.loads)
    assert [line.get_label() for line in ax.lines[:2]] == ["driver", "driven"]


def test_a_smooth_belt_has_none(run: Run, ax: Axes) -> None:
    with pytest.raises(ModelError, match="the belt has no teeth in mesh"):
        plot.load_sharing(run, ax=ax)
    with pytest.raises(ModelError, match="the belt has no teeth"):
        plot.transmission_error(run, ax=ax)
    assert not any(name in ("load_sharing", "transmission_error") for name in by_default(run))


def by_default(run: Any) -> list[str]:
    return [name for name, one in plot.FIGURES.items() if "run" in one.of and one.by_default(run)]


def test_transmission_error_over_time_and_orders(ax: Axes) -> None:
    ahead, over_time, over_orders = toothed(drive()), *map(drawn, ("transmission_error", "transmission_orders"))
    over_time(ahead, ax=ax)
    (line,) = ax.lines
    np.testing.assert_allclose(np.asarray(line.get_ydata()), 1e6 * (RIPPLE - RIPPLE.mean()), atol=1e-6)
    ax.clear()
    over_orders(ahead, ax=ax)
    order, amplitude = (np.asarray(one) for one in (ax.lines[0].get_xdata(), ax.lines[0].get_ydata()))
    assert order[np.argmax(amplitude)] == pytest.approx(24.0, abs=0.5)


def drawn(name: str) -> Callable[..., Axes]:
    """A figure without the check of what it is drawn of."""
    made: Callable[..., Axes] = vars(getattr(plot, name))["__wrapped__"]
    return made

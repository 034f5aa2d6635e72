"""Wear over the arcs of pulleys and over the belt."""

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.results import Run, derived
from beltdyn.show import plot


@pytest.fixture
def worn(make_run: Callable[..., Run], run: Run) -> Run:
    touched = run.dataset["contact_pulley"].values >= 0
    return make_run(friction_force=np.where(touched, -40.0, 0.0), slip_velocity=np.where(touched, 0.025, 0.0))


def test_a_line_for_each_pulley_where_it_wears(worn: Run, ax: Axes) -> None:
    wear = derived.wear_by_arc(worn)
    plot.wear_by_arc(worn, ax)
    assert [line.get_label() for line in ax.lines] == ["driver", "driven"]
    for number, line in enumerate(ax.lines):
        values = wear.values[number]
        np.testing.assert_array_equal(line.get_ydata(), values[values > 0.0])
        np.testing.assert_allclose(np.asarray(line.get_xdata()), np.degrees(wear["angle"].values[number][values > 0.0]))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Angle from the inlet [°]", "Wear intensity on the arc [J/m]")
    assert ax.get_ylim()[0] == 0.0


def test_what_each_pulley_does_to_the_belt(worn: Run, ax: Axes) -> None:
    wear = derived.wear_by_belt(worn)
    plot.wear_by_belt(worn, ax)
    for number, line in enumerate(ax.lines):
        np.testing.assert_array_equal(line.get_ydata(), wear[number])
        np.testing.assert_array_equal(line.get_xdata(), wear["element_coordinate"])
    assert ax.get_ylabel() == "Wear intensity on the belt [J/m]"

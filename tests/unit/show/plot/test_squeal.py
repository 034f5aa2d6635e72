"""Growth of squeal over the load, as it is drawn."""

import numpy as np
import pytest
from matplotlib.axes import Axes

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.show import plot
from beltdyn.vibration.squeal import SelfExcited, Squeal


def test_growth_by_pulley_and_both_limits(drive: Drive, ax: Axes) -> None:
    rest = bd.modes(drive, about="rest", count=1)
    with pytest.raises(ModelError, match="does not say whether the belt squeals"):
        plot.squeal(rest, ax=ax)
    quiet = SelfExcited(0.5, np.nan, np.nan, "", np.nan, np.nan)
    loud = [SelfExcited(load, 900.0 * load, 2000.0, "driven", 7.0, 0.25) for load in (1.0, 1.5)]
    found = bd.results.Result(Squeal((quiet, *loud), loud[0], 1.6, "wet").beside(rest.dataset), rest.drive)
    plot.squeal(found, ax=ax)
    line, points, squeal, slip = ax.lines
    np.testing.assert_allclose(np.asarray(line.get_ydata()), [0.0, 900.0, 1350.0])
    np.testing.assert_allclose(np.asarray(points.get_xdata()), [1.0, 1.5])
    assert points.get_label() == "fed by driven"
    assert [np.asarray(one.get_xdata())[0] for one in (squeal, slip)] == [1.0, 1.6]
    assert [text.get_text() for text in ax.texts] == ["2", "2"]

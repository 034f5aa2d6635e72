"""The drive at one instant."""

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from beltdyn.results import Run
from beltdyn.show import plot


def test_configuration(run: Run, ax: Axes) -> None:
    plot.configuration(run, time=0.501, ax=ax)
    assert ax.get_title() + ax.get_title(loc="left") == "t = 0.5 s"
    instant = run.fields_at(0.5)
    (belt,) = (artist for artist in ax.collections if isinstance(artist, LineCollection))
    np.testing.assert_array_equal(belt.get_array(), instant["belt_tension"])
    starts = np.array([segment[0] for segment in belt.get_segments()])
    np.testing.assert_allclose(starts, instant["node_position"], atol=1e-12)
    rims = [patch for patch in ax.patches if isinstance(patch, Circle) and patch.radius == 0.08125]
    assert [rim.center for rim in rims] == [pulley.center for pulley in run.drive.pulleys]
    assert [text.get_text() for text in ax.texts] == ["driver", "driven"]


def test_configuration_of_a_drive_at_rest(make_run: Callable[..., Run], ax: Axes) -> None:
    plot.configuration(make_run(outputs=1), ax=ax)
    assert all(isinstance(patch, Circle) for patch in ax.patches)

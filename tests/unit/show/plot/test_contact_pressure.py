"""Contact forces over the belt laid straight."""

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from beltdyn.errors import ModelError
from beltdyn.results import Run, derived
from beltdyn.show import plot


@pytest.mark.parametrize(("pulley", "rising"), [("driver", False), ("driven", True), (1, True)])
def test_normal_force_falls_on_the_driver(run: Run, ax: Axes, pulley: str | int, rising: bool) -> None:
    plot.contact_forces(run, pulley, ax=ax)
    distance, force = (np.asarray(data) for data in ax.lines[0].get_data())
    assert distance[0] == 0.0
    assert np.all(np.diff(distance) > 0)
    assert distance[-1] == pytest.approx(np.pi * 0.08125, abs=0.015)
    assert np.all(np.diff(force) > 0) == rising
    assert force.min() > 0
    assert ax.get_ylabel() == "Normal force on the belt [N/m]"
    assert ax.get_xlabel().endswith("[m]")


def test_friction_with_its_limits(run: Run, ax: Axes) -> None:
    plot.contact_forces(run, "driven", kind="friction", ax=ax)
    (limits,) = ax.collections
    assert isinstance(limits, LineCollection)
    upper, lower = (np.asarray(segment) for segment in limits.get_segments())
    np.testing.assert_allclose(upper[:, 1], -lower[:, 1])
    force = np.asarray(ax.lines[0].get_ydata())
    assert np.all(np.abs(force) < upper[:, 1])
    assert force.max() < 0


@pytest.mark.parametrize("pulley", ["idler", 2, -1])
def test_unknown_pulley_is_a_model_error(run: Run, ax: Axes, pulley: str | int) -> None:
    with pytest.raises(ModelError, match="Choose one of driver, driven"):
        plot.contact_forces(run, pulley, ax=ax)


@pytest.mark.parametrize(("kind", "name"), [("tension", "belt_tension"), ("normal", "normal_force")])
def test_forces_over_the_angle(run: Run, ax: Axes, kind: Any, name: str) -> None:
    """Tension and normal force fall together around the driver."""
    plot.arc_forces(run, "driver", kind=kind, ax=ax)
    angle, force = (np.asarray(data) for data in ax.lines[0].get_data())
    assert (angle.min() >= 0.0, angle.max() <= 180.0) == (True, True)
    arc = derived.contact_arc(run, "driver")
    np.testing.assert_array_equal(force, arc[name])
    assert force[-1] < 0.7 * force[0]
    assert ax.get_xlabel() == "Angle from the inlet [°]"


def test_friction_over_the_angle_drives_the_belt_on_the_driver(run: Run, ax: Axes) -> None:
    plot.arc_forces(run, "driver", kind="friction", ax=ax)
    assert np.all(np.asarray(ax.lines[0].get_ydata()) > 0.0)
    with pytest.raises(ModelError, match="Choose one of tension, normal, friction"):
        plot.arc_forces(run, "driver", kind="shear", ax=ax)  # type: ignore[arg-type]

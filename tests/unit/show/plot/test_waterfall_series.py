"""Variables of run-ups in the units of figures."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.show.plot.waterfall import names_of, series


def test_units_are_those_of_an_engineer(run: Run) -> None:
    speed, aside = series(run, "pulley_speed", "driven"), series(run, "mid_span_displacement", 0)
    assert (speed.attrs["units"], aside.attrs["units"]) == ("rpm", "mm")
    recorded = run.dataset["filtered_pulley_speed"][:, 1]
    np.testing.assert_allclose(speed, recorded * 30.0 / np.pi, rtol=1e-6)
    assert speed.attrs["of"] == "driven"


def test_the_hub_load_is_a_magnitude(run: Run) -> None:
    load, force = series(run, "hub_load", 0), run.dataset["filtered_hub_force"][:, 0]
    np.testing.assert_allclose(load, np.hypot(force[:, 0], force[:, 1]), rtol=1e-6)
    assert (load.attrs["units"], load.attrs["long_name"]) == ("N", "Hub load")
    assert names_of(run, "hub_load") == ["driver", "driven"]


def test_the_angle_of_an_arm_is_in_degrees(run: Run) -> None:
    x, y = run.drive.pulleys[0].center
    arm = {"kind": "rotary", "pulley": "driver", "pivot": (x, y + 1.0), "preload": 1.0, "inertia": 1.0}
    place = run.dataset["shaft_angle"][:, :1].rename(pulley="tensioner").assign_attrs(units="m, rad", long_name="Place")
    tensioned = Run(run.dataset.assign(tensioner_position=place), run.drive.replace(tensioner=[arm]))
    angle = series(tensioned, "tensioner_position", 0)
    assert angle.attrs["units"] == "°"
    np.testing.assert_allclose(angle, np.degrees(place[:, 0]))


def test_an_unknown_variable_is_a_model_error(run: Run) -> None:
    with pytest.raises(ModelError, match="hub_load"):
        names_of(run, "hub")

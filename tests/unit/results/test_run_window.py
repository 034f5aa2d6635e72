"""Parts of a run, numbers of its pulleys, and names and units of what is made of it."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.run import labelled, pulley_number, window


def test_what_is_derived_has_its_own_unit_along_the_same_dimensions(run: Run) -> None:
    speed = run.dataset["pulley_speed"]
    made = labelled(2.0 * speed.values, speed, "1/s", "Twice the speed")
    assert made.attrs == {"units": "1/s", "long_name": "Twice the speed"}
    assert (made.dims, made["pulley"].values.tolist()) == (("time", "pulley"), ["driver", "driven"])
    np.testing.assert_array_equal(made, 2.0 * speed.values)
    assert speed.attrs["units"] == "rad/s"


@pytest.mark.parametrize(("start", "end", "outputs"), [(None, None, 101), (0.2, 0.5, 31), (0.5, 0.5, 1), (0.995, 9, 1)])
def test_a_window_holds_both_of_its_ends(run: Run, start: float | None, end: float | None, outputs: int) -> None:
    part = window(run, start, end)
    times = part["time"].values
    assert len(times) == part.sizes["field_time"] == outputs
    assert run.dataset["time"].sel(time=slice(start, end)).values.tolist() == times.tolist()


def test_no_output_between_two_instants(run: Run) -> None:
    with pytest.raises(ModelError, match=r"no output from 2 s to the end; the run was recorded from 0 to 1 s"):
        window(run, start=2)


def test_a_run_without_outputs_has_nothing_to_show(run: Run) -> None:
    with pytest.raises(ModelError, match="the run ended before its first output"):
        window(Run(run.dataset.isel(time=slice(0)), run.drive))


@pytest.mark.parametrize(("pulley", "number"), [("driver", 0), ("driven", 1), (0, 0), (1, 1)])
def test_pulleys_are_known_by_name_and_by_number(run: Run, pulley: str | int, number: int) -> None:
    assert pulley_number(run, pulley) == number


@pytest.mark.parametrize("pulley", ["idler", 2, -1])
def test_unknown_pulley(run: Run, pulley: str | int) -> None:
    with pytest.raises(ModelError, match="Choose one of driver, driven"):
        pulley_number(run, pulley)

"""The figures of linear axes."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.results import Run


@pytest.mark.slow
def test_the_error_of_the_carriage_is_drawn_in_micrometers() -> None:
    run = bd.simulate(bd.example("printer_axis").with_({"simulation.duration": 0.06}))
    ax = bd.plot.carriage_error(run)
    time, error = np.array(ax.lines[0].get_data())
    assert time == pytest.approx(run.dataset.time.values)
    assert error == pytest.approx(1e6 * run.dataset.carriage_error.values[:, 0])
    assert "carriage_error" in bd.plot.FIGURES
    with pytest.raises(ModelError, match="this drive has no carriage"):
        bd.plot.carriage_error(Run(run.dataset.drop_vars("carriage_error"), run.drive))


@pytest.mark.slow
def test_stiffness_and_frequency_are_drawn_over_the_stroke() -> None:
    found = bd.stroke(bd.example("printer_axis"), places="-50, 50 mm")
    ax = bd.plot.stroke(found)
    way, stiffness = np.array(ax.lines[0].get_data())
    assert way == pytest.approx([-50.0, 50.0])
    assert stiffness == pytest.approx(1e-3 * found.dataset.stiffness.values)
    frequencies = bd.plot.stroke(found, "frequency").lines[0].get_ydata()
    assert np.array(frequencies) == pytest.approx(found.dataset.frequency.values)
    with pytest.raises(ModelError, match="Choose one of stiffness, frequency"):
        bd.plot.stroke(found, "mass")

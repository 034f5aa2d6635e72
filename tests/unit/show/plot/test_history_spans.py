from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.derived import wear_by_arc, wear_by_belt
from beltdyn.show import plot

MakeRun = Callable[..., Run]


def test_mid_spans_in_millimetres(make_run: MakeRun, run: Run, ax: Axes) -> None:
    raised = run.dataset["contact_position"].values + np.array([0.0, 2e-3])
    plot.mid_spans(make_run(contact_position=raised), ax)
    assert ax.get_ylabel() == "Mid-span displacement [mm]"
    np.testing.assert_allclose(np.asarray(ax.lines[0].get_ydata()), 2.0, rtol=1e-4)  # single precision of places
    np.testing.assert_allclose(np.asarray(ax.lines[1].get_ydata()), -2.0, rtol=1e-4)


def test_spectrum_of_the_second_half(make_run: MakeRun, ax: Axes) -> None:
    time = np.linspace(0.0, 1.0, 101)
    ripple = np.where(time < 0.5, 50.0 * np.cos(2 * np.pi * 30.0 * time), 2.0 * np.cos(2 * np.pi * 20.0 * time))
    plot.tension_spectrum(make_run(span_tension=60.0 + np.stack([ripple, 0.1 * ripple], axis=1)), ax=ax)
    frequency, amplitude = (np.asarray(data) for data in ax.lines[0].get_data())
    assert frequency[amplitude.argmax()] == pytest.approx(20.0, abs=1.0)
    assert ax.get_ylabel() == "Amplitude of span tension [N]"


def test_a_drive_without_tensioners_has_no_place_to_draw(run: Run, ax: Axes) -> None:
    with pytest.raises(ModelError, match="no moving tensioner"):
        plot.tensioners(run, ax)


def test_wear(run: Run, ax: Axes) -> None:
    plot.wear_by_arc(run, ax)
    wear = wear_by_arc(run)[1]
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), wear[wear > 0.0])
    assert ax.get_ylabel() == "Wear intensity on the arc [J/m]"
    belt = plot.wear_by_belt(run)
    np.testing.assert_array_equal(belt.lines[0].get_ydata(), wear_by_belt(run)[0])
    assert belt.get_xlabel().startswith("Belt coordinate")

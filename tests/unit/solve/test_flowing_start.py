"""Runs over time on a mesh that stays: they begin at rest or in steady running, and end where steady running says."""

from importlib.resources import files

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.published.cases import better, loaded_two_pulley
from beltdyn.solve.standard import StandardIntegrator


@pytest.fixture(scope="module")
def loaded() -> Drive:
    """Case 2 of the paper, on about 30 elements that stay."""
    return better(loaded_two_pulley(), elements=30, frame="staying", duration=0.3)


@pytest.fixture(scope="module")
def constant(loaded: Drive) -> Drive:
    """The same at its full speed and load from the beginning."""
    driver, driven = loaded.pulleys
    speed, torque = ({"kind": "constant", "value": value} for value in (120.0, -45.0))
    return loaded.replace(
        pulley=[driver.replace(speed=speed), driven.replace(torque=torque)],
        simulation=loaded.simulation.replace(start="steady"),
    )


def test_steady_running_goes_on(constant: Drive) -> None:
    """Nothing changes but angles, so that steps grow."""
    found = bd.simulate(constant).dataset
    speed = found.pulley_speed.values[:, 1]
    assert np.ptp(speed) < 1e-5 * speed[0]
    assert np.ptp(found.span_tension.values, axis=0).max() < 1e-4 * found.span_tension.values.max()
    assert found.step_size.values.max() > 0.01
    assert found.attrs["steps"] < 100
    assert np.abs(found.energy_closure).max() < 1e-3


@pytest.mark.slow
def test_a_run_from_rest_ends_in_steady_running(loaded: Drive, constant: Drive) -> None:
    run = bd.simulate(loaded.replace(simulation=loaded.simulation.replace(duration=1.5)))
    steady = bd.simulate(constant.replace(simulation=constant.simulation.replace(duration=0.01))).dataset
    for name, tolerance in (("pulley_speed", 1e-5), ("span_tension", 1e-4)):
        np.testing.assert_allclose(run.dataset[name].values[-1], steady[name].values[0], rtol=tolerance)
    assert not [warning for warning in run.warnings if "mesh" in warning]


def test_the_number_of_elements_is_about_that_asked_for(constant: Drive) -> None:
    short = constant.replace(simulation=constant.simulation.replace(duration=1e-3))
    assert bd.simulate(short).dataset.sizes["node"] == pytest.approx(30, abs=4)


def test_what_does_not_fit_is_refused(loaded: Drive) -> None:
    with pytest.raises(ModelError, match="every prescribed speed is zero"):
        bd.simulate(loaded.replace(simulation=loaded.simulation.replace(start="steady")))
    with pytest.raises(ModelError, match=r'"bdf" does not fit simulation\.frame = "staying"'):
        bd.simulate(loaded, integrator=StandardIntegrator("bdf", 1e-3))
    band = bd.load(str(files("beltdyn") / "examples" / "band_brake.toml"))
    with pytest.raises(ModelError, match="does not fit an open belt"):
        bd.simulate(band.replace(simulation=band.simulation.replace(frame="staying")))

"""Estimates of the mesh's errors, on results made by formulas."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.results.resolution import FORCE_LIMIT, TENSION_LIMIT

MakeRun = Callable[..., Run]


def rippled(run: Run, amplitude: float) -> np.ndarray:
    """Normal forces that alternate from point to point: a ripple of that root mean square over the mean."""
    force = run.dataset["normal_force"].values
    return np.asarray(force * (1.0 + amplitude * (-1.0) ** np.arange(force.shape[1])))


@pytest.mark.parametrize("amplitude", [0.02, 0.1, 0.5])
def test_ripple_is_measured_and_the_trend_is_not(make_run: MakeRun, run: Run, amplitude: float) -> None:
    """A cubic through the few tens of points in the middle of an arc follows some of the ripple: 5 %."""
    assert max(run.resolution.force_errors) < 1e-3  # tension is linear along the arcs
    errors = make_run(normal_force=rippled(run, amplitude)).resolution.force_errors
    assert errors == pytest.approx((amplitude, amplitude), rel=0.05)


def test_tension_error_is_twice_the_mean_square_variation(make_run: MakeRun, run: Run) -> None:
    tension = run.dataset["belt_tension"].values
    made = make_run(tension_variation=np.full_like(tension, 3.0))
    mean = float(made.dataset["belt_tension"].values[made.dataset["time"].values >= 0.8].mean())
    assert made.resolution.tension_error == pytest.approx(2.0 * 9.0 / mean**2, rel=1e-3)


def test_limits_decide(make_run: MakeRun, run: Run) -> None:
    for factor, resolved in ((0.9, True), (1.2, False)):
        resolution = make_run(normal_force=rippled(run, factor * FORCE_LIMIT)).resolution
        assert [resolution.resolves(number) for number in range(2)] == [resolved, resolved]
        assert (resolution.elements == run.drive.belt.elements) == resolved


def test_elements_follow_the_fourth_power(make_run: MakeRun, run: Run) -> None:
    resolution = make_run(normal_force=rippled(run, 0.3)).resolution
    worst = max(resolution.force_errors) / FORCE_LIMIT
    assert resolution.elements == math.ceil(20 * worst**0.25)
    variation = np.full_like(run.dataset["belt_tension"].values, 20.0)
    tension = make_run(tension_variation=variation).resolution
    assert tension.elements == math.ceil(20 * (tension.tension_error / TENSION_LIMIT) ** 0.25)


def test_layers(run: Run) -> None:
    bending, contact = run.resolution.layers
    tension = float(run.dataset["belt_tension"].values[-1].mean())
    assert bending == pytest.approx(math.sqrt(run.drive.belt.bending_stiffness / tension), rel=1e-3)
    assert contact == pytest.approx(math.sqrt(tension / run.drive.contact.stiffness), rel=1e-3)


def test_free_belt_has_no_force_error(make_run: MakeRun, run: Run) -> None:
    free = np.full_like(run.dataset["contact_pulley"].values, -1)
    resolution = make_run(contact_pulley=free).resolution
    assert all(math.isnan(error) for error in resolution.force_errors)
    assert resolution.resolves(0)
    assert resolution.elements == run.drive.belt.elements


def test_too_few_points_cannot_tell(make_run: MakeRun, run: Run) -> None:
    touched = run.dataset["contact_pulley"].values.copy()
    touched[:, 5:] = -1
    touched[:, :5] = 0
    resolution = make_run(contact_pulley=touched).resolution
    assert resolution.force_errors[0] == math.inf
    assert not resolution.resolves(0)
    assert resolution.elements == 2 * run.drive.belt.elements

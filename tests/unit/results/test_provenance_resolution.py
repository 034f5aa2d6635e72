"""Estimates of the mesh's errors from results made by formulas."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import ERROR_LIMITS, Drive, Running, elements_needed, install, mesh_errors
from beltdyn.results import Run

MakeRun = Callable[..., Run]


def test_errors_are_those_of_the_drive_at_the_speed_of_the_run(run: Run) -> None:
    speed = run.dataset["belt_speed"].values[run.dataset["time"].values >= 0.8]
    lifted = run.drive.belt.mass_per_length * float(np.mean(speed**2))
    running = Running(install(run.drive).tension, lifted)
    assert run.resolution.errors == pytest.approx(mesh_errors(run.drive, running, run.drive.elements))
    assert run.resolution.needed == elements_needed(run.drive, running)


def test_raised_tension_of_a_coarse_mesh_does_not_count(make_run: MakeRun, run: Run) -> None:
    """A mesh that doubles the tension asks for the same elements; one that loses tension asks for more."""
    tension = run.dataset["belt_tension"].values
    assert make_run(belt_tension=2.0 * tension).resolution == run.resolution
    lost = make_run(belt_tension=0.2 * tension).resolution
    assert lost.needed["tension"] > run.resolution.needed["tension"]


def test_limits_decide(run: Run, fine_drive: Drive) -> None:
    for one, resolved in ((run, False), (Run(run.dataset, fine_drive), True)):
        for name, limit in ERROR_LIMITS.items():
            assert one.resolution.resolves(name) is resolved
            assert (one.resolution.errors[name] <= limit) is resolved
            assert (one.resolution.needed[name] <= one.drive.elements) is resolved


def test_at_rest_there_is_no_slip_to_judge(make_run: MakeRun, run: Run) -> None:
    rest = make_run(belt_speed=np.zeros_like(run.dataset["belt_speed"].values)).resolution
    assert math.isnan(rest.errors["slip"])
    assert math.isnan(rest.errors["losses"])
    assert rest.resolves("slip")
    assert rest.errors["tension"] > 0.0


def test_nothing_is_known_without_tension(make_run: MakeRun, run: Run) -> None:
    slack = make_run(belt_tension=-run.dataset["belt_tension"].values)
    assert all(math.isnan(error) for error in slack.resolution.errors.values())
    assert slack.resolution.needed == {}
    assert not any("elements" in warning for warning in slack.warnings)


def test_layers(run: Run) -> None:
    bending, contact = run.resolution.layers
    tension = install(run.drive).tension
    assert bending == pytest.approx(math.sqrt(run.drive.belt.bending_stiffness / tension), rel=1e-3)
    assert contact == pytest.approx(math.sqrt(tension / run.drive.contact_stiffness), rel=1e-3)


def test_pressures_are_not_asked_for_on_a_mesh_that_was_chosen(run: Run) -> None:
    """The drive of a run with an installed tension holds the chosen number as if it were given; the file does not."""
    assert any("peak pressure" in text for text in run.warnings)
    given = run.drive.replace(belt=run.drive.belt.replace(elements=None))
    chosen = Run(run.dataset.assign_attrs(drive_as_given=given.text), run.drive)
    assert not any("pressure" in text for text in chosen.warnings)

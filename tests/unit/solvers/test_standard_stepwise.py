"""One-step methods with step control; docs/extending/analysis.md fits the order of one."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.solvers.standard import ErrorControl, FixedSteps, StepError, Stepwise
from beltdyn.system.first_order import FirstOrder
from beltdyn.transient.simulate import simulate


@pytest.mark.parametrize(
    ("error", "accepted", "length"),
    [
        (1e-4, True, 0.9e-3),
        (1e-4 / 16.0, True, 3.6e-3),
        (0.0, True, 4e-3),
        (1e-12, True, 4e-3),
        (4e-4, False, 0.45e-3),
        (np.inf, False, 0.2e-3),
    ],
)
def test_the_next_step_makes_the_error_allowed(error: float, accepted: bool, length: float) -> None:
    """The error of a method of first order falls with the square of the step; 4 ms are the most."""
    control = ErrorControl(rtol=1e-4, max_step=4e-3)
    verdict = control.judge(1e-3, error, 1)
    assert verdict.accepted is accepted
    assert verdict.length == pytest.approx(length)


class Frozen:
    """A method for which nothing moves, and steps beyond a length have no solution."""

    name, order = "frozen", 1

    def __init__(self, longest: float) -> None:
        self.longest = longest

    def step(self, equations: FirstOrder, time: float, y: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
        if length > self.longest:
            raise StepError("it is too long")
        return y.copy(), np.zeros_like(y)


@pytest.fixture
def short(drive: Drive) -> Drive:
    return drive.replace(simulation=drive.simulation.replace(duration=0.01))


def test_steps_end_on_breakpoints_and_at_the_end(drive: Drive) -> None:
    """The speed of the driver has a kink at 0.05 s: 25 steps of 2 ms, and after it four and the rest of 1 ms."""
    longer = drive.replace(simulation=drive.simulation.replace(duration=0.059, output_interval=1e-3))
    run = simulate(longer, integrator=Stepwise(Frozen(np.inf), FixedSteps(2e-3)))
    assert run.dataset.attrs["steps"] == 30
    assert run.dataset.attrs["integrator"] == "frozen"
    assert float(run.dataset["step_size"][-1]) == pytest.approx(1e-3)


def test_steps_without_a_solution_are_tried_shorter(short: Drive) -> None:
    control = ErrorControl(rtol=1e-4, max_step=5e-3, first=5e-3)
    run = simulate(short, integrator=Stepwise(Frozen(2e-3), control))
    assert run.dataset.attrs["rejected_steps"] > 0
    assert float(run.dataset["step_size"].max()) <= 2e-3


def test_a_method_that_cannot_go_on_says_why(short: Drive) -> None:
    with pytest.raises(ConvergenceError, match=r"frozen fails at t = 0 s .*: it is too long\. Try"):
        simulate(short, integrator=Stepwise(Frozen(1e-3), FixedSteps(2e-3)))

"""The first guess of a step of generalised-alpha.

On a staying mesh, A is expected to go on changing as it did over the last step, as far as that would have foretold
the last step: fields that stay in space change slowly, and friction takes hold within a slip of some mm/s, less than
speeds change by in a step.  Nodes that travel meet pulleys within a few steps; there A is guessed constant.
"""

from beltdyn.kernel import by_type, kernel
from beltdyn.solve.integrators.alpha_impulse import add_missed_impulses
from beltdyn.solve.integrators.alpha_method import Method
from beltdyn.solve.integrators.integrator_state import IntegratorState, trial_motion
from beltdyn.system.arrays import System
from beltdyn.system.frame import Flowing, Travelling
from beltdyn.system.prescribed import prescribe


@kernel
def predict(system: System, method: Method, state: IntegratorState, length: float, end: float) -> None:
    """Overwrite the trial state by the first guess of a step.

    Parameters
    ----------
    system
        The system.
    method
        Coefficients.
    state
        At the beginning of the step; its trial state is overwritten.
    length, end
        Length of the step and where it ends, s.
    """
    expected = state.clock.persistence * length
    for i in range(state.position.size):
        before, after = state.auxiliary[i], state.auxiliary[i] + expected * state.trend[i]
        bend = (0.5 - method.beta) * before + method.beta * after
        rise = (1.0 - method.gamma) * before + method.gamma * after
        state.trial.position[i] = state.position[i] + length * state.velocity[i] + length * length * bend
        state.trial.velocity[i] = state.velocity[i] + length * rise
        state.trial.acceleration[i] = (
            (1.0 - method.am) * after + method.am * before - method.af * state.acceleration[i]
        ) / (1.0 - method.af)
    add_missed_impulses(system, method, state, length)
    prescribe(system, trial_motion(state, end))


@kernel
def follow_trend(system: System, state: IntegratorState, length: float) -> None:
    """Take the change of A over a step, and how much of it the change before foretold.

    Parameters
    ----------
    system
        The system.
    state
        At the beginning of the step, with its end on trial; trend and persistence are changed.
    length
        Length of the step, s.
    """
    state.clock.persistence = _persistence(system.frame, system, state, length)
    for i in range(state.auxiliary.size):
        state.trend[i] = (state.trial.auxiliary[i] - state.auxiliary[i]) / length


@kernel(inline=True)
def _none(frame: Travelling, system: System, state: IntegratorState, length: float) -> float:
    """Of nodes that travel with the belt."""
    return 0.0


@kernel(inline=True)
def _of_bodies(frame: Flowing, system: System, state: IntegratorState, length: float) -> float:
    """The part of the change before that fits the change over this step best: of the belt's flow, shafts, tensioners.

    Their speeds decide on slip; accelerations of nodes tremble beside them.
    """
    along = square = 0.0
    for body in range(system.bodies.size):
        i, reach = system.first_body + body, system.bodies[body].reach
        before = reach * length * state.trend[i]
        along += before * reach * (state.trial.auxiliary[i] - state.auxiliary[i])
        square += before * before
    return min(1.0, max(0.0, along / square)) if square > 0.0 else 0.0


_persistence = by_type({Travelling: _none, Flowing: _of_bodies}, "persistence")

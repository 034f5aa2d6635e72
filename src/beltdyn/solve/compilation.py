"""Compile the kernels of a simulation before its clock starts: once on a machine, then they come from the disk."""

import numpy as np

from beltdyn.solve.generalized_alpha import advance
from beltdyn.solve.march import Settings, empty_outputs, new_march
from beltdyn.system.arrays import NODE, System
from beltdyn.system.motion import accelerate, new_equations
from beltdyn.system.observe import observe
from beltdyn.system.state import State


def compile_kernels(system: System, state: State) -> None:
    """Call every kernel that static equilibrium, generalised-alpha and observation need, on no work at all.

    Parameters
    ----------
    system
        Any system; kernels do not depend on its size.
    state
        A state of it.
    """
    equations = new_equations(system)
    velocity, acceleration = np.zeros_like(state.position), np.zeros_like(state.position)
    accelerate(system, 0.0, state.position, velocity, acceleration, np.zeros(NODE), equations)
    settings = Settings(0.0, 1.0, 1.0, 1.0, np.ones(NODE))
    march = new_march(0.0, 1.0, state.position, state.velocity)
    advance(system, settings, march, equations, 0.0, 0, empty_outputs(np.zeros(0), state.position.size))
    observe(system, np.empty(0), np.empty((0, 0)), np.empty((0, 0)))

"""What makes the steps of a simulation as short as they are."""

from beltdyn.model.simulation import Simulation
from beltdyn.solve.trajectory import Statistics

_MANY = 0.1
"""Share of steps tried in vain from which on they are what makes a run long."""
_NEAR = 0.4
"""Mean step over a bound from which on the bound is felt."""


def step_bound(simulation: Simulation, statistics: Statistics, reached: float) -> str:
    """Say what bounds the time steps, and what would let them be longer.

    Parameters
    ----------
    simulation
        Settings.
    statistics
        What the solver did so far.
    reached
        Time that it has reached, s.

    Returns
    -------
    str
        One or two sentences; empty before the first step.
    """
    taken, rejected = statistics.steps, statistics.rejected_steps
    if taken == 0:
        return ""
    mean, share = reached / taken, rejected / (taken + rejected)
    if share > _MANY:
        return (
            f"{share:.0%} of the time steps are tried in vain, since friction builds up steeply with the slip "
            "velocity, or contact is hard. A smaller contact.creep_rate_factor (or a larger contact.creep_velocity) or "
            "contact.stiffness makes it quicker."
        )
    if simulation.max_step is not None and mean > _NEAR * simulation.max_step:
        return f"simulation.max_step = {simulation.max_step:g} s bounds the steps."
    if mean > _NEAR * simulation.output_interval:
        interval = simulation.output_interval
        return f"Steps end on outputs: a longer simulation.output_interval than {interval:g} s is quicker."
    return (
        f"Steps are as short as simulation.rtol = {simulation.rtol:g} asks for where the belt vibrates on its pulleys. "
        "A larger one, fewer belt.elements, or a smaller contact.stiffness or slope of friction makes it quicker."
    )

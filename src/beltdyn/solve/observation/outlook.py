"""What makes the steps of a simulation as short as they are."""

from beltdyn.model import Drive
from beltdyn.model.advice import other_creep
from beltdyn.solve.integrators.trajectory import Statistics

_MANY = 0.1
"""Share of steps tried in vain from which on they are what makes a run long."""
_GENTLER = 10.0
"""Factor on the slip with which friction takes hold, by which a run is to be quicker."""
_NEAR = 0.4
"""Mean step over a bound from which on the bound is felt."""


def step_bound(drive: Drive, statistics: Statistics, reached: float) -> str:
    """Say what bounds the time steps, and what would let them be longer.

    Parameters
    ----------
    drive
        The drive.
    statistics
        What the solver did so far.
    reached
        Simulated time until now, s.

    Returns
    -------
    str
        One or two sentences; empty before the first step.
    """
    simulation = drive.simulation
    taken, rejected = statistics.steps, statistics.rejected_steps
    if taken == 0:
        return ""
    mean, share = reached / taken, rejected / (taken + rejected)
    if share > _MANY:
        return (
            f"{share:.0%} of the time steps are rejected because friction builds up within a small slip "
            f"or contact is stiff. For a faster run, {other_creep(drive, _GENTLER)}, which adds to the "
            f"slip; or reduce contact.stiffness = {drive.contact_stiffness:.2g} N/m^2, which reduces "
            "the tension."
        )
    if simulation.max_step is not None and mean > _NEAR * simulation.max_step:
        return f"simulation.max_step = {simulation.max_step:g} s limits the steps."
    if mean > _NEAR * simulation.output_interval:
        interval = simulation.output_interval
        return f"Steps end on outputs: a simulation.output_interval above {interval:g} s is faster."
    return (
        f"Steps are as short as simulation.rtol = {simulation.rtol:g} requires where the belt vibrates "
        f"on its pulleys. A larger value is faster, as are fewer belt.elements than {drive.elements}; "
        "`beltdyn check` shows the loss of accuracy."
    )

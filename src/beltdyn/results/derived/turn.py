"""Running means that remove ripple at the belt's turn and at harmonics."""

import numpy as np
import xarray as xr

from beltdyn.results.cycles import turn_window
from beltdyn.results.run import Run
from beltdyn.results.window import Cycle, Window


def turn_means(run: Run, variable: xr.DataArray) -> xr.DataArray:
    """Running mean of a variable over a turn of the belt and the period of other excitation.

    Parameters
    ----------
    run : Run
        The run.
    variable : DataArray
        A variable over time (first dimension), at outputs of this run.

    Returns
    -------
    DataArray
        The same variable averaged over whole windows with their middles at the instants: NaN before that of the first
        window, the mean over the last one after its middle. NaN where a value in the window is NaN. Unchanged where the
        belt does not even run by an element.

    Examples
    --------
    >>> bd.derived.turn_means(run, run.dataset.pulley_speed).dims
    ('time', 'pulley')
    """
    window = turn_window(run.dataset, run.drive)
    rows = np.searchsorted(window.time, variable["time"].values)
    cycles = tuple(Cycle(cycle.phase[rows], cycle.count) for cycle in window.cycles)
    return variable.copy(data=Window(window.time[rows], cycles).running_means(variable.values))

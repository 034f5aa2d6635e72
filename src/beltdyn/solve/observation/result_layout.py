"""Names and reference coordinates of the results of a drive."""

import numpy as np

from beltdyn.model import Drive
from beltdyn.results import Layout
from beltdyn.system.arrays import System
from beltdyn.system.discretization import curve_lengths, element_kind, point_coordinates
from beltdyn.system.frame import Flowing


def result_layout(drive: Drive, system: System) -> Layout:
    """Names and reference coordinates of the results.

    Parameters
    ----------
    drive, system
        What is simulated.

    Returns
    -------
    Layout
        Belt coordinates run from node 0 in the direction of motion.
    """
    names = tuple(pulley.name for pulley in drive.pulleys)
    spans = tuple(f"{a}-{b}" for a, b in drive.spans)
    lengths = curve_lengths(system)
    starts = np.cumsum(lengths) - lengths
    return Layout(
        pulleys=names,
        spans=spans,
        node_coordinate=point_coordinates(system),
        element_coordinate=starts + 0.5 * lengths,
        belt_coordinate=(starts[:, None] + lengths[:, None] * system.contact.points).ravel(),
        coordinate_names=element_kind(system).coordinates,
        tensioners=tuple(names[pulley] for pulley in system.tensioners.pulley),
        bodies=_bodies(drive, system),
    )


def _bodies(drive: Drive, system: System) -> tuple[str, ...]:
    """Names of rims, of bodies and controllers behind them, of the belt that flows, and of tensioners."""
    names = [pulley.name for pulley in drive.pulleys]
    hubs = [f"{one.name} hub[{number}]" for one in drive.pulleys for number, _ in enumerate(one.hub, 1)]
    lags = [
        f"{one.name} load[{number}]"
        for one in drive.pulleys
        for number, load in enumerate(one.load, 1)
        if load.state_lag is not None
    ]
    flow = ["belt"] if isinstance(system.frame, Flowing) else []
    return (*names, *hubs, *lags, *flow, *(f"{names[pulley]} tensioner" for pulley in system.tensioners.pulley))

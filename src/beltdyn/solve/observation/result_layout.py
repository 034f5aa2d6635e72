"""Names and reference coordinates of the results of a drive."""

import numpy as np

from beltdyn.model import Drive
from beltdyn.results import Layout
from beltdyn.system.arrays import System
from beltdyn.system.discretization import curve_lengths, element_kind, point_coordinates


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
    )

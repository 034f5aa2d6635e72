"""Wear intensity: friction work over the arc and over the belt, to which wear is proportional (Archard 1953)."""

import numpy as np
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.results.arc import arc_ends
from beltdyn.results.derived.labels import in_words, window
from beltdyn.results.friction_work import ARC_PARTS, BEYOND
from beltdyn.results.mechanics import element_lengths
from beltdyn.results.run import Run


def wear_by_arc(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Friction work ``|f_t v_t|`` over the arc of each pulley.

    In each of equal parts of the arc, the work done on the belt in it is summed and divided by its length, so that
    the sum over a pulley is all of its work. The parts reach a quarter of the arc between the tangent points further at
    both of its ends, since a belt that sinks in or bends touches before them.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s: from the first to the last output of fields between them.

    Returns
    -------
    DataArray
        J per metre of arc, pulley and ``share``: the middle of the part, 0 at the tangent point where the belt enters
        when it runs in the direction of ascending belt coordinate, 1 at the other; ``angle`` (rad) and ``part_length``
        (m) belong to it.

    Raises
    ------
    ModelError
        If there are no two outputs of fields between them, or the work was not recorded.

    Examples
    --------
    >>> bd.derived.wear_by_arc(run).dims
    ('pulley', 'share')
    """
    dataset, work = _work(run, "friction_work_on_arc", start, end)
    _, wrap = arc_ends(run.drive, dataset["pulley_center"].values.mean(axis=0))
    share = dataset["arc_share"].values
    length = np.broadcast_to(((1.0 + 2.0 * BEYOND) * run.drive.radii * wrap / ARC_PARTS)[:, None], work.shape)
    dims = ("pulley", "share")
    return xr.DataArray(
        work / length,
        {
            "pulley": dataset["pulley"],
            "share": ("share", share, {"units": "1", "long_name": "Position on the arc from the inlet"}),
            "angle": (dims, np.outer(wrap, share), {"units": "rad", "long_name": "Angle from the inlet"}),
            "part_length": (dims, length, {"units": "m", "long_name": "Length of the arc segment"}),
        },
        dims,
        attrs={"units": "J/m", "long_name": "Wear intensity on the arc"},
    )


def wear_by_belt(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Friction work ``|f_t v_t|`` over the belt.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s: from the first to the last output of fields between them.

    Returns
    -------
    DataArray
        J per metre of belt, pulley and element. On a staying mesh an element stands for the belt that was in it at the
        beginning. Pulleys on the back of the belt wear its other surface.

    Raises
    ------
    ModelError
        If there are no two outputs of fields between them, or the work was not recorded.

    Examples
    --------
    >>> bd.derived.wear_by_belt(run).dims
    ('pulley', 'element')
    """
    dataset, work = _work(run, "friction_work_on_belt", start, end)
    coordinates = {"pulley": dataset["pulley"], "element_coordinate": dataset["element_coordinate"]}
    attributes = {"units": "J/m", "long_name": "Wear intensity on the belt"}
    lengths = element_lengths(dataset, run.drive.belt_length)
    return xr.DataArray(work / lengths, coordinates, ("pulley", "element"), attrs=attributes)


def _work(run: Run, name: str, start: float | None, end: float | None) -> tuple[xr.Dataset, FloatArray]:
    """What was recorded, and the sum of works from the first to the last output of fields, J."""
    run.require(name)
    dataset = window(run, start, end)
    if dataset.sizes["field_time"] < 2:
        raise ModelError(
            f"there are fewer than two outputs along the belt from {in_words(start, end)}, so the friction work "
            "between them is unknown. Choose a longer time, or reduce simulation.field_interval."
        )
    return dataset, np.asarray(dataset[name][1:].values.sum(axis=0, dtype=float))

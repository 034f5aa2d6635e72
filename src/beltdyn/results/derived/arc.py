"""Contact along the arc of a pulley, over the angle from the inlet."""

import numpy as np
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.results.derived.labels import in_words, pulley_number, window
from beltdyn.results.friction_work import ARC_PARTS, BEYOND
from beltdyn.results.mechanics import angle_from_inlet, arc_ends, element_lengths, rim_speeds, sliding_velocity
from beltdyn.results.run import Run, StaticResult

# Wear intensity: friction work over the arc and over the belt, to which wear is proportional (Archard 1953)


def wear_by_arc(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Friction work ``|f_t v_t|`` over the arc of each pulley.

    The arc is divided into equal segments; the work in each is divided by its length, so that the integral over a
    pulley is its total friction work. The segments extend beyond the tangent points by a quarter of the arc at both
    ends, because penetration and bending make the belt touch earlier.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s, from its first to its last output along the belt.

    Returns
    -------
    DataArray
        J per meter of arc, by pulley and ``share``, the position of the middle of the segment: 0 at the inlet tangent
        point of a belt running in the direction of ascending belt coordinate, 1 at the outlet. Coordinates ``angle``
        (rad) and ``part_length`` (m).

    Raises
    ------
    ModelError
        If the range has fewer than two outputs along the belt, or the work was not recorded.

    Examples
    --------
    >>> bd.derived.wear_by_arc(run).dims
    ('pulley', 'share')
    """
    dataset, work = _work(run, "friction_work_on_arc", start, end)
    _, wrap = arc_ends(run.prepared, dataset["pulley_center"].values.mean(axis=0))
    share = dataset["arc_share"].values
    length = np.broadcast_to(((1.0 + 2.0 * BEYOND) * run.prepared.radii * wrap / ARC_PARTS)[:, None], work.shape)
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
        Time range, s, from its first to its last output along the belt.

    Returns
    -------
    DataArray
        J per meter of belt, by pulley and element. On a staying mesh an element represents the belt that it contained
        at the start. Pulleys on the back of the belt wear its other surface.

    Raises
    ------
    ModelError
        If the range has fewer than two outputs along the belt, or the work was not recorded.

    Examples
    --------
    >>> bd.derived.wear_by_belt(run).dims
    ('pulley', 'element')
    """
    dataset, work = _work(run, "friction_work_on_belt", start, end)
    coordinates = {"pulley": dataset["pulley"], "element_coordinate": dataset["element_coordinate"]}
    attributes = {"units": "J/m", "long_name": "Wear intensity on the belt"}
    lengths = element_lengths(dataset, run.prepared.belt_length)
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


def contact_arc(run: Run | StaticResult, pulley: str | int, time: float | None = None) -> xr.Dataset:
    """Pressure, shear and sliding along the arc of a pulley at one instant.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.

    Returns
    -------
    xarray.Dataset
        Over ``angle`` (rad, from the tangent point where the belt enters, in the direction in which the rim moves):
        ``normal_force`` and ``friction_force`` (N/m, the latter positive in that direction), ``pressure`` and ``shear``
        (Pa: these over the belt's width), ``slip_velocity`` (m/s, belt faster than the rim) and ``sliding``, 1 where
        friction is fully used, otherwise 0.

    Raises
    ------
    ModelError
        If there is no such pulley, or the run holds no output.

    Examples
    --------
    >>> arc = bd.derived.contact_arc(run, "driver")
    >>> sorted(arc)
    ['friction_force', 'normal_force', 'pressure', 'shear', 'sliding', 'slip_velocity']
    """
    number, prepared = pulley_number(run, pulley), run.prepared
    instant = run.fields_at(time)
    centers = instant["pulley_center"].values
    inlet, wrap = arc_ends(prepared, centers)
    touched = instant["contact_pulley"].values
    on = touched == number
    turning = prepared.pulleys[number].turning
    place = instant["contact_position"].values[on] - centers[number]
    angle = angle_from_inlet(place, inlet[number], wrap[number], turning)
    speed = instant["pulley_speed"].values
    backwards = rim_speeds(speed, prepared)[number] < 0.0
    forward = -turning if backwards else turning
    angle = wrap[number] - angle if backwards else angle
    normal, slip = instant["normal_force"].values, instant["slip_velocity"].values
    sliding = sliding_velocity(slip, normal, touched, speed, prepared)[on] != 0.0
    normal, shear = normal[on], forward * instant["friction_force"].values[on]
    columns = {
        "normal_force": (normal, "N/m", "Normal force on the belt"),
        "friction_force": (shear, "N/m", "Friction force on the belt"),
        "pressure": (normal / prepared.belt.width, "Pa", "Contact pressure"),
        "shear": (shear / prepared.belt.width, "Pa", "Contact shear"),
        "slip_velocity": (forward * slip[on], "m/s", "Slip velocity"),
        "sliding": (sliding.astype(float), "1", "Sliding"),
    }
    order = np.argsort(angle, kind="stable")
    return xr.Dataset(
        {
            name: ("angle", values[order], {"units": units, "long_name": long_name})
            for name, (values, units, long_name) in columns.items()
        },
        {"angle": ("angle", angle[order], {"units": "rad", "long_name": "Angle from the inlet"}), "time": instant.time},
    )

"""Contact over the place: along the arcs of pulleys and across nips, and wear by place on arcs and belt."""

import numpy as np
import xarray as xr

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Prepared
from beltdyn.results.friction_work import ARC_PARTS, BEYOND
from beltdyn.results.mechanics import angle_from_inlet, arc_ends, cells, element_lengths, rim_speeds, sliding_velocity
from beltdyn.results.run import Run, StaticResult, in_words, pulley_number, window

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
        (Pa: these over the belt's width), ``slip_velocity`` (m/s, belt faster than the rim), ``sliding``, 1 where
        friction is fully used, otherwise 0, and ``belt_tension`` (N), linear between the middles of elements.

    Raises
    ------
    ModelError
        If there is no such pulley, or the run holds no output.

    Examples
    --------
    >>> arc = bd.derived.contact_arc(run, "driver")
    >>> sorted(arc)
    ['belt_tension', 'friction_force', 'normal_force', 'pressure', 'shear', 'sliding', 'slip_velocity']
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
        "belt_tension": (_tension_at_points(instant)[on], "N", "Belt tension"),
    }
    order = np.argsort(angle, kind="stable")
    return xr.Dataset(
        {
            name: ("angle", values[order], {"units": units, "long_name": long_name})
            for name, (values, units, long_name) in columns.items()
        },
        {"angle": ("angle", angle[order], {"units": "rad", "long_name": "Angle from the inlet"}), "time": instant.time},
    )


def _tension_at_points(instant: xr.Dataset) -> FloatArray:
    """Tension of the belt at all contact points, N, linear between the middles of elements."""
    tension, points = instant["belt_tension"].values, instant.sizes["contact_point"]
    place = (np.arange(points) + 0.5) * len(tension) / points
    return np.asarray(np.interp(place, np.arange(len(tension)) + 0.5, tension, period=len(tension)))


def _number(run: Run, roller: str | int) -> tuple[int, int, int]:
    """Row of a nip in the results, its roller and its pulley."""
    number, beside = pulley_number(run, roller), run.prepared.path.nips_by_roller
    names = [run.drive.pulleys[one].name for one, _ in beside]
    if number not in [one for one, _ in beside]:
        raise ModelError(
            f'"{run.drive.pulleys[number].name}" is not the roller of a nip. '
            + (f"Choose one of {', '.join(names)}." if names else "The drive has no [[nip]].")
        )
    row = [one for one, _ in beside].index(number)
    return row, *beside[row]


def nip_profile(run: Run, roller: str | int, time: float | None = None) -> xr.Dataset:
    """Pressure, shear and slip over a nip on both faces of the belt at one instant.

    Parameters
    ----------
    run : Run
        The run.
    roller : str or int
        Name or number of the roller beside the path.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.

    Returns
    -------
    xarray.Dataset
        Over ``face`` (both rollers by name) and ``distance`` (m, along the running belt from the line of centers):
        ``pressure`` and ``shear`` on the belt (Pa, the latter positive in the direction in which the belt runs) and
        ``slip_velocity`` (m/s, belt faster than the roller).

    Raises
    ------
    ModelError
        If there is no such nip, or the run holds no output.

    Examples
    --------
    >>> bd.derived.nip_profile(run, "driver")
    Traceback (most recent call last):
    ...
    beltdyn.errors.ModelError: "driver" is not the roller of a nip. The drive has no [[nip]].
    """
    row, beside, on = _number(run, roller)
    instant, prepared = run.fields_at(time), run.prepared
    here = np.flatnonzero(instant["nip_normal_force"].values[row] > 0.0)
    centers = instant["pulley_center"].values
    way = centers[beside] - centers[on]
    from_center = instant["contact_position"].values[here] - centers[on]
    across = (way[0] * from_center[:, 1] - way[1] * from_center[:, 0]) / np.hypot(*way)
    forward = float(np.sign(rim_speeds(instant["pulley_speed"].values, prepared)[on])) or 1.0
    # the belt touches its roller beside the path with the other face: forces there are along the clockwise tangent
    turning = np.array([prepared.pulleys[one].turning for one in (beside, on)], dtype=float)
    sense = turning[1] * forward
    values = {
        "pressure": ("normal_force", 1.0 / prepared.belt.width, "Pa", "Pressure in the nip"),
        "shear": ("friction_force", forward / prepared.belt.width, "Pa", "Shear in the nip"),
        "slip_velocity": ("slip_velocity", forward, "m/s", "Slip velocity in the nip"),
    }
    order = np.argsort(sense * across)
    columns = {}
    for name, (variable, factor, units, long_name) in values.items():
        faces = np.stack([instant[f"nip_{variable}"].values[row, here], instant[variable].values[here]])
        if name != "pressure":
            faces = turning[:, None] * faces
        columns[name] = (("face", "distance"), factor * faces[:, order], {"units": units, "long_name": long_name})
    labels = [run.drive.pulleys[one].name for one in (beside, on)]
    distance = ("distance", (sense * across)[order], {"units": "m", "long_name": "Distance from the line of centers"})
    return xr.Dataset(columns, {"face": labels, "distance": distance, "time": instant.time})


def nips(run: Run, time: float | None = None) -> xr.Dataset:
    """What each nip does at one instant.

    Parameters
    ----------
    run : Run
        The run.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.

    Returns
    -------
    xarray.Dataset
        By ``nip``: ``force`` (N), ``width`` (m), ``peak_pressure`` (Pa), ``indentation`` (m, by which the undeformed
        rollers and the belt overlap) and the ``gap`` that follows from it (m), ``thickness`` (m, the least one of the
        belt) and ``thickness_after`` (m, behind the nip, by ``belt.compression_set``), ``compression_loss`` (W, of
        covers and belt on both rollers), ``tension_before`` and ``tension_after`` (N) where the running belt enters and
        leaves, and ``speed_ratio``, surface speed of the roller over that of the pulley. By ``nip`` and ``side``
        (roller, pulley): ``pull`` (N, on the belt in the nip, positive in the direction in which it runs), ``torque``
        (N m, on the shaft), ``grip_limit`` (N, mu F), and ``grip``, the pull over it.

    Raises
    ------
    ModelError
        If the drive has no nip, or the run holds no output.

    Examples
    --------
    >>> bd.derived.nips(run)
    Traceback (most recent call last):
    ...
    beltdyn.errors.ModelError: the drive has no nip. Give a group [[nip]].
    """
    pairs, prepared = run.prepared.path.nips_by_roller, run.prepared
    if not pairs:
        raise ModelError("the drive has no nip. Give a group [[nip]].")
    instant = run.fields_at(time)
    at = run.dataset.sel(time=instant.time)
    reach = cells(instant["belt_coordinate"].values, prepared.belt_length)
    speeds = rim_speeds(at["pulley_speed"].values, prepared)
    forward = float(np.sign(speeds[prepared.reference])) or 1.0
    columns = dict[str, list[float | list[float]]]()

    def add(**values: float | list[float]) -> None:
        for name, value in values.items():
            columns.setdefault(name, []).append(value)

    for row, (roller, pulley) in enumerate(pairs):
        pressed = instant["nip_normal_force"].values[row] > 0.0
        way = at["pulley_center"].values[pulley] - at["pulley_center"].values[roller]
        apart = float(np.hypot(*way))
        radii = prepared.radii[[roller, pulley]]
        pulls = [
            forward * prepared.pulleys[one].turning * float(np.sum((reach * force)[pressed]))
            for one, force in (
                (roller, instant["nip_friction_force"].values[row]),
                (pulley, instant["friction_force"].values),
            )
        ]
        normal = [
            float(np.sum((reach * force)[pressed]))
            for force in (instant["nip_normal_force"].values[row], instant["normal_force"].values)
        ]
        add(
            force=-float(at["hub_force"].values[roller] @ way) / apart,
            width=float(at["nip_width"].values[row]),
            peak_pressure=float(instant["nip_normal_force"].values[row].max()) / prepared.belt.width,
            indentation=float(radii.sum()) - apart,
            gap=prepared.belt.thickness - float(radii.sum()) + apart,
            thickness=_thickness(prepared, instant, row, pressed),
            thickness_after=_thickness(prepared, instant, row, pressed, prepared.belt.compression_set),
            compression_loss=float(at["contact_damping_power"].values[[roller, pulley]].sum()),
            tension_before=float(at["nip_tension_before"].values[row]),
            tension_after=float(at["nip_tension_after"].values[row]),
            speed_ratio=float(speeds[roller] / speeds[pulley]) if speeds[pulley] else np.nan,
            pull=pulls,
            torque=at["shaft_torque"].values[[roller, pulley]].tolist(),
            grip_limit=(limits := (prepared.frictions[[roller, pulley]] * normal).tolist()),
            grip=_grip(pulls, limits),
        )
    described = {
        "force": ("N", "Force of the nip"),
        "width": ("m", "Nip width"),
        "peak_pressure": ("Pa", "Peak pressure in the nip"),
        "indentation": ("m", "Overlap of undeformed rollers and belt"),
        "gap": ("m", "Gap of undeformed rollers"),
        "thickness": ("m", "Least thickness of the belt in the nip"),
        "thickness_after": ("m", "Thickness of the belt behind the nip"),
        "compression_loss": ("W", "Power lost by compression"),
        "tension_before": ("N", "Tension where the belt enters the nip"),
        "tension_after": ("N", "Tension where the belt leaves the nip"),
        "speed_ratio": ("1", "Surface speed of the roller over that of the pulley"),
        "pull": ("N", "Force along the running belt in the nip"),
        "torque": ("N m", "Torque on the shaft"),
        "grip_limit": ("N", "Largest force along the belt by friction"),
        "grip": ("1", "Force along the belt over its limit"),
    }
    return xr.Dataset(
        {
            name: (
                ("nip", "side") if np.ndim(columns[name]) > 1 else ("nip",),
                np.array(columns[name], dtype=float),
                {"units": units, "long_name": long_name},
            )
            for name, (units, long_name) in described.items()
        },
        {"nip": [run.drive.pulleys[one].name for one, _ in pairs], "side": ["roller", "pulley"], "time": instant.time},
    )


def _thickness(prepared: Prepared, instant: xr.Dataset, row: int, pressed: BoolArray, part: float = 1.0) -> float:
    """Least thickness of a belt that each face presses by its line force over the stiffness of contact, m.

    A part of that compression leaves the thickness behind the nip.
    """
    faces = instant["nip_normal_force"].values[row] + instant["normal_force"].values
    return float(prepared.belt.thickness - part * np.max(faces[pressed], initial=0.0) / prepared.contact_stiffness)


def _grip(pulls: list[float], limits: list[float]) -> list[float]:
    """Force along the belt on both sides over its limit mu F; NaN without friction."""
    return [abs(pull) / limit if limit > 0.0 else np.nan for pull, limit in zip(pulls, limits, strict=True)]

"""Nips: pressure and shear on both faces of the belt between two rollers, and what follows from them."""

import numpy as np
import xarray as xr

from beltdyn.arrays import BoolArray
from beltdyn.errors import ModelError
from beltdyn.model import Prepared
from beltdyn.results.derived.labels import pulley_number
from beltdyn.results.mechanics import cells, rim_speeds
from beltdyn.results.run import Run


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
    along = instant["belt_coordinate"].values[here]
    centers = instant["pulley_center"].values
    way = centers[beside] - centers[on]
    from_center = instant["contact_position"].values[here] - centers[on]
    across = (way[0] * from_center[:, 1] - way[1] * from_center[:, 0]) / np.hypot(*way)
    ahead = np.sign(along[-1] - along[0]) * np.sign(float(rim_speeds(instant["pulley_speed"].values, prepared)[on]))
    sense = np.sign(across[-1] - across[0]) * (ahead or 1.0)
    forward = ahead or 1.0
    values = {
        "pressure": ("normal_force", 1.0 / prepared.belt.width, "Pa", "Pressure in the nip"),
        "shear": ("friction_force", forward / prepared.belt.width, "Pa", "Shear in the nip"),
        "slip_velocity": ("slip_velocity", forward, "m/s", "Slip velocity in the nip"),
    }
    # the belt touches its roller beside the path with the other face: forces there are along the clockwise tangent
    turning = np.array([prepared.pulleys[one].turning for one in (beside, on)], dtype=float)
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

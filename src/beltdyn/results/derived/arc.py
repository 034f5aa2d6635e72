"""Contact along the arc of a pulley, by the angle from where the belt enters."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from beltdyn.model import Drive, Path
from beltdyn.results.derived.labels import pulley_number
from beltdyn.results.mechanics import rim_speeds, sliding_velocity
from beltdyn.results.run import Run

FloatArray = NDArray[np.float64]


def arc_ends(drive: Drive, centers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give the angles at which the belt's path reaches and the wrap angles, from circles alone.

    Parameters
    ----------
    drive : Drive
        Effective radii and sides.
    centers : ndarray, shape (pulleys, 2)
        Where the pulleys are, m.

    Returns
    -------
    inlet, wrap : ndarray, shape (pulleys,)
        Angle of the tangent point where the span before each pulley ends, from the x axis; wrap angle; rad.
    """
    path = Path(centers, drive.path.radii)
    reached = np.roll(path.span_points[:, 1], 1, axis=0) - centers
    return np.arctan2(reached[:, 1], reached[:, 0]), path.wrap_angles


def angle_from_inlet(place: FloatArray, inlet: float, wrap: float, turning: int) -> FloatArray:
    """Angle of points around a pulley in the direction of ascending belt coordinate.

    Parameters
    ----------
    place : ndarray, shape (k, 2)
        Points, from the pulley's center, m.
    inlet, wrap : float
        See `arc_ends`.
    turning : int
        1, or -1 for a pulley at the belt's back.

    Returns
    -------
    ndarray, shape (k,)
        rad, zero at the inlet, negative shortly before it.
    """
    free = 0.5 * (2.0 * np.pi - wrap)
    turned = turning * (np.arctan2(place[:, 1], place[:, 0]) - inlet)
    return np.asarray(np.mod(turned + free, 2.0 * np.pi) - free)


def contact_arc(run: Run, pulley: str | int, time: float | None = None) -> xr.Dataset:
    """Give pressure, shear and sliding along the arc of a pulley at one instant.

    Parameters
    ----------
    run : Run
        The run.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        The instant, s; the output nearest to it is taken. The last one by default.

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
    """
    number, drive = pulley_number(run, pulley), run.drive
    run.require_output()
    instant = run.dataset.isel(time=-1) if time is None else run.dataset.sel(time=time, method="nearest")
    centers = instant["pulley_center"].values
    inlet, wrap = arc_ends(drive, centers)
    touched = instant["contact_pulley"].values
    on = touched == number
    turning = drive.pulleys[number].turning
    place = instant["contact_position"].values[on] - centers[number]
    angle = angle_from_inlet(place, inlet[number], wrap[number], turning)
    backwards = rim_speeds(instant["pulley_speed"].values, drive)[number] < 0.0
    forward = -turning if backwards else turning
    angle = wrap[number] - angle if backwards else angle
    normal, slip = instant["normal_force"].values, instant["slip_velocity"].values
    sliding = sliding_velocity(slip, normal, touched, drive)[on] != 0.0
    normal, shear = normal[on], forward * instant["friction_force"].values[on]
    columns = {
        "normal_force": (normal, "N/m", "Normal force on the belt"),
        "friction_force": (shear, "N/m", "Friction force on the belt"),
        "pressure": (normal / drive.belt.width, "Pa", "Contact pressure"),
        "shear": (shear / drive.belt.width, "Pa", "Contact shear"),
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

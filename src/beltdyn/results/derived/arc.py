"""Contact along the arc of a pulley, over the angle from the inlet."""

import numpy as np
import xarray as xr

from beltdyn.results.arc import angle_from_inlet, arc_ends
from beltdyn.results.derived.labels import pulley_number
from beltdyn.results.mechanics import rim_speeds, sliding_velocity
from beltdyn.results.run import Run
from beltdyn.results.static import StaticResult


def contact_arc(run: Run | StaticResult, pulley: str | int, time: float | None = None) -> xr.Dataset:
    """Pressure, shear and sliding along the arc of a pulley at one instant.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        The instant, s; the output of fields nearest to it is taken. The last one by default.

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
    number, drive = pulley_number(run, pulley), run.drive
    instant = run.fields_at(time)
    centers = instant["pulley_center"].values
    inlet, wrap = arc_ends(drive, centers)
    touched = instant["contact_pulley"].values
    on = touched == number
    turning = drive.pulleys[number].turning
    place = instant["contact_position"].values[on] - centers[number]
    angle = angle_from_inlet(place, inlet[number], wrap[number], turning)
    speed = instant["pulley_speed"].values
    backwards = rim_speeds(speed, drive)[number] < 0.0
    forward = -turning if backwards else turning
    angle = wrap[number] - angle if backwards else angle
    normal, slip = instant["normal_force"].values, instant["slip_velocity"].values
    sliding = sliding_velocity(slip, normal, touched, speed, drive)[on] != 0.0
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

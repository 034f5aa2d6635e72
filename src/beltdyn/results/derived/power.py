"""Pulley powers over time."""

import xarray as xr

from beltdyn.results.balance import Balance, power_balance
from beltdyn.results.derived.labels import labelled, window
from beltdyn.results.run import Run
from beltdyn.results.window import plain_window


def pulley_powers(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Power in, power out and loss at every pulley.

    What comes in at the shaft either goes to the belt or is lost in contact, but for what the rim, the bodies of its
    hub and the contact store at the moment: in the mean of steady running ``power_in`` = ``power_out`` +
    ``power_lost``. At a driven pulley power in and out are negative: the belt gives more than the load takes.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    xarray.Dataset
        W, time and pulley: ``power_in`` = shaft torque * shaft speed, from the shaft; ``power_out`` = - torque of the
        belt * pulley speed - losses in contact, to the belt; ``power_lost`` = ``friction_power`` +
        ``contact_damping_power``; and these two.

    Examples
    --------
    >>> sorted(bd.derived.pulley_powers(run))
    ['contact_damping_power', 'friction_power', 'power_in', 'power_lost', 'power_out']
    """
    dataset = window(run, start, end)
    lost = dataset["friction_power"] + dataset["contact_damping_power"]
    powers = {
        "power_in": (dataset["shaft_torque"] * dataset["shaft_speed"], "Power from the shaft"),
        "power_out": (-dataset["pulley_torque"] * dataset["pulley_speed"] - lost, "Power to the belt"),
        "power_lost": (lost, "Power lost in contact"),
    }
    made = {name: labelled(value.values, lost, "W", long_name) for name, (value, long_name) in powers.items()}
    return xr.Dataset({**made, **{name: dataset[name] for name in ("friction_power", "contact_damping_power")}})


def balance(run: Run, start: float | None = None, end: float | None = None) -> Balance:
    """Mean shaft powers, losses by cause and efficiency over part of a run.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s.

    Returns
    -------
    Balance
        Mean powers; the efficiency leaves out what is being stored or given back.

    Examples
    --------
    >>> balance = bd.derived.balance(run)
    >>> sorted(balance.losses)[:3]
    ['belt bending', 'belt compression', 'belt stretch']
    """
    part = window(run, start, end)
    return power_balance(part, plain_window(part["time"].values))

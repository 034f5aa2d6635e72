"""Pulley loads over time: hub load, slip safety and tension ratio."""

import numpy as np
import xarray as xr

from beltdyn.results.cycles import Cycle, Window, plain_window, turn_window
from beltdyn.results.energy_balance import Balance, lifting_power, power_balance
from beltdyn.results.mechanics import SpanTension, rim_speeds
from beltdyn.results.run import Run, labelled, window
from beltdyn.results.schema import SLIP_SAFETIES
from beltdyn.results.slip_safety import slip_parts, slip_safety_of

# Pulley powers over time


def pulley_powers(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Power in, power out and loss at every pulley.

    Shaft power is transmitted to the belt, lost in contact, or stored in the rim, the bodies of its hub chain and the
    contact; on average in steady running ``power_in`` = ``power_out`` + ``power_lost``. At a driven pulley, power in
    and out are negative.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

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
        Time range, s.

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
    over = plain_window(part["time"].values)
    return power_balance(part, over, lifting_power(part, run.prepared, over))


# Span tensions and mid-span displacements


def span_tensions(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Mean, minimum and maximum tension of every span, along it and over time.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    xarray.Dataset
        ``mean``, ``min`` and ``max``, N, by span.

    Examples
    --------
    >>> bd.derived.span_tensions(run, end=0.0)["mean"].values.round(2)  # N, at rest
    array([28.19, 28.19])
    """
    part = window(run, start, end)
    numbers = {
        "mean": (part["span_tension"].mean("time"), "Mean span tension"),
        "min": (part["least_span_tension"].min("time"), "Minimum span tension"),
        "max": (part["largest_span_tension"].max("time"), "Maximum span tension"),
    }
    return xr.Dataset(
        {name: value.assign_attrs(units="N", long_name=meaning) for name, (value, meaning) in numbers.items()}
    )


def mid_span_displacements(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Mid-span displacement of every span.

    The straight line between the tangent points of the two pulleys, where these are at the instant, is zero; the
    belt's place is interpolated between the points of contact of the free belt before and after the middle. Since the
    belt sinks into pulleys, it is a little off zero even at rest.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    DataArray
        m, time and span, positive to the left of the direction of ascending belt coordinate: inwards on a drive
        without crossings; NaN where the belt has left a pulley.

    Raises
    ------
    ModelError
        If it was not recorded.

    Examples
    --------
    >>> bd.derived.mid_span_displacements(run).dims
    ('time', 'span')
    """
    run.require("mid_span_displacement")
    return window(run, start, end)["mid_span_displacement"]


# Running means that remove ripple at the belt's turn and at harmonics


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
    window = turn_window(run.dataset, run.prepared)
    rows = np.searchsorted(window.time, variable["time"].values)
    cycles = tuple(Cycle(cycle.phase[rows], cycle.count) for cycle in window.cycles)
    return variable.copy(data=Window(window.time[rows], cycles).running_means(variable.values))


# Slip of the pulleys and its parts: creep, and sliding of the whole arc

_STANDING = 0.01
"""Share of its largest speed below which the driver counts as standing still."""


def slips(run: Run, start: float | None = None, end: float | None = None, *, turns: bool = True) -> xr.Dataset:
    """Slip and its parts over time.

    The slip of pulley i is its rim's speed loss against that of the driver d, which is the first pulley of prescribed
    speed, or else the first with a motor: s_i = 1 - v_i / v_d with v = ``|omega|`` R, positive in the direction in
    which the belt runs. Speeds are means over a turn of the belt and the period of other
    excitation, as in the summary, or instantaneous values. With the velocity g (belt faster than the rim)
    at which the belt slides on the *whole* arc of a pulley beyond what the friction law calls creep,

        sliding_i = (g_i - g_d) / v_d,    creep_i = s_i - sliding_i.

    Creep is thus the slip of a belt that still sticks somewhere on both arcs. Its part

        elastic_creep_i = 1 - g(T_i) / g(T_d)

    with the stretches g of the spans that reach the two pulleys, (T_d - T_i) / E A at small strain, is the creep
    of a belt without bending stiffness under Coulomb friction (Reynolds 1874, Grashof 1883). ``radial`` is due to the
    sinking of the cord, with ``contact.slip_radius = "cord"``. ``bending`` is due to the
    stretch lost in bending and its hysteresis at the inlet (`theory.creep.entry_strain`), and
    ``regularization``, the rest, to the slope of the friction law. Sliding has no bound, as on an overloaded pulley.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.
    turns : bool
        Whether speeds and tensions are means over turns (`turn_means`) or instantaneous.

    Returns
    -------
    xarray.Dataset
        ``slip``, ``creep``, ``elastic_creep``, ``radial``, ``bending``, ``regularization`` and ``sliding`` in %, over
        time and pulley; NaN while the driver stands still.

    Examples
    --------
    >>> bd.derived.slips(run)["slip"].dims
    ('time', 'pulley')
    """
    dataset = window(run, start, end)
    dataset = run.dataset if turns else dataset
    over = turn_window(run.dataset, run.prepared) if turns else Window(dataset["time"].values, ())
    gross = over.running_means(dataset["sliding_speed"].values)
    speed = over.running_means(dataset["pulley_speed"].values)
    tension = SpanTension.of(lambda name: over.running_means(dataset[name].values))
    rim = rim_speeds(speed, run.prepared)
    driver = np.abs(rim[:, run.drive.reference, None])
    rim = np.where(driver > _STANDING * np.max(driver, initial=0.0, where=np.isfinite(driver)), rim, 0.0)
    parts = slip_parts(rim, tension, gross, np.ptp(run.dataset["time"].values), run.prepared)
    called = {
        "slip": (parts.slip, "Slip"),
        "creep": (parts.slip - parts.sliding, "Creep"),
        "elastic_creep": (parts.elastic_creep, "Elastic creep"),
        "radial": (parts.radial, "Slip due to the sinking of the cord"),
        "bending": (parts.bending, "Slip due to bending"),
        "regularization": (parts.regularization, "Slip due to the friction law slope"),
        "sliding": (parts.sliding, "Sliding"),
    }
    like = dataset["pulley_speed"]
    made = {name: labelled(100.0 * values, like, "%", long_name) for name, (values, long_name) in called.items()}
    return xr.Dataset(made).sel(time=slice(start, end))


def sliding_arcs(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Sliding arc of each pulley: where ``|f_t|`` has reached mu f_n.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    xarray.Dataset
        ``sliding_share`` of the arc of contact, and ``sliding_arc`` = share * wrap angle, rad; time and pulley.

    Examples
    --------
    >>> sorted(bd.derived.sliding_arcs(run))
    ['sliding_arc', 'sliding_share']
    """
    dataset = window(run, start, end)
    wrap, share = dataset["wrap_angle"], dataset["sliding_share"].values
    return xr.Dataset(
        {
            "sliding_share": labelled(share, wrap, "1", "Sliding share of the arc"),
            "sliding_arc": labelled(share * wrap.values, wrap, "rad", "Sliding arc"),
        }
    )


def hub_loads(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Hub load of every pulley as vector, magnitude and direction.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    xarray.Dataset
        ``hub_force`` (time, pulley, axis) and ``hub_load``, its magnitude, in N; ``hub_direction``, its direction
        from the x axis, counter-clockwise from -pi to pi, rad.

    Examples
    --------
    >>> bd.derived.hub_loads(run)["hub_load"][0].values.round(2)  # N, at rest
    array([69.39, 69.39])
    """
    force = window(run, start, end)["hub_force"]
    x, y = force.sel(axis="x", drop=True), force.sel(axis="y", drop=True)
    return xr.Dataset(
        {
            "hub_force": force,
            "hub_load": labelled(np.hypot(x.values, y.values), x, "N", "Hub load"),
            "hub_direction": labelled(np.arctan2(y.values, x.values), x, "rad", "Hub load direction"),
        }
    )


def slip_safety(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Slip safety: the factor on all loads at which each pulley reaches gross slip, at each instant.

    See `beltdyn.results.slip_safety.slip_safety_of_states`: 1 at the edge of gross slip, NaN without load.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    DataArray
        Time and pulley; NaN where a span is missing because the belt has left a pulley.

    Examples
    --------
    >>> bd.derived.slip_safety(run).dims
    ('time', 'pulley')
    """
    return slip_safeties(run, start, end)["slip_safety"]


def slip_safeties(run: Run, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Slip safety by all loads, and by the load of each pulley alone, at each instant; see `slip_safety`.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    xarray.Dataset
        ``slip_safety`` and ``own_load_safety``, over time and pulley.

    Examples
    --------
    >>> sorted(bd.derived.slip_safeties(run))
    ['own_load_safety', 'slip_safety']
    """
    dataset = window(run, start, end)
    found = slip_safety_of(lambda name: dataset[name].values, run.prepared)
    return xr.Dataset(
        {
            name: labelled(values, dataset["wrap_angle"], "1", label)
            for (name, label), values in zip(SLIP_SAFETIES.items(), found, strict=True)
        }
    )


def tension_ratios(run: Run, start: float | None = None, end: float | None = None) -> xr.DataArray:
    """Tension ratio at every pulley: the larger over the smaller tension at the ends of its arc.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        Time range, s.

    Returns
    -------
    DataArray
        Time and pulley, at least 1; NaN where a span is slack.

    Examples
    --------
    >>> bd.derived.tension_ratios(run)[0].values.round(3)  # at rest
    array([1., 1.])
    """
    dataset = window(run, start, end)
    before, after = SpanTension.of(lambda name: dataset[name].values).at_arcs(run.prepared)
    tight, slack = np.maximum(before, after), np.minimum(before, after)
    ratio = np.divide(tight, slack, out=np.full_like(slack, np.nan), where=slack > 0.0)
    return labelled(ratio, dataset["wrap_angle"], "1", "Tension ratio")

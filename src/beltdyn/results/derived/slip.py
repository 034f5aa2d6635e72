"""Slip of the pulleys and its parts: creep, and sliding of the whole arc."""

import numpy as np
import xarray as xr

from beltdyn.results.cycles import turn_window
from beltdyn.results.derived.labels import labelled, window
from beltdyn.results.mechanics import rim_speeds
from beltdyn.results.run import Run
from beltdyn.results.slipping import slip_parts
from beltdyn.results.window import Window

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
    of a belt without bending stiffness under Coulomb friction (Reynolds 1874, Grashof 1883). ``bending`` is due to the
    stretch lost in bending and its hysteresis at the inlet (`theory.elastic_creep.entry_strain`), and
    ``regularisation``, the rest, to the slope of the friction law. Sliding has no bound, as on an overloaded pulley.

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
        ``slip``, ``creep``, ``elastic_creep``, ``bending``, ``regularisation`` and ``sliding`` in %, over time and
        pulley; NaN while the driver stands still.

    Examples
    --------
    >>> bd.derived.slips(run)["slip"].dims
    ('time', 'pulley')
    """
    dataset = window(run, start, end)
    dataset = run.dataset if turns else dataset
    over = turn_window(run.dataset, run.drive) if turns else Window(dataset["time"].values, ())
    gross = over.running_means(dataset["sliding_speed"].values)
    speed, tension = (over.running_means(dataset[name].values) for name in ("pulley_speed", "span_tension"))
    rim = rim_speeds(speed, run.drive)
    driver = np.abs(rim[:, run.drive.reference, None])
    rim = np.where(driver > _STANDING * np.max(driver, initial=0.0, where=np.isfinite(driver)), rim, 0.0)
    parts = slip_parts(rim, tension, gross, np.ptp(run.dataset["time"].values), run.drive)
    called = {
        "slip": (parts.slip, "Slip"),
        "creep": (parts.slip - parts.sliding, "Creep"),
        "elastic_creep": (parts.elastic_creep, "Elastic creep"),
        "bending": (parts.bending, "Slip due to bending"),
        "regularisation": (parts.regularisation, "Slip due to the friction law slope"),
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

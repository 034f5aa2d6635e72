"""Figures of nips: pressure and shear on both faces of the belt."""

from collections.abc import Callable
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.results import Run, derived
from beltdyn.show.plot.legends import name_lines
from beltdyn.show.plot.registry import Choice, figure
from beltdyn.show.plot.style import axes_or_new, color, dash, panels

_KILO = 1e3


def _has_nips(run: Run) -> bool:
    """Whether the drive of a run has nips, and the run outputs."""
    return bool(run.drive.nips) and run.dataset.sizes["field_time"] > 0


def _by_nips(draw: Callable[..., Axes], run: Run, choice: Choice) -> Figure:
    """Lay out a panel for each nip."""
    return panels([[partial(draw, run, nip.roller) for nip in run.drive.nips] or [partial(draw, run)]])


@figure(_has_nips, _by_nips)
def nip_pressure(run: Run, roller: str | int | None = None, time: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw pressure and shear over a nip on both faces of the belt.

    Parameters
    ----------
    run : Run
        A run or steady running of a drive with nips.
    roller : str or int, optional
        Name or number of the roller beside the path; that of the first nip by default.
    time : float, optional
        Instant of an output along the belt, s; the last one by default.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes. Shear on the belt is positive in the direction in which it runs.

    Raises
    ------
    ModelError
        If there is no such nip, or the run holds no output.

    Examples
    --------
    >>> bd.plot.nip_pressure(run)
    Traceback (most recent call last):
    ...
    beltdyn.errors.ModelError: "driver" is not the roller of a nip. The drive has no [[nip]].
    """
    if roller is None:
        roller = run.drive.nips[0].roller if run.drive.nips else 0
    profile = derived.nip_profile(run, roller, time)
    ax = axes_or_new(ax)
    for face in profile["face"].values.tolist():
        number, own = run.drive.number_of(face), profile.sel(face=face)
        for part, style in (("pressure", "-"), ("shear", dash(1))):
            values = own[part] / _KILO
            ax.plot(1e3 * own["distance"], values, color=color(number), linestyle=style, label=f"{part}, {face}")
    ax.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    ax.set(xlabel=f"{profile['distance'].attrs['long_name']} [mm]", ylabel="Stress in the nip [kPa]")
    ax.set_title(" on ".join(profile["face"].values.tolist()))
    name_lines(ax)
    return ax

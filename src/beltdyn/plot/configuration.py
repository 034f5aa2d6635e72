"""The drive as it stands at one instant."""

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from beltdyn.analyses import RUN, STATIC
from beltdyn.plot.drive import DrivePicture, draw_rotation, fit_height, size_of
from beltdyn.plot.headline import at_instant
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import axes_or_new, new_figure
from beltdyn.plot.view import spread
from beltdyn.results import Result, Run, StaticResult


def _one_large_panel(draw: Callable[..., Axes], run: Result, choice: Choice) -> Figure:
    """Lay out a figure of one panel, as large as the drive asks for."""
    page = new_figure(size_of(run.drive))
    fit_height(page, draw(run, ax=page.add_subplot()))
    return page


@figure(always, _one_large_panel, of=(RUN, STATIC))
def configuration(run: Run | StaticResult, time: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw belt and pulleys at one instant, the belt's tension in color.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    time : float, optional
        The instant, s; the output of fields nearest to it is drawn. The last one by default.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.configuration(run).get_xlabel()
    'x [m]'
    """
    instant = run.fields_at(time)
    ax = axes_or_new(ax, size_of(run.drive))
    tension = instant["belt_tension"].values
    DrivePicture(run, ax, Normalize(*spread(float(tension.min()), float(tension.max()), "N"))).show(instant)
    ax.set_title(at_instant(run, float(instant["time"])))
    centers = instant["pulley_center"].values if "pulley_center" in instant else run.drive.centers
    for pulley, center, speed in zip(run.drive.pulleys, centers, instant["pulley_speed"].values, strict=True):
        draw_rotation(ax, center, pulley.radius, float(speed))
    return ax

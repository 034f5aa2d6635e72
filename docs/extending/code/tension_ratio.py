"""Ratio of the span tensions on both sides of the pulleys."""

from matplotlib.axes import Axes

from beltdyn.results import Run
from beltdyn.show.plot import axes_or_new, color, dash, figure, label, name_lines


@figure()
def tension_ratio(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the tension behind each pulley over the one before it.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> axes = bd.plot.tension_ratio(run)
    """
    ax = axes_or_new(ax)
    time, tension = run.dataset["time"], run.dataset["span_tension"].values
    for number, pulley in enumerate(run.drive.pulleys):  # span i leads from pulley i to the next
        ratio = tension[:, number] / tension[:, number - 1]
        ax.plot(time, ratio, color=color(number), linestyle=dash(number), label=pulley.name)
    ax.set(xlabel=label(time), ylabel="Span tension behind over before [1]")
    name_lines(ax)
    return ax

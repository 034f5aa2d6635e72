"""Squeal: how fast self-excited vibrations of a drive grow over its load."""

import numpy as np
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.plot.figures import figure
from beltdyn.show.plot.style import INK, axes_or_new, color, label, name_lines


def _was_asked(result: Result) -> bool:
    return "squeal_growth" in result.dataset


@figure(_was_asked, of=("modes",))
def squeal(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the growth rate of the fastest growing vibration over the load, with its frequency in kHz at each point.

    Colors are those of the pulley whose friction feeds it. A dashed line marks the load from which on the belt squeals,
    a dotted one gross slip.

    Parameters
    ----------
    result : Result
        Of `modes` with ``squeal``.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the result has no answer to squeal.

    Examples
    --------
    >>> wet = bd.modes(bd.example("alternator_drive"), squeal="wet")
    >>> bd.plot.squeal(wet).get_xlabel()
    'Load, factor on all loads of the drive'
    """
    if not _was_asked(result):
        raise ModelError('this result does not say whether the belt squeals. Compute `modes` with squeal = "wet".')
    ax, dataset = axes_or_new(ax), result.dataset
    load, growth = dataset["squeal_load"].values, np.nan_to_num(dataset["squeal_growth"].values)
    ax.plot(load, growth, color=INK, linewidth=0.8, zorder=1)
    fed = dataset["squeal_pulley"].values
    names = [pulley.name for pulley in result.drive.pulleys]
    for name in [name for name in names if name in fed]:
        on = fed == name
        ax.plot(load[on], growth[on], color=color(names.index(name)), marker="o", linestyle="", label=f"fed by {name}")
    for at, rate, hertz in zip(load, growth, dataset["squeal_frequency"].values, strict=True):
        if np.isfinite(hertz):
            ax.annotate(f"{hertz / 1e3:.3g}", (at, rate), (0, 5), textcoords="offset points", ha="center", fontsize=8)
    for name, dashes, words in (("squeal_from", "--", "squeal"), ("slip_from", ":", "gross slip")):
        at = float(dataset[name])
        if np.isfinite(at) and at <= 1.1 * load.max(initial=1.0):
            ax.axvline(at, color=INK, linestyle=dashes, linewidth=1.0, label=f"{words} from {at:.3g} on")
    ax.set(xlabel=label(dataset["squeal_load"]), ylabel=label(dataset["squeal_growth"]))
    ax.set_ylim(bottom=0.0)
    name_lines(ax)
    return ax

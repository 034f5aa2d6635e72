"""Order cuts: amplitudes of linear response over speed, beside those of a run-up and measured ones."""

from collections.abc import Callable
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.parts.quantity import RPM, SHOWN_UNITS
from beltdyn.plot.legends import name_lines, name_once
from beltdyn.plot.panels import panels, rows
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import INK, Dash, axes_or_new, color, label
from beltdyn.results import Result

_SHOWN = {**SHOWN_UNITS, "m": ("mm", 1e3)}
_BESIDE: dict[str, tuple[Dash, str, str]] = {"run_up": ("--", "", "in the run-up"), "measured": ("", "o", "measured")}
"""What may stand beside -> its line style, its mark, and its name."""
_END = "_amplitude"


def _all_panels(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each span, pulley or tensioner of a variable."""
    values = result.dataset[_name(result, choice.variable)]
    names = [str(one) for one in values[values.dims[-1]].values]
    page = panels(rows([partial(draw, result, choice.variable, one) for one in names]), sharey=False)
    name_once(page)
    return page


@figure(always, _all_panels, of=("response",))
def response(result: Result, variable: str = "span_tension", of: str | int = 0, *, ax: Axes | None = None) -> Axes:
    """Draw the amplitudes of a result over speed, a line for each excitation, and their sum.

    The sum is that of all amplitudes, as if they met. Dashed lines are the same orders of a run-up, and circles those
    that were measured, where they were put beside.

    Parameters
    ----------
    result : Result
        Of `response`.
    variable : str
        A result, such as "hub_load".
    of : str or int
        Name or number of the span, pulley or tensioner.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such variable, or nothing of that name.

    Examples
    --------
    >>> wave = [{"order": 2, "amplitude": 0.02}]
    >>> wavy = drive.replace(pulley=[drive.pulleys[0].replace(harmonics=wave), drive.pulleys[1]])
    >>> bd.plot.response(bd.response(wavy, speed="80, 120 rpm")).get_ylabel()
    'Amplitude [N]'
    """
    dataset, name = result.dataset, _name(result, variable)
    names = [str(one) for one in dataset[dataset[name].dims[-1]].values]
    place = names.index(of) if of in names else of
    if not isinstance(place, int) or not 0 <= place < len(names):
        raise ModelError(f"of = {of!r} is not in this drive. Choose one of {', '.join(names)}.")
    ax, speed = axes_or_new(ax), RPM * dataset["speed"].values
    unit, factor = _SHOWN.get(str(dataset[name].attrs["units"]), (str(dataset[name].attrs["units"]), 1.0))
    linear = factor * dataset[name].values[:, :, place]
    ax.plot(speed, linear.sum(axis=1), color=INK, linewidth=0.9, label="sum of amplitudes")
    for number, one in enumerate(dataset["excitation"].values):
        ax.plot(speed, linear[:, number], color=color(number), label=str(one))
        for kind, (dashes, mark, _) in _BESIDE.items():
            if f"{kind}_{name}" in dataset:
                other = factor * dataset[f"{kind}_{name}"].values[:, number, place]
                ax.plot(speed, other, color=color(number), linestyle=dashes, marker=mark, markersize=3.5, linewidth=1.1)
    title = str(dataset[name].attrs["long_name"]).rpartition(",")[0]
    ax.set(xlabel=label(dataset["speed"]).replace("rad/s", "rpm"), ylabel=f"Amplitude [{unit.replace(' ', '·')}]")
    ax.set_title(f"{title}, {names[place]}")
    ax.set_ylim(bottom=0.0)
    there = [
        Line2D([], [], color=INK, linestyle=dashes, marker=mark, markersize=3.5, label=words)
        for kind, (dashes, mark, words) in _BESIDE.items()
        if f"{kind}_{name}" in dataset
    ]
    name_lines(ax, [*ax.get_legend_handles_labels()[0], *there])
    return ax


def _name(result: Result, variable: str) -> str:
    """Name of the amplitudes of a result."""
    known = [
        str(name).removesuffix(_END)
        for name, values in result.dataset.data_vars.items()
        if str(name).endswith(_END) and values.ndim == 3 and not str(name).startswith(tuple(_BESIDE))
    ]
    if variable not in known:
        raise ModelError(f"variable = {variable!r} is not a result of a response. {suggest(variable, known)}")
    return f"{variable}{_END}"

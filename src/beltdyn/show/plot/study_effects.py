"""Figures of a study: effects of parameters, one at a time and as shares of the variance."""

import numpy as np
from matplotlib.axes import Axes

from beltdyn.analyses import STUDY
from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.plot.legends import name_lines
from beltdyn.show.plot.registry import figure
from beltdyn.show.plot.study import (
    chosen_result,
    in_shown_units,
    labelled,
    moved_from_base,
    numbers_of,
    panel_for_each_result,
    suits,
)
from beltdyn.show.plot.style import INK, axes_or_new, color

# Sobol indices: what part of the variance of a result is due to each number that varies (Saltelli et al. 2010)

_RESAMPLES = 200
"""Of the bootstrap."""
_LEVEL = 1e-12
"""Change of a result, over its largest value, that is rounding."""


def indices_of(values: FloatArray, dimensions: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """First-order and total Sobol indices at the points of Saltelli's design (Saltelli et al. 2010), and their errors.

    Results have shape (n (d + 2), results); unknown ones leave out the n-th points of all parts of the design. Indices
    have shape (results, d), NaN where a result is known in fewer than two places or does not vary; errors are half of
    the 95 % confidence intervals, by bootstrap over the points.
    """
    parts = values.reshape(dimensions + 2, -1, values.shape[1])
    found = np.full((4, values.shape[1], dimensions), np.nan)
    for result in range(values.shape[1]):
        known = parts[:, np.isfinite(parts[:, :, result]).all(axis=0), result]
        if known.shape[1] < 2 or np.ptp(known) <= _LEVEL * np.max(np.abs(known)):
            continue
        drawn = np.random.default_rng(0).integers(known.shape[1], size=(_RESAMPLES, known.shape[1]))
        spread = np.stack([_indices(known[:, places]) for places in drawn])
        low, high = np.nanquantile(spread, (0.025, 0.975), axis=0)
        found[:, result] = [*_indices(known), *(0.5 * (high - low))]
    return found[0], found[1], found[2], found[3]


def _indices(known: FloatArray) -> FloatArray:
    """First-order indices and total ones, shape (2, d), from results of shape (d + 2, n).

    Those of first order by Saltelli et al. (2010), Table 2 (b), total ones by Jansen, (f).
    """
    first, second, mixed = known[0], known[1], known[2:]
    mean, variance = known[:2].mean(), known[:2].var()
    with np.errstate(divide="ignore", invalid="ignore"):
        alone = ((second - mean) * (mixed - first)).mean(axis=1) / variance
        in_all = 0.5 * ((first - mixed) ** 2).mean(axis=1) / variance
    return np.stack([alone, in_all])


_MOST_BARS = 12
_NARROW = 22
"""Letters in a line beside a bar."""
_TICKS = 5
"""Numbers below a panel at most, less one: they may have many digits."""


@figure(suits("tornado"), panel_for_each_result, of=(STUDY,))
def tornado(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the range of a result as each parameter varies while the others keep their values of the drive file.

    Parameters
    ----------
    result : Result
        Of `study` with the sampling "one_at_a_time".
    of : str, optional
        Name of the result; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or several parameters vary at a time.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension"],
    ...     number=[{"path": "belt.width", "values": [0.01, 0.02]}],
    ...     sampling="one_at_a_time",
    ... )
    >>> bd.plot.tornado(bd.study(study, drive, jobs=1)).get_xlabel()
    'tension [N]'
    """
    name, ax = chosen_result(result, of), axes_or_new(ax)
    if result.dataset.attrs["sampling"] != "one_at_a_time":
        raise ModelError('a tornado needs parameters varied one at a time. Use sampling = "one_at_a_time".')
    values = in_shown_units(result.dataset[name])
    moved = {path: moved_from_base(result.dataset[path]) for path in numbers_of(result)}
    at_base = values[~np.any(list(moved.values()), axis=0)]
    base = float(at_base[0]) if at_base.size else np.nan
    spans = {path: (np.append(values[where], base), where) for path, where in moved.items() if where.any()}
    widths = {path: float(np.nan_to_num(np.nanmax(some) - np.nanmin(some))) for path, (some, _) in spans.items()}
    order = sorted(spans, key=lambda path: widths[path])[-_MOST_BARS:]
    for row, path in enumerate(order):
        some, where = spans[path]
        numbers = in_shown_units(result.dataset[path])[where]
        for value, number in ((np.nanmin(some), int(np.nanargmin(some))), (np.nanmax(some), int(np.nanargmax(some)))):
            ax.barh(row, value - base, left=base, color=color(int(value < base)), height=0.7)
            if number < len(numbers):
                side = "left" if value > base else "right"
                ax.annotate(f"{numbers[number]:.4g}", (value, row), (3 if value > base else -3, 0), "data",
                            "offset points", ha=side, va="center", fontsize=8)  # fmt: skip
    ax.axvline(base, color=INK, linewidth=0.9)
    ax.set_yticks(range(len(order)), [labelled(result.dataset[path], _NARROW) for path in order], fontsize=8)
    ax.margins(x=0.2)
    ax.locator_params(axis="x", nbins=_TICKS)
    ax.set_xlabel(labelled(result.dataset[name]))
    return ax


@figure(suits("indices"), panel_for_each_result, of=(STUDY,))
def sobol_indices(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the share of each parameter in the variance of a result, alone and with interactions.

    Bars are first-order and total Sobol indices, with 95 % confidence intervals.

    Parameters
    ----------
    result : Result
        Of `study` with the sampling "saltelli".
    of : str, optional
        Name of the result; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or the study has another sampling.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension"],
    ...     number=[{"path": "belt.width", "values": [0.01, 0.02]}],
    ...     sampling="saltelli",
    ...     points=2,
    ... )
    >>> bd.plot.sobol_indices(bd.study(study, drive, jobs=1)).get_yticklabels()[0].get_text()
    'belt.width [mm]'
    """
    name, ax = chosen_result(result, of), axes_or_new(ax)
    if result.dataset.attrs["sampling"] != "saltelli":
        raise ModelError('Sobol indices need a Saltelli design. Use sampling = "saltelli".')
    names = numbers_of(result)
    first, total, first_error, total_error = indices_of(result.dataset[name].values[:, None], len(names))
    places = np.arange(len(names))
    for side, values, errors, told in (
        (0.2, first[0], first_error[0], "alone"),
        (-0.2, total[0], total_error[0], "with interactions"),
    ):
        ax.barh(places + side, values, 0.38, xerr=errors, capsize=2, color=color(int(side < 0.0)), label=told)
    ax.set_yticks(places, [labelled(result.dataset[one], _NARROW) for one in names], fontsize=8)
    ax.set_xlim(left=min(0.0, float(np.nan_to_num(first[0]).min()) - 0.05))
    ax.set_xlabel(f"Share of the variance of\n{name}", fontsize=9)
    name_lines(ax)
    return ax

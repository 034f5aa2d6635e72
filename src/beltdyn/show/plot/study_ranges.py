"""Figures of what numbers of a study do to its results: tornado and Sobol indices."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from beltdyn.analyses import STUDY
from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.messages import listing
from beltdyn.results import Result
from beltdyn.show.plot.figures import figure
from beltdyn.show.plot.gaps import count_missing, write_inside
from beltdyn.show.plot.study_values import (
    chosen_result,
    in_shown_units,
    is_number,
    labelled,
    moved_from_base,
    numbers_of,
    panel_for_each_result,
    suits,
)
from beltdyn.show.plot.style import INK, axes_or_new, color, name_lines, note

# Sobol indices: what part of the variance of a result is due to each number that varies (Saltelli et al. 2010)

_RESAMPLE_COUNT = 200
"""Number of bootstrap samples, from which 95 % confidence intervals follow."""
_ROUNDING = 1e-12
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
        if known.shape[1] < 2 or np.ptp(known) <= _ROUNDING * np.max(np.abs(known)):
            continue
        drawn = np.random.default_rng(0).integers(known.shape[1], size=(_RESAMPLE_COUNT, known.shape[1]))
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


_MAX_BARS = 12
"""Bars of a tornado at most, those of the widest ranges: each needs a line for its name."""
_LABEL_LENGTH = 22
"""Letters of a line of the name beside a bar at most."""
_MAX_TICK_INTERVALS = 5
"""Numbers below a panel at most, less one: they may have many digits."""
_NEUTRAL = "0.6"
"""Color of bars without a base."""


@figure(suits("tornado"), panel_for_each_result, of=(STUDY,))
def tornado(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the range of a result as each parameter varies while the others keep their values of the drive file.

    Where the point of the drive file has no value, bars run between the least and the largest of the known ones.

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
    name = chosen_result(result, of)
    if result.dataset.attrs["sampling"] != "one_at_a_time":
        raise ModelError('a tornado needs parameters varied one at a time. Use sampling = "one_at_a_time".')
    ax, values = axes_or_new(ax), in_shown_units(result.dataset[name])
    moved = {path: moved_from_base(result.dataset[path]) for path in numbers_of(result)}
    at_base = values[~np.any(list(moved.values()), axis=0)]
    base = float(at_base[0]) if at_base.size else np.nan
    known = {path: where & np.isfinite(values) for path, where in moved.items()}
    spans = {path: (values[where].min(), values[where].max()) for path, where in known.items() if where.any()}
    widths = {path: np.fmax(high, base) - np.fmin(low, base) for path, (low, high) in spans.items()}
    order = sorted(spans, key=lambda path: widths[path])[-_MAX_BARS:]
    for row, path in enumerate(order):
        _draw_bars(ax, row, values[known[path]], base, _values_in_words(result.dataset[path], known[path]))
    if np.isfinite(base):
        ax.axvline(base, color=INK, linewidth=0.9)
    ax.set_yticks(range(len(order)), [labelled(result.dataset[path], _LABEL_LENGTH) for path in order], fontsize=8)
    if not ax.patches:
        write_inside(ax, f"The same {labelled(result.dataset[name])} at all points with a value")
    ax.use_sticky_edges = False
    ax.set_ylim(-0.6, len(order) - 0.4)
    ax.margins(x=0.2)
    ax.locator_params(axis="x", nbins=_MAX_TICK_INTERVALS)
    ax.set_xlabel(labelled(result.dataset[name]))
    _note_gaps(ax, values, base, [path for path, where in known.items() if moved[path].any() and not where.any()])
    return ax


def _values_in_words(numbers: xr.DataArray, where: BoolArray) -> list[str]:
    """Values of a number at some points, without unit, or words."""
    if is_number(numbers):
        return [f"{one:.4g}" for one in in_shown_units(numbers)[where]]
    return [str(one) for one in numbers.values[where].tolist()]


def _draw_bars(ax: Axes, row: int, values: FloatArray, base: float, words: Sequence[str]) -> None:
    """Draw the extremes of a result in a row as bars from the base, or between them where there is none."""
    based = np.isfinite(base)
    middle = base if based else float(values.mean())
    for place, sense in ((int(np.argmin(values)), -1.0), (int(np.argmax(values)), 1.0)):
        value, above = float(values[place]), sense > 0.0
        if sense * (value - middle) < 0.0 or (based and value == base):
            continue
        tint = color(int(not above)) if based else _NEUTRAL
        ax.barh(row, value - middle, left=middle, color=tint, height=0.7)
        ax.annotate(words[place], (value, row), (3 if above else -3, 0), "data", "offset points",
                    ha="left" if above else "right", va="center", fontsize=8)  # fmt: skip


def _note_gaps(ax: Axes, values: FloatArray, base: float, unknown: Sequence[str]) -> None:
    """Write below a tornado what it has no values of."""
    said = [] if np.isfinite(base) else ["no value at the point of the drive file"]
    missing = int(np.count_nonzero(~np.isfinite(values)))
    said += [count_missing(values)] if missing > len(said) else []
    said += [f"no value for {listing(unknown)}"] if unknown else []
    note(ax, "\n".join(said))


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
    name, names = chosen_result(result, of), numbers_of(result)
    if result.dataset.attrs["sampling"] != "saltelli":
        raise ModelError('Sobol indices need a Saltelli design. Use sampling = "saltelli".')
    ax, values = axes_or_new(ax), result.dataset[name].values
    first, total, first_error, total_error = indices_of(values[:, None], len(names))
    places = np.arange(len(names))
    for side, shares, errors, told in (
        (0.2, first[0], first_error[0], "alone"),
        (-0.2, total[0], total_error[0], "with interactions"),
    ):
        ax.barh(places + side, shares, 0.38, xerr=errors, capsize=2, color=color(int(side < 0.0)), label=told)
    ax.set_yticks(places, [labelled(result.dataset[one], _LABEL_LENGTH) for one in names], fontsize=8)
    ax.set_xlim(left=min(0.0, float(np.nan_to_num(first[0]).min()) - 0.05))
    ax.set_xlabel(f"Share of the variance of\n{name}", fontsize=9)
    name_lines(ax)
    note(ax, count_missing(values))
    if np.isnan(total).all():
        write_inside(ax, "No indices: the result does not vary, or is known at too few points")
    return ax

"""Work-precision diagrams of the compared models, and the contact forces that they give."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from beltdyn.show.plot.style import INK, color, dash, new_figure
from validation.paper.averages import BINS
from validation.paper.measures import DRIVEN, DRIVER
from validation.paper.picture import picture
from validation.paper.runs import Runs
from validation.paper.statement import Picture
from validation.paper.statements.model_errors import MEASURES, Comparison
from validation.paper.statements.model_runs import (
    BEAM,
    BEAMS,
    MODELS,
    PAPER,
    REFERENCE,
    TRUSS,
    TRUSSES,
    reference_name,
    run_name,
)

_MARKERS = ("o", "s", "^", "o", "s", "^")
_IN_A_ROW = 3
_LINE_WIDTHS = {"unknowns": 1.3, "cpu_time": 0.6}
_LABELS = {
    "speed": "Speed error",
    "tension": "Span tension error",
    "normal": "Normal force error",
    "friction": "Friction force error",
}
_PULLEYS = {DRIVER: "driver", DRIVEN: "driven"}


def draw_convergence(comparison: Comparison, targets: Mapping[str, Sequence[float]]) -> Picture:
    """Errors over the number of unknowns."""
    caption = f"Errors over the unknowns of the belt, {comparison.case.title}. Dotted: the targets."
    return picture(caption)(_draw_errors)(comparison, targets, "unknowns", "Unknowns of the belt")


def draw_work(comparison: Comparison, targets: Mapping[str, Sequence[float]]) -> Picture:
    """Errors over processor time."""
    caption = f"Errors over processor time, {comparison.case.title}, outputs included. Dotted: the targets."
    return picture(caption)(_draw_errors)(comparison, targets, "cpu_time", "Processor time [s]")


def _draw_errors(comparison: Comparison, targets: Mapping[str, Sequence[float]], cost: str, label: str) -> Figure:
    measures = [measure for measure in MEASURES if comparison.case.loaded or measure != "friction"]
    rows, columns = (2, 2) if len(measures) > _IN_A_ROW else (1, len(measures))
    figure = new_figure((8.6, 0.8 + 2.6 * rows))
    axes = figure.subplots(rows, columns).ravel()
    for ax, measure in zip(axes, measures, strict=True):
        for number, model in enumerate(MODELS):
            meshes = comparison.series[model].errors
            ax.loglog(
                [getattr(mesh, cost) for mesh in meshes],
                [mesh.of(measure) for mesh in meshes],
                color=color(number % 3),
                linestyle=dash(number // 3),
                marker=_MARKERS[number],
                markersize=4.5,
                markerfacecolor=color(number % 3) if number < 3 else "white",
                linewidth=_LINE_WIDTHS[cost],
                label=model.title,
            )
        for target in targets[measure]:
            ax.axhline(target, color=INK, linestyle=":", linewidth=1.0)
        ax.set(xlabel=label, title=_LABELS[measure])
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def draw_distributions(runs: Runs, comparison: Comparison) -> Picture:
    """Mean forces over the arcs."""
    caption = (
        f"Mean contact forces over the arc in the last 0.2 s, {comparison.case.title}: "
        f"the paper's element with {comparison.case.elements}, 60 and {REFERENCE} elements, and the models of Leamy "
        "and "
        "Wasfy with their numbers of elements on half a pulley, and few trusses."
    )
    return picture(caption)(_draw_distributions)(runs, comparison)


def _draw_distributions(runs: Runs, comparison: Comparison) -> Figure:
    case = comparison.case
    kinds: Sequence[str] = ("normal", "friction") if case.loaded else ("normal",)
    shown = {
        f"paper's element, {case.elements}": run_name(case, PAPER, case.elements),
        "paper's element, 60": run_name(case, PAPER, 60),
        f"truss, {TRUSS}": run_name(case, TRUSSES, TRUSS),
        f"three-node beam, {BEAM}": run_name(case, BEAMS, BEAM),
        f"truss, {TRUSSES.meshes[1]}": run_name(case, TRUSSES, TRUSSES.meshes[1]),
    }
    found, exact = [runs[name].dataset for name in shown.values()], runs[reference_name(case)].dataset
    place = (np.arange(BINS) + 0.5) / BINS
    figure = new_figure((8.6, 0.7 + 2.7 * len(kinds)))
    grid = figure.subplots(len(kinds), 2, squeeze=False)
    for row, kind in zip(grid, kinds, strict=True):
        for ax, pulley in zip(row, _PULLEYS, strict=True):
            for number, samples in enumerate(found):
                style: dict[str, Any] = {"color": color(number), "linestyle": dash(number), "linewidth": 1.4}
                ax.plot(place, samples[f"arc_{kind}_force"][pulley], **style)
            ax.plot(place, exact[f"arc_{kind}_force"][pulley], color=INK, linewidth=1.0)
            ax.set(xlabel="Part of the arc, from entry", ylabel=f"{kind.capitalize()} force [N/m]")
            ax.set_title(_PULLEYS[pulley])
    figure.legend(grid[0][0].lines, [*shown, f"paper's element, {REFERENCE}"], loc="outside lower center", ncols=3)
    return figure

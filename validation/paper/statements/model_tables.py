"""Tables of the compared models: errors and cost of every run, and the orders at which errors fall."""

from collections.abc import Sequence
from math import isfinite

from validation.paper.numbers import shown
from validation.paper.statement import Table, Value
from validation.paper.statements.model_errors import MEASURES, Comparison, Series
from validation.paper.statements.model_runs import MODELS

NAMES = {"speed": "speed", "tension": "span tension", "normal": "normal force", "friction": "friction force"}
"""The errors as they are called on the page."""


def measures_of(comparison: Comparison) -> list[str]:
    """The errors that a case has; without load the mean friction is next to nothing."""
    return [measure for measure in MEASURES if comparison.case.loaded or measure != "friction"]


def error_table(comparison: Comparison) -> Table:
    """Every mesh of every model on a case."""
    rows: list[list[Value]] = [
        [
            f"{model.title}, {mesh.elements}",
            mesh.unknowns,
            mesh.half_pulley,
            *(100.0 * mesh.of(measure) for measure in measures_of(comparison)),
            100.0 * mesh.unevenness,
            mesh.cpu_time,
            mesh.steps,
        ]
        for model in MODELS
        for mesh in comparison.series[model].errors
    ]
    errors = [f"{NAMES[measure]} [%]" for measure in measures_of(comparison)]
    headings = [
        "model, elements",
        "unknowns",
        "on half a pulley",
        *errors,
        "unevenness [%]",
        "processor time [s]",
        "steps",
    ]
    return Table(f"Errors and cost, {comparison.case.title}", headings, rows)


def order_table(comparisons: Sequence[Comparison]) -> Table:
    """Fitted orders, with the meshes that they were fitted over."""

    def cell(found: Series, measure: str) -> Value:
        meshes = found.falling(measure)
        order = found.order(measure)
        return f"{shown(order)} ({meshes[0].elements}–{meshes[-1].elements})" if isfinite(order) else "–"

    rows: list[list[Value]] = []
    for comparison in comparisons:
        for model in MODELS:
            found, used = comparison.series[model], measures_of(comparison)
            cells = [cell(found, measure) if measure in used else "–" for measure in MEASURES]
            rows.append([f"{comparison.case.title}: {model.title}", *cells])
    caption = (
        "Order at which errors fall with the number of unknowns, fitted over the meshes in brackets: from the largest "
        "error on, as long as each has less than 0.8 of the error before"
    )
    return Table(caption, ["case and model", *(NAMES[measure] for measure in MEASURES)], rows)

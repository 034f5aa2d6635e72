"""Whether 5, 7 and 11 integration points give identical solutions in Figs. 10-13."""

from collections.abc import Mapping
from itertools import product

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from validation.paper.distribution import distribution
from validation.paper.measures import largest, rms, settled_mean, speed
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, Table, Value, clearly_below, verdict
from validation.paper.statements.loaded_runs import (
    FACTORS,
    KINDS,
    POINTS,
    POWERS,
    PULLEYS,
    fine_name,
    loaded_cases,
    published_name,
    zone_name,
)

_IDENTICAL = 0.01
_SAME_SPEED = 1e-3
_NAMES = {"as published": published_name, "better settings": zone_name}


def cases() -> Mapping[str, Drive]:
    """The runs of Figs. 10-13."""
    return loaded_cases()


def section(runs: Runs) -> Section:
    """Spread of solutions with several numbers of points."""
    return Section(
        "integration-points",
        "Integration points",
        "The same runs with 5, 7 and 11 Gauss points an element, over whole elements as published, and over the "
        "touching part of each element from "
        "equilibrium. Forces are compared at the same places of the arc, and differences taken over the mean "
        "magnitude of the force.",
        [_forces(runs), _speeds(runs)],
        tables=[_table(runs)],
    )


def _force(runs: Runs, name: str, pulley: int, kind: str, ends: bool) -> FloatArray:
    return distribution(runs[name], pulley).on_grid(kind, ends)


def _spread(runs: Runs, names: list[str], pulley: int, kind: str, ends: bool) -> float:
    """Largest rms difference of the forces of several runs from those of the last, over its mean magnitude."""
    *others, last = (_force(runs, name, pulley, kind, ends) for name in names)
    return max(rms(force - last) for force in others) / float(np.abs(last).mean())


def _forces(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        numbers, worst = [], 0.0
        for factor, kind, (index, pulley) in product(FACTORS, KINDS, enumerate(PULLEYS)):
            names = [_NAMES[settings](factor, points) for points in POINTS]
            spread = _spread(runs, names, index, kind, ends=False)
            worst = max(worst, spread)
            numbers.append(Number(f"νₛ = {POWERS[factor]}, {kind}, {pulley}", spread, "%"))
        return Finding(settings, numbers, clearly_below(worst, _IDENTICAL))

    return Statement(
        name="identical-forces",
        title="5, 7 and 11 integration points give identical forces",
        quote="In the studies of the friction and normal force distributions, the number of integration points … was "
        "varied. In these examples 5, 7 and 11 integration points produce identical solutions.",
        page=254,
        criterion="In the middle of the arc, forces with 5 and 7 points differ from those with 11 by less than 1 % "
        "(rms), for all forces, pulleys and factors; undecided within a fifth of that, by which forces at an instant "
        "change with time steps.",
        findings=[finding(settings) for settings in _NAMES],
        remark="Friction is the more sensitive: it is the local speed of the belt times νₛ, and few points of a "
        "coarse mesh leave that speed uneven.",
        departures=("integration-of-contact",),
    )


def _speeds(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        numbers, worst = [], 0.0
        for factor in FACTORS:
            speeds = [speed(runs[_NAMES[settings](factor, points)]) for points in POINTS]
            apart = largest(np.ptp(speeds, axis=0)) / 120.0
            means = [settled_mean(runs[_NAMES[settings](factor, points)], "pulley_speed") for points in POINTS]
            worst = max(worst, float(np.ptp(means)) / 120.0)
            numbers += [
                Number(f"νₛ = {POWERS[factor]}: means of the last 0.2 s", float(np.ptp(means)) / 120.0, "%"),
                Number("largest at any instant", apart, "%"),
            ]
        return Finding(settings, numbers, verdict(worst < _SAME_SPEED))

    return Statement(
        name="identical-speeds",
        title="5, 7 and 11 integration points give identical speeds",
        quote="In these examples 5, 7 and 11 integration points produce identical solutions.",
        page=254,
        criterion="Mean driven speeds of the last 0.2 s agree to 0.1 % of 120 rad/s.",
        findings=[finding(settings) for settings in _NAMES],
    )


def _table(runs: Runs) -> Table:
    """Every number of points against the fine mesh."""
    rows: list[list[Value]] = []
    for factor, (settings, name), points in product(FACTORS, _NAMES.items(), POINTS):
        run = runs[name(factor, points)]
        apart = [
            _spread(runs, [name(factor, points), fine_name(factor)], pulley, kind, ends)
            for kind, ends, pulley in product(KINDS, (False, True), (0, 1))
        ]
        rows.append(
            [
                f"{POWERS[factor]}, {points}, {settings}",
                int(run.dataset.attrs["steps"]),
                *(100.0 * part for part in apart),
            ]
        )
    headings = [
        f"{kind}, {part}, {pulley} [%]" for kind, part, pulley in product(KINDS, ("middle", "whole arc"), PULLEYS)
    ]
    return Table(
        "Difference of forces from those of 120 elements with better settings (rms, over the mean magnitude)",
        ["νₛ, points, settings", "steps", *headings],
        rows,
    )

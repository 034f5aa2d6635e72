"""Energy account of every run with published settings: a check of our own."""

from collections.abc import Callable, Mapping

import numpy as np

from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.energy_balance import largest_closure
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, Table, Value, verdict
from validation.published import better, two_pulley

_LIMIT = 0.01
_CASES: dict[str, Callable[[Drive], Drive]] = {"two_pulley_20": lambda drive: drive, "two_pulley_20_better": better}
_LEDGER = ("driver_work", "torque_work", "friction_loss", "damping_loss")
_STORED = ("kinetic_energy", "strain_energy", "penalty_energy")


def cases() -> Mapping[str, Drive]:
    """The first case with both kinds of settings; the account is made of all runs on the page."""
    return {name: build(two_pulley()) for name, build in _CASES.items()}


def section(runs: Runs) -> Section:
    """Closure of all accounts."""
    for name in _CASES:
        runs[name].require_output()
    return Section(
        "energy",
        "Energy account",
        "Work of the drivers and loads, less what is stored and what friction and contact damping take, must vanish. "
        "Work is that which forces "
        "really do: on the belt force times velocity, on a pulley torque times speed. The closure error is relative "
        "to the energy put in.",
        [_closes(runs)],
        tables=[_table(runs)],
    )


def _published(run: Run) -> bool:
    contact = run.drive.contact
    return contact.integration == "fixed" and contact.normal_law == "published"


def _closes(runs: Runs) -> Statement:
    def finding(settings: str, published: bool) -> Finding:
        errors = {
            name: abs(largest_closure(run.dataset).error) for name, run in runs.items() if _published(run) is published
        }
        worst = max(errors, key=lambda name: errors[name])
        numbers = [
            Number("runs", len(errors)),
            Number("largest error", errors[worst], "%"),
            Number("in", worst.replace("_", " ")),
            Number("median error", float(np.median(list(errors.values()))), "%"),
        ]
        return Finding(settings, numbers, verdict(errors[worst] < _LIMIT))

    return Statement(
        name="energy-closes",
        title="The energy account closes",
        quote="",
        page=None,
        criterion="The closure error of every run is at any time below 1 % of the energy put in.",
        findings=[finding("as published", True), finding("better settings", False)],
        remark="A check of our own; the paper gives no energies.",
    )


def _table(runs: Runs) -> Table:
    rows: list[list[Value]] = []
    for name, run in runs.items():
        if _published(run):
            end = run.dataset.isel(time=-1)
            ledger = [float(end[key]) for key in _LEDGER]
            change = sum(float(end[key] - run.dataset[key][0]) for key in _STORED)
            rows.append(
                [
                    name.replace("_", " "),
                    *ledger,
                    change,
                    100.0 * largest_closure(run.dataset).error,
                    int(run.dataset.attrs["steps"]),
                ]
            )
    headings = [
        "run, published settings",
        "work of driver [J]",
        "of torques [J]",
        "lost in friction [J]",
        "in damping [J]",
        "stored more [J]",
        "largest closure error [%]",
        "steps",
    ]
    return Table("Energy at the end of each run with published settings", headings, rows)

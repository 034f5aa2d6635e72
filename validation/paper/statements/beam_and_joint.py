"""Belt-like element against the full beam (Eqs. 14 and 15), and both ways to close the belt (Eqs. 25 to 27)."""

from collections.abc import Mapping

import numpy as np

from beltdyn.model import Drive
from beltdyn.results import Run
from validation.paper.averages import mean_forces
from validation.paper.measures import DRIVEN, DRIVER, largest, rms, settled, speed
from validation.paper.runs import REPEATS, Runs
from validation.paper.statement import Finding, Number, Section, Statement, Table, Value, verdict
from validation.paper.statements.model_runs import CASES, PAPER, Case, make, run_name
from validation.paper.timing import below, with_spread

_CASES = (CASES[0], CASES[2])
_FINE, _FINEST = 60, 120
_SIGNIFICANT = 0.5
_BEAM = 1.0
_EXCESSIVE = 2.0
_SMALL = 0.01


def cases() -> Mapping[str, Drive]:
    """Both published drives with alpha2 = 1, and with multipliers, beside those with neither."""
    drives: dict[str, Drive] = {}
    for case in _CASES:
        for elements in _meshes(case):
            drive = make(case, PAPER, elements)
            drives[run_name(case, PAPER, elements)] = drive
            drives[_beam_name(case, elements)] = drive.replace(belt=drive.belt.replace(bending_factor=_BEAM))
        for elements in (case.elements, _FINE):
            drive = make(case, PAPER, elements)
            tied = drive.simulation.replace(joint="multipliers")
            drives[_tied_name(case, elements)] = drive.replace(simulation=tied)
    return drives


def _meshes(case: Case) -> tuple[int, ...]:
    return (case.elements, _FINE, _FINEST)


def _beam_name(case: Case, elements: int) -> str:
    return f"{case.name}_full_beam_{elements}"


def _tied_name(case: Case, elements: int) -> str:
    return f"{case.name}_multipliers_{elements}"


def timed(runs: Runs) -> list[str]:
    """Both forms of the joint with two meshes."""
    return [name for names in _forms().values() for name in names]


def section(runs: Runs) -> Section:
    """What the factor on bending and the form of the joint change."""
    return Section(
        "beam-and-joint",
        "Full beam and Lagrange multipliers",
        "Case 1 (20 elements, α₂ = 0.01) and case 2 (30 elements, α₂ = 0.001) with better settings, with α₂ = 1, "
        "which is the shear deformable beam, and with the belt closed by Lagrange multipliers. Errors are those "
        f"against {_FINEST} elements of the same kind.",
        [_softer(runs), _locking(runs), _same_motion(runs), _effort(runs)],
        tables=[_table(runs)],
    )


def _tension(run: Run) -> float:
    return float(settled(run, "span_tension").mean())


def _softer(runs: Runs) -> Statement:
    def finding(case: Case) -> Finding:
        belt, beam = (runs[name(case, _FINEST)] for name in (_belt_name, _beam_name))
        numbers, parts = [], []
        for title, run in (("belt-like", belt), ("full beam", beam)):
            bend = run.drive.belt.bending_stiffness / float(run.drive.radii[0]) ** 2
            parts.append(bend / _tension(run))
            numbers += [
                Number(f"{title}: E I α₂ / R²", bend, "N"),
                Number("span tension", _tension(run), "N"),
                Number("the first over the second", parts[-1], "%"),
                Number("wrap angle of the driver", float(settled(run, "wrap_angle")[:, DRIVER].mean()), "rad"),
                Number("steps", int(run.dataset.attrs["steps"])),
            ]
        numbers += [
            Number("driven speeds differ, rms", rms(speed(beam) - speed(belt)) / case.speed, "%"),
            Number("mean normal forces over the arcs differ, rms", _normal_difference(beam, belt), "%"),
        ]
        return Finding(case.title, numbers, verdict(parts[0] < _SMALL < parts[1]))

    return Statement(
        name="little-bending-stiffness",
        title="The belt-like element opposes a small resistance to bending",
        quote="the new element is capable of presenting a very high stiffness in axial solicitation as well as of "
        "opposing a small resistance to bending, just as a piece of a typical belt",
        page=255,
        criterion="With 120 elements, the force E I α₂ / R² that bends the belt around a pulley is below 1 % of the "
        "span tension, and above it with α₂ = 1.",
        findings=[finding(case) for case in _CASES],
        remark="The full beam bulges between the pulleys, which takes up the belt's length and raises its tension.",
    )


def _belt_name(case: Case, elements: int) -> str:
    return run_name(case, PAPER, elements)


def _normal_difference(run: Run, other: Run) -> float:
    expected = mean_forces(other, "normal")
    return rms(mean_forces(run, "normal") - expected) / rms(expected)


def _locking(runs: Runs) -> Statement:
    def finding(case: Case) -> Finding:
        numbers, errors = [], {}
        for title, name in (("belt-like", _belt_name), ("full beam", _beam_name)):
            converged = runs[name(case, _FINEST)]
            for elements in (case.elements, _FINE):
                run = runs[name(case, elements)]
                errors[title, elements] = abs(_tension(run) / _tension(converged) - 1.0)
                numbers += [
                    Number(f"{title}, {elements} elements: span tension, error", errors[title, elements], "%"),
                    Number("driven speed, rms error", rms(speed(run) - speed(converged)) / case.speed, "%"),
                ]
        coarse = [errors[title, case.elements] for title in ("belt-like", "full beam")]
        return Finding(case.title, numbers, verdict(coarse[0] <= _SIGNIFICANT * coarse[1]))

    return Statement(
        name="belt-like-element-saves-unknowns",
        title="The belt-like element is more accurate than the full beam on the same mesh",
        quote="",
        page=None,
        criterion="With the paper's mesh, the span tension of the belt-like element is off by at most half of what "
        "that of the full beam is off by, each against 120 elements of its own.",
        findings=[finding(case) for case in _CASES],
        remark="A check of our own. What is wrong on coarse meshes is the stretch of a cubic that has to follow an arc "
        "(membrane locking); α₂ does not touch it.",
        departures=("tension-on-coarse-meshes",),
    )


def _same_motion(runs: Runs) -> Statement:
    def finding(case: Case) -> Finding:
        numbers, met = [], True
        for elements in (case.elements, _FINE):
            shared, tied = runs[_belt_name(case, elements)], runs[_tied_name(case, elements)]
            apart = largest(speed(tied) - speed(shared)) / case.speed
            tension = abs(_tension(tied) / _tension(shared) - 1.0)
            rtol = shared.drive.simulation.rtol
            met &= max(apart, tension) < rtol
            numbers += [
                Number(f"{elements} elements: driven speeds differ by at most", apart, "%"),
                Number("span tensions differ by", tension, "%"),
                Number("largest gap of the joint", float(tied.dataset["joint_gap"].max()), "m"),
            ]
        return Finding(case.title, numbers, verdict(met))

    return Statement(
        name="multipliers-same-motion",
        title="Both forms of the joint give the same motion",
        quote="after eliminating the constraint equations, the system equations of motion can be simply written as … "
        "However, no excessive effort is required if the linear constraints are not eliminated",
        page=248,
        criterion="Driven speed, over the driver's, and span tension differ by less than the tolerance of the steps, "
        "10⁻³.",
        findings=[finding(case) for case in _CASES],
        remark="The node that is there twice changes the norms by which steps are chosen, and so the steps.",
    )


_FORMS = {"shared node": _belt_name, "multipliers": _tied_name}
"""Forms of the joint -> the names of their runs."""


def _forms() -> dict[tuple[Case, str], list[str]]:
    """Names of the runs of a case and a form of the joint."""
    return {
        (case, title): [name(case, n) for n in (case.elements, _FINE)]
        for case in _CASES
        for title, name in _FORMS.items()
    }


def _effort(runs: Runs) -> Statement:
    groups = _forms()
    taken = runs.cpu_times(timed(runs))

    def finding(case: Case) -> Finding:
        numbers, spent = [], []
        for title in _FORMS:
            names = groups[case, title]
            times = np.sum([taken[name] for name in names], axis=0)
            iterations = sum(int(runs[name].dataset.attrs["newton_iterations"]) for name in names)
            spent.append(times / iterations)
            numbers += [
                Number(f"{title}, {case.elements} and {_FINE} elements: processor time", with_spread(times), "s"),
                Number("iterations", iterations),
            ]
        quotient = spent[1] / spent[0]
        numbers.append(Number("time of an iteration, multipliers over shared node", with_spread(quotient)))
        return Finding(case.title, numbers, below(quotient, np.array([_EXCESSIVE])))

    return Statement(
        name="multipliers-no-excessive-effort",
        title="Multipliers take no excessive effort",
        quote="no excessive effort is required if the linear constraints are not eliminated",
        page=248,
        criterion="In every repetition an iteration takes less than twice as long. It does not hold if it takes more "
        "in every one, and is undecided in between.",
        findings=[finding(case) for case in _CASES],
        remark=f"Both forms were run {REPEATS} times more in turns, side by side and without outputs. Numbers are "
        "the median and the range of processor times.",
    )


def _table(runs: Runs) -> Table:
    rows: list[list[Value]] = []
    kinds = (("belt-like", _belt_name), ("full beam", _beam_name), ("belt-like, multipliers", _tied_name))
    for case in _CASES:
        for title, name in kinds:
            for elements in _meshes(case):
                if name(case, elements) in runs:
                    rows.append([f"{case.title}: {title}, {elements}", *_row(runs[name(case, elements)])])
    headings = [
        "drive and element",
        "span tension [N]",
        "driven speed [rad/s]",
        "steps",
        "rejected",
        "processor time [s]",
    ]
    return Table("Means of the last 0.2 s and cost", headings, rows)


def _row(run: Run) -> list[Value]:
    attributes = run.dataset.attrs
    return [
        _tension(run),
        float(settled(run, "pulley_speed")[:, DRIVEN].mean()),
        int(attributes["steps"]),
        int(attributes["rejected_steps"]),
        float(attributes["cpu_time"]),
    ]

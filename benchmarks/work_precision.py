"""Errors of driven speed, tensions and contact forces over processor time: mesh that travels, mesh that stays, Exudyn.

The published cases from rest to full speed in 1 s. Errors are those against a fine mesh of the same kind with a tight
tolerance, and of Exudyn in speed alone against its own (`exudyn_comparison.py`): of speeds and tensions the root mean
square over the run, over the largest value; of contact forces that of the normal force over the inner 170 degrees of
both arcs, mean over the last 0.2 s, over the largest. Times are the least of the rounds, without compilation,
with the state at rest and the making of the results.

    python benchmarks/work_precision.py [--figure FILE] [--rounds N] [--references FOLDER]
"""

import argparse
import time
from collections.abc import Callable
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from exudyn_comparison import CASES, reference, theirs
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from beltdyn import simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.show.plot.style import color, new_figure, styled
from validation.published.cases import better, loaded_two_pulley, two_pulley

Frame = Literal["travelling", "staying"]
MEASURES = ("driven speed", "span tensions", "contact forces")
PEER = "Exudyn"
ANGLES = np.radians(np.linspace(5.0, 175.0, 69))
"""From the inlet of an arc."""
LAST = 0.2
"""Time at the end over which forces are averaged, s."""


class Case(NamedTuple):
    """A published drive and the meshes to run it on."""

    title: str
    drive: Callable[..., Drive]
    meshes: dict[Frame, tuple[int, ...]]
    rtol: tuple[float, ...]
    reference: dict[Frame, int]
    """Elements of the reference."""
    peer: str
    """Name of the case for the peer."""


PUBLISHED = (
    Case(
        "case 1",
        lambda elements, **settings: better(two_pulley(elements), **settings),
        {"travelling": (24, 36, 60, 120), "staying": (27, 36, 46)},
        (1e-2, 1e-3, 1e-4),
        {"travelling": 240, "staying": 100},
        "case-1",
    ),
    Case(
        "case 2",
        lambda elements, **settings: better(loaded_two_pulley(elements=elements), **settings),
        {"travelling": (30, 60, 120), "staying": (21, 27, 46)},
        (1e-2, 1e-3, 1e-4),
        {"travelling": 240, "staying": 100},
        "case-2-1e4",
    ),
)


class Seen(NamedTuple):
    """What is compared of a run: values at all outputs, or over the arcs."""

    values: tuple[FloatArray, ...]
    """One array for each of `MEASURES`."""
    seconds: float

    def errors(self, other: "Seen") -> list[float]:
        """Errors against another one."""
        pairs = zip(self.values, other.values, strict=True)
        return [float(np.sqrt(np.mean((mine - fine) ** 2)) / np.max(np.abs(fine))) for mine, fine in pairs]


def look(run: Run, seconds: float) -> Seen:
    """What is compared of a run."""
    found = run.dataset
    forces = np.concatenate([over_arc(run, pulley) for pulley in range(len(run.drive.pulleys))])
    return Seen((found.pulley_speed.values[:, 1], found.span_tension.values, forces), seconds)


def over_arc(run: Run, pulley: int) -> FloatArray:
    """Normal force at `ANGLES` of a pulley that turns counter-clockwise, mean over the end of the run, N/m."""
    path, center = run.drive.path, run.drive.centers[pulley]
    last = run.dataset.sel(field_time=slice(run.dataset.field_time.values[-1] - LAST, None))
    arm = last.contact_position.values - center
    start = path.span_points[pulley - 1, 1] - center
    angle = np.arctan2(start[0] * arm[..., 1] - start[1] * arm[..., 0], arm @ start)
    touching = last.contact_pulley.values == pulley
    rows = [np.argsort(np.where(one, along, np.inf))[: one.sum()] for along, one in zip(angle, touching, strict=True)]
    forces = zip(rows, angle, last.normal_force.values, strict=True)
    return np.asarray(np.mean([np.interp(ANGLES, along[row], force[row]) for row, along, force in forces], axis=0))


def solve(case: Case, frame: Frame, elements: int, rtol: float) -> Seen:
    """Run a case."""
    drive = case.drive(elements, frame=frame, rtol=rtol, duration=1.0)
    settings = drive.simulation.replace(output_interval=2e-3, field_interval=4e-3)
    begun = time.process_time()
    run = simulate(drive.replace(simulation=settings))
    return look(run, time.process_time() - begun)


class Entry(NamedTuple):
    """A setting, its errors and its time."""

    program: str
    mesh: int
    setting: str
    errors: tuple[float, ...]
    seconds: float


def entries(case: Case, rounds: int, references: Path) -> list[Entry]:
    """Everything that is run of a case."""
    fine = {frame: solve(case, frame, elements, 1e-5) for frame, elements in case.reference.items()}
    between = fine["staying"].errors(fine["travelling"])
    CONSOLE.print(f"{case.title}: the references differ by " + ", ".join(f"{error:.1e}" for error in between))
    found = list[Entry]()
    for frame in case.meshes:
        for elements, rtol in product(case.meshes[frame], case.rtol):
            runs = [solve(case, frame, elements, rtol) for _ in range(rounds)]
            errors = tuple(runs[0].errors(fine[frame]))
            found.append(Entry(frame, elements, f"rtol {rtol:g}", errors, min(run.seconds for run in runs)))
    if find_spec("exudyn") is not None:
        found += peers(case, references)
    return found


def peers(case: Case, references: Path) -> list[Entry]:
    """The peer's errors in speed; its time is that of the transient."""
    other = CASES[case.peer]
    fine = reference(references, f"exudyn-{case.peer}", lambda: theirs(other, 240, 2e-4, 4))
    found = list[Entry]()
    for elements, step in product(other.elements, other.steps):
        speed, seconds = theirs(other, elements, step, other.segments)
        error = float(np.sqrt(np.mean((speed - fine) ** 2)) / np.max(np.abs(fine)))
        found.append(Entry(PEER, elements, f"step {step:g} s", (error,), seconds))
    return found


def table(case: Case, rows: list[Entry]) -> Table:
    """Errors and times."""
    result = Table("mesh", "elements", "setting", *MEASURES, "time, s", title=case.title)
    for row in rows:
        errors = [f"{error:.1e}" for error in row.errors] + [""] * (len(MEASURES) - len(row.errors))
        result.add_row(row.program, str(row.mesh), row.setting, *errors, f"{row.seconds:.2f}")
    return result


@styled
def draw(found: dict[str, list[Entry]]) -> Figure:
    """Errors over time: a line for each mesh, along its tolerances."""
    figure = new_figure((9.0, 2.9 * len(found) + 0.5))
    grid = figure.subplots(len(found), len(MEASURES), squeeze=False)
    programs = ["travelling", "staying", PEER]
    names = {"travelling": "mesh that travels", "staying": "mesh that stays", PEER: PEER}
    for (title, rows), line in zip(found.items(), grid, strict=True):
        for number, (measure, ax) in enumerate(zip(MEASURES, line, strict=True)):
            for program, mesh in dict.fromkeys((row.program, row.mesh) for row in rows):
                own = [row for row in rows if (row.program, row.mesh) == (program, mesh) and len(row.errors) > number]
                times, errors = [row.seconds for row in own], [row.errors[number] for row in own]
                place = programs.index(program)
                ax.loglog(times, errors, color=color(place), marker="os^"[place], markersize=4, label=names[program])
                if own:
                    ax.annotate(str(mesh), (times[-1], errors[-1]), (3, 3), textcoords="offset points", fontsize=7)
            ax.set(xlabel="Processor time [s]", ylabel="Error", title=f"{title}: {measure}")
            ax.grid(True, which="major", linewidth=0.4)
    labels = {label: handle for ax in grid[:, 0] for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(labels.values(), labels.keys(), loc="outside lower center", ncols=3)
    return figure


CONSOLE = Console(width=110)


def main() -> None:
    """Run, print and draw."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--figure", type=Path, default=Path("work-precision.svg"))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--references", type=Path, default=Path("exudyn-references"))
    arguments = parser.parse_args()
    for case, frame in product(PUBLISHED, ("travelling", "staying")):
        simulate(case.drive(30, frame=frame, duration=0.01))  # compiles
    found = dict[str, list[Entry]]()
    for case in PUBLISHED:
        found[case.title] = entries(case, arguments.rounds, arguments.references)
        CONSOLE.print(table(case, found[case.title]))
    draw(found).savefig(arguments.figure)


if __name__ == "__main__":
    main()

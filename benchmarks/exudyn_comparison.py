"""Error against time of beltdyn and of Exudyn on the paper's drives.

Both run in turn, several times over, one thread each; compilation is apart, and so is static equilibrium.  Times are
those of the processor, so that other work on the machine disturbs both alike.
The error is that of the driven speed against the same program's own converged solution (240 elements, tight
tolerance), root mean square over the run, so that the slight difference of the two theories does not count.
References are kept in a folder (`--references`), since those of Exudyn take minutes.
"""

import argparse
import os
import statistics
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # idle threads of linear algebra count as processor time

import numpy as np
from rich.console import Console
from rich.table import Table

from beltdyn import simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.solvers.run_progress import Progress
from validation.published import better, loaded_two_pulley, two_pulley

Solution = tuple[FloatArray, float]
"""Driven speed at the output instants, rad/s, and seconds of the processor."""

Frame = Literal["travelling", "staying"]
REFERENCE_ELEMENTS: dict[Frame, int] = {"travelling": 240, "staying": 100}
TIMES = np.linspace(0.0, 1.0, 1001)
"""Instants at which speeds are compared, s."""
OUTPUT_INTERVAL = 2e-3
"""Of beltdyn, which records everything at an output, s; Exudyn records two speeds every millisecond."""
CONSOLE = Console()


def case_1(elements: int, rtol: float) -> Drive:
    """Table 1 and Eq. 28, from equilibrium, with contact by default."""
    return better(two_pulley(elements), rtol=rtol)


def case_2(creep_rate_factor: float) -> Callable[[int, float], Drive]:
    """The drive of the force distributions, Eq. 29, from equilibrium, with contact by default."""
    return lambda elements, rtol: better(loaded_two_pulley(creep_rate_factor, elements=elements), rtol=rtol)


@dataclass(frozen=True)
class Case:
    """A drive, and what to run on it: meshes and tolerances of beltdyn; meshes, steps and segments of Exudyn."""

    drive: Callable[[int, float], Drive]
    own_elements: tuple[int, ...]
    """On the mesh that travels."""
    elements: tuple[int, ...]
    rtol: tuple[float, ...]
    integration: Literal["full", "reduced"] = "full"
    """Of beltdyn; Exudyn's settings are of reduced integration too."""
    steps: tuple[float, ...] = (2e-3, 1e-3, 5e-4)
    segments: int = 12
    staying_elements: tuple[int, ...] = (15, 21, 27)
    staying_rtol: tuple[float, ...] = (1e-2, 5e-3, 3e-3, 1e-3)


CASES = {
    "case-1": Case(case_1, (20, 24, 30, 36, 40), (20, 30), (1.8e-2, 1e-2, 3e-3, 1e-3), "reduced"),
    "case-2-1e4": Case(case_2(1e4), (28, 30, 32), (30,), (5e-3, 2e-3, 1e-3)),
    "case-2-1e5": Case(case_2(1e5), (28, 30, 32), (30,), (1e-3, 5e-4, 3e-4), staying_rtol=(1e-3, 3e-4, 1e-4)),
}


def ours(case: Case, frame: Frame, elements: int, rtol: float) -> Solution:
    """Simulate with beltdyn; the time is that of the transient, observation of results included."""
    drive = case.drive(elements, rtol)
    settings = drive.simulation.replace(output_interval=OUTPUT_INTERVAL, frame=frame)
    integration = case.integration if frame == "travelling" else "full"
    begun: list[float] = []

    def note(progress: Progress) -> None:
        if progress.phase == "integrating" and not begun:
            begun.append(time.process_time())

    run = simulate(drive.replace(belt=drive.belt.replace(integration=integration), simulation=settings), progress=note)
    seconds = time.process_time() - begun[0]
    return np.interp(TIMES, run.dataset["time"], run.dataset["pulley_speed"][:, 1]), seconds


def theirs(case: Case, elements: int, step: float, segments: int) -> Solution:
    """Simulate with Exudyn; nan where it gives up."""
    from validation.peers.exudyn_drive import Settings
    from validation.peers.exudyn_drive import simulate as simulate_in_exudyn

    drive = case.drive(elements, 1e-3)
    try:
        run = simulate_in_exudyn(drive, Settings(step, segments))
    except (RuntimeError, ValueError):
        return np.full_like(TIMES, np.nan), float("nan")
    return np.interp(TIMES, run.time, run.speed), run.seconds


def reference(folder: Path, name: str, make: Callable[[], Solution]) -> FloatArray:
    """A converged solution, from its file or computed now."""
    path = folder / f"{name}.npy"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        CONSOLE.print(f"computing {path} …")
        np.save(path, make()[0])
    return np.asarray(np.load(path))


@dataclass
class Entry:
    """One program with one setting."""

    program: str
    elements: int
    setting: str
    run: Callable[[], Solution]
    reference: FloatArray
    seconds: list[float] = field(default_factory=list)
    error: float = float("nan")

    @property
    def median(self) -> float:
        """Median of the times so far, s."""
        return statistics.median(self.seconds)

    def take_turn(self) -> None:
        """Run once."""
        speed, seconds = self.run()
        self.seconds.append(seconds)
        self.error = float(np.sqrt(np.mean((speed - self.reference) ** 2)))


def own_entries(
    name: str, case: Case, folder: Path, frame: Frame, meshes: tuple[int, ...], tolerances: tuple[float, ...]
) -> list[Entry]:
    """What beltdyn runs on a case in a frame."""
    fine = REFERENCE_ELEMENTS[frame]
    own = reference(folder, f"beltdyn-{frame}-{name}", lambda: ours(case, frame, fine, 1e-5))
    return [
        Entry(f"beltdyn, {frame}", n, f"rtol {rtol:g}", lambda n=n, rtol=rtol: ours(case, frame, n, rtol), own)  # type: ignore[misc]
        for n in meshes
        for rtol in tolerances
    ]


def entries(name: str, case: Case, folder: Path, with_peer: bool) -> list[Entry]:
    """Everything to run on a case."""
    made = [
        *own_entries(name, case, folder, "travelling", case.own_elements, case.rtol),
        *own_entries(name, case, folder, "staying", case.staying_elements, case.staying_rtol),
    ]
    if with_peer:
        peer = reference(folder, f"exudyn-{name}", lambda: theirs(case, 240, 2e-4, 4))
        made += [
            Entry("Exudyn", n, f"step {step:g} s", lambda n=n, h=step: theirs(case, n, h, case.segments), peer)  # type: ignore[misc]
            for n in case.elements
            for step in case.steps
        ]
    return made


def table(name: str, rows: list[Entry]) -> Table:
    """Error and median time of every entry."""
    result = Table("program", "elements", "setting", "error, rad/s", "time, s", "spread, s", title=name)
    for row in rows:
        spread = f"{min(row.seconds):.3f} to {max(row.seconds):.3f}"
        result.add_row(row.program, str(row.elements), row.setting, f"{row.error:.4f}", f"{row.median:.3f}", spread)
    return result


def verdicts(rows: list[Entry]) -> Iterator[str]:
    """For every mesh of Exudyn, how much faster beltdyn is at no larger an error.

    Exudyn's best accurate setting on a mesh is its fastest whose error is within a tenth of its smallest there.
    """
    ours = [row for row in rows if row.program != "Exudyn"]
    for elements in sorted({row.elements for row in rows if row.program == "Exudyn"}):
        peers = [row for row in rows if row.program == "Exudyn" and row.elements == elements]
        accurate = 1.1 * min(row.error for row in peers)
        best = min((row for row in peers if row.error <= accurate), key=lambda row: row.median)
        rivals = [row for row in ours if row.error <= best.error]
        if not rivals:
            yield f"No setting of beltdyn reaches {best.error:.4f} rad/s, as Exudyn does with {elements} elements."
            continue
        own = min(rivals, key=lambda row: row.median)
        yield (
            f"Exudyn, {elements} elements: {best.error:.4f} rad/s in {best.median:.3f} s ({best.setting}). "
            f"{own.program}, {own.elements} elements: {own.error:.4f} rad/s in {own.median:.3f} s ({own.setting}), "
            f"{best.median / own.median:.1f} times faster."
        )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("cases", nargs="*", choices=[*CASES, []], default=[], metavar="CASE")
    parser.add_argument("--references", type=Path, default=Path("exudyn-references"))
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    with_peer = find_spec("exudyn") is not None
    if not with_peer:
        CONSOLE.print("exudyn is not installed (pip install exudyn): beltdyn runs alone.")
    for name in arguments.cases or CASES:
        rows = entries(name, CASES[name], arguments.references, with_peer)
        for _ in range(arguments.rounds):
            for row in rows:
                row.take_turn()
        CONSOLE.print(table(name, rows))
        for line in verdicts(rows) if with_peer else ():
            CONSOLE.print(line)


if __name__ == "__main__":
    main()

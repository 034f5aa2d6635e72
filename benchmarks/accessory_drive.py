"""Work and precision of the accessory drive among the examples over time: seven pulleys, dry friction, crank harmonics.

The first second holds start, flare, overrunning clutch and idle.  What is compared are headline numbers over the idle
from 0.6 to 1 s: speeds, slips, mean and largest span tensions and hub loads, angle of the arm.  Times are those of the
processor for the whole second, with the state at rest and the results; compilation is apart.
"""

import argparse
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import beltdyn
from beltdyn import simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, load
from beltdyn.results import Run, open_run

WINDOW = slice(0.6, 1.0)
REFERENCE = "staying", 178, 1e-5
"""Frame, elements and tolerance of the solution that errors are against."""
SETTINGS = {
    "staying": [(60, 1e-2), (60, 3e-3), (60, 1e-3), (80, 1e-3), (100, 1e-3), (120, 1e-3), (178, 1e-3), (178, 1e-4)],
    "travelling": [(120, 3e-3), (120, 1e-3)],
}


class Headline(NamedTuple):
    """Headline numbers, each of every pulley, span or tensioner."""

    speed: FloatArray
    slip: FloatArray
    mean_tension: FloatArray
    largest_tension: FloatArray
    hub_load: FloatArray
    arm_angle: FloatArray


def headline(run: Run) -> Headline:
    """What is compared, over the window."""
    seen = run.dataset.sel(time=WINDOW)
    speed, tension = seen.pulley_speed.mean("time").values, seen.span_tension.values
    rim = np.abs(speed) * run.drive.radii
    load_on_hub = np.linalg.norm(seen.hub_force.values, axis=-1)
    return Headline(
        speed,
        1.0 - rim[1:] / rim[0],
        tension.mean(axis=0),
        tension.max(axis=0),
        load_on_hub.mean(axis=0),
        seen.tensioner_position.mean("time").values,
    )


def errors(found: Headline, fine: Headline) -> Iterator[float]:
    """Largest error of each kind over the value; of slips and angles, which may be zero, over the largest of them."""
    for name, value in fine._asdict().items():
        scale = np.max(np.abs(value)) if name in ("slip", "arm_angle") else np.abs(value)
        yield float(np.max(np.abs(getattr(found, name) - value) / scale))


def example(frame: str, elements: int, rtol: float, duration: float = 1.0) -> Drive:
    """The drive of the example."""
    drive = load(Path(beltdyn.__file__).parent / "examples" / "accessory_drive.toml")
    changed = {"frame": frame, "rtol": rtol, "duration": duration}
    return drive.with_({"belt.elements": elements, **{f"simulation.{name}": value for name, value in changed.items()}})


def reference(path: Path) -> Headline:
    """Headline numbers of a fine run, from its file or computed now."""
    if not path.exists():
        Console().print(f"computing {path} …")
        simulate(example(*REFERENCE), path)
    return headline(open_run(path))


def main() -> None:
    """Print a table for each frame."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("frames", nargs="*", choices=[*SETTINGS, []], default=[], metavar="FRAME")
    parser.add_argument("--reference", type=Path, default=Path("accessory-reference.nc"))
    arguments = parser.parse_args()
    fine = reference(arguments.reference)
    for frame in arguments.frames or SETTINGS:
        simulate(example(frame, SETTINGS[frame][0][0], 1e-3, 2e-3))
        names = (name.replace("_", " ") for name in Headline._fields)
        table = Table("elements", "rtol", "s", "steps", "in vain", "iterations", *names, title=frame)
        for elements, rtol in SETTINGS[frame]:
            begun = time.process_time()
            run = simulate(example(frame, elements, rtol))
            used, counts = time.process_time() - begun, run.dataset.attrs
            numbers = (str(counts[name]) for name in ("steps", "rejected_steps", "newton_iterations"))
            parts = (f"{100.0 * error:.2f} %" for error in errors(headline(run), fine))
            table.add_row(str(elements), f"{rtol:g}", f"{used:.2f}", *numbers, *parts)
        Console(width=160).print(table)


if __name__ == "__main__":
    main()

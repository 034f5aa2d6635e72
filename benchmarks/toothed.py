"""Computing times of toothed belts: steady running, a second of a printer's axis, a second with single teeth.

Processor times of one thread: `python benchmarks/toothed.py`. Each analysis is done once before the clock starts. The
single teeth are those of a belt with 120 teeth HTD 8M at 3000 rpm, from steady running on; largest tooth load and
transmission error at meshing frequency show what a mesh and a tolerance leave.
"""

import time
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from steady import seconds

import beltdyn as bd
from beltdyn.arrays import FloatArray

TEETH, SPEED = 22, 100.0 * np.pi
SECONDS = 0.2
"""Simulated time of a run with single teeth, s."""
MESHES: tuple[dict[str, Any], ...] = (
    {"rtol": 1e-3, "elements": 120},
    {"rtol": 3e-4, "elements": 120},
    {"rtol": 1e-3},
)
"""What single teeth run on; elements are as chosen where none are given."""


def single_teeth(duration: float, rtol: float, elements: int | None = None) -> bd.Drive:
    """Two pulleys, the driven one at half of the speed."""
    return bd.Drive(
        name="Two pulleys with single teeth",
        belt={
            "profile": "HTD 8M",
            "width": "20 mm",
            "teeth": 120,
            "installed_tension": "300 N",
            "toothing": {"law": "discrete"},
            "elements": elements,
            "discretization": "quintic",
        },
        pulley=[
            {"name": "driver", "center": [0.0, 0.0], "teeth": TEETH, "speed": SPEED},
            {"name": "driven", "center": [0.345, 0.0], "teeth": 2 * TEETH, "inertia": 8e-4, "torque": -12.0},
        ],
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation={
            "duration": duration,
            "start": "steady",
            "rtol": rtol,
            "output_interval": 5e-5,
            "field_interval": 5e-4,
        },
    )


def at_meshing(run: bd.Run) -> float:
    """Amplitude of the transmission error at meshing frequency, m."""
    error = bd.derived.transmission_error(run).sel(pulley="driven")
    values: FloatArray = error.values
    window = np.hanning(values.size) / np.hanning(values.size).sum()
    turned = np.exp(-1j * TEETH * SPEED * error["time"].values)
    return float(2.0 * abs(np.sum(window * (values - values.mean()) * turned)))


def main() -> None:
    """Print the tables."""
    console, timing, axis = Console(), bd.example("timing_drive"), bd.example("printer_axis")
    bd.steady_state(timing)
    found = seconds(lambda: bd.steady_state(timing))
    console.print(f"steady running of four pulleys: {1e3 * found:.0f} ms (asked: 50)")
    bd.simulate(axis.with_({"simulation.duration": 0.02}))
    found = seconds(lambda: bd.simulate(axis), 3)
    console.print(f"one second of a printer's axis: {found:.2f} s (asked: 1)")
    table = Table("elements", "rtol", "s a second", "begin, s", "steps", "iterations", "largest load, N", "error, nm")
    bd.simulate(single_teeth(1e-3, 1e-3))
    for mesh in MESHES:
        begin = seconds(lambda mesh=mesh: bd.simulate(single_teeth(1e-3, **mesh)), 1)
        begun = time.process_time()
        run = bd.simulate(single_teeth(SECONDS, **mesh))
        taken = time.process_time() - begun - begin
        data = run.dataset
        table.add_row(
            str(data.sizes["element"]),
            f"{mesh['rtol']:g}",
            f"{taken / SECONDS:.1f}",
            f"{begin:.1f}",
            str(data.attrs["steps"]),
            str(data.attrs["newton_iterations"]),
            f"{float(np.abs(data.tooth_force).max()):.2f}",
            f"{1e9 * at_meshing(run):.0f}",
        )
    console.print(table)


if __name__ == "__main__":
    main()

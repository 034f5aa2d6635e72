"""A conveyor of 5 km on 5832 idlers: steady running, and its start along an S-curve in 60 s.

Processor time of one thread, medians; compilation is apart: each analysis is done once before the clock starts.
"""

import math
from functools import partial

from rich.console import Console
from rich.table import Table
from steady import seconds

import beltdyn as bd

ROUNDS = 3
LENGTH, SPEED = 5000.0, 8.0
LINES = {("tail", "head"): (1.2, 22.0), ("head", "tail"): (3.0, 18.0)}
"""Spacing (m) and rotating mass (kg) of the idlers of both strands."""


def conveyor(start: str) -> bd.Drive:
    """A level conveyor for 1500 t/h, started in 60 s from rest, or in steady running."""
    supports = [
        {"kind": "idlers", "span": list(span), "spacing": line[0], "idler_mass": line[1], "friction": 0.02}
        for span, line in LINES.items()
    ]
    return bd.Drive(
        gravity=[0.0, -9.81],
        belt={
            "width": 1.0,
            "thickness": 0.016,
            "axial_stiffness": 180e6,
            "bending_stiffness": 20.0,
            "mass_per_length": 25.0,
        },
        pulley=[
            {
                "name": "head",
                "center": [0.0, 0.0],
                "radius": 0.5,
                "speed": {"kind": "cosine_ramp", "start": 0.0, "end": 60.0, "value": SPEED},
            },
            {"name": "tail", "center": [LENGTH, 0.0], "radius": 0.5, "inertia": 40.0, "mass": 800.0},
        ],
        tensioner=[
            {
                "kind": "sliding",
                "pulley": "tail",
                "direction": [1.0, 0.0],
                "mass": 3e4,
                "preload": 3e5,
                "damping": 5e4,
            }
        ],
        support=supports,
        goods=[{"span": ["tail", "head"], "mass_per_length": 104.0}],
        contact={"friction": 0.4, "standstill_creep": 1e-4},
        simulation={"duration": 60.0, "output_interval": 0.1, "start": start},
    )


def main() -> None:
    """Print the table."""
    table = Table("analysis", "elements", "processor time, s", title="A conveyor of 5 km")
    drive = conveyor("equilibrium")
    idlers = sum(math.floor(LENGTH / spacing) for spacing, _ in LINES.values())
    for name, analysis in (("steady running", bd.steady_state), ("start in 60 s", bd.simulate)):
        run = analysis(drive)
        table.add_row(name, str(run.dataset.sizes["element"]), f"{seconds(partial(analysis, drive), ROUNDS):.2f}")
    Console().print(table)
    Console().print(f"{idlers} idlers on both strands.")


if __name__ == "__main__":
    main()

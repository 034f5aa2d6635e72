"""Long runs on the mesh that stays: a minute of case 2 at constant load, and slow drive cycles of ten minutes.

Prints the steps, the processor time of one thread and its part of the simulated time. Compilation is apart: a short run
of each drive is done before the clock starts. Cycles of tables swing three times between their
smallest and largest speed, and twice between their loads, with a point each second; those of cosine ramps rise once,
from rest. The last column is the largest change of the speed of case 2's driven pulley, over the largest speed, at a
tenth of the tolerance.
"""

import time
from importlib.resources import files
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from beltdyn import load, simulate
from beltdyn.model import Drive
from beltdyn.results import Run
from validation.published.cases import better, loaded_two_pulley

MINUTE, CYCLE = 60.0, 600.0
_SWINGS_OF_SPEED, _SWINGS_OF_LOAD = 3, 2


def case_2(speed: object, torque: object, **simulation: Any) -> Drive:
    """The drive of Figs. 10-13 on the mesh that stays, with another speed and torque."""
    drive = better(loaded_two_pulley(), frame="staying", **simulation)
    driver, driven = drive.pulleys
    return drive.replace(pulley=[driver.replace(speed=speed), driven.replace(torque=torque)])


def alternator_drive(speed: object, schedule: object, **simulation: Any) -> Drive:
    """The example with an arm and a spring, with another speed of the crank and part of the load."""
    drive = load(str(files("beltdyn") / "examples" / "alternator_drive.toml"))
    crank, tensioner, alternator = drive.pulleys
    loads = [one.replace(schedule=schedule) for one in alternator.load]
    return drive.replace(
        pulley=[crank.replace(speed=speed), tensioner, alternator.replace(load=loads)],
        simulation=drive.simulation.replace(**simulation),
    )


def swings(least: float, most: float, number: int) -> dict[str, object]:
    """A table with a point each second that swings by cosines."""
    times = np.arange(CYCLE + 1.0)
    values = least + (most - least) * 0.5 * (1.0 - np.cos(2.0 * np.pi * number * times / CYCLE))
    return {"kind": "table", "times": times.tolist(), "values": values.tolist()}


def ramp(value: float, start: float, end: float) -> dict[str, object]:
    """A cosine ramp."""
    return {"kind": "cosine_ramp", "start": start, "end": end, "value": value}


def constant(value: float) -> dict[str, object]:
    """What stays."""
    return {"kind": "constant", "value": value}


def runs() -> dict[str, Drive]:
    """The drives to time, by a name."""
    minute = {"duration": MINUTE, "start": "steady"}
    steady = {"duration": CYCLE, "output_interval": 1.0, "start": "steady"}
    rest = {**steady, "start": "equilibrium"}
    full = constant(120.0), constant(-45.0)
    published = loaded_two_pulley().pulleys
    run_up = published[0].speed, published[1].torque
    cycle = {"speed": swings(60.0, 120.0, _SWINGS_OF_SPEED)}
    crank = swings(80.0, 300.0, _SWINGS_OF_SPEED)
    return {
        "case 2, a minute, output each s": case_2(*full, **minute, output_interval=1.0),
        "case 2, a minute, output each 0.1 s": case_2(*full, **minute, output_interval=0.1),
        "case 2, a minute with its run-up": case_2(*run_up, duration=MINUTE, output_interval=1.0),
        "case 2, cycle, cosine ramps": case_2(ramp(120.0, 0.0, 300.0), ramp(-45.0, 200.0, 500.0), **rest),
        "case 2, cycle, tables": case_2(**cycle, torque=swings(-15.0, -45.0, _SWINGS_OF_LOAD), **steady),
        "alternator, cycle, cosine ramps": alternator_drive(ramp(300.0, 0.0, 300.0), ramp(1.0, 200.0, 500.0), **rest),
        "alternator, cycle, tables": alternator_drive(crank, swings(0.2, 1.0, _SWINGS_OF_LOAD), **steady),
    }


def change(run: Run, drive: Drive) -> float:
    """Largest change of the speed of the last pulley, over the largest speed, at a tenth of the tolerance."""
    fine = drive.replace(simulation=drive.simulation.replace(rtol=0.1 * drive.simulation.rtol))
    speed, finer = (one.dataset["pulley_speed"].to_numpy()[:, -1] for one in (run, simulate(fine)))
    return float(np.abs(speed - finer).max() / np.abs(finer).max())


def main() -> None:
    """Print the table, a line for each run as it ends."""
    console = Console(width=120)
    columns = "run", "outputs", "steps + rejected", "iterations", "s", "part of real time", "change"
    table = Table(*columns, title="Long runs")
    for name, drive in runs().items():
        interval = 1e-3
        simulate(drive.replace(simulation=drive.simulation.replace(duration=interval, output_interval=interval)))
        begun = time.process_time()
        run = simulate(drive)
        taken = time.process_time() - begun
        said = run.dataset.attrs
        steps = f"{said['steps']} + {said['rejected_steps']}"
        part = f"{taken / drive.simulation.duration:.2g}"
        changed = "" if drive.tensioners else f"{change(run, drive):.1g}"
        table.add_row(name, str(run.outputs), steps, str(said["newton_iterations"]), f"{taken:.2f}", part, changed)
        console.log(name, steps, f"{taken:.2f} s")
    console.print(table)


if __name__ == "__main__":
    main()

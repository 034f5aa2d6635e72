"""Make the pictures and numbers of docs/examples/accessory_drive.md: `python docs/examples_accessory_drive.py`.

It takes about a minute: the drive itself, without its decoupler, without its tensioner, and run up to 2400 rpm.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.linalg import eigh

import beltdyn as bd
from beltdyn.cli.summary import show_summary
from beltdyn.cli.sweep import run_up
from beltdyn.model import install
from beltdyn.plot.style import new_figure, styled
from beltdyn.plot.sweep import orders

FloatArray = NDArray[np.float64]

NAME = "accessory_drive"
PICTURES = Path(__file__).parent / "_static" / "examples"
FIGURES = ("speeds", "span_tensions", "tensioners", "slip", "hub_loads")
TURN = 0.075
"""A turn of the crank at idle, s."""
OFF, ON = (1.2 - 3 * TURN, 1.2), (2.0 - 4 * TURN, 2.0)
"""Whole turns before and after the compressor is switched on, s."""
RPM = np.pi / 30.0
COLORS = 64
"""Colors of a picture, which keep it small."""


def chain_frequencies(drive: bd.Drive) -> FloatArray:
    """Eigenfrequencies, Hz, of pulleys on elastic spans and of the rotor on its spring; crank and tensioner held.

    Spans reach from middle to middle of the arcs; the compressor is off.
    """
    path, count = drive.path, len(drive.pulleys)
    arcs = path.wrap_angles * np.abs(path.radii)
    stiffness, mass = np.zeros((2, count + 1, count + 1))
    for span, length in enumerate(path.span_lengths + 0.5 * (arcs + np.roll(arcs, -1))):
        stretching = np.zeros(count + 1)
        stretching[span] = -path.radii[span]
        stretching[(span + 1) % count] = path.radii[(span + 1) % count]
        stiffness += drive.belt.axial_stiffness / length * np.outer(stretching, stretching)
    mass[np.diag_indices(count)] = [pulley.inertia for pulley in drive.pulleys]
    alternator = number(drive, "alternator")
    clutch, isolator = drive.pulleys[alternator].hub
    mass[alternator, alternator] += clutch.inertia
    mass[-1, -1] = isolator.inertia
    twist = np.eye(count + 1)[alternator] - np.eye(count + 1)[-1]
    stiffness += isolator.stiffness * np.outer(twist, twist)
    return np.asarray(np.sqrt(eigh(stiffness[1:, 1:], mass[1:, 1:], eigvals_only=True)) / (2.0 * np.pi))


def number(drive: bd.Drive, name: str) -> int:
    """Number of the pulley of this name."""
    return [pulley.name for pulley in drive.pulleys].index(name)


def without_decoupler(drive: bd.Drive) -> bd.Drive:
    """The rotor of the alternator sits on its pulley."""
    pulleys = list(drive.pulleys)
    place = number(drive, "alternator")
    inertia = pulleys[place].inertia + sum(link.inertia for link in pulleys[place].hub)
    pulleys[place] = pulleys[place].replace(hub=(), inertia=inertia)
    return drive.replace(pulley=pulleys)


def without_tensioner(drive: bd.Drive) -> bd.Drive:
    """The pulley of the tensioner is held where it stands at rest."""
    pulleys = list(drive.pulleys)
    place = number(drive, "tensioner")
    pulleys[place] = pulleys[place].replace(center=tuple(install(drive).path.centers[place]))
    return drive.replace(pulley=pulleys, tensioner=())


def swing(run: bd.Run, span: str) -> float:
    """Largest less least tension of a span at idle with the compressor off, N."""
    tension = run.dataset["span_tension"].sel(span=span, time=slice(*OFF))
    return float(tension.max() - tension.min())


def slack(run: bd.Run, window: tuple[float, float]) -> float:
    """Mean tension of the span behind the crank, N."""
    return float(run.dataset["span_tension"].sel(time=slice(*window))[:, 0].mean())


def numbers(run: bd.Run) -> Iterator[tuple[str, float, float]]:
    """What it is, by hand, and of the run."""
    drive, dataset = run.drive, run.dataset
    compressor, alternator = number(drive, "compressor"), number(drive, "alternator")
    on = dataset[["span_tension", "pulley_center", "hub_force"]].sel(time=slice(*ON)).mean("time")
    tension = on["span_tension"].values
    step = drive.pulleys[compressor].load[0].constant / drive.radii[compressor]
    yield "compressor: tension before less behind it, N", step, tension[compressor] - tension[compressor - 1]
    cleared = tension - drive.belt.mass_per_length * float(dataset["belt_speed"][-1].mean()) ** 2
    wraps = replace(drive.path, centers=on["pulley_center"].values).wrap_angles
    for pulley in (alternator, 0):
        behind, before = cleared[pulley], cleared[pulley - 1]
        load = np.sqrt(behind**2 + before**2 - 2.0 * behind * before * np.cos(wraps[pulley]))
        yield f"{drive.pulleys[pulley].name}: hub load, N", load, float(np.hypot(*on["hub_force"].values[pulley]))
    falling = dataset.sel(time=slice(0.5, 0.58), pulley="alternator")
    clutch, isolator = drive.pulleys[alternator].hub
    braking = float(falling["shaft_torque"].mean()) - clutch.drag_torque
    slowing = float(np.polyfit(falling["time"], falling["shaft_speed"], 1)[0])
    yield "alternator overruns: its rotor slows down by, rad/s²", braking / (clutch.inertia + isolator.inertia), slowing
    yield "slack span: compressor on less off, N", 0.0, slack(run, ON) - slack(run, OFF)


@styled
def draw_orders(run: bd.Run, path: Path) -> None:
    """Draw the orders of the tension of the tightest span in a run-up."""
    figure = new_figure()
    orders(run, "span_tension", "compressor-crank", "crank", figure.add_subplot())
    figure.savefig(path)


def main() -> None:
    """Run, draw and print."""
    drive = bd.load(str(files("beltdyn").joinpath("examples", f"{NAME}.toml")))
    PICTURES.mkdir(parents=True, exist_ok=True)
    bd.plot.save_layout(drive, PICTURES / f"{NAME}_layout.png")
    run = bd.simulate(drive)
    for path in bd.plot.save_all(run, PICTURES / NAME, FIGURES):
        path.rename(PICTURES / f"{NAME}_{path.name}")
    (PICTURES / NAME).rmdir()
    show_summary(run)
    write = sys.stdout.write
    for what, hand, found in numbers(run):
        write(f"| {what} | {hand:.4g} | {found:.4g} |\n")
    write(f"chain of inertias and spans: {', '.join(f'{one:.3g}' for one in chain_frequencies(drive)[:3])} Hz\n")
    rigid, fixed = bd.simulate(without_decoupler(drive)), bd.simulate(without_tensioner(drive))
    for span in ("compressor-crank", "water_pump-alternator"):
        write(f"{span} swings by {swing(run, span):.4g} N, {swing(rigid, span):.4g} N without decoupler\n")
    for name, one in (("with", run), ("without decoupler", rigid), ("without tensioner", fixed)):
        least = float(one.dataset["span_tension"].min())
        write(f"{name}: slack span {slack(one, OFF):.4g} N, {slack(one, ON):.4g} N; least tension {least:.4g} N\n")
        write("".join(f"  {warning}\n" for warning in one.warnings))
    raised = bd.simulate(run_up(drive, "crank", 700.0 * RPM, 2400.0 * RPM, 3.0))
    draw_orders(raised, PICTURES / f"{NAME}_orders.png")
    for path in PICTURES.glob(f"{NAME}_*.png"):
        with Image.open(path) as picture:
            small = picture.convert("RGB").quantize(COLORS)
        small.save(path, optimize=True)


if __name__ == "__main__":
    main()

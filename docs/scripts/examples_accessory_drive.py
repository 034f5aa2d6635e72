"""What docs/examples/accessory_drive.md says in numbers, as `example_numbers.py` has it of the other examples."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from example_numbers import Number
from scipy.linalg import eigh
from scipy.optimize import curve_fit

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import install
from beltdyn.show.plot.style import new_figure, styled
from beltdyn.show.plot.waterfall import orders

TURN = 0.075
"""A turn of the crank at idle, s."""
OFF, ON = (1.2 - 3 * TURN, 1.2), (2.0 - 4 * TURN, 2.0)
"""Whole turns before and after the compressor is switched on, s."""
RPM = np.pi / 30.0


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


def rotor_swing(run: bd.Run) -> tuple[float, float]:
    """Frequency, Hz, and decay, 1/s, of the rotor on its spring when the clutch grips again.

    They are fitted to its speed together with the crank's harmonics.
    """

    def model(time: FloatArray, frequency: float, decay: float, *amplitudes: float) -> FloatArray:
        a, b, c, p2, q2, p4, q4 = amplitudes
        own, fired = 2.0 * np.pi * frequency * time, 2.0 * np.pi * 2.0 / TURN * time
        swing = np.exp(-decay * time) * (a * np.cos(own) + b * np.sin(own)) + c
        second = p2 * np.cos(fired) + q2 * np.sin(fired)
        return np.asarray(swing + second + p4 * np.cos(2.0 * fired) + q4 * np.sin(2.0 * fired))

    swinging = run.dataset["shaft_speed"].sel(time=slice(0.75, 1.2), pulley="alternator")
    start = (chain_frequencies(run.drive)[0], 3.0, 1.0, 1.0, 230.0, 0.1, 0.1, 0.1, 0.1)
    found = curve_fit(model, swinging["time"].values - 0.75, swinging.values, start)[0]
    return float(found[0]), float(found[1])


def numbers(run: bd.Run) -> Iterator[Number]:
    """Statics of the belt at idle, and the rotor of the alternator on its own."""
    drive, dataset = run.drive, run.dataset
    compressor, alternator = number(drive, "compressor"), number(drive, "alternator")
    on = dataset[["span_tension", "pulley_center", "hub_force"]].sel(time=slice(*ON)).mean("time")
    tension = on["span_tension"].values
    step = float(drive.pulleys[compressor].load[0].constant / drive.radii[compressor])
    found = float(tension[compressor] - tension[compressor - 1])
    yield Number("compressor: tension before less behind it, N", step, found, 0.01 * step)
    cleared = tension - drive.belt.mass_per_length * float(dataset["belt_speed"][-1].mean()) ** 2
    wraps = replace(drive.path, centers=on["pulley_center"].values).wrap_angles
    for pulley in (alternator, 0):
        behind, before = cleared[pulley], cleared[pulley - 1]
        load = float(np.sqrt(behind**2 + before**2 - 2.0 * behind * before * np.cos(wraps[pulley])))
        found = float(np.hypot(*on["hub_force"].values[pulley]))
        yield Number(f"{drive.pulleys[pulley].name}: hub load, N", load, found, 0.015 * load)
    falling = dataset.sel(time=slice(0.5, 0.58), pulley="alternator")
    clutch, isolator = drive.pulleys[alternator].hub
    braking = clutch.drag_torque - float(falling["shaft_torque"].mean())
    slows, found = (
        braking / (clutch.inertia + isolator.inertia),
        -float(np.polyfit(falling["time"], falling["shaft_speed"], 1)[0]),
    )
    yield Number("alternator overruns: its rotor slows down by, rad/s²", slows, found, 0.01 * slows)
    lowest = float(chain_frequencies(drive)[0])
    yield Number("lowest eigenfrequency with the spring, Hz", lowest, rotor_swing(run)[0], 0.02 * lowest)


def study(run: bd.Run, folder: Path) -> Iterator[str]:
    """Say what decoupler and tensioner are worth, and draw the orders of a run-up."""
    drive = run.drive
    yield f"chain of inertias and spans: {', '.join(f'{one:.3g}' for one in chain_frequencies(drive)[:3])} Hz"
    rigid, fixed = bd.simulate(without_decoupler(drive)), bd.simulate(without_tensioner(drive))
    for span in ("compressor-crank", "water_pump-alternator"):
        yield f"{span} swings by {swing(run, span):.4g} N, {swing(rigid, span):.4g} N without decoupler"
    for name, one in (("with", run), ("without decoupler", rigid), ("without tensioner", fixed)):
        least = float(one.dataset["span_tension"].min())
        yield f"{name}: slack span {slack(one, OFF):.4g} N, {slack(one, ON):.4g} N; least tension {least:.4g} N"
        yield from (f"  {warning}" for warning in one.warnings)
    raised = bd.sweep(drive, pulley="crank", from_=700.0 * RPM, to=2400.0 * RPM, duration=3.0)
    draw_orders(raised, folder / "orders.png")


@styled
def draw_orders(run: bd.Run, path: Path) -> None:
    """Draw the orders of the tension of the tightest span in a run-up."""
    figure = new_figure()
    orders(run, "span_tension", "compressor-crank", "crank", ax=figure.add_subplot())
    figure.savefig(path)

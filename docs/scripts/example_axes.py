"""What the page of linear axes says in numbers, beside a hand calculation; see `docs/scripts/example_numbers.py`."""

from collections.abc import Iterator

import numpy as np
from example_numbers import Number

from beltdyn import Run
from beltdyn.model.end import free_stroke


def printer_axis(run: Run) -> Iterator[Number]:
    """The travel in 2.5 turns of a stretched belt, and the pulls of guide and mass."""
    dataset, belt, carriage = run.dataset, run.drive.belt, run.drive.carriage
    assert carriage is not None
    time, tension = dataset.time.values, dataset.span_tension.values
    stretch = belt.given_pitch / 2e-3 * (1.0 + tension[0, 2] / belt.axial_stiffness)
    there = int(np.argmin(np.abs(time - 0.49)))
    way = 1e3 * float(dataset.carriage_position.values[there, 0])
    yield Number("travel in 2.5 turns, mm", 100.0 * stretch, way, 0.02)
    pull = tension[:, 2] - tension[:, 1]
    steady = (time > 0.2) & (time < 0.3)
    yield Number("pull at 300 mm/s, N", carriage.friction + 0.3 * carriage.damping, float(pull[steady].mean()), 0.05)
    rising = (time > 0.075) & (time < 0.095)
    speed = float(np.mean(np.abs(dataset.carriage_speed.values[rising, 0])))
    expected = carriage.friction + carriage.mass * 5.0 + carriage.damping * speed
    yield Number("pull at 5 m/s², N", expected, float(pull[rising].mean()), 0.1)


def gantry_axis(run: Run) -> Iterator[Number]:
    """The lag behind the motor under a force of 200 N, by the spans alone."""
    dataset, drive = run.dataset, run.drive
    assert drive.carriage is not None
    room, time = free_stroke(drive.carriage, drive.path), dataset.time.values
    beside, behind = 1.0 - room[0], room[1] - 1.0 + float(drive.path.span_lengths[0])
    stiffness = drive.belt.axial_stiffness * (1.0 / beside + 1.0 / behind)
    error = dataset.carriage_error.values[:, 0]
    before, after = (float(error[(time > end - 0.05) & (time < end)].mean()) for end in (1.0, 1.3))
    yield Number("lag under 200 N, µm", 2e8 / stiffness, 1e6 * (before - after), 0.15 * 2e8 / stiffness)

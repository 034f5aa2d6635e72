"""What the page of belts that carry says in numbers, beside a hand calculation; see `example_numbers.py`."""

from collections.abc import Iterator
from math import expm1, hypot, pi

from example_numbers import Number

from beltdyn import Run
from beltdyn.machines import Guide, Idlers
from beltdyn.results import summarize
from beltdyn.results.mechanics import SpanTension

GRAVITY = 9.81


def conveyor_1km(run: Run) -> Iterator[Number]:
    """The sum of resistances of DIN 22101, the pull of the start, and the tensions that the weight gives."""
    drive, dataset, belt = run.drive, run.dataset, run.drive.belt
    (weight,), (goods,) = drive.tensioners, drive.goods
    length, lift = drive.pulleys[1].center[0], drive.pulleys[0].center[1]
    upper, lower = drive.supports
    assert isinstance(upper, Idlers)
    assert isinstance(lower, Idlers)
    slope, friction = hypot(length, lift), upper.secondary_factor * upper.friction
    rotating = upper.rotating_mass + lower.rotating_mass
    carried = (2.0 * belt.mass_per_length + goods.mass_per_length) * length / slope
    main = friction * slope * GRAVITY * (rotating + carried)
    raising = lift * GRAVITY * goods.mass_per_length
    time, pull = dataset.time.values, dataset.shaft_torque.values[:, 0] / float(drive.radii[0])
    end, top = (time > 55.0), (time > 19.0) & (time < 23.0)
    tail = drive.pulleys[1]
    moved = (2.0 * belt.mass_per_length + goods.mass_per_length + rotating) * slope + tail.inertia / tail.radius**2
    start = 0.5 * pi * 4.0 / 40.0 * moved
    yield Number("pull in steady running, kN", 1e-3 * (main + raising), 1e-3 * float(pull[end].mean()), 0.5)
    yield Number("largest pull of the start, kN", 1e-3 * (main + raising + start), 1e-3 * float(pull[top].max()), 8.0)
    returning = friction * slope * GRAVITY * (belt.mass_per_length * length / slope + lower.rotating_mass)
    slack = 0.5 * weight.preload + lift * GRAVITY * belt.mass_per_length - returning
    before, after = SpanTension.of(lambda name: dataset[name].values[end].mean(axis=0)).at_arcs(run.prepared)
    yield Number("slack tension at the head drum, kN", 1e-3 * slack, 1e-3 * float(after[0]), 0.5)
    yield Number("tight tension, kN", 1e-3 * (slack + main + raising), 1e-3 * float(before[0]), 0.5)
    grip = expm1(pi * float(drive.frictions[0]))  # the weight holds the tension at the tail
    safety = (slack + returning) * grip / (main + raising + returning * grip)
    yield Number("slip safety of the head drum", safety, summarize(run).pulleys[0].slip_safety, 0.02)


def package_conveyor(run: Run) -> Iterator[Number]:
    """Friction of the table gives the pull, the screws the sum of the tensions."""
    drive, summary, belt = run.drive, summarize(run), run.drive.belt
    table, rollers = drive.supports
    (goods,) = drive.goods
    assert isinstance(table, Guide)
    assert isinstance(rollers, Idlers)
    assert table.end is not None
    assert rollers.end is not None
    upper = (table.end - table.start) * GRAVITY * (belt.mass_per_length + goods.mass_per_length)
    lower = (rollers.end - rollers.start) * GRAVITY * (belt.mass_per_length + rollers.rotating_mass)
    pull = table.friction * upper + rollers.friction * lower
    radius = float(drive.radii[0])
    torque = float(run.dataset.shaft_torque.values[run.dataset.time.values > 5.0, 0].mean())
    yield Number("pull, N", pull, torque / radius, 0.02 * pull)
    tension = SpanTension.of(lambda name: run.dataset[name].values[-1])
    before, after = tension.at_arcs(run.prepared)
    between = float(before[0]) - pull
    yield Number("slack tension of the drum, N", between, float(after[0]), 0.02 * pull)
    creep = 100.0 * (float(before[0]) - float(before[1])) / belt.axial_stiffness
    yield Number("creep of the tail drum, %", creep, 100.0 * summary.pulleys[1].slip, 0.02)
    mean, grip = float(tension.mean.mean()), expm1(pi * float(drive.frictions[0]))  # the screws hold the mean
    safety = mean * grip / (pull - (between - mean) * grip)
    yield Number("slip safety of the drum", safety, summary.pulleys[0].slip_safety, 0.05 * safety)

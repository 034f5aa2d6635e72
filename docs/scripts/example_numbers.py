"""What the pages of the examples say in numbers: each run beside what a hand calculation gives.

`make_examples.py` prints them, and `tests/validation/test_examples.py` holds each within its tolerance. Those of
the accessory drive stand in `docs/scripts/examples_accessory_drive.py`.
"""

from collections.abc import Iterator
from math import acos, asin, cos, hypot, pi, sqrt, tanh
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from xarray import Dataset

from beltdyn import Drive, Run, simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Pulley, prepare
from beltdyn.model.hysteresis import compression_losses
from beltdyn.results import summarize
from beltdyn.theory.creep import capstan_ratio, gross_slip_tensions, speed_loss
from beltdyn.theory.nip import bending_loss
from beltdyn.theory.span import open_belt

RPM = pi / 30.0


class Number(NamedTuple):
    """A number of a page.

    Attributes
    ----------
    what : str
        What it is, with its unit.
    hand, found : float
        By hand, and of the run.
    tolerance : float
        How far apart they may be, in the same unit.
    """

    what: str
    hand: float
    found: float
    tolerance: float


def two_pulley(run: Run) -> Iterator[Number]:
    """The driven pulley swings on two spans; the hand calculation lets only them give, and no belt on the pulleys."""
    belt, (driver, driven) = run.drive.belt, run.drive.pulleys
    span = driven.center[0] - driver.center[0]
    frequency = sqrt(2.0 * belt.axial_stiffness * driven.radius**2 / (span * driven.inertia)) / (2.0 * pi)
    since = run.dataset["time"].values >= 0.6
    time, speed = run.dataset["time"].values[since], speed_of(run, "driven")[since]
    yield Number("path length, m", 2.0 * (span + pi * driven.radius), run.drive.path.length, 1e-12)
    yield Number("mean driven speed from 0.6 s, rad/s", 12.0, float(speed.mean()), 0.06)
    yield Number("frequency of the swing, Hz", frequency, frequency_of(time, speed - 12.0), 0.15 * frequency)


def unequal_radii(run: Run) -> Iterator[Number]:
    """The motor settles where Kloss's torque is that of the fan, through the ratio of radii, the creep and bending."""
    (motor, fan), summary = run.drive.pulleys, summarize(run)
    (kloss,), (load,) = motor.load, fan.load
    ratio, loss = motor.radius / fan.radius, creep(run)
    bent = motor.radius * float(losses_of_the_belt(run.drive).sum())

    def surplus(speed: float) -> float:
        slip = 1.0 - speed / kloss.synchronous_speed
        torque = 2.0 * kloss.breakdown_torque / (slip / kloss.breakdown_slip + kloss.breakdown_slip / slip)
        return torque - bent - ratio * (load.constant + load.quadratic * (speed * ratio * (1.0 - loss)) ** 2)

    speed = brentq(surplus, 0.8 * kloss.synchronous_speed, 0.9999 * kloss.synchronous_speed)
    belt = open_belt(hypot(*np.subtract(fan.center, motor.center)), (motor.radius, fan.radius))
    yield Number("path length, m", belt.length, run.drive.path.length, 1e-9)
    yield Number("wrap angle of the motor, °", np.degrees(belt.wrap[0]), wrap(run, 0), 1e-6)
    yield Number("motor, rpm", speed / RPM, summary.pulleys[0].speed / RPM, 1.5)
    yield Number("fan, rpm", speed * ratio * (1.0 - loss) / RPM, summary.pulleys[1].speed / RPM, 1.0)
    yield from slip_and_efficiency(run, 0.05)


def fan_direct_start(run: Run) -> Iterator[Number]:
    """The run-up is that of one inertia under the motor's curve, made of its catalogue, and the fan's parabola."""
    (motor, fan), summary = run.drive.pulleys, summarize(run)
    ratio = float(run.drive.radii[0] / run.drive.radii[1])
    rated, synchronous = 15e3 / (1465.0 * RPM), 1500.0 * RPM
    breakdown = (1.0 - 1465.0 / 1500.0) * (3.0 + sqrt(8.0))
    inertia = motor.inertia + fan.inertia * ratio**2
    bent = float(run.drive.radii[0] * losses_of_the_belt(run.drive).sum())

    def driving(speed: float) -> float:
        slip = 1.0 - speed / synchronous
        if slip <= breakdown:
            return rated * 2.0 * 3.0 / (slip / breakdown + breakdown / slip)
        edges, levels = (breakdown, 6.0 / 7.0, 1.0), (3.0, 1.9, 2.4)
        k = int(slip > edges[1])
        part = (slip - edges[k]) / (edges[k + 1] - edges[k])
        return rated * (levels[k] + (levels[k + 1] - levels[k]) * part**2 * (3.0 - 2.0 * part))

    def braking(speed: float) -> float:
        share = speed / (1160.0 * RPM)
        return 14e3 / (1160.0 * RPM) * (0.02 * tanh(speed / 0.1) + 0.98 * share**2)

    def rates(time: float, state: FloatArray) -> list[float]:
        schedule = min(max((time - 0.02) / 0.06, 0.0), 1.0)
        torque = 0.5 * (1.0 - cos(pi * schedule)) * driving(state[0]) - ratio * braking(ratio * state[0])
        return [(torque - bent * tanh(state[0] / 0.1)) / inertia]

    lumped = solve_ivp(rates, (0.0, 1.5), [0.0], method="LSODA", rtol=1e-8, dense_output=True, max_step=1e-3)
    times, mark = run.dataset["time"].values, 1100.0 * RPM
    by_hand = float(np.interp(mark, ratio * lumped.y[0], lumped.t))
    found = float(np.interp(mark, np.maximum.accumulate(speed_of(run, "fan")), times))
    tight, slack = (summary.spans[k].tension for k in (1, 0))
    loss = creep(run)
    steady = brentq(lambda w: driving(w) - bent - ratio * braking(ratio * w * (1.0 - loss)), 1400.0 * RPM, 1499.0 * RPM)
    largest = float(run.dataset["shaft_torque"].values[:, 0].max())
    yield Number("largest torque of the motor, N m", 3.0 * rated, largest, 0.5)
    yield Number("time at which the fan reaches 1100 rpm, s", by_hand, found, 0.02 * by_hand)
    yield Number("motor, rpm", steady / RPM, summary.pulleys[0].speed / RPM, 1.0)
    yield Number("fan, rpm", steady * ratio * (1.0 - loss) / RPM, summary.pulleys[1].speed / RPM, 1.5)
    yield Number("torque of the motor, N m", driving(steady), summary.pulleys[0].shaft_torque, 0.5)
    force = driving(steady) / float(run.drive.radii[0]) - float(losses_of_the_belt(run.drive)[0])
    yield Number("difference of the span tensions, N", force, tight - slack, 0.01 * force)
    yield Number("slip, %", 100.0 * loss, 100.0 * summary.pulleys[1].slip, 5.0 * loss)


def crossed_belt_drive(run: Run) -> Iterator[Number]:
    """The lathe turns the other way; both pulleys have the same wrap."""
    (first, second), summary = run.drive.pulleys, summarize(run)
    radii = run.drive.radii
    distance, both = second.center[0] - first.center[0], float(sum(radii))
    angle = 2.0 * (pi - acos(both / distance))
    loss = creep(run)
    yield Number("path length, m", 2.0 * sqrt(distance**2 - both**2) + both * angle, run.drive.path.length, 1e-9)
    yield Number("wrap angle of the line shaft, °", float(np.degrees(angle)), wrap(run, 0), 1e-6)
    yield Number("wrap angle of the lathe, °", float(np.degrees(angle)), wrap(run, 1), 1e-6)
    speed = -300.0 * radii[0] / radii[1] * (1.0 - loss)
    yield Number("lathe, rpm", float(speed), summary.pulleys[1].speed / RPM, 0.2)
    yield from slip_and_efficiency(run, 0.05)
    pull = summary.spans[0].tension - summary.spans[1].tension
    limit = limit_between_fixed_centers(run, 250.0) / abs(pull)
    yield Number("slip safety", limit, summary.pulleys[1].slip_safety, 0.03 * limit)


def washing_machine(run: Run) -> Iterator[Number]:
    """Motor and drum as one body, with the belt's mass, against the run."""
    (motor, drum), summary = run.drive.pulleys, summarize(run)
    (table,), (load,) = motor.load, drum.load
    small, large = map(float, run.drive.rolling_radii)
    ratio = small / large
    belt = run.drive.belt
    inertia = motor.inertia + drum.inertia * ratio**2 + belt.mass_per_length * run.drive.belt_length * small**2
    bent = small * float(losses_of_the_belt(run.drive).sum())

    def surplus(time: float, speed: FloatArray) -> FloatArray:
        schedule = min(max((time - 0.01) / 0.07, 0.0), 1.0)
        driving = 0.5 * (1.0 - cos(pi * schedule)) * np.interp(speed, table.speeds, table.torques)
        braking = load.constant * np.tanh(speed * ratio / load.creep_speed) + load.linear * speed * ratio
        return np.asarray((driving - ratio * braking - bent * np.tanh(speed * ratio / load.creep_speed)) / inertia)

    end = run.drive.simulation.duration
    lumped = solve_ivp(surplus, (0.0, end), [0.0], method="LSODA", rtol=1e-8, dense_output=True, max_step=1e-3)
    times = run.dataset["time"].values
    mark = 1100.0 * RPM
    final = float(lumped.y[0, -1])
    yield Number("drum, rpm", final * ratio / RPM, summary.pulleys[1].speed / RPM, 0.005 * final * ratio / RPM)
    yield Number("motor, rpm", final / RPM, summary.pulleys[0].speed / RPM, 0.005 * final / RPM)
    by_hand = float(np.interp(mark, ratio * lumped.y[0], lumped.t))
    found = float(np.interp(mark, np.maximum.accumulate(speed_of(run, "drum")), times))
    yield Number("time at which the drum reaches 1100 rpm, s", by_hand, found, 0.03 * by_hand)
    torque = load.constant + load.linear * final * ratio
    yield Number("torque of the motor at 1200 rpm, N m", torque * ratio + bent, summary.pulleys[0].shaft_torque, 0.003)
    force = torque / large + float(losses_of_the_belt(run.drive)[1])
    tight, slack = (summary.spans[i].tension for i in (1, 0))
    yield Number("difference of the span tensions, N", force, tight - slack, 0.01 * force)


def slip_on_a_small_pulley(run: Run, _: Path) -> Iterator[str]:
    """Say what friction loses on each pulley, and what slip comes to at full speed and under 6 N m on two meshes."""
    ended = run.dataset["friction_power"].sel(time=slice(summarize(run).start, None)).mean("time")
    yield f"friction loses {' and '.join(f'{float(power):.2g} W' for power in ended)}"
    yield f"slip at full speed: {creep(run):.2%} by hand, {summarize(run).pulleys[1].slip:.2%} in the run"
    rolls = float(run.drive.rolling_radii[0] / run.drive.radii[0] - 1.0)
    yield f"what bending adds to the radius of the motor: {rolls:.2%}"
    for elements in (None, 2 * run.drive.elements):
        made = simulate(under_load(run.drive, elements))
        slip = summarize(made).pulleys[1].slip
        yield f"{made.drive.elements} elements: slip {creep(made):.2%} by hand, {slip:.2%} in the run"


def under_load(drive: Drive, elements: int | None) -> Drive:
    """The washing machine at a prescribed 600 rad/s of the motor, with 6 N m on a light drum, until it runs steadily.

    After 0.4 s its slip is 1 % below that of steady running, after 0.8 s within 0.1 %.
    """
    motor, drum = drive.pulleys
    ramp = {"kind": "cosine_ramp", "start": 0.01, "end": 0.06, "value": 600.0}
    driver = Pulley(name=motor.name, center=motor.center, radius=motor.radius, speed=ramp)
    driven = drum.replace(inertia=0.002, load=[{"kind": "resistance", "constant": 6.0}])
    return drive.replace(
        pulley=[driver, driven],
        belt=drive.belt.replace(elements=elements),
        simulation=drive.simulation.replace(duration=0.8),
    )


def flat_belt_idler(run: Run) -> Iterator[Number]:
    """The idler's spring sets the slack tension, by virtual work on the part of it that presses, T - m v^2."""
    drive, summary = run.drive, summarize(run)
    (spring,) = drive.tensioners
    position, step = float(run.dataset["tensioner_position"].values[-1, 0]), 1e-5
    shorter, longer = (moved(drive, position + by).path.length for by in (-step, step))
    pressing = (spring.preload - spring.rate * position) / ((longer - shorter) / (2.0 * step))
    slack = pressing + drive.belt.mass_per_length * summary.spans[0].belt_speed ** 2
    yield Number("slack tension, N", slack, summary.spans[0].tension, 0.01 * slack)
    bare = without_idler(drive)
    angle = np.degrees(pi - 2.0 * asin((bare.radii[1] - bare.radii[0]) / bare.pulleys[1].center[0]))
    found = float(np.degrees(bare.path.wrap_angles[0]))
    yield Number("wrap angle of the motor without the idler, °", float(angle), found, 1e-6)
    force = summary.spans[2].tension - summary.spans[0].tension
    torque = force * float(drive.radii[0])
    yield Number("torque of the motor, N m", torque, summary.pulleys[0].shaft_torque, 0.01 * torque)
    yield from slip_and_efficiency(run, 0.05)


def worth_of_the_idler(run: Run, _: Path) -> Iterator[str]:
    """Say what happens without the idler, and with it under twice the load."""
    bare, twice = simulate(without_idler(run.drive)), simulate(with_load(run.drive, 320.0))
    yield f"without idler: the compressor slips by {summarize(bare).pulleys[-1].slip:.1%}"
    yield f"Euler and Eytelwein's limit then: {limit_force(bare, 600.0, 0) * float(bare.drive.radii[1]):.4g} N m"
    yield f"with idler and twice the load: the compressor slips by {summarize(twice).pulleys[-1].slip:.1%}"


def band_brake(run: Run) -> Iterator[Number]:
    """Euler and Eytelwein's formula, and the frequency at which the weight bounces on the sliding belt."""
    drive = run.drive
    radius, friction, mass = float(drive.radii[0]), float(drive.frictions[0]), drive.ends[1].attached_mass
    slack, factor = mass * 9.81, capstan_ratio(friction, float(drive.path.wrap_angles[0]))
    torque = (factor - 1.0) * slack * radius
    sliding = run.dataset.sel(time=slice(0.4, 1.5))
    hanging, anchored = sliding["span_tension"].mean("time").values
    yield Number("span to the weight, N", slack, float(hanging), 0.01 * slack)
    yield Number("span to the anchor, N", factor * slack, float(anchored), 0.01 * factor * slack)
    yield Number("ratio of these tensions", factor, float(anchored / hanging), 0.005 * factor)
    found = -float(sliding["pulley_torque"].mean("time")[0])
    yield Number("braking torque, N m", torque, found, 0.01 * torque)
    power = float(sliding["friction_power"].mean("time")[0])
    yield Number("power lost in friction, W", 120.0 * RPM * torque, power, 0.01 * 120.0 * RPM * torque)
    free, held = (float(length) for length in drive.path.span_lengths)
    flexible = free + radius * (factor - 1.0) / friction + factor * held
    bounces = sqrt(drive.belt.axial_stiffness / (mass * flexible)) / (2.0 * pi)
    yield Number("frequency at which the weight bounces, Hz", bounces, _main_frequency(sliding), 0.03 * bounces)


def _main_frequency(sliding: Dataset) -> float:
    """Frequency of the largest amplitude of the tension above the weight, Hz."""
    time, tension = sliding["time"].values, sliding["span_tension"].values[:, 0]
    size = 1 << 16
    amplitudes = np.abs(np.fft.rfft((tension - tension.mean()) * np.hanning(time.size), size))
    return float(np.fft.rfftfreq(size, float(time[1] - time[0]))[np.argmax(amplitudes)])


def slip_through(run: Run) -> Iterator[Number]:
    """Euler and Eytelwein's limit on both pulleys; the sum of tensions follows from the belt's length."""
    drive = run.drive
    conveyor = drive.pulleys[1]
    radius, distance, friction = float(drive.radii[0]), conveyor.center[0], float(drive.frictions[0])
    rim = 720.0 * RPM * radius
    tight, slack = gross_slip_tensions(
        300.0, friction, distance, radius, mass_per_length=drive.belt.mass_per_length, speed=rim
    )
    braking = run.dataset.sel(time=slice(1.6, 1.85))
    spans, torque = braking["span_tension"].mean("time").values, braking["pulley_torque"].mean("time").values[1]
    limit = (tight - slack) * radius
    yield Number("tight span while it slips, N", tight, float(spans[1]), 0.02 * tight)
    yield Number("slack span while it slips, N", slack, float(spans[0]), 0.02 * slack)
    yield Number("largest torque of the belt on the conveyor, N m", limit, float(torque), 0.02 * limit)
    (load,) = conveyor.load
    times, speeds = braking["time"].values, braking["pulley_speed"].values[:, 1]
    braked = (limit - load.constant) / conveyor.inertia
    yield Number("deceleration, rad/s²", braked, float(np.polyfit(times, speeds, 1)[0]), 0.05 * abs(braked))
    sliding = np.abs(run.dataset["sliding_speed"].sel(time=slice(0.6, None))).max("pulley")
    since = float(sliding["time"][int((sliding.values > 0.001 * rim).argmax())])
    yield Number("time at which it slips through, s", 0.6 + limit / load.constant, since, 0.03)
    yield Number("slip safety at the end", 1.0, summarize(run).pulleys[1].slip_safety, 0.02)


def slip_and_efficiency(run: Run, tolerance: float) -> Iterator[Number]:
    """Creep of the last pulley, and the efficiency: creep and what bending and compression take are lost."""
    summary, loss = summarize(run), creep(run)
    bent = float(losses_of_the_belt(run.drive).sum()) * summary.spans[0].belt_speed / summary.balance.power_in
    found = summary.pulleys[-1].slip
    yield Number("slip, %", 100.0 * loss, 100.0 * found, 100.0 * tolerance * loss)
    pressed = float(compression_losses(run.prepared).sum()) * summary.spans[0].belt_speed / summary.balance.power_in
    more = 15.0 * pressed  # the tension on an arc is not that at rest
    yield Number("efficiency, %", 100.0 * (1.0 - loss - bent), 100.0 * summary.balance.efficiency, 0.1 + more)


def creep(run: Run) -> float:
    """Loss of speed from the first pulley to the last by elastic creep, from the tensions of the run."""
    tensions = [span.tension for span in summarize(run).spans]
    return speed_loss(max(tensions), min(tensions), run.drive.belt.stretch_parameters)


def losses_of_the_belt(drive: Drive) -> FloatArray:
    """Force by which bending on to each pulley and off, and compression on it, hold the belt back, N."""
    bent = bending_loss(drive.belt.bending_stiffness, drive.belt.bending_loss_factor, np.abs(drive.radii))
    return bent + compression_losses(prepare(drive))


def limit_between_fixed_centers(run: Run, tension: float) -> float:
    """Largest difference of tensions where both pulleys have the same wrap and friction, from the belt's length, N.

    `gross_slip_tensions` of unequal radii: spans and arcs, which slide, keep the mean of the tension at rest.
    """
    drive, speed = run.drive, summarize(run).spans[0].belt_speed
    pressing = tension - drive.belt.mass_per_length * speed**2
    friction, wrap_angle = float(drive.frictions[0]), float(drive.path.wrap_angles[0])
    ratio = capstan_ratio(friction, wrap_angle)
    free, radii = float(np.sum(drive.path.span_lengths)), float(np.sum(np.abs(drive.radii)))
    stretched = 0.5 * free * (ratio + 1.0) + radii * (ratio - 1.0) / friction
    return pressing * (free + radii * wrap_angle) * (ratio - 1.0) / stretched


def limit_force(run: Run, tension: float, pulley: int) -> float:
    """Euler and Eytelwein's largest difference of tensions at a mean tension, N."""
    drive = run.drive
    speed = summarize(run).spans[0].belt_speed
    pressing = tension - drive.belt.mass_per_length * speed**2
    return 2.0 * pressing * tanh(0.5 * float(drive.frictions[pulley] * drive.path.wrap_angles[pulley]))


def moved(drive: Drive, position: float) -> Drive:
    """The drive with the pulley of its sliding tensioner moved along the line."""
    (tensioner,) = drive.tensioners
    number = drive.carried(tensioner)
    pulleys = list(drive.pulleys)
    along = np.asarray(tensioner.direction) / np.hypot(*tensioner.direction)
    pulleys[number] = pulleys[number].replace(center=tuple(pulleys[number].center + position * along))
    return drive.replace(pulley=pulleys)


def without_idler(drive: Drive) -> Drive:
    """The same drive with fixed centers and without its idler, its belt as long as 600 N stretch it to the path."""
    pulleys = [pulley for pulley in drive.pulleys if pulley.side == "inside"]
    path = open_belt(pulleys[1].center[0], tuple(pulley.radius + drive.belt.pitch_offset for pulley in pulleys)).length
    length = path / float(drive.belt.stretch_parameters.stretch(600.0))
    return drive.replace(pulley=pulleys, tensioner=[], belt=drive.belt.replace(length=length))


def with_load(drive: Drive, torque: float) -> Drive:
    """The same drive with another constant load, N m, on its last pulley."""
    (load,) = drive.pulleys[-1].load
    loaded = drive.pulleys[-1].replace(load=[load.replace(constant=torque)])
    return drive.replace(pulley=[*drive.pulleys[:-1], loaded])


def wrap(run: Run, pulley: int) -> float:
    """Wrap angle of the drive at rest, degrees."""
    return float(np.degrees(run.drive.path.wrap_angles[pulley]))


def speed_of(run: Run, pulley: str) -> FloatArray:
    """Speed of a pulley over time, rad/s."""
    return np.asarray(run.dataset["pulley_speed"].sel(pulley=pulley).values)


def frequency_of(time: FloatArray, swing: FloatArray) -> float:
    """Frequency of a swing by its upward crossings of zero, Hz."""
    up = np.flatnonzero((swing[:-1] < 0.0) & (swing[1:] >= 0.0))
    crossings = time[up] - swing[up] * (time[up + 1] - time[up]) / (swing[up + 1] - swing[up])
    return float((len(crossings) - 1) / (crossings[-1] - crossings[0]))

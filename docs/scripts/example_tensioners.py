"""What the pages of the drives with a tensioner say in numbers, as `example_numbers.py` has it of the others.

The drives are the conveyor, that of an alternator, and that of a press whose arm meets its stop.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, hypot, log, pi, sqrt, tanh

import numpy as np
from example_numbers import RPM, Number, creep, losses_of_the_belt
from scipy.linalg import eigh
from scipy.optimize import brentq, curve_fit

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Path, prepare
from beltdyn.model.carrier import moved
from beltdyn.results import summarize
from beltdyn.results.derived import slip_safety
from beltdyn.theory.creep import capstan_ratio, slip_arc

STEP = 1e-5
"""Of a tensioner's position, for differences of the path, rad."""


@dataclass(frozen=True)
class Arm:
    """A drive with one tensioner by hand: the path as a polygon of straight lines and arcs, the belt as a spring."""

    drive: bd.Drive
    resting: float
    """Position at rest, rad."""
    tension: float
    """Tension at rest, N."""
    lifted: float
    """m v^2, N."""

    def path(self, position: float) -> Path:
        """The path with the tensioner at a position, rad."""
        return moved(self.drive.path, prepare(self.drive).carriers, np.array([position]))

    def lengthening(self, position: float) -> float:
        """Change of path length with the position, dL/dq, m/rad."""
        return (self.path(position + STEP).length - self.path(position - STEP).length) / (2.0 * STEP)

    def stretching(self, position: float) -> float:
        """Change of dL/dq with the position, m/rad^2."""
        lengths = [self.path(position + by).length for by in (-1e-3, 0.0, 1e-3)]
        return (lengths[0] - 2.0 * lengths[1] + lengths[2]) / 1e-6

    def slack(self, position: float) -> float:
        """Tension beside the tensioner's pulley where its spring, and a stop, balance the belt, N.

        It goes by moment and leverage over those at rest, so that what bending takes from the leverage, 1 %, drops
        out. Far beyond the stop, where no moment would be left, a hundredth of that at rest counts.
        """
        (arm,) = prepare(self.drive).carriers
        moment = max(arm.force(position) / arm.force(self.resting), 0.01)
        return self.tension * moment * self.lengthening(self.resting) / self.lengthening(position) + self.lifted

    def surplus(self, position: float, slack: float, pull: float) -> float:
        """Mean tension along the belt less that which stretches it to the path, N.

        Belt that adheres keeps the tension with which it runs on to a pulley; where it slides, the tension falls
        exponentially over the arc, and the mean of that is counted.
        """
        path, tight = self.path(position), slack + pull
        pressing = tight - self.lifted, slack - self.lifted
        ratio = pressing[0] / pressing[1]
        share = 1.0 / log(ratio) - 1.0 / (ratio - 1.0)
        driver, driven = (path.wrap_angles[k] * path.radii[k] for k in (0, -1))
        slid = [path.radii[k] * slip_arc(*pressing, float(self.drive.frictions[k])) for k in (0, -1)]
        tightened = path.span_lengths[-1] + driver - (1.0 - share) * min(slid[0], driver) + share * min(slid[1], driven)
        longer = path.length - self.path(self.resting).length
        needed = self.tension + longer * self.drive.belt.axial_stiffness / self.drive.belt_length
        return float(slack + pull * tightened / path.length - needed)

    def balance(self, pull: float) -> float:
        """Position in which spring and belt agree at a difference of tensions, rad."""
        places = self.resting - 0.05, self.resting + 0.3
        return float(brentq(lambda place: self.surplus(place, self.slack(place), pull), *places))

    def safety(self, pull: float, number: int) -> float:
        """Factor on a difference of tensions at which the belt slides on the whole arc of a pulley."""

        def missing(factor: float) -> float:
            position = self.balance(factor * pull)
            holding = capstan_ratio(float(self.drive.frictions[number]), float(self.path(position).wrap_angles[number]))
            return (self.slack(position) - self.lifted) * (holding - 1.0) - factor * pull

        factor = 1.0
        while missing(factor) > 0.0:
            factor *= 1.1
        return float(brentq(missing, factor / 1.1, factor))


def arm_of(run: bd.Run) -> Arm:
    """The arm of a run, at rest as its first output has it, and with the belt at its last speed."""
    rest, end = run.dataset.isel(time=0), run.dataset.isel(time=-1)
    lifted = run.drive.belt.mass_per_length * float(end["belt_speed"].mean()) ** 2
    return Arm(run.drive, float(rest["tensioner_position"][0]), float(rest["span_tension"].mean()), lifted)


def conveyor(run: bd.Run) -> Iterator[Number]:
    """The weight gives the sum of the tensions, load and height their difference; strands hang as parabolas."""
    drive, summary, belt = run.drive, summarize(run), run.drive.belt
    (weight,), (load,) = drive.tensioners, drive.pulleys[1].load
    radius, length = float(drive.radii[0]), drive.pulleys[1].center[0]
    bent = float(losses_of_the_belt(drive)[0])
    speed = float(drive.pulleys[0].speed.value) * radius
    pull, weighing = load.constant / radius + bent, 9.81 * belt.mass_per_length
    total, apart = weight.preload + 2.0 * belt.mass_per_length * speed**2, pull + 2.0 * radius * weighing
    slack, tight = 0.5 * (total - apart), 0.5 * (total + apart)
    found = {span.name: span.tension for span in summary.spans}
    high, low = found["tail-head"], found["head-tail"]
    yield Number("tight tension, N", tight, high, 0.01 * tight)
    yield Number("slack tension, N", slack, low, 0.01 * slack)
    yield Number("sum of the tensions, N", total, high + low, 0.005 * total)
    yield Number("difference of the tensions, N", apart, high - low, 0.005 * apart)
    yield Number("ΔT/EA, %", 100.0 * apart / belt.axial_stiffness, 100.0 * creep(run), 0.001)
    safety = weight.preload * tanh(0.5 * pi * float(drive.frictions[1])) / apart
    yield Number("slip safety", safety, summary.pulleys[1].slip_safety, 0.01 * safety)
    hanging = run.dataset["mid_span_displacement"].sel(time=slice(summary.start, None)).mean("time")
    for which, tension in (("tail-head", tight), ("head-tail", slack)):
        sag = weighing * length**2 / (8.0 * tension)
        strand = "upper" if which == "tail-head" else "lower"
        yield Number(
            f"sag of the {strand} strand, mm", 1e3 * sag, 1e3 * abs(float(hanging.sel(span=which))), 30.0 * sag
        )
    power = (pull + bent) * speed
    yield Number("power of the head drum, W", power, summary.pulleys[0].power, 0.01 * power)


def alternator_drive(run: bd.Run) -> Iterator[Number]:
    """The arm's moment gives the slack tension, the load the tight one; hub loads are sums of vectors."""
    drive, summary, arm = run.drive, summarize(run), arm_of(run)
    (load,), radii = drive.pulleys[2].load, np.abs(drive.radii)
    bent = losses_of_the_belt(drive)
    pull = load.constant / float(radii[2]) + float(bent[2])
    position = arm.balance(pull)
    slack = arm.slack(position)
    tight, path = slack + pull, arm.path(position)
    loss = creep(run)
    (found,) = summary.tensioners
    yield Number("arm at the end, °", float(np.degrees(position)), float(np.degrees(found.position)), 0.1)
    yield Number("slack tension, N", slack, summary.spans[1].tension, 0.005 * slack)
    yield Number("tight tension, N", tight, summary.spans[2].tension, 0.01 * tight)
    torque = float(radii[0]) * (pull + float(bent[:2].sum()))
    yield Number("torque of the crank, N m", torque, summary.pulleys[0].shaft_torque, 0.01 * torque)
    for number, (before, behind) in enumerate(((tight, slack), (slack, slack), (slack, tight))):
        one, other, wrapped = before - arm.lifted, behind - arm.lifted, float(path.wrap_angles[number])
        force = sqrt(one**2 + other**2 - 2.0 * one * other * cos(wrapped))
        name = drive.pulleys[number].name
        yield Number(f"{name}: hub load, N", force, summary.pulleys[number].hub_load, 0.015 * force)
    speed = 1500.0 * float(radii[0] / radii[2]) * (1.0 - loss)
    yield Number("alternator, rpm", speed, summary.pulleys[2].speed / RPM, 2.0)
    yield Number("slip, %", 100.0 * pull / drive.belt.axial_stiffness, 100.0 * summary.pulleys[2].slip, 0.015)
    lowest = natural_frequencies(arm, position, slack, tight)[0]
    yield Number("lowest natural frequency, Hz", lowest, swing_frequency(run, lowest), 0.05 * lowest)


def tensioner_stop(run: bd.Run) -> Iterator[Number]:
    """The arm's moment gives the slack tension; in the stroke the stop holds the arm, and the belt's length does."""
    drive, arm = run.drive, arm_of(run)
    (spring,), (load,), radius = drive.tensioners, drive.pulleys[2].load, float(drive.radii[2])
    bent = float(losses_of_the_belt(drive)[2])
    for when, share, instants in (("idling", 0.2, slice(0.35, 0.434)), ("stroke", 1.0, slice(0.66, 0.744))):
        pull = share * load.constant / radius + bent
        position = arm.balance(pull)
        slack, wrapped = arm.slack(position), float(arm.path(position).wrap_angles[2])
        found = run.dataset.sel(time=instants).mean("time")
        loose, tight = (float(found["span_tension"][span]) for span in (1, 2))
        arm_at, force = float(found["tensioner_position"][0]), hypot(*found["hub_force"].values[2])
        yield Number(f"{when}: arm, °", float(np.degrees(position)), float(np.degrees(arm_at)), 0.1)
        yield Number(f"{when}: slack tension, N", slack, loose, 0.02 * slack)
        yield Number(f"{when}: tight tension, N", slack + pull, tight, 0.01 * (slack + pull))
        one, other = slack + pull - arm.lifted, slack - arm.lifted
        hub = sqrt(one**2 + other**2 - 2.0 * one * other * cos(wrapped))
        yield Number(f"{when}: hub load of the press, N", hub, force, 0.015 * hub)
    safety, safeties = arm.safety(pull, 2), slip_safety(run, 0.66, 0.744).sel(pulley="press")
    yield Number("stroke: slip safety of the press", safety, float(safeties.mean()), 0.02 * safety)
    meets = brentq(lambda torque: arm.balance(torque / radius + bent) - spring.stops[1], 11.0, 55.0)
    steady = summarize(bd.steady_state(drive.with_({"pulley[press].load[1].constant": meets}), at=0.6))
    reached = np.degrees(steady.tensioners[0].position)
    yield Number(f"arm under {meets:.3g} N m, °", float(np.degrees(spring.stops[1])), float(reached), 0.1)
    free = drive.replace(tensioner=[spring.replace(stops=None, stop_stiffness=None, stop_damping=0.0)])
    by_hand = Arm(free, arm.resting, arm.tension, arm.lifted)
    slack = by_hand.slack(by_hand.balance(load.constant / radius + bent))
    found = summarize(bd.steady_state(free, at=0.6)).spans[1].tension
    yield Number("stroke without stops: slack tension, N", slack, found, 0.02 * slack)


def natural_frequencies(arm: Arm, position: float, slack: float, tight: float) -> FloatArray:
    """Of tensioner pulley, arm and alternator on elastic spans, the crank held, Hz.

    A span is as long as the belt that does not adhere: the free one, and the arc on which it slides before it.
    """
    drive, path = arm.drive, arm.path(position)
    (spring,), radii = drive.tensioners, path.radii
    ahead, behind = (path.span_directions[k] for k in (0, 1))
    _, moving = prepare(drive).carriers[0].place(position)
    sliding = slip_arc(tight - arm.lifted, slack - arm.lifted, float(drive.frictions[0]))
    lengths = path.span_lengths + sliding * np.array([radii[0], 0.0, radii[2]])
    stretches = np.array(
        [
            [radii[1], float(ahead @ moving), 0.0],
            [-radii[1], -float(behind @ moving), radii[2]],
            [0.0, 0.0, -radii[2]],
        ]
    )
    stiffness = stretches.T @ np.diag(drive.belt.axial_stiffness / lengths) @ stretches
    stiffness[1, 1] += spring.rate + (slack - arm.lifted) * arm.stretching(position)
    reach = hypot(*np.subtract(drive.pulleys[1].center, spring.pivot))
    arm_inertia = spring.inertia + drive.pulleys[1].mass * reach**2
    mass = np.diag([drive.pulleys[1].inertia, arm_inertia, drive.pulleys[2].inertia])
    return np.asarray(np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * pi))


def swing_frequency(run: bd.Run, start: float) -> float:
    """Frequency of the alternator after its load has come, by a fit of a decaying swing, Hz."""
    swinging = run.dataset["pulley_speed"].sel(time=slice(0.22, 0.4), pulley="alternator")

    def model(time: FloatArray, frequency: float, decay: float, a: float, b: float, c: float) -> FloatArray:
        angle = 2.0 * pi * frequency * time
        return np.asarray(np.exp(-decay * time) * (a * np.cos(angle) + b * np.sin(angle)) + c)

    time = swinging["time"].values - 0.22
    found = curve_fit(model, time, swinging.values, (start, 10.0, 1.0, 1.0, float(swinging.mean())))[0]
    return float(found[0])

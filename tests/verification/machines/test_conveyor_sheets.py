"""Sheets of conveyors drawn at random against a balance by hand.

Two drums of equal size, so that both strands are parallel: resistances by DIN 22101, m g h, and the masses that move.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from tests.lumped.seeds import blocks

GRAVITY, FACTOR, FRICTION, GRIP = 9.81, 1.09, 0.02, 0.4
CLASSES = {"EP 400/3": (400.0, 10.0), "EP 630/4": (630.0, 10.0), "ST 500": (500.0, 6.7), "ST 1000": (1000.0, 6.7)}
"""Strength, N/mm, and least safety factor in steady running."""
ROTORS = (2000.0, 1500.0)
"""Moments of inertia of head and tail with their drives, kg m^2."""
MOTOR = (4e3, 0.08)
"""Breakdown torque at the tail, N m, and slip."""
PULL, TENSION = 0.01, 0.01
"""Of the sum of all resistances, and of the largest tension: the mesh, and the arcs at the ends of strands."""


@dataclass
class Conveyor:
    """A conveyor drawn at random, in SI units."""

    length: float
    slope: float
    flow: float
    speed: float
    profile: str
    width: float
    motor: bool
    brake: float
    acceleration: float

    @classmethod
    def drawn(cls, seed: int) -> "Conveyor":
        draw = np.random.default_rng(seed)
        return cls(
            length=draw.uniform(40.0, 300.0),
            slope=np.radians(draw.uniform(-10.0, 8.0)),
            flow=draw.uniform(20.0, 250.0),
            speed=draw.uniform(1.0, 4.0),
            profile=draw.choice(list(CLASSES)),
            width=draw.choice([0.65, 0.8, 1.0, 1.2]),
            motor=bool(draw.random() < 0.5),
            brake=draw.uniform(2e3, 8e3),
            acceleration=draw.uniform(0.05, 0.3),
        )

    @property
    def radius(self) -> float:
        """Of the tension line."""
        return 0.4 + self.belt.pitch_offset

    @property
    def belt(self) -> bd.Belt:
        return bd.Belt.model_validate({"profile": self.profile, "width": self.width, "length": 1.0})

    @property
    def goods(self) -> float:
        return self.flow / self.speed

    @property
    def lift(self) -> float:
        """Weight of the goods along the carrying strand, N."""
        return self.goods * GRAVITY * self.length * math.sin(self.slope)

    def strand(self, rotating: float, goods: float) -> float:
        """Resistance of a strand by friction, N, with the mass of rotating parts and goods, kg/m."""
        carried = (self.belt.mass_per_length + goods) * math.cos(self.slope)
        return FACTOR * FRICTION * GRAVITY * self.length * (rotating + carried)

    @property
    def weight(self) -> float:
        """Of the take-up, N: the belt stays tight at rest and while it starts and stops."""
        moved = self.moved * max(self.acceleration, self.brake / 0.4 / self.moved)
        return 3.0 * (abs(self.lift) + self.strand(15.0, self.goods) + moved + 8e3)

    @property
    def moved(self) -> float:
        """Mass that moves, kg."""
        belt = self.belt.mass_per_length * (2.0 * self.length + 2.0 * np.pi * self.radius)
        return belt + self.length * (15.0 + 4.0 + self.goods) + sum(ROTORS) / self.radius**2

    def drive(self) -> bd.Drive:
        rise = self.length * np.array([np.cos(self.slope), -np.sin(self.slope)])
        idlers = {"kind": "idlers", "friction": FRICTION, "secondary_factor": FACTOR}
        brake = {"kind": "brake", "torque": {"kind": "step", "time": 5.0, "value": self.brake}}
        torque, slip = MOTOR
        motor = {
            "kind": "motor",
            "breakdown_torque": torque,
            "breakdown_slip": slip,
            "synchronous_speed": 1.03 * self.speed / self.radius,
        }
        return bd.Drive(
            gravity=[0.0, -GRAVITY],
            belt={"profile": self.profile, "width": self.width},
            pulley=[
                {
                    "name": "head",
                    "center": [0.0, 0.0],
                    "radius": 0.4,
                    "speed": self.speed / self.radius,
                    "inertia": ROTORS[0],
                },
                {
                    "name": "tail",
                    "center": rise.tolist(),
                    "radius": 0.4,
                    "inertia": ROTORS[1],
                    "mass": 300.0,
                    "load": [brake, motor] if self.motor else [brake],
                },
            ],
            tensioner=[
                {
                    "kind": "sliding",
                    "pulley": "tail",
                    "direction": (rise / self.length).tolist(),
                    "mass": 1e3,
                    "preload": self.weight - 1300.0 * GRAVITY * np.sin(self.slope),  # drum and slide weigh, too
                    "travel": 1.0,
                }
            ],
            support=[
                idlers | {"span": ["tail", "head"], "spacing": 1.2, "idler_mass": 18.0},
                idlers | {"span": ["head", "tail"], "spacing": 3.0, "idler_mass": 12.0},
            ],
            goods=[{"span": ["tail", "head"], "mass_flow": self.flow, "speed": self.speed}],
            contact={"friction": GRIP},
            simulation={"duration": 1.0},
        )


class ByHand:
    """Pulls, tensions and motions of a conveyor by hand; tensions in the order of the running belt from the tail."""

    def __init__(self, one: Conveyor, speed: float) -> None:
        """`speed`: of the tail drum, rad/s, which the slip of its motor follows."""
        self.one, self.speed = one, speed
        self.strands = np.array([one.strand(15.0, one.goods), one.strand(4.0, 0.0)])
        self.falls = GRAVITY * one.length * np.sin(one.slope) * one.belt.mass_per_length * np.array([1.0, -1.0])
        self.falls[0] += one.lift
        self.total = float(self.strands.sum()) + one.lift
        torque, critical = MOTOR
        slip = 1.0 - speed / (1.03 * one.speed / one.radius)
        drives = 2.0 * torque / (slip / critical + critical / slip) if one.motor else 0.0
        tail = drives / one.radius
        self.pulls = np.array([self.total - tail, tail])
        """Of head and tail."""
        self.rotors = np.array(ROTORS) / one.radius**2
        self.drives = np.array([True, one.motor])
        belt = one.belt.mass_per_length * (one.length + np.pi * one.radius)
        self.masses = np.array([belt + one.length * (15.0 + one.goods), belt + one.length * 4.0])

    def tensions(self, acceleration: float, pulls: np.ndarray) -> np.ndarray:
        """At start and end of the carrying strand, and of the other."""
        rise = self.strands + self.falls + acceleration * self.masses
        behind = np.cumsum([0.0, rise[0], -pulls[0], rise[1]])
        # the take-up holds the sum of both tensions at the tail; the weight of the belt around it is small
        first = 0.5 * (self.one.weight - behind[3])
        return np.asarray(first + behind)

    def start(self) -> np.ndarray:
        """Pulls on the belt."""
        shares = np.abs(self.pulls) / np.abs(self.pulls).sum()
        mass = self.masses.sum() + self.rotors[~self.drives].sum()
        idle = np.where(self.drives, 0.0, self.rotors * self.one.acceleration)
        return np.asarray(self.pulls + shares * mass * self.one.acceleration - idle)

    def stop(self) -> tuple[float, np.ndarray]:
        """Acceleration and pulls on the belt."""
        brake = np.array([0.0, self.one.brake / self.one.radius])
        acceleration = -(self.total + brake.sum()) / (self.masses.sum() + self.rotors.sum())
        return acceleration, -brake - self.rotors * acceleration


@blocks([3, 17], 40, 6)
def test_sheets_of_drawn_conveyors_balance(seeds: Sequence[int]) -> None:
    """The take-up of seed 17 moves its drum by 0.6 m towards the idlers, which do not press on it."""
    for seed in seeds:
        check(seed)


def check(seed: int) -> None:
    one = Conveyor.drawn(seed)
    result = bd.sheet(one.drive(), acceleration=one.acceleration / one.radius)
    found = result.dataset.isel(row=0)
    head, tail = (found.sel(pulley=name) for name in ("head", "tail"))
    hand = ByHand(one, abs(float(tail.pulley_speed)))
    speed, total = one.speed, float(np.abs([*hand.strands, one.lift]).sum())
    said: dict[str, Any] = {"atol": PULL * total, "rtol": 0.01, "err_msg": f"seed {seed}: {one}"}

    # steady running: pulls, and the account of powers, in which goods that go down are an input and no loss
    np.testing.assert_allclose(found.running_pull, hand.total if one.motor else hand.pulls[0], **said)
    np.testing.assert_allclose([head.power / speed, tail.power / speed], hand.pulls, **said)
    watts = said | {"atol": PULL * total * speed}
    np.testing.assert_allclose(found.lifting_power, one.lift * speed, **watts)
    np.testing.assert_allclose(found.loss, hand.strands.sum() * speed, **watts)
    parts = np.array([*hand.pulls, -one.lift]) * speed
    np.testing.assert_allclose(found.power_in, parts[parts > 0.0].sum(), **watts)
    np.testing.assert_allclose(found.power_out, -parts[parts < 0.0].sum(), **watts)
    assert 0.0 <= float(found.power_out) <= float(found.power_in)

    # tensions, safety factors, and motions
    moving = found.sel(motion=["start", "emergency stop"])
    steady = hand.tensions(0.0, hand.pulls)
    close: dict[str, Any] = said | {"atol": TENSION * steady.max()}
    carrying, returning = (found.sel(span=name) for name in ("tail-head", "head-tail"))
    ends = [strand[name] for strand in (carrying, returning) for name in ("tension_at_start", "tension_at_end")]
    np.testing.assert_allclose(ends, steady, **close)
    stopping, stop = hand.stop()
    motions = ((one.acceleration, hand.start()), (stopping, stop))
    tensions = np.array([hand.tensions(*motion) for motion in motions])
    np.testing.assert_allclose(moving.motion_largest_tension, tensions.max(axis=1), **close)
    np.testing.assert_allclose(moving.motion_least_tension, tensions.min(axis=1), **close)
    np.testing.assert_allclose(
        moving.motion_rate, [one.acceleration, -stopping if stopping < 0.0 else np.nan], rtol=0.02, atol=0.002
    )
    strength, least = CLASSES[one.profile]
    breaking = 1e3 * strength * one.width
    np.testing.assert_allclose(found.belt_safety, breaking / steady.max(), rtol=0.02)
    np.testing.assert_allclose(moving.motion_belt_safety, breaking / tensions.max(axis=1), rtol=0.02)
    weak = any("safety factor of the belt" in text and "in steady running" in text for text in result.warnings)
    assert weak == (float(found.belt_safety) < least)

    # drives and brakes: torques on the shaft, and their tension ratios
    torques = (hand.start() + np.where(hand.drives, hand.rotors, 0.0) * one.acceleration) * one.radius
    torques *= hand.drives
    starting = said | {"atol": PULL * total * one.radius}
    np.testing.assert_allclose(moving.motion_torque.sel(motion="start"), torques, **starting)
    braking = moving.motion_torque.sel(motion="emergency stop")
    np.testing.assert_allclose(braking, [0.0, -one.brake], rtol=1e-6, atol=1e-6)
    at_tail = tensions[:, [0, 3]] - one.belt.mass_per_length * speed**2
    ratios = at_tail.max(axis=1) / at_tail.min(axis=1)
    np.testing.assert_allclose(moving.motion_tension_ratio.sel(pulley="tail"), ratios, rtol=0.03)

    # the take-up: half of what the belt gets longer
    strain = max(float(steady.mean()), float(tensions[0].mean())) / one.belt.axial_stiffness
    stretch = strain / (1.0 + strain) * (2.0 * one.length + 2.0 * np.pi * one.radius)
    heat = (one.belt.thermal_expansion or 0.0) * 50.0
    needed = 0.5 * (stretch + float(found.belt_length) * ((one.belt.permanent_elongation or 0.0) + heat))
    assert float(found.take_up_travel) == pytest.approx(needed, rel=0.02), seed
    assert any("the take-up needs a travel" in text for text in result.warnings) == (float(found.take_up_travel) > 1.0)
    away = any("goods that go down drive the belt" in text for text in result.warnings)
    assert away == (float(found.running_pull) < 0.0)

import numpy as np

import beltdyn as bd
from beltdyn.arrays import row
from beltdyn.machines.loads.load import ShaftState
from beltdyn.machines.loads.permanent_magnet_motor import PERMANENT_MAGNET_MOTOR, limit_reached, motor_torque

VOLTAGE, CONSTANT, RESISTANCE, LIMIT = 3.0, 0.5, 0.5, 2.0
numbers = {"voltage": VOLTAGE, "torque_constant": CONSTANT, "resistance": RESISTANCE, "current_limit": LIMIT}

constants, none = row(PERMANENT_MAGNET_MOTOR, **numbers), np.zeros(0)
for speed in (1.0, 3.9, 4.1, 7.9, 8.1):  # the current is limited below 4 and above 8 rad/s
    states = (
        ShaftState(time=0.0, angle=0.0, speed=speed + step, command=0.0, state=0.0) for step in (-1e-6, 0.0, 1e-6)
    )
    before, here, after = (motor_torque(constants, none, state) for state in states)
    assert abs(here.by_speed - (after.torque - before.torque) / 2e-6) < 1e-8
for speed, limit in ((1.0, 4.0), (5.0, 8.0), (9.0, np.inf)):
    assert limit_reached(constants, none, ShaftState(0.0, 0.0, speed, 0.0, 0.0), True) == limit

drive = bd.example("two_pulley")
inertia = 0.02
motor = {"kind": "permanent_magnet_motor", **numbers, "voltage": "3000 mV"}
driver = drive.pulleys[0].replace(speed=None, inertia=inertia, load=[motor])
driven = drive.pulleys[1].replace(torque=None, inertia=inertia)
simulation = drive.simulation.replace(duration=0.4, start="equilibrium")
run = bd.simulate(drive.replace(pulley=[driver, driven], simulation=simulation))
time, speed = run.dataset["time"].values, run.dataset["pulley_speed"].values[:, 0]

expected = CONSTANT * np.clip((VOLTAGE - CONSTANT * speed) / RESISTANCE, -LIMIT, LIMIT)
assert np.allclose(run.dataset["shaft_torque"].values[:, 0], expected, rtol=1e-6)

belt = drive.belt.mass_per_length * drive.belt_length * drive.radii[0] ** 2
whole = 2 * inertia + belt
limited = 4.0 / (CONSTANT * LIMIT / whole)
assert abs(np.interp(limited / 2, time, speed) / 2.0 - 1) < 0.1  # the driven pulley swings on the spans
free = 6.0 - 2.0 * np.exp(-(time[-1] - limited) * CONSTANT**2 / (whole * RESISTANCE))
assert abs(speed[-1] / free - 1) < 0.01

put_in = float(run.dataset["torque_work"][-1])
assert abs(float(run.dataset["energy_closure"][-1])) < 1e-3
assert put_in > 0.5 * whole * speed[-1] ** 2

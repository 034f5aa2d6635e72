import numpy as np

import beltdyn as bd
from beltdyn.arrays import row
from beltdyn.machines.links.progressive_coupling import PROGRESSIVE_COUPLING, progressive_coupling

STIFFNESS, CUBIC, DAMPING, LOAD = 5.0, 400.0, 0.2, 1.0
numbers = {"stiffness": STIFFNESS, "cubic_stiffness": CUBIC, "damping": DAMPING}

constants, step = row(PROGRESSIVE_COUPLING, **numbers), 1e-5
for twist in (-0.3, 0.05, 0.2):
    before, here, after = (progressive_coupling(constants, 1.0, twist + h, 0.0) for h in (-step, 0.0, step))
    assert abs(here.torque - (after.energy - before.energy) / (2 * step)) < 1e-6
    assert abs(here.by_twist - (after.torque - before.torque) / (2 * step)) < 1e-6
    moving = progressive_coupling(constants, 1.0, twist, 0.7)
    assert np.isclose(moving.loss, (moving.torque - here.torque) * 0.7)

drive = bd.example("two_pulley")
link = {"kind": "progressive_coupling", **numbers, "inertia": 0.005}
driver = drive.pulleys[0].replace(speed={"kind": "constant", "value": 0.0})
driven = drive.pulleys[1].replace(
    inertia=0.005, hub=[link], torque={"kind": "cosine_ramp", "start": 0.0, "end": 0.1, "value": -LOAD}
)
simulation = drive.simulation.replace(duration=0.6, start="equilibrium")
run = bd.simulate(drive.replace(pulley=[driver, driven], simulation=simulation))
end = run.dataset.isel(time=-1)
twist = float(end["pulley_angle"][1] - end["shaft_angle"][1])
assert abs(STIFFNESS * twist + CUBIC * twist**3 - LOAD) < 0.02 * LOAD
assert float(end["coupling_loss"]) > 0.0
assert abs(float(end["energy_closure"])) < 1e-3

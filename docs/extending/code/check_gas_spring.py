import numpy as np

import beltdyn as bd
from beltdyn.arrays import row
from beltdyn.machines.tensioners.gas_spring import EXPONENT, GAS_SPRING, gas_spring_force
from beltdyn.model import advise, install

FORCE, COLUMN = 120.0, 0.08
gas = {"force": FORCE, "column": COLUMN}
free = {"creep_speed": 1.0, "lower": -np.inf, "upper": np.inf}
constants, step = row(GAS_SPRING, **gas, spring=free), 1e-6
for q in (-0.02, 0.0, 0.03):
    before, here, after = (gas_spring_force(constants, q + h, 0.0) for h in (-step, 0.0, step))
    assert abs(here.force + (after.energy - before.energy) / (2 * step)) < 1e-5
    assert abs(here.by_position - (after.force - before.force) / (2 * step)) < 1e-3

drive = bd.example("two_pulley")
spring = {"kind": "gas_spring", "pulley": "driven", "direction": [1.0, 0.0], "mass": 0.5, **gas}
friction = {"tensioning_friction": 6.0, "yielding_friction": 6.0}
driver, driven = drive.pulleys[0].replace(speed=12.0), drive.pulleys[1].replace(torque=-1.0)
belt = drive.belt.replace(length=drive.belt_length * 1.002)
pressed = drive.replace(pulley=[driver, driven], belt=belt, tensioner=[spring | friction], simulation={"duration": 0.2})


def gas_force(place):
    return FORCE * (COLUMN / (COLUMN + place)) ** EXPONENT


# without dry friction the belt pushes along the line as the gas does
smooth = pressed.replace(tensioner=[spring])
for analysis in (bd.equilibrium, bd.steady_state):
    found = analysis(smooth).dataset
    place, hub = np.ravel(found["tensioner_position"])[-1], found["hub_force"].values.reshape(-1, 2, 2)[-1, 1]
    assert np.isclose(-hub[0], gas_force(place), rtol=1e-4)
assert advise(pressed, install(pressed)) is not None
states = bd.tensioner_sheet(pressed).dataset
row_of_belt = states.sel(state="nominal belt")
assert np.isclose(row_of_belt["spring_load"].item(), gas_force(row_of_belt["position"].item()), rtol=1e-6)
assert np.all(np.isfinite(bd.modes(pressed, count=4).dataset["frequency"]))
run = bd.simulate(pressed)
assert abs(float(run.dataset["energy_closure"][-1])) < 1e-3

import numpy as np
from scipy.integrate import solve_ivp

import beltdyn as bd
from beltdyn.contact.normal import HuntCrossley, normal_force

law, step = HuntCrossley(1e6, 0.0, 0.5), 1e-7
for depth, rate in ((1e-4, 0.3), (1e-3, -0.5), (1e-4, -3.0), (2e-3, 0.0)):
    force = normal_force(law, depth, rate)
    deeper, less = (normal_force(law, depth + s, rate) for s in (step, -step))
    faster, slower = (normal_force(law, depth, rate + s) for s in (step, -step))
    assert np.isclose(force.by_penetration, (deeper.force - less.force) / (2 * step), rtol=1e-6)
    assert np.isclose(force.by_rate, (faster.force - slower.force) / (2 * step), rtol=1e-6)
    assert np.isclose(force.elastic, (deeper.energy - less.energy) / (2 * step), rtol=1e-6)
    assert (force.force - force.elastic) * rate >= 0.0


def motion(_, state):
    return state[1], -normal_force(law, *state).force


speed, half_period = 0.02, np.pi / np.sqrt(law.stiffness)  # of a mass of 1 kg a meter on the spring
path = solve_ivp(motion, (0.0, 2.0 * half_period), (0.0, speed), rtol=1e-10, atol=1e-14, max_step=0.1 * half_period)
assert np.isclose(1.0 + path.y[1, -1] / speed, 2.0 / 3.0 * law.impact_damping * speed, rtol=0.02)

drive = bd.example("two_pulley")
contact = drive.contact.replace(normal_law="hunt_crossley", impact_damping=1.0, damping=0.0)
run = bd.simulate(drive.replace(contact=contact, simulation=drive.simulation.replace(duration=0.3)))
end = run.dataset.isel(time=-1)
assert float(end["damping_loss"]) > 0.0
assert abs(float(end["energy_closure"])) < 1e-3 * float(end["driver_work"])

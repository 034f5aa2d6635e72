import numpy as np

import beltdyn as bd
from beltdyn.contact.friction import Smooth, friction_force

law, normal, mu, step = Smooth(0.05), 800.0, 0.4, 1e-6
for slip in (-0.3, -0.04, 0.0, 0.01, 0.2):
    force, by_slip, by_normal, _ = friction_force(law, slip, normal, mu, 1.0)
    up, down = (friction_force(law, slip + s, normal, mu, 1.0)[0] for s in (step, -step))
    more, less = (friction_force(law, slip, normal + s, mu, 1.0)[0] for s in (step, -step))
    assert np.isclose(by_slip, (up - down) / (2 * step), rtol=1e-6)
    assert np.isclose(by_normal, (more - less) / (2 * step), rtol=1e-6, atol=1e-9)
    assert force * slip <= 0.0
assert np.isclose(friction_force(law, -law.saturation(normal, mu, 1.0), normal, mu, 1.0)[0], 0.99 * mu * normal)
assert friction_force(Smooth(1e-6), 1e-3, normal, mu, 1.0)[0] == -mu * normal

drive = bd.example("two_pulley")
contact = drive.contact.replace(friction_law="smooth", smoothing_velocity=0.05, creep_rate_factor=None)
run = bd.simulate(drive.replace(contact=contact, simulation=drive.simulation.replace(duration=0.3)))
end = run.dataset.isel(time=-1)
assert float(end["friction_loss"]) > 0.0
assert abs(float(end["energy_closure"])) < 1e-3 * float(end["driver_work"])
assert 0.9 < float(end["pulley_speed"][1] / end["pulley_speed"][0]) < 1.0

import numpy as np

import beltdyn as bd
from beltdyn.stretch import Linear, Rubber, stretching

law, step = Rubber(2e4, 0.2), 1e-5
for g in (0.8, 0.99, 1.02, 1.3):
    here = stretching(law, g * g)
    tension, slope = float(law.tension(g)), float(law.tangent_stiffness(g))
    up, down = (stretching(law, (g + s) ** 2).energy for s in (step, -step))
    assert np.isclose((up - down) / (2 * step), tension, rtol=1e-6)
    assert np.isclose(2.0 * g * here.slope, tension, rtol=1e-12)
    assert np.isclose(2.0 * here.slope + 4.0 * g * g * here.curvature, slope, rtol=1e-12)
    assert np.isclose(law.stretch(tension), g, rtol=1e-12)
assert law.tension(1.1) < Linear(2e4).tension(1.1)

drive = bd.example("two_pulley")
belt = drive.belt.replace(length=drive.path.length / 1.1, youngs_modulus=1e6, stretch_law="rubber", second_share=0.2)
run = bd.simulate(drive.replace(belt=belt, simulation=drive.simulation.replace(start="equilibrium", duration=0.1)))
tension = run.dataset["span_tension"].values[0].mean()
assert np.isclose(tension, belt.stretch_parameters.tension(1.1), rtol=0.05)
end = run.dataset.isel(time=-1)
assert abs(float(end["energy_closure"])) < 1e-3 * float(end["driver_work"])

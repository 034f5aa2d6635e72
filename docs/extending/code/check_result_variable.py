import numpy as np

import beltdyn as bd

drive = bd.example("two_pulley")
drive = drive.replace(belt=drive.belt.replace(elements=60))
settings = drive.simulation.replace(start="equilibrium", duration=1e-3)
rest = bd.simulate(drive.replace(simulation=settings))
free = rest.dataset["free_length"]
assert free.dims == ("time", "span")
assert free.attrs == {"units": "m", "long_name": "Length of free elements, unstretched"}

stretch = drive.path.length / drive.belt_length
straight = np.array(drive.path.span_lengths) / stretch
element = drive.belt_length / drive.belt.elements
assert np.all(free[0] < straight)
assert np.all(free[0] > straight - 2 * element)
assert "free_length" in bd.equilibrium(drive).dataset
assert "free_length driver-driven [m]" in bd.write_csv(rest, "tables")[1].read_text(encoding="utf-8")

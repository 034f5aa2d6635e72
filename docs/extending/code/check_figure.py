import numpy as np

import beltdyn as bd

drive = bd.example("two_pulley")
settings = drive.simulation.replace(start="equilibrium", duration=1e-3)
rest = bd.simulate(drive.replace(simulation=settings))
lines = bd.plot.tension_ratio(rest).lines
assert [line.get_label() for line in lines] == ["driver", "driven"]
assert all(np.allclose(line.get_ydata(), 1.0, atol=1e-6) for line in lines)
assert [path.name for path in bd.plot.save_all(rest, "figures", ["tension_ratio"])] == ["tension_ratio.png"]

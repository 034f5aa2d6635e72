import numpy as np
from scipy.linalg import lu_factor, lu_solve

import beltdyn as bd

GAMMA = 1.0 - np.sqrt(0.5)


class Sdirk2:
    name = "sdirk2"
    order = 1

    def step(self, equations, time, y, length):
        part = length * GAMMA
        factors = lu_factor(np.eye(y.size) - part * equations.jacobian(time, y))
        first = self._slope(equations, time + part, y, part, factors)
        second = self._slope(equations, time + length, y + (length - part) * first, part, factors)
        return y + (length - part) * first + part * second, part * (second - first)

    def _slope(self, equations, time, y, part, factors):
        """The slope k = f(t, y + part k), by Newton's method with one tangent for the whole step."""
        slope = equations.rates(time, y)
        for _ in range(20):
            change = lu_solve(factors, slope - equations.rates(time, y + part * slope))
            slope = slope - change
            if np.max(np.abs(part * change)) < 1e-9:
                return slope
        raise bd.extend.StepError("Newton's method does not converge")


drive = bd.example("two_pulley")
speed = {"kind": "cosine_ramp", "start": 0.0, "end": 0.004, "value": 1.0}
drive = drive.replace(
    pulley=[drive.pulleys[0].replace(speed=speed), drive.pulleys[1]],
    simulation=drive.simulation.replace(duration=0.0016, start="equilibrium"),
)


def end(length):
    run = bd.simulate(drive, integrator=bd.extend.Stepwise(Sdirk2(), bd.extend.FixedSteps(length)))
    assert run.dataset.attrs["integrator"] == "sdirk2"
    return run.dataset.nodal_coordinates[-1].values - run.dataset.nodal_coordinates[0].values


lengths = np.array([8e-5, 4e-5, 2e-5])
exact = end(1e-5)
errors = [np.linalg.norm(end(length) - exact) for length in lengths]
order = np.polyfit(np.log(lengths), np.log(errors), 1)[0]
assert 1.7 < order < 2.6, order

controlled = bd.simulate(drive, integrator=bd.extend.Stepwise(Sdirk2(), bd.extend.ErrorControl(1e-4))).dataset
usual = bd.simulate(drive).dataset
difference = controlled.pulley_torque[-1, 0] - usual.pulley_torque[-1, 0]
assert abs(difference) < 0.01 * abs(usual.pulley_torque[-1, 0]), difference

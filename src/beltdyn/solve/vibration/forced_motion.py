"""Small motions of a drive in steady running under forces and motions that repeat themselves.

With x exp(i w t), the motions y of shafts of prescribed speed, and torques f,

    (K + i w C - w^2 M) x = f - (K' + i w C' - w^2 M') y,

where K', C', M' are the columns of these shafts in the same tangents.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.results import Run
from beltdyn.results.mid_span import mid_span_displacements
from beltdyn.solve.vibration.small_motions import about_steady, dry_tensioners
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe

if TYPE_CHECKING:
    from scipy.sparse import csc_array

_SMALL = 1e-6
"""Largest displacement of a node with which results are differenced, over the smallest radius."""
_OBSERVED = ("pulley_torque", "shaft_torque", "hub_force", "span_tension", "belt_speed")


class ForcedMotion:
    """A drive in steady running, which small motions of shafts and small torques on them excite.

    Parameters
    ----------
    run
        From `steady_state`.
    stuck
        Whether dry friction holds tensioners; else it is left out.
    """

    def __init__(self, run: Run, stuck: bool) -> None:
        self._motions = about_steady(run, all_shafts=True)
        held = self._motions.with_stuck(dry_tensioners(run.drive)) if stuck else self._motions
        self._bodies, self._tangents = held.bodies, (held.stiffness, held.damping, held.mass)
        shafts = np.asarray(self._motions.system.pulleys.shaft)
        self._shafts = self._bodies[shafts]
        driven = np.array([one.prescribed for one in run.drive.pulleys])
        self._driven = np.flatnonzero(driven)
        self._free = np.setdiff1d(np.arange(held.stiffness.shape[0]), self._shafts[driven])
        state = self._motions.state
        self._still = self._seen(state.position[None].copy(), state.velocity[None].copy())

    def answer(
        self, frequency: float, angles: Mapping[int, complex], torques: Mapping[int, complex]
    ) -> dict[str, ComplexArray]:
        """Amplitudes of results.

        Parameters
        ----------
        frequency
            Angular frequency w, rad/s.
        angles
            Number of a pulley of prescribed speed -> amplitude of the angle of its shaft, rad.
        torques
            Number of another pulley -> amplitude of a torque on its shaft, N m.

        Returns
        -------
        dict
            Of the names of results, complex amplitudes of exp(i w t), in the unit of the result.
        """
        from scipy.sparse.linalg import splu

        stiffness, damping, mass = self._tangents
        matrix: csc_array = (stiffness + 1j * frequency * damping - frequency**2 * mass).tocsr()
        moved, load = np.zeros((2, matrix.shape[0]), complex)
        for target, given in ((moved, angles), (load, torques)):
            for pulley, amplitude in given.items():
                target[self._shafts[pulley]] += amplitude
        rows = matrix[self._free]
        moved[self._free] = splu(rows[:, self._free].tocsc()).solve((load - matrix @ moved)[self._free])
        found = self._results(moved, frequency)
        for pulley, amplitude in torques.items():
            found["shaft_torque"][pulley] += amplitude
        found["shaft_torque"][self._driven] = (matrix @ moved)[self._shafts[self._driven]]
        return found

    def _results(self, moved: ComplexArray, frequency: float) -> dict[str, ComplexArray]:
        """Amplitudes of results from those of the unknowns: derivatives of what is observed, along both parts."""
        system = self._motions.system
        position = np.zeros(system.first_body + system.bodies.size, complex)
        position[: system.first_body] = moved[: system.first_body]
        position[system.first_body :] = np.where(self._bodies >= 0, moved[self._bodies], 0.0)
        velocity = 1j * frequency * position
        real = self._derivative(position.real, velocity.real)
        imaginary = self._derivative(position.imag, velocity.imag)
        found = {name: real[name] + 1j * imaginary[name] for name in real}
        ways = position[system.first_body :]
        speeds, pulleys = 1j * frequency * ways, system.pulleys.size
        direction = self._still["hub_force"][0]
        return found | {
            "hub_load": np.sum(found["hub_force"] * direction, axis=1) / np.linalg.norm(direction, axis=1),
            "pulley_speed": speeds[:pulleys],
            "shaft_speed": speeds[np.asarray(system.pulleys.shaft)],
            "tensioner_position": ways[ways.size - system.tensioners.size :],
        }

    def _derivative(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """Change of what is observed with a change of the state."""
        system, state = self._motions.system, self._motions.state
        largest = float(np.max(np.abs(position[: system.first_body]))) or 1.0
        step = _SMALL * float(np.min(system.rims.radius)) / largest
        steps = step * np.array([[1.0], [-1.0]])
        seen = self._seen(state.position + steps * position, state.velocity + steps * velocity)
        return {name: (values[0] - values[1]) / (2.0 * step) for name, values in seen.items()}

    def _seen(self, position: FloatArray, velocity: FloatArray) -> dict[str, FloatArray]:
        """What is observed at states, a row each."""
        seen: Observations = observe(self._motions.system, np.zeros(len(position)), position, velocity)
        aside = mid_span_displacements(
            self._motions.drive, seen.pulley_center, seen.contact_position, seen.contact_pulley
        )
        return {name: getattr(seen, name) for name in _OBSERVED} | {"mid_span_displacement": aside}

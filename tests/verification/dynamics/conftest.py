"""Small drives on which the verification tests run, and how to change them."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive, Pulley
from beltdyn.model.simulation import Instants
from beltdyn.solvers.alpha_advance import REACHED
from beltdyn.solvers.engine import advance, restart
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.integrator_state import Settings, empty_steps, new_state
from beltdyn.solvers.trajectory import Chunk, Statistics, Task
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import State, straight
from beltdyn.system.steady_assembly import new_equations

Change = Callable[..., Drive]


@pytest.fixture(scope="session")
def change() -> Change:
    """Make a drive from another one, with changed keys in its groups (None removes one) or with other pulleys."""

    def changed(drive: Drive, pulley: Any = None, **groups: Mapping[str, Any]) -> Drive:
        data = drive.model_dump(by_alias=True, exclude_none=True)
        for name, group in groups.items():
            data[name] = {key: value for key, value in (data[name] | dict(group)).items() if value is not None}
        return Drive(**data | ({"pulley": pulley} if pulley else {}))

    return changed


@pytest.fixture(scope="session")
def small(drive: Drive, change: Change) -> Drive:
    """A quick two-pulley drive of ten elements whose nodes fall on themselves when it is mirrored or renumbered.

    The belt of the paper, with the driver brought to speed in 20 ms against a light loaded pulley, over 30 ms.
    """
    radius = drive.pulleys[0].radius
    reach = 0.75 * np.pi * radius
    return change(
        drive,
        pulley=[
            {
                "name": "driver",
                "center": (-reach, 0.0),
                "radius": radius,
                "speed": {"kind": "cosine_ramp", "start": 0.0, "end": 0.02, "value": 12.0},
            },
            {
                "name": "driven",
                "center": (reach, 0.0),
                "radius": radius,
                "inertia": 1e-3,
                "torque": {"kind": "constant", "value": -0.5},
            },
        ],
        belt={"elements": 10},
        contact={"creep_rate_factor": 1e3},
        simulation={"duration": 0.03, "output_interval": 1e-3, "start": "equilibrium"},
    )


@pytest.fixture(scope="session")
def fixed_steps() -> Callable[[System, FloatArray, float, int, FloatArray], tuple[FloatArray, FloatArray]]:
    """Integrate from rest with equal steps: the error control allows anything, Newton's method 1e-13 m.

    Gives position and velocity at ends of steps, shape (k, 6 N + P).
    """

    def integrate(
        system: System, start: FloatArray, radius: float, steps: int, times: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        end, anything = float(times[-1]), 1e30
        step = end / steps
        settings = Settings(radius, anything, 1e-13 / (anything * step), step)
        integration = new_state(system, 0.0, step, start, np.zeros_like(start))
        equations = new_equations(system)
        taken = empty_steps(system, steps + 1)
        restart(system, integration, equations)
        status, count = advance(system, settings, integration, equations, end, 10 * steps, taken)
        assert status == REACHED
        assert abs(integration.counts.steps - steps) <= 1  # rounding of the clock
        assert integration.counts.rejected == 0
        wanted = [int(np.argmin(np.abs(taken.time[:count] - time))) for time in times]
        np.testing.assert_allclose(taken.time[wanted], times, rtol=1e-9)
        return taken.position[wanted], taken.velocity[wanted]

    return integrate


INERTIA, RADIUS, VELOCITY, RTOL = 0.4, 0.1, 10.0, 1e-3
"""Of a pulley far from the belt, and of its integration."""


class End(NamedTuple):
    """How a run ended."""

    speeds: Any
    angles: Any
    work: Any
    steps: int


@pytest.fixture(scope="session")
def follow(drive: Drive) -> Callable[..., End]:
    """Follow a far pulley for two seconds, or until another end, from given speeds of its bodies."""

    def run(speeds: tuple[float, ...] = (0.0,), integrator: Any = None, until: float = 2.0, **keys: Any) -> End:
        belt = Belt(**drive.belt.model_dump() | {"elements": 3})
        pulley = Pulley(**{"name": "far", "center": (0.0, 50.0), "radius": RADIUS, "inertia": INERTIA} | keys)
        system = belt_system(belt, [pulley], drive.contact)
        count, rest = len(speeds), straight(system)
        velocity = rest.velocity.copy()
        velocity[-count:] = speeds
        task = Task(
            system,
            State(rest.position, velocity, rest.acceleration),
            Instants(0.01, until),
            [t for profile in pulley.profiles for t in profile.breakpoints()],
            VELOCITY,
            Statistics(),
        )
        chunk = Chunk.join(list((integrator or GeneralizedAlpha(0.6, RTOL))(task)))
        return End(chunk.velocity[-1, -count:], chunk.position[-1, -count:], chunk.work[-1], task.statistics.steps)

    return run

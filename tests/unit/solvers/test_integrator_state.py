"""Steps see what is prescribed: they end at a pulse, and are as long as ever where nothing happens."""

import numpy as np
import pytest

from beltdyn.model import Constant, Drive, Profile, Pulley, Table
from beltdyn.solvers.integrator_state import StepBound
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import straight

PULSE = Table(times=(0.5, 0.5005, 0.501), values=(2.0, 102.0, 2.0))
"""A millisecond in which a speed of 2 rad/s is more by 50 rad/s in the mean: 0.05 rad."""


def driven(drive: Drive, speed: Profile) -> System:
    pulley = Pulley(name="far", center=(0.0, 50.0), radius=0.1, speed=speed)
    return belt_system(drive.belt.replace(elements=3), [pulley], drive.contact)


def reached(system: System, tolerance: float = 1e-3, before: float = 0.3, now: float = 0.4) -> float:
    """End of a step after one from `before` to `now`."""
    state, bound = straight(system), StepBound(system, tolerance)
    for time in (before, now):
        end = bound.end(time, state.position, state.velocity)
    return end


def test_steps_grow_tenfold_where_nothing_happens(drive: Drive) -> None:
    """From a tenth of a millisecond on."""
    system = driven(drive, Constant(value=2.0))
    state, bound = straight(system), StepBound(system, 1e-3)
    assert bound.end(0.0, state.position, state.velocity) == pytest.approx(1e-3, rel=1e-12)
    assert bound.end(1e-3, state.position, state.velocity) == pytest.approx(1e-3 + 1e-2, rel=1e-12)
    bound.restart()
    assert bound.end(0.5, state.position, state.velocity) == pytest.approx(0.5 + 1e-3, rel=1e-12)


def test_a_pulse_is_not_stepped_over(drive: Drive) -> None:
    assert reached(driven(drive, Constant(value=2.0))) == pytest.approx(1.4, rel=1e-12)
    assert 0.41 < reached(driven(drive, PULSE)) < 0.5005
    assert reached(driven(drive, PULSE), before=0.501, now=0.502) == pytest.approx(0.512, rel=1e-12)


def test_what_a_tolerance_allows_is_stepped_over(drive: Drive) -> None:
    """The stricter it is, the shorter the step; anything is allowed by one without bound."""
    ends = [reached(driven(drive, PULSE), tolerance) for tolerance in (np.inf, 1e-1, 1e-3, 1e-6)]
    assert ends[0] == pytest.approx(1.4, rel=1e-12)
    assert np.all(np.diff(ends) <= 0.0)
    assert ends[-1] < 0.5005

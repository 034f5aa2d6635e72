"""Decay of a small free vibration after a kick of 1 % of the load, against that of linearised motion.

The rate in the run differs by no more than what is told of the time integrator; with the advised step it agrees.
"""

import re

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.results.free_decay import free_decay, without_integrator

KICK, LOAD, INERTIA = 0.01, 10.0, 3e-3
LEFT = 0.02
"""Part of the rate by which a kick of 1 % decays otherwise than infinitesimal motion."""
LIMIT = 0.1
"""Relative error of a rate of decay from which on it is told."""


def kicked(speed: float, creep: float | None, **settings: float) -> bd.Drive:
    """A lightly damped drive in steady running whose load falls by 1 % for 5 ms."""
    times, factors = [0.0, 0.02, 0.0201, 0.025, 0.0251, 10.0], [1.0, 1.0, 1.0 - KICK, 1.0 - KICK, 1.0, 1.0]
    return bd.Drive(
        belt={
            "axial_stiffness": 5e4,
            "bending_stiffness": 5e-4,
            "mass_per_length": 0.1,
            "width": 0.012,
            "thickness": 0.004,
            "installed_tension": 300.0,
        },
        pulley=[
            {"name": "small", "center": [0.0, 0.0], "radius": 0.05, "speed": speed},
            {
                "name": "large",
                "center": [0.5, 0.0],
                "radius": 0.08,
                "inertia": INERTIA,
                "torque": {"kind": "table", "times": times, "values": [-LOAD * factor for factor in factors]},
            },
        ],
        contact={"friction": 1.0, "creep_ratio": creep},
        simulation={"duration": 0.4, "start": "steady", "output_interval": 5e-4, **settings},
    )


def rate_of_modes(drive: bd.Drive, frequency: float) -> float:
    """Rate of decay of the mode of a frequency (Hz), 1/s."""
    found = bd.modes(drive, count=12).dataset
    rotational = found.isel(mode=found.kind.values == "rotational")
    nearest = int(np.argmin(np.abs(rotational.frequency.values - frequency)))
    assert float(rotational.frequency[nearest]) == pytest.approx(frequency, rel=0.05)
    return float(2.0 * np.pi * rotational.frequency[nearest] * rotational.damping_ratio[nearest])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "creep", "radius", "is_told"),
    [(100.0, None, 0.6, False), (300.0, None, 0.6, False), (300.0, 1e-4, 0.6, False), (100.0, 1e-4, 0.3, True)],
)
def test_what_the_integrator_does_to_a_decay_is_told(
    speed: float, creep: float | None, radius: float, is_told: bool
) -> None:
    run = bd.simulate(kicked(speed, creep, spectral_radius=radius))
    time, steps = run.dataset.time.values, run.dataset.step_size.values
    late = time > 0.0255
    found = free_decay(time[late][:-1], run.dataset.span_tension.values[late, 0][:-1])
    assert found is not None
    step = float(np.mean(steps[late & (time <= found.until)] ** 3) ** (1.0 / 3.0))
    real = without_integrator(radius, found, step)
    exact, part = rate_of_modes(run.drive, real.frequency), abs(found.rate - real.rate)
    assert abs(found.rate - exact) < part + LEFT * exact
    told = [text for text in run.warnings if "the time integrator changes" in text]
    assert bool(told) == is_told == (part > LIMIT * found.rate)
    if told:
        assert float(re.search(r"off by up to ([\d.]+) 1/s", told[0])[1]) == pytest.approx(part, rel=0.05)  # type: ignore[index]
        shorter = float(re.search(r"max_step = ([\d.e-]+)", told[0])[1])  # type: ignore[index]
        again = bd.simulate(kicked(speed, creep, spectral_radius=radius, max_step=shorter))
        assert not [text for text in again.warnings if "the time integrator changes" in text]
        close = free_decay(time[late][:-1], again.dataset.span_tension.values[late, 0][:-1])
        assert close is not None
        assert close.rate == pytest.approx(exact, rel=0.05)

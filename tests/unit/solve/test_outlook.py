"""What bounds the steps of a run, from its counts."""

import pytest

from beltdyn.model.simulation import Simulation
from beltdyn.solve.outlook import step_bound
from beltdyn.solve.trajectory import Statistics


@pytest.mark.parametrize(
    ("settings", "steps", "rejected", "words"),
    [
        ({}, 1000, 400, "29% of the time steps are tried in vain"),
        ({"max_step": 1e-4}, 2000, 0, "simulation.max_step = 0.0001 s"),
        ({}, 100, 0, "output_interval than 0.001 s"),
        ({}, 100_000, 10, "simulation.rtol = 0.0001"),
        ({}, 0, 3, ""),
    ],
)
def test_what_bounds_steps(settings: dict[str, float], steps: int, rejected: int, words: str) -> None:
    simulation = Simulation(duration=1.0, output_interval=1e-3, **settings)
    said = step_bound(simulation, Statistics(steps=steps, rejected_steps=rejected), 0.1)
    assert words in said
    assert bool(said) == bool(words)

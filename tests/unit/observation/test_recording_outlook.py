"""What bounds the steps of a run, from its counts."""

import pytest

from beltdyn.model import Drive, prepare
from beltdyn.model.simulation import Simulation
from beltdyn.observation.recording import step_bound
from beltdyn.solvers.trajectory import Statistics


@pytest.mark.parametrize(
    ("settings", "steps", "rejected", "words"),
    [
        ({}, 1000, 400, "29% of the time steps are rejected"),
        ({"max_step": 1e-4}, 2000, 0, "simulation.max_step = 0.0001 s"),
        ({}, 100, 0, "output_interval above 0.001 s"),
        ({}, 100_000, 10, "simulation.rtol = 0.0001"),
        ({}, 0, 3, ""),
    ],
)
def test_what_bounds_steps(drive: Drive, settings: dict[str, float], steps: int, rejected: int, words: str) -> None:
    simulation = Simulation(duration=1.0, output_interval=1e-3, **settings)
    said = step_bound(
        prepare(drive.replace(simulation=simulation)), Statistics(steps=steps, rejected_steps=rejected), 0.1
    )
    assert words in said
    assert bool(said) == bool(words)


def test_remedies_are_those_of_the_drives_own_law(drive: Drive) -> None:
    often = Statistics(steps=1000, rejected_steps=400)
    own = step_bound(prepare(drive.replace(contact={"friction": 0.5})), often, 0.1)
    assert "increase contact.creep_ratio from " in own
    assert "creep_rate_factor" not in own
    given = {"friction": 0.5, "friction_law": "coefficient_slope", "creep_velocity": 1e-4}
    said = step_bound(prepare(drive.replace(contact=given)), often, 0.1)
    assert "omit contact.friction_law and contact.creep_velocity" in said

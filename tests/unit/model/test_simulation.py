"""Settings of a simulation: instants of outputs and of fields, and what is incompatible with together."""

from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Simulation


@pytest.mark.parametrize(
    ("settings", "stride"),
    [
        ({}, 10),  # a hundredth of a second
        ({"field_interval": 1e-3}, 1),
        ({"field_interval": 5e-3}, 5),
        ({"field_interval": 5.9e-3}, 5),  # at least as often as asked for
        ({"field_interval": 5.0}, 5000),
        ({"output_interval": 0.1}, 1),
    ],
)
def test_fields_are_recorded_at_least_as_often_as_asked_for(settings: dict[str, float], stride: int) -> None:
    instants = Simulation(**{"duration": 1.0, "output_interval": 1e-3} | settings).instants
    assert instants.stride == stride
    assert instants.end == 1.0


def test_a_run_that_begins_later_ends_as_much_later() -> None:
    settings = Simulation(duration=1.0, output_interval=0.01, start="steady", start_at=2.5)
    assert settings.end == 3.5
    assert settings.instants.count == 101
    assert settings.instants.stride == 1
    assert settings.instants[np.array([0, 1, 100])] == pytest.approx([2.5, 2.51, 3.5])


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"output_interval": 1.5}, "output_interval = 1.5 s is longer than duration = 1 s. Shorten the interval"),
        ({"field_interval": 9e-4}, "field_interval = 0.0009 s is shorter than output_interval = 0.001 s. Lengthen it"),
        ({"output_interval": 9e-7}, "requires 1.11e+06 outputs; the limit is 1,000,000. Lengthen the interval"),
        ({"output_interval": 1.0 + 1e-9}, "output_interval = 1.000000001 s is longer than duration = 1 s"),
        ({"max_step": 1e-15}, "max_step = 1e-15 s requires at least 1e+15 time steps; the limit is 1,000,000,000"),
        ({"rtol": 1.0}, "must be less than 1"),
        ({"spectral_radius": -0.1}, "must be at least 0"),
        ({"integrator": "euler"}, "is not a valid choice"),
        (
            {"start_at": 0.5},
            'start_at = 0.5 s is incompatible with start = "equilibrium", a belt at rest. Set start = "steady"',
        ),
        ({"start": "steady", "start_at": -0.5}, "must be at least 0"),
        (
            {"frame": "travelling", "force_tolerance": 0.01},
            'is incompatible with frame = "travelling", which is not refined',
        ),
        (
            {"frame": "staying", "mesh": "uniform", "force_tolerance": 0.01},
            'is incompatible with mesh = "uniform", which is not',
        ),
        ({"frame": "staying", "force_tolerance": 1.0}, "must be less than 1"),
        ({"frame": "staying", "start": "laid"}, 'start = "laid" is incompatible with frame = "staying". Set start'),
        ({"frame": "staying", "integrator": "bdf"}, 'integrator = "bdf" is incompatible with frame = "staying"'),
        ({"frame": "staying", "joint": "multipliers"}, 'joint = "multipliers" is incompatible with frame = "staying"'),
    ],
)
def test_what_does_not_fit_is_refused(settings: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        Simulation(**{"duration": 1.0, "output_interval": 1e-3} | settings)
    assert sentence in str(caught.value)


def test_limits_themselves_are_allowed() -> None:
    assert Simulation(duration=1.0, output_interval=1.0).instants.count == 2
    assert Simulation(duration=1.0, output_interval=1e-6).instants.count == 1_000_001
    assert Simulation(duration=1.0, output_interval=1e-3, field_interval=1e-3).instants.stride == 1
    for radius in (0.0, 1.0):
        assert Simulation(duration=1.0, output_interval=1.0, spectral_radius=radius).spectral_radius == radius


@pytest.mark.parametrize(("duration", "interval"), [(5.0, 1e-3), (0.02, 2e-4), (3000.0, 0.03)])
def test_outputs_are_chosen_where_none_are_asked_for(duration: float, interval: float) -> None:
    settings = Simulation(duration=duration)
    assert settings.output_interval == pytest.approx(interval)
    assert "output_interval" not in settings.arguments
    assert settings.replace(output_interval=0.5 * duration).output_interval == 0.5 * duration
    assert settings.replace(duration=1.0).output_interval == pytest.approx(1e-3)

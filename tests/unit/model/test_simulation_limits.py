"""Limits that a drive states: their units and what does not fit together."""

from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Limits, dumps, loads


def test_limits_have_units_and_survive_the_file(drive: Drive) -> None:
    limited = drive.with_({"limits.largest_hub_load": "0.8 kN", "limits.largest_slip": 0.01})
    assert limited.limits.largest_hub_load == 800.0
    assert loads(dumps(limited)) == limited


def test_a_drive_states_none_by_default(drive: Drive) -> None:
    assert drive.limits == Limits()
    assert "limits" not in drive.arguments or not drive.limits.arguments


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"largest_slip": 1.5}, "largest_slip = 1.5 must be less than 1"),
        ({"largest_hub_load": "3 m"}, 'must be in units of N, not "m"'),
        ({"least_slip_safety": 0.0}, "least_slip_safety = 0.0 must be greater than 0"),
        ({"hub_load": 3.0}, 'hub_load is not a known key. Did you mean "largest_hub_load"?'),
        ({"least_tension": 9.0, "largest_tension": 9.0}, "least_tension = 9 N must be below largest_tension = 9 N"),
    ],
)
def test_message(given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError, match=sentence.replace("?", r"\?")):
        Limits(**given)

"""The mesh of steady running in the drive file."""

from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Steady, dumps, loads


def test_it_survives_the_file(drive: Drive) -> None:
    assert drive.steady == Steady()
    rough = drive.with_({"steady.force_tolerance": 0.05})
    assert rough.steady.force_tolerance == 0.05
    assert loads(dumps(rough)) == rough


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"mesh": "fine"}, "mesh"),
        ({"force_tolerance": 1.5}, "force_tolerance = 1.5 must be less than 1"),
        ({"mesh": "uniform", "force_tolerance": 0.1}, 'force_tolerance = 0.1 is incompatible with mesh = "uniform"'),
    ],
)
def test_message(given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError, match=sentence):
        Steady(**given)

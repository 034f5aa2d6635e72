"""Why there is no steady running: what a pulley transmits at most is below what is asked for, and is told with it."""

import re
from importlib.resources import files
from typing import Any

import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, load
from beltdyn.points.traction import traction
from beltdyn.state import search
from beltdyn.state.staying import TOLERANCE
from beltdyn.state.steady import steady_state

NUMBERS = re.compile(r"slips on `(\w+)`, which transmits at most (\S+) N m of the (\S+) N m required")


FAN = {"kind": "fan", "rated_power": "3 kW", "rated_speed": "955 rpm"}


def drive(**driven: Any) -> Drive:
    """Two equal pulleys that transmit about 12 N m."""
    belt = {"profile": "PK", "ribs": 4, "installed_tension": 200.0}
    first = {"name": "motor", "center": (0.0, 0.0), "radius": 0.05, "speed": {"kind": "constant", "value": 100.0}}
    second = {"name": "driven", "center": (0.3, 0.0), "radius": 0.05, "inertia": 0.01} | driven
    return Drive(belt=belt, pulley=[first, second], simulation={"duration": 1.0, "output_interval": 1e-2})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("driven", "asked"),
    [
        ({"torque": {"kind": "constant", "value": -40.0}}, 40.0),
        ({"load": [{"kind": "resistance", "constant": 40.0}]}, 40.0),
        ({"load": [{"kind": "resistance", "constant": 30.0}, FAN]}, 60.0),
    ],
)
def test_what_is_transmitted_and_what_is_asked_for(driven: dict[str, Any], asked: float) -> None:
    """Asked for is the torque of the load, that of a fan at the speed which the pulley still has.

    The constant resistance alone is more than the belt transmits. A fan alone is not: sliding, it turns so slowly that
    it takes no more.
    """
    with pytest.raises(ConvergenceError) as caught:
        steady_state(drive(**driven))
    found = NUMBERS.search(str(caught.value))
    assert found, str(caught.value)
    most, wanted = map(float, found.groups()[1:])
    assert found[1] in ("motor", "driven")  # which transmit the same
    assert wanted == pytest.approx(asked, rel=0.02)
    limit = float(traction(drive(torque={"kind": "constant", "value": -1.0}), points=8).dataset.limit_torque)
    assert 0.9 * limit < most < 1.02 * limit


def test_solutions_on_the_way_are_exact_enough_for_what_is_transmitted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Newton's method has to know where there is no solution any more: as with the tolerance of the last one."""
    example = load(str(files("beltdyn") / "examples" / "alternator_drive.toml")).with_({"belt.friction": 0.05})

    def most() -> float:
        with pytest.raises(ConvergenceError) as caught:
            steady_state(example, at=0.5)
        found = NUMBERS.search(str(caught.value))
        assert found, str(caught.value)
        return float(found[2])

    told = most()
    monkeypatch.setattr(search, "_ON_THE_WAY", TOLERANCE)
    assert told == pytest.approx(most(), rel=5e-4)

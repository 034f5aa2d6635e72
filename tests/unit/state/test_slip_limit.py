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


ADVICE = re.compile(r"Raise the tension without loads from (\S+) N to at least (\S+) N")


@pytest.mark.parametrize(("friction", "speed", "torque"), [(0.3, 10.0, 40.0), (0.2, 400.0, 20.0)])
def test_the_least_tension_that_is_stated_is_the_one_with_which_a_drive_runs(
    friction: float, speed: float, torque: float
) -> None:
    """At low speed, and where inertia takes a part of the tension; there a belt that slips runs on, pressed by less."""
    slipping = drive(torque={"kind": "constant", "value": -torque}).with_(
        {"contact.friction": friction, "pulley[motor].speed.value": speed}
    )
    with pytest.raises(ConvergenceError) as caught:
        steady_state(slipping)
    advice = ADVICE.search(str(caught.value))
    assert advice, str(caught.value)
    before, least = map(float, advice.groups())
    assert before == pytest.approx(200.0, rel=0.02)
    assert not slips_grossly(slipping.with_({"belt.installed_tension": 1.03 * least}))
    assert slips_grossly(slipping.with_({"belt.installed_tension": 0.97 * least}))


def slips_grossly(slipping: Drive) -> bool:
    """Whether a drive is refused, or runs with gross slip."""
    try:
        return any("gross slip: the belt slides" in warning for warning in steady_state(slipping).warnings)
    except ConvergenceError:
        return True


def test_a_pulley_that_nearly_stands_still_is_refused() -> None:
    """At this tension the belt, which sheds its inertia as it slows down, would drive it at a fifth of its speed."""
    stalled = drive(torque={"kind": "constant", "value": -20.0}).with_(
        {"contact.friction": 0.2, "pulley[motor].speed.value": 400.0, "belt.installed_tension": 248.0}
    )
    with pytest.raises(ConvergenceError, match="slips on `"):
        steady_state(stalled)


def test_a_slack_span_is_named_where_more_friction_does_not_help() -> None:
    """With a factor of 2.6 in the grooves the slack span has 1/1000 of the tension of the other one."""
    slipping = drive(torque={"kind": "constant", "value": -160.0}).with_(
        {"contact.friction": 0.9, "pulley[motor].speed.value": 10.0}
    )
    with pytest.raises(ConvergenceError, match="as the span from `motor` to `driven` goes slack") as caught:
        steady_state(slipping)
    assert "more friction does not help" in str(caught.value)
    assert ADVICE.search(str(caught.value)), str(caught.value)

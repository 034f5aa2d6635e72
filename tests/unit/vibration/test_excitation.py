"""What excites a drive, and at which frequencies."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, load
from beltdyn.state.steady import steady_state
from beltdyn.vibration.excitation import given_excitations, one_line_each, own_excitations
from validation.published.cases import better, loaded_two_pulley

TASKS = Path(__file__).parents[3] / "docs" / "tasks"


@pytest.fixture(scope="module")
def loaded() -> Drive:
    """The paper's drive with waves in its speed, and in one of its loads; another one is shut off."""
    drive = better(loaded_two_pulley())
    driver, driven = drive.pulleys
    resistance: dict[str, Any] = {"kind": "resistance", "constant": "10 N m"}
    waves = [{"order": 3, "amplitude": 0.1}]
    off = {"kind": "constant", "value": 0.0}
    loads = [
        resistance | {"harmonics": waves},
        resistance | {"harmonics": [{"order": 7, "amplitude": 0.1}], "schedule": off},
    ]
    return drive.replace(
        pulley=[driver.replace(harmonics=[{"order": 2, "amplitude": 0.02}]), driven.replace(load=loads)]
    )


def test_harmonics_turns_and_belt(loaded: Drive) -> None:
    found = own_excitations(loaded)
    assert [one.name for one in found] == [
        "speed of driver, order 2",
        "load of driven, order 3",
        "turn of driver",
        "turn of driven",
        "turn of the belt",
    ]
    run = steady_state(loaded)
    turns = run.dataset.pulley_speed.values[-1] / (2.0 * np.pi)
    belt = abs(float(run.dataset.belt_speed[-1].mean())) / loaded.path.length
    frequencies = [one.frequency(run) for one in found]
    np.testing.assert_allclose(frequencies[:4], [2.0 * turns[0], 3.0 * turns[1], *turns], rtol=1e-12)
    assert frequencies[4] == pytest.approx(belt, rel=0.01)


def test_the_web_of_a_line_does_not_turn() -> None:
    """It passes once: flaws of the web come back with no turn of it."""
    line = load(TASKS / "coater.toml")
    assert [one.name for one in own_excitations(line)] == [f"turn of {one.name}" for one in line.pulleys]


def test_guides_that_stand_still_have_no_turn() -> None:
    found = own_excitations(load(TASKS / "handrail.toml"))
    assert [one.name for one in found] == ["turn of drive", "turn of roller", "turn of the belt"]


def test_what_differs_by_less_than_a_per_cent_is_one_line(loaded: Drive) -> None:
    found = own_excitations(loaded)[2:]
    names, lines = one_line_each(found, np.array([[10.0, 9.95, 3.0], [np.nan] * 3, [20.0, 19.9, 6.0]]))
    assert names == ["turn of driver; turn of driven", "turn of the belt"]
    np.testing.assert_array_equal(lines, [[10.0, 3.0], [np.nan, np.nan], [20.0, 6.0]])
    assert len(one_line_each(found, np.array([[10.0, 9.8, 3.0]]))[0]) == 3


def test_orders_by_hand(loaded: Drive) -> None:
    found = given_excitations("2, 0.5", loaded, 1)
    assert [(one.name, one.order, one.pulley) for one in found] == [
        ("order 0.5 of driven", 0.5, 1),
        ("order 2 of driven", 2.0, 1),
    ]


@pytest.mark.parametrize("text", ["", "two", "0, 1", "-1", "1..6", "2 Hz"])
def test_orders_that_are_none(loaded: Drive, text: str) -> None:
    with pytest.raises(ModelError, match=f"orders = '{text}'|orders = '2'"):
        given_excitations(text, loaded, 0)

"""What is said of limits and differences."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.results import KeyNumber, Run
from beltdyn.show.report.report import SideBySide, in_unit, limit_in_words, verdict


def number(value: float, limit: float | None = None) -> KeyNumber:
    return KeyNumber("largest_hub_load", value, "N", "driver", limit)


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ({}, ("open", "No limits are given")),
        ({"largest_hub_load": 1e4}, ("pass", "The limit is met")),
        (
            {"largest_hub_load": 1e4, "least_slip_safety": 99.0},
            ("fail", "1 of 2 limits are met: least slip safety 3.661 (limit 99)"),
        ),
    ],
)
def test_the_verdict(run: Run, limits: dict[str, float], said: tuple[str, str]) -> None:
    assert verdict([Run(run.dataset, run.drive.replace(limits=limits))]) == said


KEPT = {"largest_hub_load": 1e4, "largest_tension": 1e4}


def test_gross_slip_and_slack_at_any_time_fail(make_run: Callable[..., Run]) -> None:
    sliding, tension = np.zeros((101, 2)), np.full((101, 2), 40.0)
    sliding[10:20, 1], tension[5, 0] = 0.5, -1.0
    for changed, words in (
        ({"sliding_speed": sliding}, "All 2 limits are met, but the belt was in gross slip on driven from"),
        ({"span_tension": tension}, "All 2 limits are met, but driver-driven went slack at"),
    ):
        run = make_run(**changed)
        kind, said = verdict([Run(run.dataset, run.drive.replace(limits=KEPT))])
        assert kind == "fail"
        assert said.startswith(words)
        assert verdict([run])[1].startswith("No limits are given; ")


def test_a_stop_qualifies(make_run: Callable[..., Run], drive: Drive) -> None:
    slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    stopped = {**slide, "stops": [-0.01, 0.01], "stop_stiffness": 1e5}
    dataset = make_run().dataset.assign(tensioner_position=(("time", "tensioner"), np.full((101, 1), 0.02)))
    kind, said = verdict([Run(dataset, drive.replace(limits=KEPT, tensioner=[stopped]))])
    assert kind == "open"
    assert "but the tensioner of driven was on its upper stop from" in said


@pytest.mark.parametrize(
    ("first", "other", "words"),
    [
        (100.0, 110.0, "+10.0% relative to the first"),
        (0.0, 2.0, "+2 N relative to the first"),
        (0.0, 0.0, ""),
        (float("nan"), 1.0, ""),
    ],
)
def test_differences(first: float, other: float, words: str) -> None:
    assert SideBySide("", "", [number(first), number(other)]).difference(1) == words


def test_a_result_that_does_not_know_a_number_does_not_differ() -> None:
    assert SideBySide("", "", [number(1.0), None]).difference(1) == ""


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [(0.0123, "%", "1.23 %"), (1234.56, "N", "1235 N"), (1.5, "1", "1.5"), (float("nan"), "N", "–")],
)
def test_numbers_have_units(value: float, unit: str, words: str) -> None:
    assert in_unit(value, unit) == words


def test_limits_in_words() -> None:
    assert limit_in_words(number(1.0, 5.0)) == "at most 5 N"
    assert limit_in_words(number(1.0)) == limit_in_words(None) == "–"

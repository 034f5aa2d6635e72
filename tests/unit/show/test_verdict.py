"""What is said of limits and differences."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from beltdyn import equilibrium
from beltdyn.model import Drive
from beltdyn.model.drive import drive_of_text
from beltdyn.results import KeyNumber, Run
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import as_text
from beltdyn.show.verdict import SideBySide, in_unit, limit_in_words, unjudged_in_words, value_in_words, verdict


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


def test_limits_that_a_result_does_not_judge_are_said(run: Run, drive: Drive) -> None:
    """Of each kind of result: judged, or not judged with the command that does; several results judge together."""
    limits = {"largest_hub_load": 1e4, "least_cord_life": "100 h", "largest_utilization": 0.5}
    limited = Run(run.dataset, run.drive.replace(limits=limits))
    kind, said = verdict([limited])
    assert kind == "open"
    assert said == (
        "The limit is met, but largest utilization is not judged here and least cord life is not judged here"
    )
    assert [words.partition(":")[0] for words in unjudged_in_words([limited])] == [
        "largest utilization",
        "least cord life",
    ]
    text = as_text(sheet(limited))
    assert "at most 1e+04 N" in text or "at most 10000 N" in text
    assert "not judged here, but by `beltdyn life`" in text
    result = equilibrium(drive.replace(limits={"least_slip_safety": 2.0}))
    assert verdict([result]) == ("open", "Least slip safety is not judged here")
    assert "Limits" not in as_text(sheet(run))


def test_a_file_of_a_result_is_judged_as_the_result(make_run: Callable[..., Run]) -> None:
    """It holds what profile the belt is, and so its rating."""
    rated = make_run().drive.with_({"belt.profile": "PJ", "belt.ribs": 3, "belt.installed_tension": 60.0})
    limited = rated.replace(limits={"largest_utilization": 0.5})
    again = drive_of_text(Drive.model_validate(limited.data).text)
    run = make_run()
    assert again == limited
    assert verdict([Run(run.dataset, again)]) == verdict([Run(run.dataset, limited)])
    assert again.with_({"belt.ribs": 6}).belt.axial_stiffness == 2.0 * limited.belt.axial_stiffness


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
    [
        (0.0123, "%", "1.23 %"),
        (1234.56, "N", "1235 N"),
        (1.5, "1", "1.5"),
        (float("nan"), "N", "–"),
        (float("inf"), "%", "∞ %"),
    ],
)
def test_numbers_have_units(value: float, unit: str, words: str) -> None:
    assert in_unit(value, unit) == words


def test_a_belt_outside_its_rating_is_said_to_be() -> None:
    outside = KeyNumber("largest_utilization", np.inf, "%", "motor", 1.0)
    assert value_in_words(outside) == "outside the rating"
    assert value_in_words(replace(outside, value=1.2)) == "120 %"
    assert not outside.passes


def test_limits_in_words() -> None:
    assert limit_in_words(number(1.0, 5.0)) == "at most 5 N"
    assert limit_in_words(number(1.0)) == limit_in_words(None) == "–"

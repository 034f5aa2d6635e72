"""The examples, run in full: the numbers of their pages agree with hand calculations, and the energy account closes."""

import importlib.util
from collections.abc import Callable
from importlib.resources import files
from math import pi
from pathlib import Path
from types import ModuleType

import pytest

from beltdyn import Run, loads, simulate
from beltdyn.results import Summary, summarize

FILE = Path(__file__).parents[2] / "docs" / "example_numbers.py"
CLOSURE = 5e-3
"""Of the energy put in; the default tolerance of a step is 1e-3."""


def _numbers() -> ModuleType:
    """The numbers of the pages, which are no part of the package."""
    spec = importlib.util.spec_from_file_location("example_numbers", FILE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


PAGES = _numbers()
NAMES = list(PAGES.NUMBERS)
WARNINGS = {
    "two_pulley": ["the mesh does not resolve the contact forces along driver and driven"],
    "slip_through": [
        *("driver slides through", "conveyor slides through"),
        *("driver reached gross slip between t = 1.", "conveyor reached gross slip between t = 1."),
    ],
}
"""How the warnings of a run begin; an example that is not named here has none."""

RunExample = Callable[[str], Run]


@pytest.fixture(scope="module")
def run_example() -> RunExample:
    runs = dict[str, Run]()

    def run(name: str) -> Run:
        if name not in runs:
            text = files("beltdyn").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8")
            runs[name] = simulate(loads(text))
        return runs[name]

    return run


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_numbers_of_the_page(name: str, run_example: RunExample) -> None:
    """The tolerances stand beside the numbers."""
    numbers = list(PAGES.NUMBERS[name](run_example(name)))
    assert [number for number in numbers if not abs(number.found - number.hand) <= number.tolerance] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_energy_is_accounted_for(name: str, run_example: RunExample) -> None:
    summary = summarize(run_example(name))
    assert summary.status == "completed"
    assert abs(summary.energy_closure) < CLOSURE


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_warnings_of_the_run(name: str, run_example: RunExample) -> None:
    expected = WARNINGS.get(name, [])
    found = summarize(run_example(name)).warnings
    assert [text[: len(start)] for text, start in zip(found, expected, strict=True)] == expected


@pytest.mark.slow
def test_the_overloaded_conveyor_comes_to_a_stop(run_example: RunExample) -> None:
    run = run_example("slip_through")
    speed = run.dataset["pulley_speed"].sel(pulley="conveyor")
    driver = run.dataset["pulley_speed"].sel(pulley="driver")
    assert float(speed.sel(time=1.25, method="nearest") / driver.sel(time=1.25, method="nearest")) > 0.98
    assert abs(float(speed[-1])) < 1.0
    assert float(driver[-1]) == pytest.approx(24.0 * pi, rel=1e-6)


@pytest.mark.slow
def test_the_idler_carries_what_slips_without_it(run_example: RunExample) -> None:
    """The load of 160 N m is above what fixed centres transmit, and with the idler even twice as much is below."""
    run = run_example("flat_belt_idler")
    bare = summarize(simulate(PAGES.without_idler(run.drive)))
    assert any(text.startswith("motor slides through") for text in bare.warnings)
    assert bare.pulleys[0].margin == pytest.approx(1.0, abs=0.02)
    assert bare.pulleys[1].slip > 0.1
    twice = summarize(simulate(PAGES.with_load(run.drive, 320.0)))
    assert not any("slides through" in text for text in twice.warnings)
    assert twice.pulleys[2].slip < 0.03


@pytest.mark.slow
def test_a_crossed_belt_turns_the_lathe_the_other_way(run_example: RunExample) -> None:
    summary: Summary = summarize(run_example("crossed_belt"))
    shaft, lathe = summary.pulleys
    assert shaft.speed > 0.0 > lathe.speed
    assert shaft.power > 0.0 > lathe.power

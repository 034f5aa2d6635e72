"""The examples in docstrings do what they say.

They may use `bd`, the package, and `drive` and `run`: the example `two_pulley` over 10 ms.
"""

import doctest
import importlib
import pkgutil
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import beltdyn as bd

_MODULES = [found.name for found in pkgutil.walk_packages(bd.__path__, "beltdyn.") if ".cli" not in found.name]
_FINDER = doctest.DocTestFinder(exclude_empty=True)
EXAMPLES = [
    example
    for name in _MODULES
    for example in _FINDER.find(importlib.import_module(name), module=None)
    if example.examples and example.name.startswith(name)
]


@pytest.fixture(scope="module")
def run() -> bd.Run:
    drive = bd.example("two_pulley")
    return bd.simulate(drive.replace(simulation=drive.simulation.replace(duration=0.01)))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name.removeprefix("beltdyn."))
def test_example(example: doctest.DocTest, run: bd.Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    example.globs = {"bd": bd, "drive": bd.example("two_pulley"), "run": run}
    failed, tried = doctest.DocTestRunner(verbose=False).run(example)
    plt.close("all")
    assert tried > 0
    assert failed == 0


WITHOUT = {
    "AngleSpeedTable",
    "BatchProgress",
    "Ending",
    "Equilibrium",
    "InteractiveFigures",
    "MovingTensioner",
    "Profile",
    "Progress",
    "Rest",
    "StepError",
    "Stepwise",
    "find_equilibrium",
    "plot.animate",
    "plot.animate_modes",
    "plot.campbell",
    "plot.mode_damping",
    "plot.orders",
    "plot.waterfall",
    "simulate_all",
}
"""Public names whose docstrings have no example yet: some records, and what takes long (movies, run-ups, processes)."""


def test_public_names_have_examples() -> None:
    """A new name brings one; whoever writes one of those that lack takes the name off the list."""
    public = {"": bd, "derived.": bd.derived, "plot.": bd.plot}
    lacking = {
        f"{prefix}{name}"
        for prefix, package in public.items()
        for name in (package.__all__ if prefix else dir(bd))
        if callable(one := getattr(package, name)) and ">>>" not in (one.__doc__ or "")
    }
    assert lacking == WITHOUT

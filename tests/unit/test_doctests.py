"""The examples in docstrings do what they say.

They may use `bd`, the package, and `drive` and `run`: the drive of `beltdyn demo` over 10 ms.
"""

import doctest
import importlib
import pkgutil
from pathlib import Path

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
    drive = bd.loads(bd.published.demo_text())
    return bd.simulate(drive.replace(simulation=drive.simulation.replace(duration=0.01)))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name.removeprefix("beltdyn."))
def test_example(example: doctest.DocTest, run: bd.Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    example.globs = {"bd": bd, "drive": bd.loads(bd.published.demo_text()), "run": run}
    failed, tried = doctest.DocTestRunner(verbose=False).run(example)
    assert tried > 0
    assert failed == 0


WITHOUT = {
    "AngleSpeedTable",
    "BatchProgress",
    "BeltdynError",
    "Compared",
    "ConvergenceError",
    "Ending",
    "Equilibrium",
    "Finding",
    "InteractiveFigures",
    "MovingTensioner",
    "Profile",
    "Progress",
    "Resolution",
    "Rest",
    "StaticResult",
    "StepError",
    "Stepwise",
    "TensionerBalance",
    "TensionerSummary",
    "build_result",
    "derived.orders",
    "find_equilibrium",
    "plot.animate",
    "plot.animate_modes",
    "plot.campbell",
    "plot.efficiency_map",
    "plot.mode_damping",
    "plot.mode_shape",
    "plot.operating_points",
    "plot.optimization",
    "plot.orders",
    "plot.parallel_coordinates",
    "plot.response",
    "plot.save_all",
    "plot.save_layout",
    "plot.save_stretch",
    "plot.sensitivity",
    "plot.sobol_indices",
    "plot.stretch",
    "plot.study_contour",
    "plot.study_lines",
    "plot.tension_spectrum",
    "plot.tensioner_sheet",
    "plot.tensioners",
    "plot.tolerances",
    "plot.tornado",
    "plot.traction_curve",
    "plot.waterfall",
    "plot.wear_by_arc",
    "plot.wear_by_belt",
    "power_balance",
    "simulate_all",
}
"""Public names whose docstrings have no example yet: records that analyses give, figures, and studies."""


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

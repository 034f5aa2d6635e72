"""The examples in docstrings do what they say.

They may use `bd`, the package, and `drive` and `run`: the example `two_pulley` over 10 ms.
"""

import doctest
import importlib
import pkgutil
import re
from operator import attrgetter
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
COSTLY = (
    *("transmission_error", "stroke", "carriage_error", "plot.squeal.squeal"),
    *("calibrate.calibrate", "write_report", "line_tensions", "sheet_tensions", "sheet_slip_safety"),
)
"""Examples of toothed belts, for which kernels are compiled, and of analyses that have quick tests of their own."""


@pytest.fixture(scope="module")
def run() -> bd.Run:
    drive = bd.example("two_pulley")
    return bd.simulate(drive.replace(simulation=drive.simulation.replace(duration=0.01)))


@pytest.mark.parametrize(
    "example",
    [pytest.param(one, marks=[pytest.mark.slow] * one.name.endswith(COSTLY)) for one in EXAMPLES],
    ids=lambda example: example.name.removeprefix("beltdyn."),
)
def test_example(example: doctest.DocTest, run: bd.Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    example.globs = {"bd": bd, "drive": bd.example("two_pulley"), "run": run}
    failed, tried = doctest.DocTestRunner(verbose=False).run(example)
    plt.close("all")
    assert tried > 0
    assert failed == 0


WITHOUT = {
    "extend.Analysis",
    "extend.BatchProgress",
    "extend.Center",
    "extend.Direction",
    "extend.ElementKind",
    "extend.FrictionLaw",
    "extend.Gap",
    "extend.HubLink",
    "extend.IntegratorKind",
    "extend.LinkTorque",
    "extend.Load",
    "extend.LoadTorque",
    "extend.MovingTensioner",
    "extend.NormalForce",
    "extend.NormalLaw",
    "extend.Parameter",
    "extend.Profile",
    "extend.Progress",
    "extend.SensorSlope",
    "extend.ShaftState",
    "extend.SpringTensioner",
    "extend.StateRate",
    "extend.StepError",
    "extend.Stepwise",
    "extend.StretchLaw",
    "extend.Stretching",
    "extend.SurfaceKind",
    "extend.TensionerForce",
    "extend.figure",
    "extend.kernel",
    "extend.nearer_kink",
    "extend.quantity",
    "extend.record",
    "extend.records",
    "extend.register",
    "extend.spring_force",
    "model.MovingTensioner",
    "model.Profile",
    "model.alignment",
    "plot.always",
    "plot.animate",
    "plot.animate_modes",
    "plot.axes_or_new",
    "plot.campbell",
    "plot.color",
    "plot.dash",
    "plot.figure",
    "plot.label",
    "plot.mode_damping",
    "plot.name_lines",
    "plot.orders",
    "plot.over_time",
    "plot.waterfall",
    "simulate_all",
}
"""Public names whose docstrings have no example yet: some records, and what takes long (movies, run-ups, processes)."""
OF_THE_PACKAGE = {"model", "results"}
"""Submodules that also lend names to the package itself, which its reference page leaves out."""


def test_public_names_have_examples() -> None:
    """A new name brings one; whoever writes one of those that lack takes the name off the list."""
    reference = (Path(__file__).parents[2] / "docs" / "reference.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"^    (\w+)$", reference, flags=re.MULTILINE))
    public = {"": dir(bd)} | {
        f"{one}.": getattr(bd, one).__all__ for one in ("derived", "plot", "model", "results", "extend")
    }
    lacking = {
        f"{prefix}{name}"
        for prefix, names in public.items()
        for name in names
        if prefix[:-1] not in OF_THE_PACKAGE or (name in listed and name not in dir(bd))
        if callable(one := attrgetter(f"{prefix}{name}")(bd)) and ">>>" not in (one.__doc__ or "")
    }
    assert lacking == WITHOUT

"""Runs on a mesh that travels with the belt, made fine, against those on the mesh that stays: the same physics.

The meshes, the elements and their equations of motion have nothing in common but the law of contact and the integrator.
"""

from collections.abc import Callable
from importlib.resources import files

import numpy as np
import pytest

from beltdyn import Drive, Run, load, loads, simulate
from beltdyn.results import summarize
from validation.published import cases

pytestmark = pytest.mark.slow

SPEED, FORCE = 1e-3, 1e-2
"""What the histories may differ by (root mean square), over the largest speed and tension at the end."""
CASES: dict[str, Callable[[], Drive]] = {
    "case_1": lambda: loads(cases.demo_text()),
    "case_2": lambda: cases.loaded_two_pulley(creep_rate_factor=1e4),
}
EXAMPLES = ["alternator_drive", "flat_belt_idler", "tensioner_stop"]


def in_both(drive: Drive, elements: int | None) -> tuple[Run, Run]:
    """A drive from rest on a travelling mesh of a number of elements, or the default one, and on one that stays."""
    settings = drive.simulation.replace(start="equilibrium", rtol=1e-4, field_interval=None)
    travelling = drive.replace(
        belt=drive.belt.replace(elements=elements), simulation=settings.replace(frame="travelling")
    )
    staying = drive.replace(belt=drive.belt.replace(elements=None), simulation=settings.replace(frame="staying"))
    return simulate(travelling), simulate(staying)


def differences(travelling: Run, staying: Run, names: tuple[str, ...]) -> dict[str, float]:
    """Root mean squares of differences over the whole run, over the largest value at its end."""
    found = {}
    for name in names:
        one, other = travelling.dataset[name].values, staying.dataset[name].values
        found[name] = float(np.sqrt(np.mean((one - other) ** 2)) / np.abs(other[-len(other) // 5 :]).max())
    return found


@pytest.mark.parametrize("name", CASES)
def test_published_cases(name: str, measured: Callable[..., None]) -> None:
    """Histories from rest to full speed, with 120 elements that travel."""
    found = differences(*in_both(CASES[name](), 120), ("pulley_speed", "span_tension", "hub_force"))
    measured(**found)
    assert found.pop("pulley_speed") < SPEED
    assert max(found.values()) < FORCE


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples(name: str, measured: Callable[..., None]) -> None:
    """What a summary says at the end: speeds, tensions, hub loads and efficiency."""
    drive = load(str(files("beltdyn").joinpath("examples", f"{name}.toml")))
    one, other = (summarize(run) for run in in_both(drive, None))
    speeds = [abs(a.speed / b.speed - 1.0) for a, b in zip(one.pulleys, other.pulleys, strict=True)]
    hubs = [abs(a.hub_load / b.hub_load - 1.0) for a, b in zip(one.pulleys, other.pulleys, strict=True)]
    spans = [abs(a.tension / b.tension - 1.0) for a, b in zip(one.spans, other.spans, strict=True)]
    efficiency = abs(one.balance.efficiency - other.balance.efficiency)
    measured(speed=max(speeds), hub_load=max(hubs), tension=max(spans), efficiency=efficiency)
    assert max(speeds) < SPEED
    assert max(*spans, *hubs) < FORCE
    assert efficiency < FORCE

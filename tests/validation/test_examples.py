"""The examples, run in full: the numbers of their pages agree with hand calculations, and the energy account closes."""

from collections.abc import Callable
from importlib.resources import files
from math import pi

import pytest
from example_numbers import creep, under_load, with_load, without_idler
from make_examples import EXAMPLES, simulated

import beltdyn as bd
from beltdyn import simulate
from beltdyn.results import summarize
from beltdyn.results.derived import slip_safety

CLOSURE = 5e-3
"""Of the energy put in, at any time."""
NAMES = list(EXAMPLES)
WARNINGS = {
    "two_pulley": ["the belt has too few elements for peak pressure"],
    "tensioner_stop": ["the tensioner of tensioner was on its upper stop between t = 0.46"],
    "slip_through": [
        "gross slip: the belt slides on the whole arc of driver and conveyor",
        "the belt was in gross slip on driver from t = 1.",
    ],
}
"""How the warnings of a run begin; an example that is not named here has none."""


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_numbers_of_the_page(name: str) -> None:
    """The tolerances stand beside the numbers."""
    numbers = list(EXAMPLES[name].numbers(simulated(name)))
    assert [number for number in numbers if not abs(number.found - number.hand) <= number.tolerance] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_energy_is_accounted_for(name: str, measured: Callable[..., None]) -> None:
    summary = summarize(simulated(name))
    measured(closure=summary.energy_closure)
    assert summary.status == "completed"
    assert abs(summary.energy_closure) < CLOSURE


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_warnings_of_the_run(name: str) -> None:
    expected = WARNINGS.get(name, [])
    found = summarize(simulated(name)).warnings
    assert [text[: len(start)] for text, start in zip(found, expected, strict=True)] == expected


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if name != "two_pulley"])
def test_friction_loses_power_on_every_pulley(name: str) -> None:
    """At any time, since `moment_arm = "rim"`; the paper's drive keeps to the published arm."""
    run = simulated(name)
    assert run.drive.contact.moment_arm == "rim"
    assert float(run.dataset["friction_power"].min()) >= 0.0


@pytest.mark.slow
def test_the_overloaded_conveyor_comes_to_a_stop() -> None:
    run = simulated("slip_through")
    speed = run.dataset["pulley_speed"].sel(pulley="conveyor")
    driver = run.dataset["pulley_speed"].sel(pulley="driver")
    assert float(speed.sel(time=1.25, method="nearest") / driver.sel(time=1.25, method="nearest")) > 0.98
    assert abs(float(speed[-1])) < 1.0
    assert float(driver[-1]) == pytest.approx(24.0 * pi, rel=1e-6)


@pytest.mark.slow
def test_the_idler_carries_what_slips_without_it() -> None:
    """The load of 160 N m is above what fixed centers transmit, and with the idler half as much again is below.

    While it slides the belt follows Euler and Eytelwein's formula with the angle between its spans, within 0.5 %: what
    bending takes from the arc presses on its ends.
    """
    run = simulated("flat_belt_idler")
    slipping = simulate(without_idler(run.drive))
    bare = summarize(slipping)
    assert any("the belt slides on the whole arc" in text for text in bare.warnings)
    assert bare.pulleys[1].slip > 0.1
    assert slip_safety(slipping, 1.1, 1.6)[:, 0].values == pytest.approx(1.0, abs=0.005)
    more = summarize(simulate(with_load(run.drive, 240.0)))
    assert not any("the belt slides on the whole arc" in text for text in more.warnings)
    assert more.pulleys[2].slip < 0.03


@pytest.mark.slow
def test_a_crossed_belt_turns_the_lathe_the_other_way() -> None:
    summary = summarize(simulated("crossed_belt"))
    shaft, lathe = summary.pulleys
    assert shaft.speed > 0.0 > lathe.speed
    assert shaft.power > 0.0 > lathe.power


@pytest.mark.slow
def test_slip_on_a_small_pulley() -> None:
    """Slip under load is that of creep on the mesh that is chosen, of which bending takes 0.25 % from the radii.

    On a mesh that travels, of 100 elements of which each covers 63 degrees of the motor pulley, slip is less than the
    belt stretches by, and the run says so; with as many as the remedy names it is right.
    """
    machine = bd.load(str(files("beltdyn").joinpath("examples", "washing_machine.toml")))
    right = simulate(under_load(machine, None))
    assert summarize(right).pulleys[1].slip == pytest.approx(creep(right), rel=0.03)
    assert right.drive.rolling_radii[0] == pytest.approx(1.0025 * right.drive.radii[0], rel=1e-4)
    travelling = machine.with_({"simulation.frame": "travelling", "contact.allowed_penetration": 50e-6})
    coarse = simulate(under_load(travelling, 100))
    (finding,) = (one for one in coarse.findings if "physically impossible" in one.fault)
    assert finding.remedy.startswith("The mesh is too coarse: set belt.elements = 200 ")
    fine = simulate(under_load(travelling, 200))
    assert [one for one in fine.findings if "physically impossible" in one.fault] == []
    assert summarize(fine).pulleys[1].slip == pytest.approx(creep(fine), rel=0.03)

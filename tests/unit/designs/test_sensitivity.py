"""Sensitivities against closed forms, against running states further away, and by what changes nothing."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.designs.designs import SmallChanges
from beltdyn.designs.found_state import Running
from beltdyn.designs.sensitivity import chosen_numbers, numbers_of, sensitivity
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, load, loads, prepare
from beltdyn.parts.change import value_at
from beltdyn.results import Result, summarize
from beltdyn.state.equilibrium import equilibrium
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import steady_state
from beltdyn.transient.sweep import without_schedules
from validation.published.cases import better, loaded_two_pulley

TENSION = 600.0
SPANS = "driver-driven", "driven-driver"


@pytest.fixture(scope="module")
def loaded() -> Drive:
    """With an installed tension, so that the belt's length is found."""
    drive = better(loaded_two_pulley())
    belt = drive.belt.replace(length=None, installed_tension=TENSION)
    return drive.replace(belt=belt)


@pytest.fixture(scope="module")
def found(loaded: Drive) -> Result:
    return sensitivity(loaded, of="all")


def derivative(found: Result, result: str, number: str) -> float:
    return float(found.dataset.derivative.sel(result=result, number=number))


def test_tensions_differ_by_torque_over_radius(found: Result, loaded: Drive) -> None:
    """The torque of the load acts against the turning; within what bending moments take at a thick belt's arc ends."""
    slack, tight = (derivative(found, f"span_tension[{span}]", "pulley[driven].torque.value") for span in SPANS)
    assert (slack - tight) * loaded.radii[1] == pytest.approx(1.0, rel=0.01)
    assert derivative(found, "shaft_torque[driven]", "pulley[driven].torque.value") == pytest.approx(1.0, rel=1e-6)


def test_creep_goes_with_the_inverse_of_the_stiffness(found: Result) -> None:
    """Elastic creep is the difference of the tensions over EA, within the strain of 6 %."""
    effect, value = (found.dataset[name].sel(result="elastic_creep[driven]") for name in ("effect", "value"))
    assert float(effect.sel(number="belt.youngs_modulus") / value) == pytest.approx(-0.01, rel=TENSION / 1e4)


def test_the_length_follows_so_that_the_installed_tension_is_kept(found: Result) -> None:
    """A belt of the same length would change its tension by as much as its stiffness."""
    for span in SPANS:
        effect = found.dataset.effect.sel(result=f"span_tension[{span}]", number="belt.youngs_modulus")
        assert abs(float(effect)) < 1e-3 * TENSION


@pytest.mark.parametrize("axis", [1, 2])
def test_a_drive_that_is_moved_as_a_whole_stays_as_it_is(found: Result, axis: int) -> None:
    """The centers' derivatives cancel each other."""
    parts = [found.dataset.derivative.sel(number=f"pulley[{name}].center[{axis}]") for name in ("driver", "driven")]
    for name in (*(f"span_tension[{span}]" for span in SPANS), "hub_load[driver]", "pulley_slip[driven]"):
        one, other = (float(part.sel(result=name)) for part in parts)
        assert one == pytest.approx(-other, rel=1e-4, abs=1e-3)


@pytest.mark.parametrize("path", ["belt.youngs_modulus", "contact.friction", "pulley[driven].torque.value"])
def test_against_differences_over_larger_steps(path: str) -> None:
    """By Richardson's extrapolation from 0.2 and 0.1 per cent, to 1e-5 of the derivative, or of result over number."""
    drive = better(loaded_two_pulley())
    names = [f"span_tension[{SPANS[0]}]", "hub_load[driver]", "pulley_slip[driven]", "slip_safety[driven]"]
    table, run = sensitivity(drive, of=", ".join(names), numbers=path).dataset, steady_state(drive)
    value = next(one.value for one in numbers_of(drive) if one.path == path)

    def at(part: float) -> FloatArray:
        summary = summarize(steady_state(drive.with_({path: value * (1.0 + part)}), start=run))
        driver, driven = summary.pulleys
        return np.array([summary.spans[0].tension, driver.hub_load, driven.slip, driven.slip_safety])

    wide, narrow = ((at(part) - at(-part)) / (2.0 * part * value) for part in (2e-3, 1e-3))
    expected = (4.0 * narrow - wide) / 3.0
    allowed = 1e-5 * np.maximum(np.abs(expected), np.abs(table.value.values / value))
    assert np.all(np.abs(table.derivative.values[:, 0] - expected) <= allowed)


def test_the_largest_effect_comes_first(found: Result) -> None:
    """Of all results, in per cent of them."""
    changes = [found.dataset[f"relative_{name}"].values for name in found.dataset.result.values]
    largest = np.max(np.nan_to_num(np.abs(changes)), axis=0)
    assert np.all(np.diff(largest) <= 0.0)
    slip = found.dataset.sel(result="pulley_slip[driven]")
    np.testing.assert_allclose(found.dataset["relative_pulley_slip[driven]"], 100.0 * slip.effect / slip.value)


@pytest.fixture(scope="module")
def at_rest(loaded: Drive) -> Result:
    of = "tension, belt_length, hub_load, frequency, mode_frequency, mode_damping_ratio[1]"
    return sensitivity(loaded, of=of, numbers="belt.installed_tension, belt.youngs_modulus", about="rest")


def test_at_rest_the_tension_is_the_one_that_is_asked_for(at_rest: Result) -> None:
    assert derivative(at_rest, "tension", "belt.installed_tension") == pytest.approx(1.0, rel=1e-6)
    bending = 1e-5  # of a thick belt, at the ends of its arcs
    assert derivative(at_rest, "hub_load[driven]", "belt.installed_tension") == pytest.approx(2.0, rel=bending)
    assert derivative(at_rest, "tension", "belt.youngs_modulus") == pytest.approx(0.0, abs=1e-12)


def test_a_stiffer_belt_of_the_same_tension_is_longer(at_rest: Result, loaded: Drive) -> None:
    """L = path / (1 + T / EA), within the depth of contact, which changes the path's length with the tension alone."""
    stiffness, modulus = loaded.belt.axial_stiffness, float(loaded.belt.youngs_modulus or 0.0)
    strain = TENSION / stiffness
    expected = loaded.path.length * strain / modulus / (1.0 + strain) ** 2
    assert derivative(at_rest, "belt_length", "belt.youngs_modulus") == pytest.approx(expected, rel=1e-3)


def test_spans_swing_with_the_root_of_the_tension(at_rest: Result) -> None:
    """Half of the tension's change, within bending stiffness, and what the shorter belt has less mass in the span."""
    for name in (*(f"frequency[{span}]" for span in SPANS), "mode_frequency[6]"):
        effect, value = (at_rest.dataset[what].sel(result=name) for what in ("effect", "value"))
        assert float(effect.sel(number="belt.installed_tension") / value) == pytest.approx(0.005, rel=0.1)


def test_an_open_belt_at_rest() -> None:
    """The tension of a band brake is its weight, the hub load that of both spans."""
    drive = example("band_brake")
    found = sensitivity(drive, about="rest", of="all", numbers="end[weight].mass, belt.width")
    assert derivative(found, "tension", "end[weight].mass") == pytest.approx(9.81, rel=1e-3)  # bending on the drum
    assert derivative(found, "hub_load[drum]", "end[weight].mass") == pytest.approx(2.0 * 9.81, rel=1e-3)
    hub_loads = [
        float(np.linalg.norm(equilibrium(drive.with_({"belt.width": width})).dataset["hub_force"].values))
        for width in (0.0396, 0.0404)
    ]
    expected = (hub_loads[1] - hub_loads[0]) / 0.0008  # weight and bending of the belt
    assert derivative(found, "hub_load[drum]", "belt.width") == pytest.approx(expected, rel=1e-3)
    assert not [name for name in found.dataset["result"].values if "frequency" in str(name)]
    with pytest.raises(ModelError, match=r"mode_frequency\[1\] has no value in this state of the drive"):
        sensitivity(drive, about="rest", of="mode_frequency[1]")


def test_the_speed_of_a_driver_is_a_number(loaded: Drive) -> None:
    constant = loaded.with_({"pulley[driver].speed": 100.0})
    assert [one.path for one in chosen_numbers(constant, "pulley[driver].speed", {})] == ["pulley[driver].speed.value"]


def test_results_without_a_value_are_told(loaded: Drive) -> None:
    idle = loaded.with_({"pulley[driven].torque": 0.0})
    with pytest.raises(ModelError, match=r"slip_safety\[driven\] has no value"):
        sensitivity(idle, of="slip_safety[driven]", numbers="belt.width")


def test_numbers_of_a_drive(loaded: Drive) -> None:
    paths = {one.path: one for one in numbers_of(loaded)}
    assert {"belt.installed_tension", "contact.friction", "pulley[driven].center[2]"} <= paths.keys()
    assert not any(path.startswith(("simulation", "contact.stiffness")) for path in paths)
    assert paths["belt.installed_tension"].step == pytest.approx(0.01 * TENSION)
    assert paths["pulley[driven].center[1]"].step == 1e-3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"of": "efficency"}, "efficiency"),
        ({"of": "efficiency", "about": "rest"}, "efficiency"),
        ({"about": "standing"}, 'must be "steady" or "rest"'),
        ({"numbers": "belt.widht"}, "belt.width"),
    ],
)
def test_wrong_names_are_told(loaded: Drive, options: dict[str, str], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        sensitivity(loaded, **options)  # type: ignore[arg-type]


@pytest.mark.slow
def test_derivatives_do_not_depend_on_the_step() -> None:
    """Hub loads of a drive of seven pulleys are sums of contact forces, which tell states apart by 1e-9 of a radius."""
    drive = loads(files("beltdyn").joinpath("examples", "accessory_drive.toml").read_text(encoding="utf-8"))
    given = without_schedules(drive, drive.simulation.end)[0]
    rest = bring_to_stand(prepare(given))
    state, changes, path = Running(steady_state(rest.drive)), SmallChanges(given, rest), "pulley[alternator].radius"
    radius, load = value_at(given, path), "hub_load[alternator]"

    def effect(part: float) -> float:
        one, other = (
            state.neighbour(changes.drive(path, (1.0 + sense * part) * radius)).value(load) for sense in (1.0, -1.0)
        )
        return (one - other) / (2.0 * part)

    effects = [effect(part) for part in (3e-5, 1e-5, 3e-6)]
    assert np.ptp(effects) < 1e-5 * state.value(load)


def test_stiffnesses_and_mass_of_a_belt_given_by_its_material(loaded: Drive, found: Result) -> None:
    """As its modulus is in both stiffnesses, and its density in the mass, so are the effects of one per cent."""
    names = "belt.axial_stiffness, belt.bending_stiffness, belt.mass_per_length, pulley[driver].diameter"
    by_stiffness = sensitivity(loaded, of="largest_tension, efficiency", numbers=names).dataset

    def effect(table: xr.Dataset, number: str) -> FloatArray:
        return np.asarray(table.effect.sel(result=["largest_tension", "efficiency"], number=number))

    stiffness = effect(by_stiffness, "belt.axial_stiffness") + effect(by_stiffness, "belt.bending_stiffness")
    for number, same in (("youngs_modulus", stiffness), ("density", effect(by_stiffness, "belt.mass_per_length"))):
        np.testing.assert_allclose(same, effect(found.dataset, f"belt.{number}"), rtol=2e-3, atol=1e-9)
    diameter = effect(by_stiffness, "pulley[driver].diameter")
    np.testing.assert_allclose(diameter, effect(found.dataset, "pulley[driver].radius"), rtol=2e-3, atol=1e-9)


def test_a_measured_curve_has_no_stiffness_of_its_own(loaded: Drive) -> None:
    curve = {"strains": [0.01, 0.02], "tensions": [900.0, 1500.0]}
    curved = loaded.with_({"belt.stretch_curve": curve})
    with pytest.raises(ModelError, match=r"belt\.axial_stiffness = .* is the initial slope of"):
        chosen_numbers(curved, "belt.axial_stiffness", {})


def test_the_radius_of_a_pulley_with_teeth_is_no_number_of_its_own() -> None:
    timing = loads(files("beltdyn").joinpath("examples", "timing_drive.toml").read_text(encoding="utf-8"))
    paths = {one.path for one in numbers_of(timing)}
    assert {"pulley[tensioner].radius", "belt.toothing.tooth_stiffness", "belt.toothing.pitch"} <= paths
    assert "pulley[crankshaft].radius" not in paths


def test_a_number_at_its_bound_changes_on_one_side() -> None:
    """A loss factor of 1 cannot rise; losses do not change a belt at rest."""
    drive = better(loaded_two_pulley()).with_({"belt.stretch_loss_factor": 1.0})
    found = sensitivity(drive, about="rest", numbers="belt.stretch_loss_factor")
    np.testing.assert_allclose(found.dataset.derivative, 0.0, atol=1e-3)
    assert not found.dataset.attrs.get("warnings")


def test_a_conveyor_has_no_efficiency_and_its_resistances_change_as_friction_does() -> None:
    """The coefficient C of DIN 22101, 1 by default, is a factor on the friction coefficient.

    Slip safeties are found to 1e-8, and inputs changed by 1e-5: effects of one per cent are exact to 1e-5 of a safety.
    """
    drive = loads(files("beltdyn").joinpath("examples", "package_conveyor.toml").read_text(encoding="utf-8"))
    found = sensitivity(drive, numbers="support[2].friction, support[2].secondary_factor").dataset
    assert list(found.result.values) == ["least_slip_safety", "largest_tension"]
    friction, factor = (found.effect.sel(number=f"support[2].{name}") for name in ("friction", "secondary_factor"))
    exact = 1e-5 * found.value.values
    assert np.all(np.abs(factor - friction) < 1e-3 * np.abs(friction) + exact)
    assert float(friction.sel(result="largest_tension")) > 0.0


@pytest.mark.slow
def test_stability_of_a_controlled_drive_is_found_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not for each number, whose changes are small: eigenvalues cost more than all the rest."""
    found = list[object]()

    def counted(motions: object) -> ComplexArray:
        found.append(motions)
        return np.zeros(0, complex)

    monkeypatch.setattr("beltdyn.state.steady.growing", counted)
    drive = load(Path(__file__).parents[3] / "docs" / "tasks" / "coater.toml")
    derivatives = sensitivity(drive, of="span_tension[infeed-coater]", numbers="pulley[coater].speed.value").dataset
    assert len(found) == 1
    assert float(derivatives.effect[0, 0]) > 0.0  # a larger draw stretches the web more

"""Runs over time on a mesh that stays: they begin at rest or in steady running, and end where steady running says."""

from importlib.resources import files
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Pulley, prepare
from beltdyn.results import summarize
from beltdyn.results.derived import wear_by_arc, wear_by_belt
from beltdyn.results.mechanics import centerline, element_lengths, recorded_kind
from beltdyn.solvers.standard import StandardIntegrator
from beltdyn.state import refinement
from beltdyn.state.search import SteadySearch
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def loaded() -> Drive:
    """Case 2 of the paper, on about 30 elements that stay."""
    return better(loaded_two_pulley(), elements=30, frame="staying", duration=0.3)


@pytest.fixture(scope="module")
def constant(loaded: Drive) -> Drive:
    """The same at its full speed and load from the beginning."""
    driver, driven = loaded.pulleys
    speed, torque = ({"kind": "constant", "value": value} for value in (120.0, -45.0))
    return loaded.replace(
        pulley=[driver.replace(speed=speed), driven.replace(torque=torque)],
        simulation=loaded.simulation.replace(start="steady"),
    )


def test_steady_running_goes_on(constant: Drive) -> None:
    """Nothing changes but angles, so that steps grow."""
    found = bd.simulate(constant).dataset
    speed = found.pulley_speed.values[:, 1]
    assert np.ptp(speed) < 1e-5 * speed[0]
    assert np.ptp(found.span_tension.values, axis=0).max() < 1e-4 * found.span_tension.values.max()
    assert found.step_size.values.max() > 0.01
    assert found.attrs["steps"] < 100
    assert np.abs(found.energy_closure).max() < 1e-3


@pytest.mark.slow
def test_a_run_from_rest_ends_in_steady_running(loaded: Drive, constant: Drive) -> None:
    run = bd.simulate(loaded.replace(simulation=loaded.simulation.replace(duration=1.5)))
    steady = bd.simulate(constant.replace(simulation=constant.simulation.replace(duration=0.01))).dataset
    for name, tolerance in (("pulley_speed", 1e-5), ("span_tension", 1e-4)):
        np.testing.assert_allclose(run.dataset[name].values[-1], steady[name].values[0], rtol=tolerance)
    assert not [warning for warning in run.warnings if "mesh" in warning]


def test_the_number_of_elements_is_about_that_asked_for(constant: Drive) -> None:
    short = constant.replace(simulation=constant.simulation.replace(duration=1e-3))
    assert bd.simulate(short).dataset.sizes["node"] == pytest.approx(30, abs=4)


@pytest.fixture(scope="module")
def short(loaded: Drive) -> Drive:
    """The same for a millisecond, with the number of elements that is chosen."""
    return loaded.replace(belt=loaded.belt.replace(elements=None), simulation=loaded.simulation.replace(duration=1e-3))


def test_the_number_of_elements_is_known_before(short: Drive) -> None:
    """A drive file tells with it how large its results will be."""
    assert bd.simulate(short).dataset.sizes["node"] == short.elements
    travelling = short.replace(simulation=short.simulation.replace(frame="travelling", start="equilibrium"))
    assert short.elements != travelling.elements


def test_errors_of_the_mesh_are_those_at_rest(short: Drive) -> None:
    """As a finer mesh shows them; on one of half as many elements they are larger."""
    fine = bd.simulate(short).resolution.errors
    coarse = bd.simulate(short.replace(belt=short.belt.replace(elements=short.elements // 2))).resolution.errors
    assert 0.0 < fine["peak pressure"] < coarse["peak pressure"]
    assert fine["tension"] < 1e-3
    assert np.isnan(fine["slip"])


def test_the_belt_is_drawn_by_the_elements_that_stay(short: Drive) -> None:
    """Cubic curves through the nodes would leave the arcs, whose radius is theirs less the penetration."""
    run = bd.simulate(short)
    last, drive = run.fields_at(), run.drive
    kind, lengths = recorded_kind(run.dataset, prepare(drive)), element_lengths(run.dataset, drive.belt_length)
    points = centerline(kind, last["nodal_coordinates"].values, lengths).reshape(-1, 2)
    depths = drive.radii[0] - np.linalg.norm(points - drive.centers[0], axis=1)
    touching = last["contact_pulley"].values == 0
    deepest = float(last["normal_force"].values[touching].max()) / drive.contact_stiffness
    assert kind.name == "quintic"
    assert depths.max() == pytest.approx(deepest, rel=0.02)


def test_what_does_not_fit_is_refused(loaded: Drive) -> None:
    with pytest.raises(ModelError, match="every prescribed speed is zero"):
        bd.simulate(loaded.replace(simulation=loaded.simulation.replace(start="steady")))
    with pytest.raises(ModelError, match=r'"bdf" does not support simulation\.frame = "staying"'):
        bd.simulate(loaded, integrator=StandardIntegrator("bdf", 1e-3))
    band = bd.load(str(files("beltdyn") / "examples" / "band_brake.toml"))
    with pytest.raises(ModelError, match="is incompatible with an open belt"):
        bd.simulate(band.replace(simulation=band.simulation.replace(frame="staying")))


def test_bending_loses_as_much_as_in_steady_running() -> None:
    """Runs over time smooth its hysteresis over a shorter length, and make up for what that leaves out, within 3 %."""
    drive = bd.load(str(files("beltdyn").joinpath("examples", "unequal_radii.toml")))
    settings = {"duration": 0.05, "output_interval": 1e-3, "frame": "staying", "start": "steady"}
    motor, fan = drive.pulleys
    speed = {"kind": "constant", "value": 150.0}
    driver = Pulley(name=motor.name, center=motor.center, radius=motor.radius, speed=speed)
    drive = drive.replace(pulley=[driver, fan], simulation=settings)
    steady = summarize(bd.steady_state(drive)).balance.losses["belt bending"]
    loss = bd.simulate(drive).dataset["bending_loss"]
    assert float(loss[-1] - loss[-21]) / 0.02 == pytest.approx(steady, rel=0.03)


@pytest.mark.parametrize("begin", [{}, {"start": "steady", "start_at": 1.6}])
def test_a_mesh_is_refined_to_a_tolerance(short: Drive, begin: dict[str, object]) -> None:
    """At rest, or in steady running; the finer one has twice the elements, and a tenth of the errors or less."""
    settings = short.simulation
    coarse, fine = (
        bd.simulate(short.replace(simulation=settings.replace(force_tolerance=tolerance, **begin)))
        for tolerance in (0.05, 1e-4)
    )
    assert 1e-4 < coarse.resolution.errors["peak pressure"] < 0.05
    assert fine.resolution.errors["peak pressure"] < 1e-4
    assert fine.dataset.sizes["node"] > 1.3 * coarse.dataset.sizes["node"]
    one, other = (run.dataset.span_tension.values[0] for run in (coarse, fine))
    np.testing.assert_allclose(one, other, rtol=1e-4)


def test_a_mesh_of_equal_elements(short: Drive) -> None:
    settings = short.simulation.replace(mesh="uniform")
    run = bd.simulate(short.replace(belt=short.belt.replace(elements=40), simulation=settings))
    lengths = element_lengths(run.dataset, run.drive.belt_length)
    np.testing.assert_allclose(lengths, run.drive.belt_length / 40, rtol=1e-9)
    assert run.resolution.errors["peak pressure"] < 0.01


def test_a_mesh_that_a_tolerance_refines_has_at_least_the_elements_of_the_belt(short: Drive) -> None:
    settings = short.simulation.replace(force_tolerance=0.01)
    free, given = (short.replace(belt=short.belt.replace(elements=n), simulation=settings) for n in (None, 80))
    assert bd.simulate(free).dataset.sizes["node"] < 40
    assert 80 <= bd.simulate(given).dataset.sizes["node"] < 90


def test_what_begins_to_swing_with_the_run_is_told(constant: Drive) -> None:
    driver, driven = constant.pulleys
    table = {"kind": "angle_table", "angles": [0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi], "torques": [0, -10, -20, -10]}
    swinging = constant.replace(
        pulley=[
            driver.replace(harmonics=[{"order": 2.0, "amplitude": 0.01}]),
            driven.replace(torque=None, load=[table]),
        ],
        simulation=constant.simulation.replace(duration=2e-3),
    )
    said = "steady running with the mean of the speed of driver and the load of driven; the oscillation sets in at once"
    assert [said in warning for warning in bd.simulate(swinging).warnings].count(True) == 1


def test_the_belt_that_passed_a_pulley_is_worn_by_it(constant: Drive) -> None:
    """Half a turn wears each piece that passed the driver by its power of friction over the way, and no other."""
    passed = 0.06 * 9.394
    settings = constant.simulation.replace(duration=0.06, output_interval=1e-4, field_interval=0.06)
    run = bd.simulate(constant.replace(simulation=settings))
    wear, arc = wear_by_belt(run).isel(pulley=0), wear_by_arc(run).isel(pulley=0)
    lengths = element_lengths(run.dataset, run.drive.belt_length)
    work = float((arc * arc["part_length"]).sum())
    assert float(wear.values @ lengths) == pytest.approx(work, rel=1e-6)
    assert float(wear.max()) == pytest.approx(work / passed, rel=1e-3)
    worn = float(lengths[wear.values > 1e-3 * work / passed].sum())
    assert passed < worn < passed + run.drive.path.wrap_angles[0] * run.drive.radii[0] + 2.0 * lengths.max()


def test_a_mesh_that_leads_to_no_finer_one_is_made_finer_at_rest(
    constant: Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As the accessory drive with a tolerance of 10 %: the search begins again, on more elements, and is right."""
    refine, begun = refinement.refine, list[int]()

    def stubborn(search: SteadySearch, *rest: Any) -> Any:
        begun.append(search.constant.nodes)
        if len(begun) == 1:
            raise ConvergenceError("not with so many elements")
        return refine(search, *rest)

    settings = constant.simulation.replace(duration=1e-3, force_tolerance=0.05)
    drive = constant.replace(simulation=settings)
    straight = bd.simulate(drive).dataset
    monkeypatch.setattr(refinement, "refine", stubborn)
    found = bd.simulate(drive).dataset
    assert len(begun) == 2
    assert begun[1] > begun[0]
    np.testing.assert_allclose(found.pulley_speed.values[0], straight.pulley_speed.values[0], rtol=1e-4)

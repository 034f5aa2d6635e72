"""Steady running from that of a neighbor: places of tensioners and controllers are taken along, and what changes."""

import time
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.solvers.run_progress import Progress
from beltdyn.state import steady
from beltdyn.state.newton import SteadyWork
from beltdyn.state.refinement import MeshRule
from beltdyn.state.search import SteadySearch
from beltdyn.state.staying import FINER
from beltdyn.state.steady import _require_trims, search_from, steady_beside, steady_from, steady_state, tangent_of
from tests.unit.state.test_search import two
from tests.unit.vibration.test_small_motions import loose

SET_FORCE, TORQUE, GAIN, RATE, PRELOAD = 360.5, -4.0, 1e-2, 2e4, 400.0
"""N, N m, 1/N, N/m, N: at rest the slide is pressed by 360.3 N."""


def controlled(**trim: Any) -> Drive:
    """A torque that is trimmed by the force of a tensioner."""
    left, right, slide = loose().pulleys
    load = {"kind": "torque_trim", "torque": TORQUE, "sensor": "slide", "set_force": SET_FORCE, "force_gain": GAIN}
    return loose().replace(pulley=[left.replace(speed=50.0), right.replace(load=[load | trim]), slide])


@pytest.fixture(scope="module")
def proportional() -> Run:
    return steady_state(controlled(), elements=40)


@pytest.fixture(scope="module")
def integrating() -> Run:
    return steady_state(controlled(integral_time=0.5), elements=40)


def force_of(run: Run) -> float:
    """Of the spring of the slide, N."""
    return PRELOAD - RATE * float(run.dataset.tensioner_position[-1, 0])


def test_an_integrating_controller_holds_its_set_value(integrating: Run) -> None:
    assert force_of(integrating) == pytest.approx(SET_FORCE, rel=1e-9)
    assert abs(float(integrating.dataset.hub_force[-1, 2, 1])) == pytest.approx(SET_FORCE, rel=1e-6)


def test_a_proportional_controller_trims_by_its_error(proportional: Run) -> None:
    error = SET_FORCE - force_of(proportional)
    assert abs(error) > 1.0
    torque = float(proportional.dataset.shaft_torque[-1, 1])
    assert torque == pytest.approx(TORQUE * (1.0 + GAIN * error), rel=1e-6)


@pytest.mark.parametrize(("part", "refused"), [(0.99, True), (1.01, False)])
def test_a_trim_beyond_its_limit_is_refused(proportional: Run, part: float, refused: bool) -> None:
    """By as much as the error requires."""
    trim = abs(GAIN * (SET_FORCE - force_of(proportional)))
    drive = proportional.drive.with_({"pulley[right].load[1].largest_trim": part * trim})
    search = search_from(bd.model.prepare(drive), proportional, 1.0)
    if refused:
        with pytest.raises(ConvergenceError, match=f'"right" holds its set value with a trim of -?{trim:.3g}, but has'):
            _require_trims(search)
    else:
        _require_trims(search)


@pytest.mark.parametrize("kind", ["proportional", "integrating"])
def test_a_search_begins_with_the_state_of_its_neighbor(kind: str, request: pytest.FixtureRequest) -> None:
    """Places of the belt, the tensioner and the controller, and all speeds."""
    run = request.getfixturevalue(kind)
    result, search = run.dataset, search_from(run.prepared, run, 1.0)
    system, state = search.constant, search.state
    np.testing.assert_allclose(state.nodes(system), result.nodal_coordinates[-1], rtol=1e-12, atol=1e-12)
    assert state.position[-1] == pytest.approx(float(result.tensioner_position[-1, 0]), rel=1e-12)
    if kind == "integrating":
        assert state.position[-2] == pytest.approx(float(result.body_position[-1, 3]), rel=1e-12)
        assert abs(state.position[-2]) > 0.1
    np.testing.assert_allclose(state.velocity[system.first_body :][:3], result.pulley_speed[-1], rtol=1e-12)
    assert search.belt_parameter == pytest.approx(result.attrs["belt_parameter"], rel=1e-12)


def test_a_neighbor_at_another_speed_begins_in_proportion(proportional: Run) -> None:
    """All rims, and the belt; places stay."""
    faster = proportional.drive.with_({"pulley[left].speed": 60.0})
    begun, before = (search_from(bd.model.prepare(drive), proportional, 1.0) for drive in (faster, proportional.drive))
    np.testing.assert_allclose(begun.state.velocity, 1.2 * before.state.velocity, rtol=1e-12)
    assert begun.belt_parameter == pytest.approx(1.2 * before.belt_parameter, rel=1e-12)
    np.testing.assert_array_equal(begun.state.position, before.state.position)


def test_the_same_drive_changes_nothing(proportional: Run) -> None:
    """In the time that it takes; one with other pulleys is none beside it."""
    begun = time.perf_counter()
    result = steady_beside(proportional.drive, proportional)
    assert result is not None
    assert 0.0 < result.seconds <= time.perf_counter() - begun
    assert np.abs(result.change).max() < 1e-6
    assert np.abs(result.search.unknowns()).max() > 1.0
    with pytest.raises(ModelError, match="start has the pulleys left, right, slide and 1 moving tensioners; the drive"):
        steady_beside(two(), proportional)


@pytest.mark.parametrize("with_tangent", [False, True])
def test_a_change_is_the_guess_of_another_search(proportional: Run, with_tangent: bool) -> None:
    """What is carried over and the change make the solution, which a search with that guess confirms at once."""
    heavier = proportional.drive.with_({"pulley[right].load[1].torque": 1.1 * TORQUE})
    tangent: SteadyWork | None = tangent_of(proportional) if with_tangent else None
    result = steady_beside(heavier, proportional, tangent=tangent)
    assert result is not None
    again = steady_beside(heavier, proportional, guess=result.change)
    assert again is not None
    assert again.search.iterations == 1
    np.testing.assert_allclose(again.change, result.change, rtol=1e-6, atol=1e-8)


def test_progress_and_the_time_of_the_search_are_told(proportional: Run) -> None:
    """Also of a search from a neighbor."""
    drive, reports, begun = proportional.drive, list[Progress](), time.perf_counter()
    run = steady_state(drive, start=proportional, progress=reports.append)
    assert 0.0 < run.dataset.attrs["wall_time"] <= time.perf_counter() - begun
    assert (reports[0].time, reports[0].outputs_written, reports[0].phase) == (0.0, 0, "equilibrium")
    assert reports[0].duration == drive.simulation.duration


def test_a_guess_is_added_to_what_is_carried_over(proportional: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = list[FloatArray]()

    def resume(search: SteadySearch, tangent: SteadyWork | None = None) -> bool:
        begun.append(search.unknowns())
        return False

    monkeypatch.setattr(SteadySearch, "resume", resume)
    guess = np.linspace(1e-6, 1e-5, search_from(proportional.prepared, proportional, 1.0).unknowns().size)
    assert steady_beside(proportional.drive, proportional) is None
    assert steady_beside(proportional.drive, proportional, guess=guess) is None
    np.testing.assert_allclose(begun[1] - begun[0], guess, atol=1e-12)


@pytest.mark.parametrize("converges", [True, False])
def test_steady_running_of_analyses_begins_with_a_neighbor_or_at_rest(
    proportional: Run, converges: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(steady, "_continued", lambda *_, bands: "near" if converges else None)
    monkeypatch.setattr(steady, "_from_rest", lambda *_, bands: "rest")
    monkeypatch.setattr(steady, "_as_run", lambda prepared, instant, result: result)
    begun: list[Any] = [steady_from(proportional.drive, start, None, bands=True) for start in (None, proportional)]
    assert begun == ["rest", "near" if converges else "rest"]


@pytest.mark.parametrize(("tolerance", "refined"), [(0.05, False), (0.005, True)])
def test_the_mesh_of_a_neighbor_is_refined_from_the_coarser_one_on(
    proportional: Run, tolerance: float, refined: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With which it was compared, where its error of 1 % is too large; the first finer one is that of the neighbor."""
    begun, rule = list[MeshRule](), MeshRule(0.01, 0.7)

    def refine(search: object, coarse: MeshRule, tolerance: float) -> tuple[dict[str, float], MeshRule]:
        assert search == "coarser"
        begun.append(coarse)
        return {"peak pressure": 0.001}, coarse.finer()

    monkeypatch.setattr(steady, "_rule_of", lambda _: rule)
    monkeypatch.setattr(steady, "against_coarser", lambda *_: ({"peak pressure": 0.01, "tension": 0.0}, "coarser"))
    monkeypatch.setattr(steady, "refine", refine)
    result = steady._continued(proportional.prepared, proportional, 1.0, tolerance, bands=False)
    assert result is not None
    assert isinstance(result.search, SteadySearch) is not refined
    assert result.rule.fineness == pytest.approx(rule.fineness)
    assert [each.fineness for each in begun] == [pytest.approx(0.7 / FINER)] * refined

"""Optima against closed forms, and what is said of studies that cannot be."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import held, study_points
from beltdyn.designs.designs import Designs, free_numbers
from beltdyn.designs.optimization_history import Aims, aims_of
from beltdyn.designs.optimize import optimize
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, OptimizationStudy, dumps, example, loads
from beltdyn.points.traction import traction
from beltdyn.results import Result, open_result, summarize
from beltdyn.solvers.run_progress import Progress
from beltdyn.state.steady import steady_state
from validation.published.cases import better, loaded_two_pulley

TENSION, SAFETY = 600.0, 2.0
FREE: dict[str, Any] = {"path": "belt.installed_tension", "least": 200.0, "largest": "900 N"}
SAFE: dict[str, Any] = {"result": "slip_safety", "at_least": SAFETY}
POINTS: dict[str, Any] = {"load": "0.5, 1"}


@pytest.fixture(scope="module")
def loaded() -> Drive:
    drive = better(loaded_two_pulley())
    belt = drive.belt.replace(length=None, installed_tension=TENSION)
    return drive.replace(belt=belt)


def study(**changes: Any) -> OptimizationStudy:
    given: dict[str, Any] = {"number": [FREE], "goal": {"result": "hub_load"}, "requirement": [SAFE], "points": POINTS}
    return OptimizationStudy(**given | changes)


@pytest.fixture(scope="module")
def found(loaded: Drive) -> Result:
    return optimize(loaded, study=study())


def test_least_hub_load_for_a_slip_safety(found: Result) -> None:
    """Its belt slides at the safety times the load: to 5 % as safeties promise, and 1 % since it creeps by 25 %."""
    best = found.dataset.sel(point="load 1").best_result
    safeties = best.sel(result=["slip_safety[driver]", "slip_safety[driven]"])
    assert float(safeties.min()) == pytest.approx(SAFETY, rel=2e-4)
    largest = float(traction(found.drive, slip="20, 25 %").dataset.torque.max())
    assert largest == pytest.approx(SAFETY * 45.0, rel=0.06)


def test_its_goal_is_that_of_its_drive(found: Result) -> None:
    """The best drive is one that can be read and run."""
    summary = summarize(steady_state(found.drive))
    assert float(found.dataset.goal_found) == pytest.approx(max(one.hub_load for one in summary.pulleys), rel=1e-3)
    assert found.drive == loads(str(found.dataset.attrs["best_drive"]))
    assert found.drive.belt.installed_tension == pytest.approx(float(found.dataset.best[0]))


def test_start_and_best_stand_side_by_side(found: Result) -> None:
    dataset = found.dataset
    assert dataset.requirement.values.tolist() == ["minimize largest hub_load", "slip_safety at least 2"]
    assert float(dataset.worst[0]) == float(dataset.goal_found) < float(dataset.worst_at_start[0])
    assert dataset.worst_at.values[1].endswith(", load 1")
    assert float(dataset.start[0]) == TENSION
    assert dataset.number_unit.values.tolist() == ["N"]
    assert int(dataset.designs) == dataset.sizes["design"]


@pytest.mark.slow
def test_the_mean_of_efficiencies_can_be_maximized(loaded: Drive) -> None:
    """Losses of friction fall with the tension down to where slip costs more: it is not above the start."""
    wanted = study(goal={"result": "efficiency", "sense": "maximize", "over": "mean"})
    dataset = optimize(loaded, study=wanted, most=8).dataset
    assert float(dataset.goal_found) > float(dataset.goal_at_start)
    mean = float(dataset.best_result.sel(result="efficiency").mean())
    assert float(dataset.goal_found) == pytest.approx(mean)


@pytest.mark.slow
def test_a_design_that_slips_through_is_no_solution(loaded: Drive) -> None:
    """Without a requirement less tension is better until the belt slips; what slips is marked with its reason."""
    wanted = study(requirement=[], number=[FREE | {"least": 20.0}], points={})
    found = optimize(loaded, study=wanted, most=5)
    failures = [str(one) for one in found.dataset.failure.values]
    assert any("the belt slips on `driver`" in one for one in failures)  # pulleys are equal
    assert np.all(np.isnan(found.dataset.design_goal.values) == np.array([bool(one) for one in failures]))
    assert any("excluded" in warning for warning in found.warnings)
    assert steady_state(found.drive).status == "completed"


@pytest.mark.slow
def test_where_no_design_keeps_to_all_limits(loaded: Drive) -> None:
    found = optimize(
        loaded, study=study(requirement=[{"result": "hub_load", "at_most": "300 N"}, SAFE], points={}), most=6
    )
    assert any("no design satisfies all limits" in warning for warning in found.warnings)


def test_a_start_that_does_not_run_is_refused(loaded: Drive) -> None:
    slack = loaded.with_({"belt.installed_tension": 210.0, "pulley[driven].torque.value": -300.0})
    with pytest.raises(ConvergenceError, match="starts from the given drive, which does not run"):
        optimize(slack, study=study(points={}))


def test_an_interruption_keeps_what_was_found(loaded: Drive, tmp_path: Path) -> None:
    file, drive_file = tmp_path / "out.nc", tmp_path / "out.toml"

    def interrupt(progress: Progress) -> None:
        if progress.outputs_written == 2:
            raise KeyboardInterrupt

    optimize(loaded, study=study(), output=file, progress=interrupt)
    found = open_result(file)
    assert found.status == "interrupted"
    assert found.dataset.sizes["design"] == 2
    assert str(found.dataset.ended.values).startswith("interrupted")
    assert loads(drive_file.read_text(encoding="utf-8")) == found.drive


def test_another_drive_file_is_not_replaced(loaded: Drive, tmp_path: Path) -> None:
    (tmp_path / "out.toml").write_text(dumps(loaded), encoding="utf-8")
    with pytest.raises(ModelError, match=r"out\.toml"):
        optimize(loaded, study=study(), output=tmp_path / "out.nc")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"number": [FREE | {"path": "belt.widht"}]}, r"belt.widht is not a known key. Did you mean \"width\"?"),
        ({"number": [FREE | {"path": "pulley[idler].radius"}]}, r"pulley\[idler\] does not exist"),
        ({"number": [FREE | {"path": "belt.elements"}]}, "is not a continuous number"),
        ({"number": [FREE | {"path": "belt.length"}]}, "is not given in the drive file"),
        ({"number": [FREE | {"largest": "9 m"}]}, "must be in units of N"),
        ({"number": [FREE | {"largest": 100.0}]}, "least = 200 is not below largest = 100"),
        ({"number": [FREE | {"largest": 300.0}]}, "the drive file has 600, which is outside"),
        ({"goal": {"result": "hub_laod"}}, "goal.result = 'hub_laod' is not a numerical result. Did you mean"),
        ({"requirement": [SAFE | {"result": "safety"}]}, r"requirement\[1\].result = 'safety'"),
        (
            {"requirement": [{"result": "hub_load", "at_most": "3 m"}]},
            r"requirement\[1\].at_most = '3 m' must be",
        ),
        ({"points": {"table": "none.csv"}}, "none.csv.* cannot be read"),
        ({"points": {"speed": "fast"}}, "must be a range"),
        ({"order": [{"order": 2, "least_speed": 1.0, "largest_speed": 2.0}]}, "no operating point prescribes a speed"),
    ],
)
def test_what_does_not_fit_the_drive_is_told(loaded: Drive, changes: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        optimize(loaded, study=study(**changes))


def test_a_design_followed_along_the_tangent_is_that_found_from_rest(loaded: Drive) -> None:
    """Halving the tension is far beyond Newton's method from the state at hand, and not beyond the path of states."""
    given = study()
    there, points = held(loaded, given.points), study_points(loaded, given.points, Path())
    (number,) = free_numbers(loaded, given.numbers[:1])
    watched = aims_of(given, there, points).watched
    designs = Designs(loaded, [number], points, given.points, watched, None, lambda part: None)
    start = designs.find({number.path: TENSION})
    slopes = designs.derivatives(start)
    followed, alone = designs.find({number.path: 0.6 * TENSION}, start), designs.find({number.path: 0.6 * TENSION})
    assert not followed.failure
    assert all(path.keys() == {number.path} for path in start.tangents)
    assert followed.values == pytest.approx(alone.values, rel=0.01, nan_ok=True)
    assert slopes[:, 0, 0] == pytest.approx(2.0, rel=0.05)  # both spans pull at the hub


def test_the_study_is_never_replaced(loaded: Drive, tmp_path: Path) -> None:
    file = tmp_path / "s.toml"
    number = '[[number]]\npath = "belt.installed_tension"\nleast = 200\nlargest = 900'
    file.write_text(f'{number}\n[goal]\nresult = "hub_load"\n')
    with pytest.raises(ModelError, match="which is the study"):
        optimize(loaded, study=file, output=tmp_path / "s.nc", overwrite=True)
    assert "installed_tension" in file.read_text()


def test_what_the_tolerance_of_limits_lets_pass_is_said(found: Result, tmp_path: Path) -> None:
    """The limit of slip is active: the best design misses it by less than 1e-4 of it, or not at all, as is said."""
    best = found.dataset
    beyond = 1.0 - float(best.worst[1]) / SAFETY
    assert beyond <= 1e-4
    assert ("a limit is violated by" in str(best.ended.item())) == (beyond > 0.0)


@pytest.mark.parametrize("mean", [False, True])
def test_goals_count_what_has_a_value(mean: bool) -> None:
    """Drawn at random: the goal of all values, and its slope by differences, without those that are not there."""
    chance = np.random.default_rng(5)
    for _ in range(50):
        points, results = chance.integers(1, 4), chance.integers(1, 5)
        values, slopes = chance.normal(size=(points, results)), chance.normal(size=(points, results, 1))
        values[chance.random(values.shape) < 0.4] = np.nan
        weights, sign = chance.random(points), chance.choice([-1.0, 1.0])
        aims = Aims((), tuple(range(results)), "", sign, mean, (), weights)

        def goal(of: FloatArray, aims: Aims = aims, weights: FloatArray = weights) -> float:
            known = np.isfinite(of)
            if not known.any():
                return np.inf
            each = np.broadcast_to(weights[:, None], of.shape)[known]
            wanted = aims.sign * of[known]
            return float(each @ wanted / each.sum()) if aims.mean else float(wanted.max())

        assert float(np.max(aims.goal_values(values))) == pytest.approx(goal(values))
        if np.isfinite(values).any():
            small = 1e-7
            worst = int(np.argmax(aims.goal_values(values)))
            ahead = goal(values + small * slopes[..., 0])
            assert aims.goal_slopes(values, slopes)[worst, 0] == pytest.approx((ahead - goal(values)) / small, abs=1e-6)


@pytest.fixture(scope="module")
def idling() -> Drive:
    """A drive with a smooth tensioner, which has neither a rating nor teeth."""
    return example("alternator_drive")


@pytest.mark.parametrize(
    ("result", "sense"),
    [
        ("utilization", "minimize"),
        *(
            pytest.param(name, sense, marks=pytest.mark.slow)
            for name in ("slip_safety", "rated_power", "mesh_error", "rib_damage", "hub_load")
            for sense in ("minimize", "maximize")
        ),
    ],
)
def test_a_goal_over_pulleys_is_that_of_those_that_have_it(idling: Drive, result: str, sense: str) -> None:
    wanted = study(number=[FREE], goal={"result": result, "sense": sense}, requirement=[], points={})
    found = optimize(idling, study=wanted, most=2).dataset
    assert np.isfinite(found.goal_found)
    names = [name for name in found.result.values if name.startswith(result)]
    worst = np.nanmax if sense == "minimize" else np.nanmin
    assert float(found.goal_at_start) == worst(found.start_result.sel(result=names))


def test_a_goal_without_any_value_is_refused(idling: Drive) -> None:
    with pytest.raises(ModelError, match=r"the goal has no value: utilization\[tensioner\] cannot be computed"):
        optimize(idling, study=study(goal={"result": "utilization[tensioner]"}, requirement=[], points={}))


def test_a_limit_of_what_has_no_value_is_told(idling: Drive) -> None:
    limited = study(requirement=[{"result": "utilization[tensioner]", "at_most": 1.0}], points={})
    found = optimize(idling, study=limited, most=2)
    assert any("no result has a value at any operating point" in warning for warning in found.warnings)

"""The drive sheet: what it holds, and how its parts agree."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.designs import drive_sheet
from beltdyn.errors import ModelError
from beltdyn.model import example, install, loads
from beltdyn.model.demand import required_tension
from beltdyn.model.installation import tension_checks
from beltdyn.solvers.run_progress import Progress
from tests.unit.points.test_tensioner_sheet import PRELOAD, RATE, SLIDE

ROWS = [
    {"name": "idle", "share": 0.7, "speed": "900 rpm", "power": {"alternator": "0.5 kW"}},
    {"name": "fast", "share": 0.3, "speed": "3000 rpm", "power": {"alternator": "1 kW"}},
]


@pytest.fixture(scope="module")
def found() -> bd.Result:
    drive = example("alternator_drive").replace(
        duty=ROWS, limits={"least_slip_safety": 1.5, "largest_hub_load": "2 kN"}
    )
    return bd.sheet(drive, acceleration="2000 rpm/s", points=5)


def test_rows_and_curves_meet(found: bd.Result) -> None:
    dataset = found.dataset
    assert dataset.row.values.tolist() == ["idle", "fast"]
    np.testing.assert_allclose(dataset.speed.values[[0, -1]] * 30.0 / np.pi, [900.0, 3000.0])
    for name in ("span_tension", "hub_load", "slip_safety", "peak_tension", "tensioner_position"):
        np.testing.assert_allclose(dataset[f"{name}_over_speed"].values[[0, -1]], dataset[name].values, rtol=1e-6)
    np.testing.assert_allclose(dataset.power.sel(pulley="alternator"), [-500.0, -1000.0], rtol=1e-6)
    assert (dataset.least_slip_safety <= dataset.slip_safety + 1e-9).where(dataset.slip_safety.notnull(), True).all()
    assert (dataset.peak_tension >= dataset.span_tension).all()
    assert dataset.case.size == 6


def test_positions_of_the_tensioner_are_those_of_the_tensioner_sheet(found: bd.Result) -> None:
    """Within 1 %: the sheet changes the equilibrium of finite elements, which the other finds anew."""
    dataset, other = found.dataset, bd.tensioner_sheet(example("alternator_drive")).dataset
    names = {"replace": "worn belt", "max": "longest belt", "mean": "nominal belt", "min": "shortest belt"}
    for state, name in names.items():
        one, there = dataset.sel(state=state), other.sel(state=name)
        assert float(one.state_tension) == pytest.approx(float(there.tension), rel=0.01)
        assert float(one.state_position) == pytest.approx(float(there.position), abs=3e-3)
        assert float(one.state_take_up) == pytest.approx(float(there.leverage), rel=0.01)
    free = dataset.sel(state="free")
    assert float(free.state_position) == pytest.approx(float(other.position.sel(state="free arm")))
    assert [float(free[f"state_{name}"]) for name in ("tension", "hub_load")] == [0.0, 0.0]
    assert float(free.state_spring) == pytest.approx(0.0, abs=1e-9)


def test_belts_of_standard_length_stand_around_the_nominal_one(found: bd.Result) -> None:
    dataset = found.dataset
    assert dataset.standard.values[0] < float(dataset.nominal_length) < dataset.standard.values[-1]
    known = dataset.standard_tension.values[np.isfinite(dataset.standard_tension.values)]
    assert (np.diff(known) < 0.0).all()


def test_limits_judge_peaks_and_the_least_slip_safety(found: bd.Result) -> None:
    numbers = {one.key: one for one in bd.results.key_numbers(found)}
    assert numbers["largest_hub_load"].value == pytest.approx(float(found.dataset.peak_hub_load.max()))
    assert numbers["least_slip_safety"].value == pytest.approx(float(found.dataset.least_slip_safety.min()))
    assert numbers["least_slip_safety"].limit == 1.5


def test_alignment_is_that_of_the_drive_with_tolerances() -> None:
    """Between fixed centers, where the path at rest is the given one."""
    drive = bd.loads(
        """
belt = { profile = "PK", ribs = 4, installed_tension = "400 N" }
pulley = [
    { name = "motor", center = [0, 0], diameter = "120 mm", speed = "1000 rpm" },
    { name = "fan", center = [0.4, 0], diameter = "180 mm", inertia = 0.01, axial_offset = "0.5 ± 4 mm" },
]
simulation = { duration = "1 s" }
"""
    )
    result = bd.sheet(drive, points=2)
    expected, dataset = bd.model.alignment(drive), result.dataset
    np.testing.assert_allclose(dataset.fleeting_angle, expected.angles, rtol=1e-9)
    np.testing.assert_allclose(dataset.worst_fleeting_angle, expected.worst, rtol=1e-9)
    assert float(dataset.allowed_fleeting_angle) == expected.limit
    np.testing.assert_allclose(dataset.allowed_offset, expected.allowed_offset, rtol=1e-9)
    assert np.all(dataset.worst_fleeting_angle.values > np.abs(dataset.fleeting_angle.values))
    assert any("with tolerances, but the belt allows" in one for one in result.warnings)


def test_spans_are_checked_as_in_the_workshop() -> None:
    """A new, a run-in and a loose belt between fixed centers as `check` tells; one state where a spring holds it."""
    drive = example("fan_direct_start")
    needed = required_tension(drive, install(drive))
    assert needed is not None
    dataset, checks = bd.sheet(drive, points=2).dataset, tension_checks(drive, install(drive), least=needed.tension)
    assert dataset.tension_formula.values.tolist() == list(needed.by_formula)
    np.testing.assert_allclose(dataset.required_tension, list(needed.by_formula.values()), rtol=0.01)
    assert dataset.belt_state.values.tolist() == [one.state for one in checks] == ["new", "run in", "least"]
    for one in checks:
        at = dataset.sel(belt_state=one.state)
        np.testing.assert_allclose(at.span_frequency, one.frequencies, rtol=0.01)  # closed form, finite elements
        np.testing.assert_allclose(at.deflection_force, one.forces, rtol=0.01)
    np.testing.assert_allclose(dataset.deflection, 0.016 * dataset.span_length)
    held = bd.sheet(example("alternator_drive"), points=2).dataset
    assert held.belt_state.values.tolist() == ["at rest"]


def test_a_tensioner_at_its_stops_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """A slide of two equal spans between stops: T = (F - k q) / 2, at the load stop too; beyond, the belt is slack."""
    progress, slide = list[Progress](), loads(SLIDE)
    monkeypatch.setattr(drive_sheet, "_SLACK", 0.05)
    result = bd.sheet(slide, points=2, tolerance="21.3 mm", wear="0.7 mm", progress=progress.append)
    assert progress == [Progress(0.0, 1.0, 0.0, 0, "equilibrium")]
    found = result.dataset
    load = found.sel(state="load")
    assert float(load.state_position) == pytest.approx(-0.008)
    assert float(load.state_tension) == pytest.approx(0.5 * (PRELOAD + 0.008 * RATE), rel=1e-3)
    said = {text.split()[5]: text for text in result.warnings if "moves the tensioner of tail to its stop" in text}
    assert said.keys() == {"replace", "max", "min"}
    assert f"with {float(found.state_tension.sel(state='min')):.4g} N" in said["min"]
    assert 0.0 < float(found.state_tension.sel(state="max")) < 0.05 * float(found.tension_at_rest)
    assert all("where the belt is slack" in said[state] for state in ("replace", "max"))
    slack = found.sel(state="replace")
    assert (float(slack.state_tension), float(slack.state_hub_load)) == (0.0, 0.0)


def test_it_is_kept_in_a_file(found: bd.Result, tmp_path: Path) -> None:
    kept = bd.open_result(found.save(tmp_path / "sheet.nc"))
    assert kept.kind == "sheet"
    np.testing.assert_array_equal(kept.dataset.mode_frequency, found.dataset.mode_frequency)


def test_a_slipping_pulley_is_told_with_its_case() -> None:
    drive = example("alternator_drive")
    with_less = bd.sheet(drive.replace(contact=drive.contact.replace(friction=0.05)), points=2)
    assert any("slips: its slip safety is" in one for one in with_less.warnings)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"light_load": 1.5}, "light_load = 1.5 must be at most 1"),
        ({"speed": "-100, 100 rpm"}, "must be positive"),
        ({"tolerance": "-1 mm"}, "tolerance = '-1 mm' must be non-negative"),
    ],
)
def test_options_are_checked(options: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        bd.sheet(example("alternator_drive"), **options)
    with pytest.raises(ModelError, match="a drive sheet needs a closed belt"):
        bd.sheet(example("band_brake"))


EXAMPLES = sorted(one.stem for one in Path(bd.__file__).parent.joinpath("examples").glob("*.toml"))


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_has_a_sheet_or_a_remedy_that_works(name: str) -> None:
    drive = bd.example(name).with_({"steady.force_tolerance": 0.2})
    if drive.ends:
        with pytest.raises(ModelError, match="a drive sheet needs a closed belt"):
            bd.sheet(drive)
        return
    refusal, options = "", dict[str, str]()
    try:
        found = bd.sheet(drive, points=3)
    except ModelError as error:
        refusal = str(error)
    if refusal:
        remedy = re.search(r'Give them by (\w+), such as "(.*)"\.', refusal)
        assert remedy is not None, refusal
        options[remedy[1]] = remedy[2]
        found = bd.sheet(drive, points=3, **options)  # type: ignore[arg-type]
    assert found.kind == "sheet"

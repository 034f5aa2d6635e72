"""Whole runs: status, outputs, interruption, failure, memory against file, static equilibrium."""

import importlib
import warnings
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from beltdyn import equilibrium, example, simulate
from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.machines import FunctionLoad
from beltdyn.model import Drive
from beltdyn.results import open_run
from beltdyn.results.checks.mesh import COARSE_SETTINGS
from beltdyn.results.summary import FAILURE, VALUES
from beltdyn.solvers.run_progress import Progress
from beltdyn.solvers.standard import FixedSteps, Stepwise
from beltdyn.system.first_order import FirstOrder
from beltdyn.transient.checkpoint import CheckpointWarning
from beltdyn.transient.simulate import _without_checkpoints, choose_integrator

Change = Callable[..., Drive]
simulate_module = importlib.import_module("beltdyn.transient.simulate")  # its name is that of the function, too
SLOW = [pytest.param(one, marks=pytest.mark.slow) for one in ("cvode", "ida", "bdf", "radau")]
INTEGRATORS = ["generalized_alpha", *SLOW]


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("start", ["laid", "equilibrium"])
def test_outputs_lie_exactly_where_they_are_wanted(change: Change, integrator: str, start: str) -> None:
    """The duration is no multiple of the interval."""
    settings = {"integrator": integrator, "start": start, "duration": 5e-4, "output_interval": 1.5e-4}
    run = simulate(change(simulation=settings))
    assert run.status == "completed"
    np.testing.assert_array_equal(run.dataset.time, [*(1.5e-4 * np.arange(4)), 5e-4])
    assert run.dataset.attrs["integrator"] == integrator


@pytest.fixture(scope="module")
def thrown(change: Change) -> Callable[[float], xr.Dataset]:
    """The laid belt springs into its pulleys for a millisecond, in some hundred steps; recorded at intervals."""
    settings = {"start": "laid", "duration": 1e-3}

    def record(interval: float) -> xr.Dataset:
        every = {"output_interval": interval, "field_interval": interval}
        return simulate(change(simulation=settings | every)).dataset

    return record


def test_dense_output_costs_no_steps(thrown: Callable[[float], xr.Dataset]) -> None:
    sparse, dense = (thrown(interval).attrs["steps"] for interval in (1e-3, 1e-7))
    assert sparse > 50
    assert dense == pytest.approx(sparse, rel=0.05)


def test_dense_output_agrees_with_sparse_output(thrown: Callable[[float], xr.Dataset]) -> None:
    """Even where a step holds more outputs than are handed out at once."""
    sparse, dense = thrown(1e-4), thrown(1e-7)
    assert dense.sizes["time"] == 10_001
    allowed = 1e-3 * 3.0 * 1e-3  # rtol times the velocity of the recoil times the duration
    np.testing.assert_allclose(dense.node_position[::1000], sparse.node_position, atol=allowed)
    jumps = np.abs(np.diff(dense.node_position, axis=0)).max()
    assert jumps < 2.0 * np.abs(dense.nodal_velocities[..., :2]).max() * 1e-7  # no output is extrapolated


def test_file_and_memory_hold_the_same(change: Change, tmp_path: Path) -> None:
    memory, file = simulate(change()), simulate(change(), tmp_path / "run.nc")
    assert file.path == tmp_path / "run.nc"
    assert memory.path is None
    xr.testing.assert_equal(memory.dataset, open_run(tmp_path / "run.nc").dataset.load())
    times = {"created", "wall_time", "cpu_time", "compile_time", "start_time", "check_time"}
    assert times <= memory.dataset.attrs.keys() == file.dataset.attrs.keys()
    for name in memory.dataset.attrs.keys() - times:
        assert memory.dataset.attrs[name] == file.dataset.attrs[name]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_interruption_keeps_what_was_computed(change: Change, tmp_path: Path, integrator: str) -> None:
    def interrupt(progress: Progress) -> None:
        if progress.outputs_written >= 3:
            raise KeyboardInterrupt

    settings = {"integrator": integrator, "duration": 0.5, "output_interval": 1e-4}
    run = simulate(change(simulation=settings), tmp_path / "run.nc", interrupt)
    kept = open_run(tmp_path / "run.nc")
    assert run.status == kept.status == "interrupted"
    assert 3 <= kept.dataset.sizes["time"] < 1000
    np.testing.assert_array_equal(kept.dataset.time, 1e-4 * np.arange(kept.dataset.sizes["time"]))


def test_failure_keeps_what_was_computed(failing: Drive, tmp_path: Path) -> None:
    with pytest.raises(ConvergenceError, match=r"fails at t = 0\.002.*node \d.*Try more elements"):
        simulate(failing, tmp_path / "run.nc")
    kept = open_run(tmp_path / "run.nc")
    assert kept.status == "failed"
    np.testing.assert_allclose(kept.dataset.time, [0.0, 1e-3, 2e-3])


def test_nothing_is_computed_for_a_file_that_cannot_be_written(change: Change, tmp_path: Path) -> None:
    told: list[Progress] = []
    with pytest.raises(ModelError):
        simulate(change(), tmp_path / "missing" / "run.nc", told.append)
    notes = tmp_path / "notes.txt"
    notes.write_text("of others", encoding="utf-8")
    with pytest.raises(ModelError, match="overwrite"):
        simulate(change(), notes, told.append)
    assert notes.read_text(encoding="utf-8") == "of others"
    assert told == []


def test_equilibrium_is_the_start_of_a_simulation(change: Change) -> None:
    static, moving = equilibrium(change()).dataset, simulate(change()).dataset
    np.testing.assert_array_equal(static.nodal_coordinates, moving.nodal_coordinates[0])
    np.testing.assert_allclose(static.hub_force.sum("pulley"), 0.0, atol=1e-6)  # of 50 N; Newton's tolerance


@pytest.mark.parametrize("joint", ["shared_node", "multipliers"])
def test_a_drive_at_rest_in_equilibrium_stays_there(drive: Drive, change: Change, joint: str) -> None:
    run = simulate(change(simulation={"joint": joint, "duration": 0.04, "output_interval": 0.01})).dataset
    moved = np.abs(run.node_position - run.node_position[0]).max()
    assert moved < 1e-9  # rounding; the driver starts after 50 ms


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_settings_reach_the_integrator(change: Change, integrator: str) -> None:
    """A belt that springs into its pulleys takes more steps for less error; no step is above the longest."""

    def steps(duration: float, **settings: float | str) -> int:
        settings |= {"integrator": integrator, "duration": duration, "output_interval": duration}
        return int(simulate(change(simulation=settings)).dataset.attrs["steps"])

    assert steps(2e-4, start="laid", rtol=1e-4) > 2 * steps(2e-4, start="laid", rtol=1e-2)
    assert steps(5e-3, max_step=1e-4) >= 50 > steps(5e-3)


def with_function(change: Change, **settings: object) -> Drive:
    drive = change(simulation={"duration": 4e-4, "output_interval": 1e-4} | settings)
    load = FunctionLoad(function=lambda time, angle, speed: -1.0 - 0.1 * speed)
    return drive.replace(pulley=[drive.pulleys[0], drive.pulleys[1].replace(torque=None, load=[load])])


def test_a_run_with_a_function_is_complete_but_keeps_no_checkpoints(change: Change, tmp_path: Path) -> None:
    """A function cannot be stored in a file; all else is as in other runs."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", CheckpointWarning)
        run = simulate(with_function(change), tmp_path / "run.nc", checkpoint=1e-9)
    np.testing.assert_array_equal(run.dataset.time, 1e-4 * np.arange(5))
    assert run.dataset.shaft_torque.values[0, 1] == pytest.approx(-1.0)
    assert run.status == "completed"


def test_why_a_run_cannot_be_resumed(change: Change) -> None:
    """Of the integrator that computes it, which may be another one than that of the drive."""
    drive, method = change(), choose_integrator(change(simulation={"integrator": "bdf"}))
    assert _without_checkpoints(drive, None) == ""
    assert _without_checkpoints(drive, choose_integrator(drive)) == ""
    assert _without_checkpoints(drive, method) == 'has integrator = "bdf", whose state is not stored'
    assert "bdf" in _without_checkpoints(change(simulation={"integrator": "bdf"}), None)
    assert 'a load of kind "function"' in _without_checkpoints(with_function(change), None)


def test_where_nothing_was_kept_a_warning_points_to_the_call(change: Change, tmp_path: Path) -> None:
    with pytest.warns(CheckpointWarning, match="nothing to resume: no run of this drive has begun there") as raised:
        simulate(change(), tmp_path / "run.nc", resume=True)
    assert raised[0].filename == __file__


@pytest.mark.parametrize("compared", [False, True])
def test_a_run_is_compared_with_steady_running_where_that_is_wanted(
    change: Change, compared: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the speeds and loads of its end; or it says why there is none."""
    asked = list[Drive]()

    def steadily(drive: Drive) -> None:
        asked.append(drive)
        raise ConvergenceError("it slips")

    monkeypatch.setattr(simulate_module, "steady_state", steadily)
    attributes = simulate(change(), compare_steady=compared).dataset.attrs
    assert attributes.get(FAILURE) == ("it slips" if compared else None)
    assert len(asked) == compared
    assert VALUES not in attributes


@pytest.mark.parametrize(
    ("ends", "steadily", "noted"), [(False, True, True), (False, False, False), (True, True, False)]
)
def test_settings_of_a_coarse_run_are_noted_where_it_ends_steadily(
    change: Change, ends: bool, steadily: bool, noted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its losses are compared with those of steady running, which open belts do not have."""
    notes, checked = dict[str, object](), list[bool]()
    recording = SimpleNamespace(
        check=lambda: checked.append(True), run=lambda: None, note=lambda **attributes: notes.update(attributes)
    )
    monkeypatch.setattr(simulate_module, "ends_steadily", lambda run: steadily)
    monkeypatch.setattr(simulate_module, "_steady_losses", lambda drive: {"losses": 1.0})
    drive = example("band_brake") if ends else change(belt={"elements": 20})
    simulate_module._end(recording, drive, False)
    assert checked == [True]
    assert (notes.get("losses"), COARSE_SETTINGS in notes) == (1.0 if noted else None, noted)


def test_an_open_belt_is_not_compared_with_steady_running(tmp_path: Path) -> None:
    """It says so before anything is computed."""
    reports = list[Progress]()
    with pytest.raises(ModelError, match="an open belt has no steady running"):
        simulate(example("band_brake"), tmp_path / "run.nc", reports.append, compare_steady=True)
    assert reports == []
    assert not list(tmp_path.iterdir())


def test_a_run_needs_a_duration(change: Change) -> None:
    with pytest.raises(ModelError, match=r"simulation\.duration is missing, the time to be simulated"):
        simulate(change(simulation={"duration": None, "output_interval": None}))


class Frozen:
    """A method of others, for which nothing moves."""

    name, order = "frozen", 1

    def step(self, equations: FirstOrder, time: float, y: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
        return y.copy(), np.zeros_like(y)


def test_methods_of_others_are_recorded_without_checkpoints(change: Change, tmp_path: Path) -> None:
    """All their states, from the length that gives the installed tension."""
    drive = change(
        belt={"length": None, "installed_tension": 60.0},
        simulation={"start": "equilibrium", "duration": 4e-4, "output_interval": 1e-4},
    )
    method = Stepwise(Frozen(), FixedSteps(1e-4))
    with warnings.catch_warnings():
        warnings.simplefilter("error", CheckpointWarning)
        run = simulate(drive, tmp_path / "run.nc", integrator=method, checkpoint=1e-9)
    np.testing.assert_allclose(run.dataset.time, 1e-4 * np.arange(5))
    assert run.dataset.attrs["integrator"] == "frozen"
    assert run.dataset.attrs["drive_as_given"] == drive.text
    assert run.drive.belt_length != drive.belt_length
    assert float(run.dataset.span_tension[0].mean()) == pytest.approx(60.0, rel=1e-4)

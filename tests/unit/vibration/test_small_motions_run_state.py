"""States of runs over time: the modes about the end of a run that has settled are those about steady running."""

from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli import main
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.system.build import staying_system
from beltdyn.transient.beginning import instant_of
from beltdyn.vibration.modes import modes
from beltdyn.vibration.small_motions import state_of
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def settled(tmp_path_factory: pytest.TempPathFactory) -> bd.Run:
    """Case 2 of the paper at its full speed and load, which goes on in the steady running in which it begins."""
    loaded = better(loaded_two_pulley(), elements=30, frame="staying", duration=0.3)
    driver, driven = loaded.pulleys
    speed, torque = ({"kind": "constant", "value": value} for value in (120.0, -45.0))
    drive = loaded.replace(
        pulley=[driver.replace(speed=speed), driven.replace(torque=torque)],
        simulation=loaded.simulation.replace(start="steady"),
    )
    return bd.simulate(drive, tmp_path_factory.mktemp("settled") / "run.nc")


@pytest.fixture(scope="module")
def steady(settled: bd.Run) -> bd.Run:
    return bd.steady_state(settled.drive)


def test_the_belt_passes_as_in_steady_running(settled: bd.Run, steady: bd.Run) -> None:
    system, state, speed = state_of(settled, 0.3)
    assert speed == pytest.approx(steady.dataset.attrs["belt_parameter"], rel=1e-5)
    assert system.frame.speed[0] == speed
    assert state.velocity[system.first_body :][:2] == pytest.approx(steady.dataset.pulley_speed.values[-1], rel=1e-5)


def test_modes_of_a_settled_run_are_those_of_steady_running(settled: bd.Run, steady: bd.Run) -> None:
    """Frequencies to 0.1 %; those of their two meshes, of 30 and 40 elements, differ by 0.02 %.

    Damping of a thousandth differs by up to 7 % between meshes of 30 to 83 elements, and is compared on that of a run,
    which begins in steady running.
    """
    assert settled.path is not None
    run = bd.results.open_run(settled.path)
    found, expected = (modes(about, count=6).dataset for about in (run, steady))
    light = (found.damping_ratio < 0.5).values
    assert np.count_nonzero(light) == 6
    np.testing.assert_allclose(found.frequency[light], expected.frequency[light], rtol=1e-3)
    begun = modes(run, at=0.0, count=6).dataset
    np.testing.assert_allclose(found.damping_ratio, begun.damping_ratio, rtol=0.03)
    np.testing.assert_allclose(begun.damping_ratio, expected.damping_ratio, rtol=0.07)
    assert found.kind.values.tolist() == expected.kind.values.tolist()
    assert str(found.attrs["title"]).endswith("in its run at t = 0.3 s")
    again = modes(settled.drive, about=settled, at=0.3, count=2).dataset
    np.testing.assert_array_equal(again.frequency, found.frequency.sel(mode=again.mode))


@pytest.mark.slow
def test_modes_of_a_run_on_a_mesh_by_arcs_are_those_of_steady_running() -> None:
    """Belt that has gone over at each arc is no body; five modes below where the supports' short waves begin."""
    settings = {"duration": 0.02, "output_interval": 0.001, "start": "steady", "start_at": 3.0}
    drive = bd.example("package_conveyor").with_({f"simulation.{key}": value for key, value in settings.items()})
    run = bd.simulate(drive)
    assert np.abs(run.dataset.attrs["mesh_shifts"]).max() > 1e-3
    found, expected = (modes(about, count=5).dataset for about in (run, drive))
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=1e-3)
    np.testing.assert_allclose(found.damping_ratio, expected.damping_ratio, rtol=0.03)


def test_bending_has_the_hysteresis_of_the_drive(settled: bd.Run) -> None:
    belt = settled.drive.belt.replace(bending_loss_factor=0.3)
    drive = settled.drive.replace(belt=belt, simulation=settled.drive.simulation.replace(duration=1e-3))
    system, _, _ = state_of(bd.simulate(drive), 0.0)
    law = system.element.section
    assert law == staying_system(prepare(drive), system.length).element.section
    assert law.bending_hysteresis > 0.0


def test_instants_at_which_the_belt_was_recorded(settled: bd.Run) -> None:
    assert instant_of(settled, None) == pytest.approx(0.3)
    assert instant_of(settled, 0.123) == pytest.approx(0.123)
    with pytest.raises(ModelError, match=r"from 0 to 0.3 s, every 0.003 s, the nearest at 0.123 s"):
        modes(settled, at=0.1234)


def test_a_mesh_that_travels_has_none(drive: Drive) -> None:
    short = drive.replace(simulation=drive.simulation.replace(duration=1e-3, output_interval=1e-3))
    run = bd.simulate(short)
    with pytest.raises(ModelError, match='Run the drive again with frame = "staying"'):
        modes(run)


def test_options_that_do_not_go_with_a_run(settled: bd.Run, steady: bd.Run) -> None:
    with pytest.raises(ModelError, match="speed and pulley cannot be given with a run over time"):
        modes(settled, speed="800 rpm")
    with pytest.raises(ModelError, match="about cannot be given with a run"):
        modes(settled, about="rest")
    with pytest.raises(ModelError, match="speed, pulley and at require about"):
        modes(steady, at=0.1)


def test_the_command_takes_a_run(settled: bd.Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "modes.nc"
    with pytest.raises(SystemExit) as ended:
        main(["modes", str(settled.path), "--at", "0.15", "--count", "2", "-o", str(path)])
    assert ended.value.code == 0
    assert "in its run at t = 0.15 s" in " ".join(capsys.readouterr().out.split())
    with pytest.raises(SystemExit) as ended:
        main(["modes", str(path)])
    assert ended.value.code == 2
    assert "holds results of modes, not of a run" in " ".join(capsys.readouterr().err.split())

"""Runs that begin in a state of an earlier run: what one run in one go does, two do, one after the other."""

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli import main
from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps, load
from beltdyn.results import Run
from beltdyn.transient.beginning import _difference, with_instant
from beltdyn.transient.simulate import simulate

END, MIDDLE = 0.04, 0.02
RISE = {"kind": "cosine_ramp", "start": 0.0, "end": 0.2, "value": 12.0}
ENERGIES = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")
WORKS = ("driver_work", "friction_loss", "damping_loss", "bending_loss", "tensioner_loss")


def example(name: str, **settings: object) -> Drive:
    drive = load(str(files("beltdyn") / "examples" / f"{name}.toml"))
    return drive.with_({f"simulation.{key}": value for key, value in {"duration": END, **settings}.items()})


DRIVES: dict[str, Callable[[], Drive]] = {
    "staying": lambda: example("alternator_drive").with_({"belt.elements": 30}),
    "travelling": lambda: example("two_pulley", frame="travelling", start="equilibrium").with_(
        {"pulley[driver].speed": RISE}
    ),
}
"""With an arm, a clutch and a length that is found for the tension; and of the paper's elements."""


@pytest.fixture(scope="module", params=["staying", pytest.param("travelling", marks=pytest.mark.slow)])
def whole(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    return simulate(DRIVES[request.param](), tmp_path_factory.mktemp(request.param) / "whole.nc")


@pytest.fixture(scope="module")
def given(whole: Run) -> Drive:
    return bd.loads(whole.dataset.attrs.get("drive_as_given", whole.dataset.attrs["drive"]))


@pytest.fixture(scope="module")
def second(whole: Run, given: Drive, tmp_path_factory: pytest.TempPathFactory) -> Run:
    path = tmp_path_factory.mktemp("parts")
    simulate(given.with_({"simulation.duration": MIDDLE}), path / "first.nc").dataset.close()
    changes = {"simulation.duration": END - MIDDLE, "simulation.start": {"file": str(path / "first.nc")}}
    return simulate(given.with_(changes), path / "second.nc")


def scale(values: np.ndarray) -> float:
    return float(np.nanmax(np.abs(values)))


def test_time_energy_and_forces_are_continuous(whole: Run, second: Run) -> None:
    """States are recorded in double precision, but velocities of nodes with 24 binary digits: to 6e-8."""
    first = bd.results.open_run(second.drive.simulation.start.file).dataset  # type: ignore[union-attr]
    after = second.dataset
    assert float(first.time[-1]) == float(after.time[0]) == MIDDLE
    assert float(after.time[-1]) == pytest.approx(END, rel=1e-12)
    for name in (*ENERGIES, "pulley_speed", "pulley_angle", "span_tension"):
        large = scale(whole.dataset[name].values)
        np.testing.assert_allclose(after[name][0], first[name][-1], rtol=0.0, atol=2e-7 * large, err_msg=name)
    large = scale(first["hub_force"].values)
    np.testing.assert_allclose(after["hub_force"][0], first["hub_force"][-1], rtol=0.0, atol=1e-4 * large)


def test_two_runs_end_as_one(whole: Run, second: Run) -> None:
    """To the tolerance of steps, 1e-4: the second run takes new accelerations and begins with short steps."""
    last, mine = whole.dataset.isel(time=-1), second.dataset.isel(time=-1)
    for name in (*ENERGIES, "pulley_speed", "pulley_angle", "span_tension", "hub_force"):
        large = scale(whole.dataset[name].values)
        np.testing.assert_allclose(mine[name], last[name], rtol=0.0, atol=2e-4 * large, err_msg=name)
    first = bd.results.open_run(second.drive.simulation.start.file).dataset  # type: ignore[union-attr]
    for name in WORKS:
        together = float(first[name][-1] + mine[name])
        assert together == pytest.approx(
            float(last[name]), rel=1e-3, abs=1e-6 * scale(whole.dataset["driver_work"].values)
        )


def test_any_recorded_instant_and_another_clock(whole: Run, given: Drive) -> None:
    """From the middle of the whole run, with schedules from zero on: the speed jumps, places do not."""
    start = {"file": str(whole.path), "time": MIDDLE}
    run = simulate(given.with_({"simulation.start": start, "simulation.start_at": 0.0, "simulation.duration": 1e-3}))
    there = whole.dataset.sel(time=MIDDLE, method="nearest")
    assert float(run.dataset.time[0]) == 0.0
    np.testing.assert_array_equal(run.dataset.pulley_angle[0], there.pulley_angle)
    np.testing.assert_allclose(run.dataset.strain_energy[0], there.strain_energy, rtol=1e-12)


def test_loads_and_speeds_may_differ(whole: Run, given: Drive) -> None:
    """A driver that is let go turns on by its inertia: its speed does not jump."""
    driver = next(number for number, one in enumerate(given.pulleys) if one.prescribed)
    pulleys = list(given.pulleys)
    pulleys[driver] = pulleys[driver].replace(speed=None, harmonics=(), inertia=10.0)
    settings = given.simulation.replace(start={"file": str(whole.path)}, duration=1e-3)
    run = simulate(given.replace(pulley=pulleys, simulation=settings))
    speeds = run.dataset.pulley_speed.isel(pulley=driver)
    assert float(speeds[0]) == float(whole.dataset.pulley_speed.isel(pulley=driver)[-1])
    assert float(speeds[-1]) == pytest.approx(float(speeds[0]), rel=1e-2)


def test_the_drive_of_a_run_begins_in_it_too(whole: Run) -> None:
    """It has the length that was found."""
    again = whole.drive.with_({"simulation.start": {"file": str(whole.path)}, "simulation.duration": 1e-3})
    found = simulate(again)
    assert found.drive.belt_length == whole.drive.belt_length
    np.testing.assert_allclose(found.dataset.strain_energy[0], whole.dataset.strain_energy[-1], rtol=1e-12)


@pytest.mark.parametrize(
    "changes",
    [
        {"belt.mass_per_length": 0.2},
        pytest.param({"contact.stiffness": 1e8}, marks=pytest.mark.slow),
        pytest.param({"gravity": (0.0, -9.81)}, marks=pytest.mark.slow),
    ],
)
def test_what_must_agree(whole: Run, given: Drive, changes: dict[str, object]) -> None:
    other = given.with_({**changes, "simulation.start": {"file": str(whole.path)}})
    with pytest.raises(ModelError, match=r"simulation\.start: .* in this drive but .* Make it the same") as error:
        simulate(other)
    assert next(iter(changes)).split(".")[0] in str(error.value)


def test_frame_mesh_and_instant_must_fit(whole: Run, given: Drive) -> None:
    start = {"simulation.start": {"file": str(whole.path)}}
    frame = "travelling" if given.frame.stays else "staying"
    with pytest.raises(ModelError, match=r"simulation\.frame is .* in this drive"):
        simulate(given.with_({**start, "simulation.frame": frame}))
    with pytest.raises(ModelError, match=r"belt\.elements is .* in this drive"):
        simulate(given.with_({**start, "belt.elements": 60}))
    with pytest.raises(ModelError, match=r"time = 0.02034 s is not an output along the belt"):
        simulate(given.with_({"simulation.start": {"file": str(whole.path), "time": 0.02034}}))


def test_entries_without_names_are_told_by_their_number() -> None:
    mine, other = ({"end": [{"kind": "held"}, {"kind": "weight", "mass": mass}]} for mass in (1.0, 2.0))
    assert _difference(mine, other) == ("end[2].mass", "1.0", "2.0")
    assert _difference(mine, mine) is None


def test_what_is_no_earlier_run(given: Drive, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"simulation\.start: .*none.nc"):
        simulate(given.with_({"simulation.start": {"file": str(tmp_path / "none.nc")}}))
    (tmp_path / "text.nc").write_text("no result", encoding="utf-8")
    with pytest.raises(ModelError, match=r"simulation\.start: .*text.nc"):
        with_instant(given.with_({"simulation.start": {"file": str(tmp_path / "text.nc")}}))
    bd.equilibrium(given).save(tmp_path / "rest.nc")
    with pytest.raises(ModelError, match=r"simulation\.start: .*rest.nc is the result of another analysis"):
        with_instant(given.with_({"simulation.start": {"file": str(tmp_path / "rest.nc")}}))


def test_a_checkpoint_goes_on_with_its_own_run_alone(tmp_path: Path) -> None:
    checkpoint = tmp_path / "run.checkpoint"
    checkpoint.write_bytes(b"beltdyn checkpoint 0.1.0\n")
    with pytest.raises(ModelError, match=r"is a checkpoint, .*beltdyn simulate --resume .*run\.nc") as error:
        with_instant(DRIVES["travelling"]().with_({"simulation.start": {"file": str(checkpoint)}}))
    assert "give its result file" in str(error.value)


def test_the_command_tells_what_is_wrong(given: Drive, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 2, no traceback, and nothing written."""
    path = tmp_path / "drive.toml"
    path.write_text(dumps(given.with_({"simulation.start": {"file": str(tmp_path / "none.nc")}})), encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        main(["simulate", str(path), "-o", str(tmp_path / "out.nc")])
    assert ended.value.code == 2
    assert "simulation.start" in capsys.readouterr().err
    assert not (tmp_path / "out.nc").exists()

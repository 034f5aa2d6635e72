"""Units of both versions of FMI, written, checked and simulated by fmpy.

A host that is Python itself needs no more than that; the packages bring binaries for Linux and Windows alone.
"""

import sys
import zipfile
from collections.abc import Callable, Sequence
from math import isnan
from pathlib import Path
from shutil import move
from typing import Any

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from pythonfmu import FmuBuilder

from beltdyn.cosimulation import fmu
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, example, load, loads
from beltdyn.transient.simulate import simulate
from beltdyn.transient.simulator import Simulator

pytestmark = pytest.mark.skipif(not FmuBuilder.has_binary(), reason="pythonfmu has no binary for this system")

SPEED, TORQUE = "pulley[driver].speed", "pulley[driven].torque"
CENTER = "pulley[driven].center[1]"
BOTH = ("2.0", "3.0")
STEP = 1e-3

Hosts = Callable[[Path], Any]
"""Makes a program that simulates a unit; see conftest."""


@pytest.fixture(scope="module", params=["3.0", pytest.param("2.0", marks=pytest.mark.slow)])
def unit(request: pytest.FixtureRequest, short: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fmu(short, tmp_path_factory.mktemp("units") / "drive.fmu", fmi=request.param)


def test_it_is_valid_and_tells_of_its_variables(unit: Path, short: Drive) -> None:
    assert validate_fmu(str(unit)) == []
    described = fmpy.read_model_description(str(unit))
    assert described.modelName == short.title
    assert described.coSimulation.canGetAndSetFMUstate or described.coSimulation.canGetAndSetFMUState
    assert described.coSimulation.canHandleVariableCommunicationStepSize
    experiment = described.defaultExperiment
    told = (experiment.startTime, experiment.stopTime, experiment.stepSize, experiment.tolerance)
    assert [float(one) for one in told] == [0.0, 0.03, 1e-3, 1e-4]
    variables = {one.name: one for one in described.modelVariables}
    speed, torque, load_ = variables[SPEED], variables[TORQUE], variables["hub_load[driver]"]
    assert (speed.causality, speed.unit, float(speed.start)) == ("input", "rad/s", 0.0)
    assert (torque.causality, torque.unit, float(torque.start)) == ("input", "N m", -0.1)
    assert (load_.causality, load_.unit, load_.start) == ("output", "N", None)
    assert load_.description == "Hub load, magnitude: driver"
    assert float(variables["simulation.rtol"].start) == 1e-4
    assert [one for one in variables.values() if one.causality == "output"] == [
        one.variable for one in described.outputs
    ]
    assert all(one.dependencies == [] for one in described.outputs)
    units = {one.name: one.baseUnit for one in described.unitDefinitions}
    assert (units["N m"].kg, units["N m"].m, units["N m"].s, units["rad/s"].rad) == (1, 2, -2, 1)


@pytest.mark.slow
def test_it_runs_as_a_simulator_does_after_it_was_moved(unit: Path, short: Drive, tmp_path: Path) -> None:
    """To the bit, by the schedule of the file; as `simulate` to 1e-9, whose outputs are where the host steps to."""
    other = tmp_path / "an other place"
    other.mkdir()
    moved = Path(move(fmu(short, tmp_path / unit.name, fmi=_version(unit)), other))
    found = fmpy.simulate_fmu(str(moved), output_interval=STEP, fmi_call_logger=None)
    simulator = Simulator(short)
    for row in found[1:]:
        simulator.step(float(row["time"]))
    assert len(found) == 31
    assert {name: float(found[-1][name]) for name in simulator.outputs()} == simulator.outputs()
    run = simulate(short).dataset
    for name in ("driver", "driven"):
        for variable in ("pulley_speed", "shaft_torque", "pulley_angle"):
            expected = run[variable].sel(pulley=name).values
            scale = float(abs(expected).max())
            assert found[f"{variable}[{name}]"] == pytest.approx(expected, rel=1e-9, abs=1e-9 * scale)


@pytest.mark.slow  # kernels of spread teeth over time
def test_a_toothed_drive_runs_as_it_does_without_a_host(tmp_path: Path) -> None:
    drive = example("timing_drive").with_({"simulation.duration": 5e-3})
    found = fmpy.simulate_fmu(str(fmu(drive, tmp_path / "drive.fmu")), output_interval=STEP)
    speeds = {name: found[f"pulley_speed[{name}]"] for name in ("crankshaft", "camshaft")}
    assert speeds["camshaft"].mean() == pytest.approx(0.5 * speeds["crankshaft"].mean(), rel=1e-3)
    simulator = Simulator(drive)
    for row in found[1:]:
        simulator.step(float(row["time"]))
    assert {name: float(found[-1][name]) for name in simulator.outputs()} == simulator.outputs()


def _version(path: Path) -> str:
    return str(fmpy.read_model_description(str(path)).fmiVersion)


def test_inputs_act_as_those_of_a_simulator(unit: Path, short: Drive, host: Hosts) -> None:
    """Steps of any length, inputs that are set each time whether they change or not."""
    one, simulator = host(unit).begin(), Simulator(short)
    torques: Sequence[float] = (-0.1, -0.3, -0.3, 0.2)
    now = 0.0
    for number, (torque, size) in enumerate(zip(torques, (1e-3, 0.7e-3, 2.3e-3, 1e-4), strict=True)):
        one.put(SPEED, 1.0)
        one.put(TORQUE, torque)
        one.unit.doStep(now, size)
        if number == 0:
            simulator.set_speed("driver", 1.0)
        if number in (0, 1, 3):
            simulator.set_torque("driven", torque)
        simulator.step(now + size)
        now += size
    assert one.outputs() == simulator.outputs()


def test_going_back_leads_to_the_same_to_the_bit(unit: Path, host: Hosts) -> None:
    """In the same unit, and by way of bytes in another one."""
    one, other = host(unit).begin(), host(unit).begin()
    one.put(TORQUE, -0.4)
    one.step(0)
    state = one.save()
    data = one.to_bytes(state)
    one.step(1)
    expected = one.outputs()
    one.put(TORQUE, 3.0)
    one.step(2)
    assert one.outputs() != expected
    one.restore(state)
    one.step(1)
    assert one.outputs() == expected
    other.restore(other.from_bytes(data))
    other.step(1)
    assert other.outputs() == expected


@pytest.mark.parametrize("version", BOTH)
def test_a_center_is_moved_and_taken_back(short: Drive, tmp_path: Path, host: Hosts, version: str) -> None:
    """As `Simulator.set_center` does, to the bit; a state that is set back has the center where it was."""
    path = fmu(short, tmp_path / "drive.fmu", [CENTER], fmi=version)
    assert validate_fmu(str(path)) == []
    one, simulator = host(path).begin(), Simulator(short)
    (variable,) = [named for named in one.description.modelVariables if named.name == CENTER]
    assert (variable.causality, variable.unit, float(variable.start)) == ("input", "m", short.pulleys[1].center[0])
    x, y = simulator.center("driven")
    for number in range(3):
        if number == 1:
            state = one.save()
        if number:
            one.put(CENTER, x + 1e-4 * number)
            simulator.set_center("driven", (x + 1e-4 * number, y))
        one.step(number)
        simulator.step(number * STEP + STEP)
    assert one.outputs() == simulator.outputs()
    one.restore(state)
    one.put(CENTER, x)
    one.step(1)
    assert one.outputs() != simulator.outputs()
    one.restore(state)
    for number in (1, 2):
        one.put(CENTER, x + 1e-4 * number)
        one.step(number)
    assert one.outputs() == simulator.outputs()


def test_two_instances_know_nothing_of_each_other(unit: Path, host: Hosts) -> None:
    """Nor does one of the other version, in the same process."""
    alone = host(unit).begin()
    for number in range(3):
        alone.step(number)
    expected = alone.outputs()
    one, other = host(unit).begin(), host(unit).begin()
    other.put(TORQUE, 5.0)
    for number in range(3):
        one.step(number)
        other.step(number)
    assert one.outputs() == expected
    assert other.outputs() != expected


def test_reset_and_terminate(unit: Path, host: Hosts) -> None:
    one = host(unit).begin()
    one.step(0)
    first = one.outputs()
    one.put(TORQUE, 1.0)
    one.step(1)
    one.unit.terminate()
    one.unit.reset()
    one.begin()
    one.step(0)
    assert one.outputs() == first


@pytest.mark.parametrize("fmi", BOTH)
def test_a_step_that_fails_is_told_and_changes_nothing(fmi: str, light: Drive, host: Hosts, tmp_path: Path) -> None:
    """As an error by FMI 3.0; by FMI 2.0 it is discarded, the only failure that pythonfmu passes on beside a crash."""
    one = host(fmu(light, tmp_path / "drive.fmu", fmi=fmi)).begin()
    one.step(0)
    before = one.outputs()
    one.put(TORQUE, 1e15)
    with pytest.raises(
        FMICallException, match="DoStep failed with status 3" if one.newer else "DoStep failed with status 2"
    ):
        one.step(1)
    assert one.logged[-1].startswith("the simulation fails at t = 0.001")
    assert one.outputs() == before
    one.put(TORQUE, -0.1)
    one.step(1)
    with pytest.raises(FMICallException, match="DoStep failed"):
        one.step(7)
    assert "a step is requested from t = 0.007 s, but the drive is at t = 0.002 s" in one.logged[-1]


def test_what_a_host_must_not_set_changes_nothing_and_its_next_step_fails(unit: Path, host: Hosts) -> None:
    """An exception would be fatal, and end the process: outputs, unknown references and other types than numbers."""
    one, other = host(unit).begin(), host(unit).begin()
    real, text = ("Float64", "Int64") if one.newer else ("Real", "Integer")
    attempts: list[tuple[str, list[int], list[Any], str]] = [
        (f"set{real}", [one.references["pulley_speed[driver]"]], [1.0], "pulley_speed[driver] is an output"),
        (
            f"set{real}",
            [one.references[TORQUE], 2**32 - 1],
            [9.0, 1.0],
            "no variable has the value reference 4294967295",
        ),
        (f"set{text}", [one.references[TORQUE]], [1], f"{TORQUE} is a real number"),
        ("setString", [one.references[TORQUE]], ["1"], f"{TORQUE} is a real number"),
        ("setBoolean", [12345], [True], "no variable has the value reference 12345"),
    ]
    for number, (function, references, values, message) in enumerate(attempts):
        getattr(one.unit, function)(references, values)
        assert one.logged[-1].startswith(message)
        with pytest.raises(FMICallException, match=r"DoStep failed with status [23]"):
            one.step(number)
        assert message in one.logged[-1]
        one.step(number)
        other.step(number)
    assert one.outputs() == other.outputs()


def test_what_is_not_there_is_read_as_nothing_with_a_message(unit: Path, host: Hosts) -> None:
    one = host(unit).begin()
    real, text = ("Float64", "Int64") if one.newer else ("Real", "Integer")
    speed = one.references["pulley_speed[driver]"]
    known, unknown = getattr(one.unit, f"get{real}")([speed, 12345])
    assert known == one.get("pulley_speed[driver]")
    assert isnan(unknown)
    assert one.logged[-1] == "no variable has the value reference 12345"
    assert list(getattr(one.unit, f"get{text}")([speed])) == [0]
    assert one.logged[-1].startswith("pulley_speed[driver] is a real number")
    assert [bool(value) for value in one.unit.getBoolean([speed])] == [False]
    assert list(one.unit.getString([speed])) in ([b""], [""])  # FMPy gives bytes in FMI 2.0
    if one.newer:
        assert list(one.unit.getUInt64([speed])) == [0]
        assert list(one.unit.getInt32([speed])) == [0]
    one.step(0)


def test_a_beginning_that_fails_is_told(unit: Path, host: Hosts) -> None:
    """A tolerance that is none: the first step fails; then the unit can be begun anew, with another one."""
    one = host(unit)
    one.put("simulation.rtol", 2.0)
    one.begin()
    assert "simulation.rtol = 2.0" in one.logged[-1]
    with pytest.raises(FMICallException, match="DoStep failed"):
        one.step(0)
    assert "the drive is not initialized" in one.logged[-1]
    one.unit.reset()
    one.put("simulation.rtol", 1e-3)
    one.begin()
    one.step(0)


def test_the_stop_time_and_the_tolerance_of_the_host_hold_by_fmi_2(short: Drive, host: Hosts, tmp_path: Path) -> None:
    """By FMI 3.0 the package hands on neither; there the tolerance is a parameter alone."""
    unit = fmu(short, tmp_path / "drive.fmu")
    one, other = host(unit).begin(tolerance=1e-3, stopTime=0.001), host(unit)
    other.put("simulation.rtol", 1e-3)
    other.begin()
    for each in (one, other):
        each.step(0)
    assert one.outputs() == other.outputs()
    with pytest.raises(FMICallException, match="DoStep failed"):
        one.step(1)
    assert "after the stop time 0.001 s" in one.logged[-1]


def test_the_clock_of_the_host_may_begin_anywhere(unit: Path, host: Hosts) -> None:
    one, other = host(unit).begin(), host(unit).begin(100.0)
    for number in range(2):
        one.step(number, 2.0**-10)
        other.step(number, 2.0**-10, 100.0)
    assert one.outputs() == other.outputs()
    if other.newer:
        assert other.get("time") == 100.0 + 2.0**-9


def test_tables_of_the_drive_file_are_inside(short: Drive, drive_text: str, tmp_path: Path) -> None:
    """A speed from a CSV file that is gone by the time the unit runs."""
    (tmp_path / "speed.csv").write_text("time,speed\n0,0\n0.01,3\n", encoding="utf-8")
    file = tmp_path / "drive.toml"
    speed = next(line for line in drive_text.splitlines() if line.startswith("speed = "))
    file.write_text(drive_text.replace(speed, 'speed = { kind = "table", file = "speed.csv" }'), encoding="utf-8")
    drive = load(file)
    unit = fmu(drive, tmp_path / "drive.fmu", outputs=["pulley_speed"])
    for one in (file, tmp_path / "speed.csv"):
        one.unlink()
    with zipfile.ZipFile(unit) as archive:
        assert loads(archive.read("resources/drive.toml").decode()) == drive
    found = fmpy.simulate_fmu(str(unit), stop_time=0.01, output_interval=0.005)
    assert found["pulley_speed[driver]"] == pytest.approx([0.0, 1.5, 3.0])


def test_another_version_of_beltdyn_is_told(
    short: Drive, host: Hosts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unit = fmu(short, tmp_path / "drive.fmu")
    monkeypatch.setattr("beltdyn.cosimulation.slave.__version__", "99.0")
    one = host(unit).begin()
    assert one.logged[-1].endswith("but runs with beltdyn 99.0.")
    one.step(0)


def test_writing_leaves_no_trace_and_replaces_units_alone(short: Drive, tmp_path: Path) -> None:
    paths, file = list(sys.path), tmp_path / "drive.fmu"
    fmu(short, file, [], [])
    assert sys.path == paths
    assert [one.name for one in tmp_path.iterdir()] == ["drive.fmu"]
    fmu(short, file, [SPEED], ["pulley_speed"], fmi="3.0")
    causes = [one.causality for one in fmpy.read_model_description(str(file)).modelVariables]
    assert causes == ["independent", "parameter", "input", "output", "output"]
    file.write_text("mine", encoding="utf-8")
    with pytest.raises(ModelError, match="already exists"):
        fmu(short, file)
    assert file.read_text(encoding="utf-8") == "mine"
    assert fmu(short, file, overwrite=True) == file


def test_names_that_are_no_identifiers(short: Drive, tmp_path: Path) -> None:
    for name in ("2 pulleys, ä.fmu", "ok.fmu"):
        unit = fmu(short, tmp_path / name, outputs=["kinetic_energy"])
        assert validate_fmu(str(unit)) == []


def test_what_cannot_be_written_is_told(short: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "drive.fmu"
    with pytest.raises(ModelError, match="runs on other machines"):
        fmu(short.with_({"simulation.start": {"file": "run.nc"}}), tmp_path / "drive.fmu")
    with pytest.raises(ModelError, match=r"must end in \.fmu"):
        fmu(short, tmp_path / "drive.zip")
    with pytest.raises(ModelError, match=r"fmi = '1.0' is not a supported FMI version. Choose 2.0 or 3.0."):
        fmu(short, file, fmi="1.0")
    with pytest.raises(ModelError, match="Did you mean"):
        fmu(short, file, ["pulley[driver].spead"])
    with pytest.raises(ModelError, match="supports only generalized_alpha"):
        fmu(short.with_({"simulation.integrator": "radau"}), file)
    monkeypatch.setattr("beltdyn.cosimulation.component.Simulator", _fails)
    with pytest.raises(ConvergenceError, match="no state"):
        fmu(short, file)
    monkeypatch.setitem(sys.modules, "pythonfmu3", None)
    with pytest.raises(ModelError, match=r"pythonfmu3 is not installed.*with its extra beltdyn\[fmu\]"):
        fmu(short, file, fmi="3.0")
    assert list(tmp_path.iterdir()) == []


def _fails(drive: Drive, progress: object = None) -> Simulator:
    raise ConvergenceError("there is no state to begin with.")

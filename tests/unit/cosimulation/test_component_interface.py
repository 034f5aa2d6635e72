"""What can be set and read of a drive, and how it is chosen."""

from importlib.resources import files
from pathlib import Path

import pytest

from beltdyn.cosimulation.component import Interface, choose_inputs, choose_outputs, inputs_of
from beltdyn.errors import ModelError
from beltdyn.model import Drive, loads
from beltdyn.results import RECORDED


def test_speeds_of_drivers_and_torques_of_others_can_be_set(drive: Drive) -> None:
    assert list(inputs_of(drive))[:2] == ["pulley[driver].speed", "pulley[driven].torque"]
    constant = {"kind": "constant", "value": "30 rpm"}
    faster = drive.with_({"pulley[driver].speed": constant, "pulley[driven].torque": None})
    (speed,) = choose_inputs(faster, None)
    assert (speed.name, speed.unit, speed.is_speed) == ("pulley[driver].speed", "rad/s", True)
    assert speed.start == pytest.approx(3.14159, rel=1e-5)
    assert choose_inputs(faster, ["pulley[driven].torque"])[0].start == 0.0


def test_centers_are_set_where_they_are_asked_for_and_no_spring_moves_them(drive: Drive) -> None:
    assert [one.name for one in choose_inputs(drive, None)] == ["pulley[driver].speed", "pulley[driven].torque"]
    x, y = choose_inputs(drive, ["pulley[driven].center[1]", "pulley[driven].center[2]"])
    assert (x.unit, x.coordinate, x.is_speed, x.start) == ("m", 0, False, drive.pulleys[1].center[0])
    assert (y.coordinate, y.meaning) == (1, "Center, y: driven")
    sprung = loads(files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8"))
    assert "pulley[tensioner].center[1]" not in inputs_of(sprung)
    assert "pulley[alternator].center[1]" in inputs_of(sprung)


def test_outputs_are_chosen_by_name_or_family(drive: Drive) -> None:
    one, *others = choose_outputs(drive, ["shaft_torque[driver]", "pulley_speed"])
    assert (one.name, one.unit, one.meaning) == ("shaft_torque[driver]", "N m", "Torque on the pulley's shaft: driver")
    assert [other.name for other in others] == ["pulley_speed[driver]", "pulley_speed[driven]"]
    every = {one.name: one for one in choose_outputs(drive, None)}
    assert {"hub_load[driven]", "span_tension[driver-driven]", "kinetic_energy", "driver_work"} < every.keys()
    assert every["friction_loss"].meaning == RECORDED["friction_loss"].long_name
    assert choose_outputs(drive, []) == ()


def test_an_arm_turns_by_an_angle() -> None:
    drive = loads(files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8"))
    (place,) = choose_outputs(drive, ["tensioner_position"])
    assert (place.name, place.unit) == ("tensioner_position[tensioner]", "rad")


@pytest.mark.parametrize(
    ("inputs", "outputs", "sentence"),
    [
        (["pulley[driver].sped"], None, 'is not an input of this drive. Did you mean "pulley[driver].speed"?'),
        (["pulley[driver].torque"], None, "'pulley[driver].torque' is not an input of this drive."),
        (None, ["shaft_torqe"], 'is not an output of this drive. Did you mean "shaft_torque"?'),
        (None, ["drive.fmu"], "'drive.fmu' is not an output of this drive. Give the file with -o."),
        (["zzz"], None, "Choose one of pulley[driver].speed, pulley[driven].torque, pulley[driver].center[1], "),
    ],
)
def test_wrong_names_are_told(inputs: list[str] | None, outputs: list[str] | None, sentence: str, drive: Drive) -> None:
    with pytest.raises(ModelError) as told:
        (choose_inputs(drive, inputs), choose_outputs(drive, outputs))
    assert sentence in str(told.value)


def test_it_is_written_and_read(drive: Drive, tmp_path: Path) -> None:
    chosen = choose_inputs(drive, None), choose_outputs(drive, None)
    interface = Interface("Drive", "drive", 0.0, 1.0, 1e-3, 1e-4, *chosen)
    interface.write(tmp_path)
    assert Interface.read(tmp_path) == interface

"""Loads of pulleys on their belt, by hand."""

from math import pi

import pytest

from beltdyn.model import loads
from beltdyn.theory.rating import RUN_IN, least_tension

TEXT = """
belt = {{ profile = "{profile}"{size}, installed_tension = "2 kN" }}
limits = {{ service_factor = 1.25 }}
pulley = [
  {{ name = "motor", center = [0, 0], {small}, speed = "{sense}1000 rpm" }},
  {{ name = "pump", center = ["900 mm", 0], {large}, inertia = 1.0, torque = "{brake}300 N m" }},
]
"""
SIZES = {"small": 'diameter = "200 mm"', "large": 'diameter = "400 mm"'}


@pytest.mark.parametrize(("sense", "brake"), [("", "-"), ("-", "")])
def test_power_and_tension_follow_from_torque_and_speed_in_either_sense(sense: str, brake: str) -> None:
    drive = loads(TEXT.format(profile="SPB", size=", ribs = 3", sense=sense, brake=brake, **SIZES))
    taken, speed = drive.belt_loads(0).powers_drawn(drive.path)
    power = 300.0 * 500.0 * pi / 30.0
    assert taken.tolist() == pytest.approx([0.0, power])
    assert speed == pytest.approx(0.1 * 1000.0 * pi / 30.0)
    required = drive.belt_loads(0).required_tension(drive.path)
    assert required is not None
    assert required.pull == pytest.approx(1.25 * power / speed)
    wrap = float(drive.path.wrap_angles.min())
    least = least_tension(required.pull, wrap, 3 * 0.194, speed)
    assert required.tension == pytest.approx(least)
    assert drive.belt_loads(0).run_in_tension(drive.path) == pytest.approx(RUN_IN * least)


MOTORS = {
    "servo_motor": 'speed = "{sense}1000 rpm", proportional_gain = 5, integral_time = "0.1 s", torque_limit = 400',
    "motor": 'breakdown_torque = 900, breakdown_slip = 0.2, synchronous_speed = "{sense}1000 rpm"',
    "induction_motor": 'rated_power = "20 kW", rated_speed = "{sense}970 rpm", locked_rotor_ratio = 2, '
    "breakdown_ratio = 2.6",
    "table": "speeds = {speeds}, torques = {torques}",
}
TURNING = {"speeds": "['0 rpm', '900 rpm', '1000 rpm']", "torques": "[300, 200, 0]"}
BACKWARDS = {"speeds": "['-1000 rpm', '-900 rpm', '0 rpm']", "torques": "[0, -200, -300]"}


@pytest.mark.parametrize("rotation", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("sense", ["", "-"])
@pytest.mark.parametrize("kind", MOTORS)
def test_motors_drive_in_their_sense(kind: str, sense: str, rotation: str) -> None:
    """The power is that of a prescribed speed, and the belt runs as the motor turns."""
    text = TEXT.format(profile="SPB", size=", ribs = 3", sense=sense, brake="" if sense else "-", **SIZES)
    keys = MOTORS[kind].format(sense=sense, **(BACKWARDS if sense else TURNING))
    load = f'inertia = 0.1, load = [{{ kind = "{kind}", {keys} }}]'
    driven = loads(f'rotation = "{rotation}"\n' + text.replace(f'speed = "{sense}1000 rpm"', load))
    taken, speed = driven.belt_loads(0).powers_drawn(driven.path)
    assert taken.tolist() == pytest.approx([0.0, 300.0 * 500.0 * pi / 30.0])
    assert speed == pytest.approx(0.1 * 1000.0 * pi / 30.0)
    assert driven.running_sense == (-1 if sense else 1) * (1 if rotation == "counter-clockwise" else -1)


def test_there_is_no_rule_for_driving_loads_and_none_of_running_in_for_teeth() -> None:
    driving = loads(TEXT.format(profile="SPB", size=", ribs = 3", sense="", brake="", **SIZES))
    assert driving.belt_loads(0).required_tension(driving.path) is None
    sizes = {"small": "teeth = 40", "large": "teeth = 80"}
    text = TEXT.format(profile="HTD 8M", size=', width = "50 mm"', sense="", brake="-", **sizes)
    toothed = loads(text.replace('installed_tension = "2 kN"', "teeth = 285"))
    assert toothed.belt_loads(0).required_tension(toothed.path) is not None
    assert toothed.belt_loads(0).run_in_tension(toothed.path) is None

"""Linear axes that cannot run: one clear error each; the carriage holds both ends in running order."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Carriage, Drive, FixedEnd, dumps, example, loads, prepare
from beltdyn.model.end import carriage_rate, free_stroke, turned

AXIS = example("printer_axis")
TEXT = AXIS.text
SPEED = TEXT[TEXT.index("speed = {") : TEXT.index("}", TEXT.index("speed = {")) + 1]


@pytest.mark.parametrize(
    ("given", "changed", "told"),
    [
        ("teeth = 330", "teeth = 330.5", r"belt\.teeth = 330\.5 must be a whole number"),
        (
            'name = "idler"\ncenter',
            'name = "idler"\nside = "outside"\ncenter',
            'teeth = 20 is incompatible with side = "outside": the back of the belt has no teeth',
        ),
        ('tension = "20 N"', 'tension = "20 N"\ncrossed = true', "crossed = true is incompatible with teeth"),
        ("teeth = 20\ninertia", 'teeth = 20\ndiameter = "15 mm"\ninertia', "but the belt has a pitch of 2 mm"),
        (
            '"-120 mm", "120 mm"',
            '"-150 mm", "150 mm"',
            r"stroke = \[-0\.15, 0\.15\] m is longer than the belt between the pulleys",
        ),
        (
            '"2.5 turn", "0 turn"',
            '"2.5 turn", "4 turn"',
            r'the speed of "motor" moves "carriage" to 0\.16 m, beyond its stroke, -0\.12 to 0\.12 m',
        ),
        ('"-120 mm", "120 mm"', '"10 mm", "120 mm"', "must be a lower and an upper way on both sides of zero"),
        ('"150 mm", "6.366 mm"', '"150 mm", "30 mm"', r"it must run along it within 5°\. Move center"),
        (SPEED, "inertia = 1e-5", 'nothing moves "carriage": no pulley of the axis has a speed, a motor or a torque'),
        (
            "[carriage]",
            '[[end]]\nname = "a"\nkind = "fixed"\npoint = [0, 0.1]\n[carriage]',
            "the carriage holds both ends",
        ),
        (
            "[simulation]",
            "[simulation]\nforce_tolerance = 0.01",
            r"force_tolerance = 0\.01 is incompatible with \[carriage\]: the mesh of an axis is not refined",
        ),
    ],
)
def test_what_cannot_run_is_told(given: str, changed: str, told: str) -> None:
    assert TEXT.count(given) == 1
    with pytest.raises(ModelError, match=told):
        loads(TEXT.replace(given, changed))


def test_a_move_that_comes_too_early_is_told_with_its_time() -> None:
    with pytest.raises(ModelError, match=r"move 1 takes from 0\.05 to .* s, but the next one begins at 0\.1 s"):
        loads(TEXT.replace('"0.5 s"', '"0.1 s"'))


def test_ends_are_those_of_the_carriage_in_running_order() -> None:
    """The belt leaves the carriage towards the first pulley."""
    first, last = AXIS.ends
    assert isinstance(first, FixedEnd)
    assert isinstance(last, FixedEnd)
    assert first.point == pytest.approx((0.135, 6.366e-3))
    assert last.point == pytest.approx((0.165, 6.366e-3))
    assert AXIS.spans[-1] == ("carriage out", "motor")
    assert AXIS.carriage is not None
    assert free_stroke(AXIS.carriage, AXIS.path) == pytest.approx((-0.1603, 0.135), rel=1e-3)


def test_a_turn_moves_it_by_the_teeth_of_the_motor() -> None:
    assert AXIS.carriage is not None
    assert carriage_rate(AXIS.carriage, AXIS.path, 0) * 6.283185307 == pytest.approx(0.040, rel=1e-6)
    other = AXIS.carriage.replace(direction=(1.0, 0.0))
    assert carriage_rate(other, AXIS.path, 0) == -carriage_rate(AXIS.carriage, AXIS.path, 0)


def test_ways_are_looked_at_where_a_move_turns_back() -> None:
    """2.5 turns there and back within a second: the extremes are exact."""
    speed = AXIS.pulleys[0].speed
    assert speed is not None
    angles = turned(speed, 1.0)
    assert angles.max() == pytest.approx(5.0 * np.pi, rel=1e-12)
    assert angles.min() == pytest.approx(0.0, abs=1e-9)
    assert turned(speed, 1.0) is angles  # for the same move it is found once


def test_the_mesh_stays_at_arcs_unless_single_teeth_travel() -> None:
    assert AXIS.frame.stays
    assert not AXIS.with_({"belt.toothing.law": "discrete"}).frame.stays
    with pytest.raises(ModelError, match="no belt flows past its ends"):
        example("band_brake").with_({"simulation.frame": "staying"})


def test_the_carriage_keeps_from_pulleys_by_its_stroke_its_move_or_its_room() -> None:
    """Without stops a driver with prescribed speed moves it by 100 mm; with a torque it may go to the pulleys."""
    assert AXIS.carriage is not None
    assert prepare(AXIS).carriage_range == (-0.12, 0.12)
    free = AXIS.replace(carriage=AXIS.carriage.replace(stroke=None))
    assert prepare(free).carriage_range == pytest.approx((0.0, 0.1), abs=1e-3)
    moved = {"name": "motor", "center": [0.0, 0.0], "teeth": 20, "inertia": 1e-5, "torque": 0.1}
    driven = free.replace(pulley=[moved, AXIS.pulleys[1]])
    assert prepare(driven).carriage_range == free_stroke(AXIS.carriage, driven.path)


def test_it_is_written_and_read() -> None:
    assert loads(dumps(AXIS)) == AXIS
    with pytest.raises(ModelError, match="stroke is missing"):
        Carriage(center=[0, 0], direction=[1, 0], mass=1.0, stop_stiffness=1e5)


def test_a_drive_without_carriage_has_its_own_ends() -> None:
    brake: Drive = example("band_brake")
    assert [end.name for end in brake.ends] == ["anchor", "weight"]
    assert brake.carriage is None


def test_a_tensioner_that_yields_is_refused() -> None:
    fixed = 'kind = "fixed"\npulley = "idler"\ndirection = [1, 0]'
    sprung = fixed.replace("fixed", "sliding") + '\npreload = "60 N"\nmass = "0.1 kg"'
    text = TEXT.replace('installed_tension = "20 N"\n', "").replace(fixed, sprung)
    with pytest.raises(ModelError, match='the spring-loaded tensioner of "idler" is incompatible with'):
        loads(text)

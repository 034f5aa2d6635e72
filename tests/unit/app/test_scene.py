"""What the canvas draws: geometry by hand."""

import json
import math
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

from beltdyn.app.draft import draft
from beltdyn.app.scene import length_in, scene
from beltdyn.model import Drive, load

HERE = Path()


def test_two_equal_pulleys_are_drawn_to_scale(drive: Drive) -> None:
    drawn = scene(draft(drive.data, HERE))
    first, second = drawn["pulleys"]
    assert (first["x"], first["y"], first["r"]) == pytest.approx((-191.441, 0.0, 81.25))
    assert first["wrap"] == second["wrap"] == "180.0°"
    assert (first["drives"], second["drives"]) == (True, False)
    assert [one["length"] for one in drawn["spans"]] == pytest.approx([382.9, 382.9], abs=0.05)
    assert drawn["belt"].startswith("M -191.44 81.25 L 191.44 81.25 A 81.25 81.25 0 ")
    assert drawn["extent"] == pytest.approx([-272.691, -81.25, 272.691, 81.25])
    json.dumps(drawn)


def test_names_of_small_pulleys_have_room_beyond_the_belt(drive: Drive) -> None:
    """To the left of the left pulley of a drive, and to the right of the right one; above and below a web."""
    first, second = scene(draft(drive.data, HERE))["pulleys"]
    assert (first["beyond"], second["beyond"]) == (pytest.approx([-1.0, 0.0]), pytest.approx([1.0, 0.0]))
    line = load(Path(__file__).parents[3] / "docs" / "tasks" / "coater.toml")
    below = {one["name"]: one["beyond"][1] > 0.0 for one in scene(draft(line.data, HERE), settled=False)["pulleys"]}
    assert [name for name, down in below.items() if down] == ["dancer", "coater", "oven 2", "pull"]


def test_rollers_of_nips_have_spans_without_length() -> None:
    """Their numbers reach the browser, which knows no NaN."""
    line = load(Path(__file__).parents[3] / "docs" / "tasks" / "calender5.toml")
    json.dumps(scene(draft(line.data, HERE), settled=False), allow_nan=False)


def test_an_empty_drive_file_shows_an_empty_canvas() -> None:
    drawn = scene(draft({}, HERE))
    assert (drawn["pulleys"], drawn["belt"], drawn["valid"]) == ([], "", False)


def test_wrong_pulleys_are_drawn_as_far_as_they_can_be(drive: Drive) -> None:
    data = drive.data
    data["pulley"] += [
        {"name": "no size", "center": [0, 0]},
        {"center": ["0 mm", "200 mm"], "diameter": "40 mm"},
        3,
        {},
    ]
    data["contact"]["friction"] = -1.0
    drawn = scene(draft(data, HERE))
    assert not drawn["valid"]
    assert [(one["number"], one["name"]) for one in drawn["pulleys"]][2:] == [(3, "pulley 4")]
    assert drawn["pulleys"][2]["r"] == pytest.approx(20.0)
    assert drawn["belt"] == ""
    assert drawn["pulleys"][2]["wrong"]
    del data["pulley"][4:], data["pulley"][2]
    assert scene(draft(data, HERE))["belt"]


def test_an_arm_and_its_rest_are_drawn(alternator_text: str) -> None:
    import tomllib

    data = tomllib.loads(alternator_text)
    drawn = scene(draft(data, HERE))
    assert drawn["tensioners"][0]["pivot"] == pytest.approx([100.0, -100.0])
    assert drawn["ghosts"] == []  # it rests where it is drawn, but for a third of a degree
    data["tensioner"][0]["preload"] = "12 N m"
    drawn = scene(draft(data, HERE))
    (ghost,) = drawn["ghosts"]
    assert math.hypot(ghost["x"] - 100.0, ghost["y"] + 100.0) == pytest.approx(math.hypot(70.0, 40.0))
    assert drawn["rest"] != drawn["belt"]


@pytest.mark.parametrize(
    ("value", "length"),
    [("25 mm", 0.025), (3, 3.0), ("3", None), (None, None), ([], None), (math.inf, None), (1e9, None), ("1 N", None)],
)
def test_lengths_are_read_where_they_can_be(value: object, length: float | None) -> None:
    assert length_in(value) == length


@pytest.mark.parametrize("name", ["timing_drive", "printer_axis", "gantry_axis", "servo_axis"])
def test_every_pulley_of_an_example_with_teeth_is_drawn(name: str) -> None:
    text = files("beltdyn").joinpath("examples", f"{name}.toml").read_text("utf-8")
    made = draft(tomllib.loads(text), HERE)
    assert made.drive is not None
    sizes = [1e3 * one.radius for one in made.drive.pulleys]
    assert [one["r"] for one in scene(made)["pulleys"]] == pytest.approx(sizes)
    broken = draft({**made.data, "contact": {"friction": -1}}, HERE)  # while something else is wrong
    assert broken.drive is None
    assert len(scene(broken)["pulleys"]) == len(sizes)


def test_a_list_of_pulleys_in_the_other_order_is_drawn_alike() -> None:
    """The drive has its pulleys counter-clockwise whatever the order in the file."""
    data = tomllib.loads(files("beltdyn").joinpath("examples", "accessory_drive.toml").read_text(encoding="utf-8"))
    clockwise = data | {"pulley": [data["pulley"][0], *data["pulley"][:0:-1]]}
    drawn, other = ({one.pop("name"): one for one in scene(draft(each, HERE))["pulleys"]} for each in (data, clockwise))
    for name, pulley in drawn.items():
        del pulley["number"], other[name]["number"]
        assert pulley == other[name], name

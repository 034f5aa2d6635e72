"""What is done on the canvas, as edits."""

import math
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest
import tomli_w

from beltdyn.app import placing
from beltdyn.app.draft import Draft, draft
from beltdyn.app.scene import circles, toothing_in
from beltdyn.app.session import Document
from beltdyn.app.workspace import EMPTY
from beltdyn.model import prepare
from beltdyn.parts.toml_edits import Edit

HERE = Path()


def of(document: Document) -> Draft:
    return draft(document.data, HERE)


def test_values_keep_the_units_of_the_file(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply(placing.resize(document.data, 0, 0.0765))
    document.apply(placing.move(document.data, 2, 0.0012, 0.28))
    assert document.data["pulley"][0]["radius"] == "76.5 mm"
    assert document.data["pulley"][2]["center"] == [0.0012, 0.28]


def test_steps_of_keys_add_up(alternator_text: str) -> None:
    document = Document(alternator_text)
    for _ in range(3):
        document.apply(placing.nudge(document.data, 2, 0.001, -0.001))
        document.apply(placing.grow(document.data, 2, 0.001))
        document.apply(placing.nudge_pivot(document.data, 0, 0.0, 0.001))
    assert document.data["pulley"][2]["center"] == [0.003, 0.267]
    assert document.data["pulley"][2]["radius"] == "31 mm"
    assert document.data["tensioner"][0]["pivot"] == [0.1, 0.103]
    document.apply([Edit("set", ("pulley", 2, "radius"), "x"), Edit("set", ("tensioner", 0, "pivot"), 1)])
    assert placing.nudge(document.data, 2, 1.0, 0.0) == []
    assert placing.nudge_pivot(document.data, 0, 1.0, 0.0) == []


def test_a_pulley_given_by_its_diameter_keeps_it() -> None:
    document = Document('[[pulley]]\nname = "a"\ndiameter = "100 mm"\n')
    document.apply(placing.resize(document.data, 0, 0.04))
    assert document.data["pulley"][0] == {"name": "a", "diameter": "80 mm"}


def test_the_other_side_and_back(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply(placing.flip(document.data, 0))
    assert document.data["pulley"][0]["side"] == "outside"
    document.apply(placing.flip(document.data, 0))
    assert document.data == tomllib.loads(alternator_text)


def test_tensioners_follow_a_name_and_go_with_their_pulley(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply(placing.rename(document.data, 1, "arm"))
    assert document.data["tensioner"][0]["pulley"] == "arm"
    assert of(document).drive is not None
    document.apply(placing.remove(document.data, 1))
    assert document.data["tensioner"] == []
    assert of(document).drive is not None


def test_a_pulley_meets_the_belt_later(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply(placing.shift(document.data, 0, 1))
    assert [one["name"] for one in document.data["pulley"]] == ["tensioner", "crank", "alternator"]
    document.apply(placing.shift(document.data, 0, -1))
    assert [one["name"] for one in document.data["pulley"]] == ["crank", "alternator", "tensioner"]


def test_a_drive_is_laid_out_from_nothing() -> None:
    document = Document(EMPTY)
    for x, y in ((-0.1, 0.0), (0.15, 0.0), (0.0, 0.2), (0.0, 0.05)):
        document.apply(placing.add(of(document), x, y))
    found = of(document)
    assert found.drive is not None
    assert [one.name for one in found.drive.pulleys] == ["driver", "pulley 4", "driven", "pulley 3"]
    assert [one.side for one in found.drive.pulleys] == ["inside", "outside", "inside", "inside"]
    assert document.text.startswith(EMPTY[:40])


@pytest.mark.parametrize("kind", ["rotary", "sliding", "fixed"])
def test_a_new_tensioner_tensions_the_belt(kind: str) -> None:
    document = Document(EMPTY)
    for x, y in ((-0.1, 0.0), (0.15, 0.0), (0.0, 0.2)):
        document.apply(placing.add(of(document), x, y))
    document.apply(placing.new_tensioner(of(document), 2, kind, 0))
    drive = of(document).drive
    assert drive is not None, of(document).told
    assert drive.tensioners[0].kind == kind
    if kind != "fixed":
        positions = prepare(drive).installation.tensioner_positions
        assert abs(positions[0]) < 0.01  # its spring fits the installed tension where it stands


def test_a_new_pulley_finds_room() -> None:
    document = Document(EMPTY)
    for x in (-0.1, 0.1, 0.03):
        document.apply(placing.add(of(document), x, 0.0))
    _, second, third = (float(str(one["radius"]).removesuffix(" mm")) for one in document.data["pulley"])
    assert 70.0 - second > third


def test_pulleys_with_teeth_are_sized_by_teeth() -> None:
    """By the pointer to the nearest number, by keys by one at least; on the back of the belt they have none."""
    document = Document(files("beltdyn").joinpath("examples", "timing_drive.toml").read_text("utf-8"))
    pulleys = document.data["pulley"]
    number = next(place for place, one in enumerate(pulleys) if "teeth" in one)
    teeth, circle = pulleys[number]["teeth"], circles(document.data)[number]
    document.apply(placing.resize(document.data, number, circle.radius + 3.2 * 0.008 / (2.0 * math.pi)))
    assert document.data["pulley"][number]["teeth"] == teeth + 3
    document.apply(placing.grow(document.data, number, -1e-6))
    assert document.data["pulley"][number]["teeth"] == teeth + 2
    document.apply(placing.flip(document.data, number))
    turned = document.data["pulley"][number]
    assert "teeth" not in turned
    assert turned["side"] == "outside"
    document.apply(placing.flip(document.data, number))
    assert document.data["pulley"][number]["teeth"] == teeth + 2
    assert "radius" not in document.data["pulley"][number]


def test_a_new_pulley_has_teeth_within_a_belt_with_teeth() -> None:
    document = Document(files("beltdyn").joinpath("examples", "timing_drive.toml").read_text("utf-8"))
    assert toothing_in(document.data) is not None
    document = Document(tomli_w.dumps({"belt": document.data["belt"]}))
    document.apply(placing.add(of(document), 0.0, 0.0))
    document.apply(placing.add(of(document), 0.4, 0.0))
    assert len(document.data["pulley"]) == 2
    assert all(isinstance(one["teeth"], int) and "radius" not in one for one in document.data["pulley"])

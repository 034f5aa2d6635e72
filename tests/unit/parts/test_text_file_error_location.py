"""From the location of an error to the key as a user writes it."""

from typing import Any

import pytest

from beltdyn.model import Belt, Drive
from beltdyn.parts.text_file import ErrorLocation, shorten

DATA: dict[str, Any] = {
    "pulley": [
        {"name": "driver", "speed": {"kind": "ramp", "end": 1}},
        {"name": "driven", "load": [{"kind": "motor"}]},
        {"radius": 1.0},
    ],
    "tensioner": [{"pulley": "idler"}],
}


@pytest.fixture
def locations() -> ErrorLocation:
    return ErrorLocation(Drive, DATA)


@pytest.mark.parametrize(
    ("location", "path"),
    [
        ((), ""),
        (("tensioner", 0, "preload"), "tensioner[idler].preload"),
        (("belt", "width"), "belt.width"),
        (("pulley", 1, "radius"), "pulley[driven].radius"),
        (("pulley", 2, "radius"), "pulley[3].radius"),
        (("pulley", 0, "speed", "ramp", "end"), "pulley[driver].speed.end"),
        (("pulley", 1, "load", 0, "motor", "breakdown_slip"), "pulley[driven].load[1].breakdown_slip"),
        (("pulley", 7, "center", 1), "pulley[8].center[2]"),
    ],
)
def test_a_path_names_what_has_a_name_and_leaves_out_kinds(
    locations: ErrorLocation, location: tuple[int | str, ...], path: str
) -> None:
    assert locations.locate(location)[0] == path


def test_the_schema_is_that_of_the_key(locations: ErrorLocation) -> None:
    schema = locations.locate(("pulley", 1, "load", 0, "motor", "breakdown_slip"))[1]
    assert schema["description"].startswith("the slip at the largest torque")


def test_known_keys_and_kinds_are_those_of_the_place(locations: ErrorLocation) -> None:
    assert {"width", "density"} <= set(locations.keys(("belt",)))
    assert "breakdown_torque" in locations.keys(("pulley", 1, "load", 0, "motor"))
    assert set(locations.kinds(("pulley", 1, "load", 0))) >= {"motor", "resistance", "table"}
    assert locations.keys(("belt", "width", "deeper")) == []


def test_a_part_alone_is_named_by_its_kind() -> None:
    assert ErrorLocation(Belt, {}).locate(("width",))[0] == "belt.width"


@pytest.mark.parametrize(
    ("text", "longest", "short"), [("abcdef", 6, "abcdef"), ("abcdefg", 6, "abc..."), (12, 6, "12")]
)
def test_what_is_long_is_cut(text: object, longest: int, short: str) -> None:
    assert shorten(text, longest) == short

"""Errors as sentences: the key, the value, the rule, the remedy."""

from typing import Any, Literal

import pytest
from pydantic import Field, ValidationError, model_validator

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.messages import apart, reason, show, suggest, told_apart
from beltdyn.parts.part import Part


class Wheel(Part):
    """A part with a key of each sort."""

    radius: float = Field(gt=0, description="the radius, in m")
    teeth: int = Field(20, ge=3, description="the number of teeth")
    name: str = Field("wheel", max_length=8, description="a name")
    material: Literal["steel", "polymer"] = "steel"
    hub: tuple[float, ...] = Field((1.0, 2.0), min_length=2)
    locked: bool = False

    @model_validator(mode="after")
    def _is_no_disc(self) -> "Wheel":
        if self.radius == 1.0:
            raise ValueError("has no hub. Give another radius")
        if self.radius == 2.0:
            raise ValueError("radius and teeth exclude each other. Remove one")
        return self


def said(**keys: Any) -> list[str]:
    with pytest.raises(ModelError) as caught:
        Wheel(**keys)
    return str(caught.value).splitlines()


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({}, "wheel.radius is missing. Give the radius, in m."),
        ({"radius": -2.5}, "wheel.radius = -2.5 must be greater than 0. Give the radius, in m."),
        ({"radius": "big"}, 'wheel.radius = "big" must be a number. Give the radius, in m.'),
        ({"radius": float("nan")}, "wheel.radius = nan must be a finite number. Give the radius, in m."),
        ({"radius": 0.1, "teeth": 2}, "wheel.teeth = 2 must be at least 3. Give the number of teeth."),
        ({"radius": 0.1, "name": "a" * 9}, 'wheel.name = "aaaaaaaaa" is longer than 8 characters.'),
        ({"radius": 0.1, "locked": "so"}, 'wheel.locked = "so" must be true or false, without quotation marks.'),
        ({"radius": 0.1, "locked": 0.5}, "wheel.locked = 0.5 must be true or false, without quotation marks."),
        ({"radius": 0.1, "hub": 3}, "wheel.hub = 3 must be a list [...]."),
        ({"radius": 0.1, "hub": [3.0]}, "wheel.hub = [3.0] needs at least 2 entries."),
        ({"radius": 0.1, "material": "stele"}, 'wheel.material = "stele" is not a valid choice. Did you mean "steel"?'),
        ({"radius": 0.1, "material": "x"}, 'wheel.material = "x" is not a valid choice. Choose one of steel, polymer.'),
        ({"radius": 0.1, "tooth": 3}, 'wheel.tooth is not a known key. Did you mean "teeth"?'),
        ({"radius": 1.0}, "wheel has no hub. Give another radius."),
        ({"radius": 2.0}, "wheel: radius and teeth exclude each other. Remove one."),
    ],
)
def test_a_sentence_for_every_rule(keys: dict[str, Any], sentence: str) -> None:
    assert said(**keys) == [sentence]


def test_every_error_is_told_once() -> None:
    assert len(said(radius=-1, teeth=1, locked="so")) == 3


def test_a_misspelled_key_is_not_missing_too() -> None:
    assert said(raduis=0.1) == ['wheel.raduis is not a known key. Did you mean "radius"?']
    assert len(said(colour="red")) == 2


def test_a_list_with_a_wrong_entry_is_not_too_short_too() -> None:
    assert said(radius=0.1, hub=["x"]) == ['wheel.hub[1] = "x" must be a number.']


def test_twenty_errors_are_enough() -> None:
    found = said(radius=0.1, **{f"key{number}": 1 for number in range(30)})
    assert len(found) == 21
    assert found[-1] == "10 more errors are not shown."


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.1, "0.1"), (float("inf"), "inf"), ("ä", '"ä"'), ([1, "x"], '[1, "x"]'), (None, "null"), (1j, "1j")],
)
def test_values_are_written_as_in_a_drive_file(value: object, text: str) -> None:
    assert show(value) == text


def test_numbers_are_told_apart() -> None:
    assert apart(1.4, 1.2763) == ("1.4", "1.2763")
    assert apart(1.38720004, 1.3872) == ("1.38720004", "1.3872")
    assert apart(0.1, 0.1) == ("0.1", "0.1")
    assert len(set(apart(1.0, 1.0 + 2.0**-52))) == 2


def test_long_values_are_cut() -> None:
    assert len(show("x" * 1000)) == 60
    assert len(show({1: object()})) <= 60


def test_the_system_says_why_a_file_cannot_be_used() -> None:
    assert reason(FileNotFoundError(2, "No such file or directory")) == "no such file or directory"
    assert reason(ValueError("Its unit is MPa, not N")) == "its unit is MPa, not N"
    assert reason(ValueError("MPa is no unit of force")) == "MPa is no unit of force"


def test_each_error_is_told_with_its_place_in_the_data(drive: Drive) -> None:
    data = drive.data
    data["pulley"][1]["radius"] = -1.0
    data["pulley"][0]["speed"] = {"kind": "constant", "value": "12 m"}
    with pytest.raises(ValidationError) as caught:
        Drive.model_validate(data)
    told = {one.location: one.sentence for one in told_apart(caught.value, Drive, data)}
    assert set(told) == {("pulley", 1, "radius"), ("pulley", 0, "speed", "value")}
    assert told["pulley", 1, "radius"].startswith("pulley[driven].radius = -1.0 must be greater than 0.")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("pully_slip", 'Did you mean "pulley_slip"?'),
        ("slipp", 'Did you mean "pulley_slip" or "slip_safety"?'),
        ("heat", "Choose one of pulley_slip, slip_safety, hub_load"),
    ],
)
def test_names_are_suggested_by_their_likeness_or_that_of_a_word(given: str, words: str) -> None:
    assert suggest(given, ["pulley_slip", "slip_safety", "hub_load"]) == words

"""The keys of forms, from the schema."""

import tomllib
from importlib.resources import files
from typing import Any

import pytest

from beltdyn.app.forms import as_text, as_value, fields, kinds, value_at
from beltdyn.model import read_catalogue


@pytest.fixture(scope="module")
def data() -> dict[str, Any]:
    return tomllib.loads(files("beltdyn").joinpath("examples", "accessory_drive.toml").read_text(encoding="utf-8"))


def test_the_belt_has_its_keys_with_units_and_the_profiles_of_the_catalogue(data: dict[str, Any]) -> None:
    found = {one.key: one for one in fields(data, ("belt",))}
    assert (found["installed_tension"].unit, found["installed_tension"].text("mm")) == ("N", "300")
    assert found["profile"].form == "choice"
    assert "SPB" in found["profile"].choices
    assert found["wedge_angle"].unit == "rad"
    assert found["elements"].unit == ""
    assert found["crossed"].form == "flag"
    assert (found["integration"].choices, found["integration"].default) == (("full", "reduced"), "full")
    assert fields(data, ("belt",))[0].key == "profile"


@pytest.mark.parametrize("profile", read_catalogue())
def test_a_belt_is_asked_for_the_keys_of_its_profile(profile: str) -> None:
    entry, belt = read_catalogue()[profile], {"profile": profile}
    keys = {one.key for one in fields({"belt": belt}, ("belt",))}
    assert entry.sold_by in keys
    assert not keys & ({"ribs", "diameter", "density", "sold"} - {entry.sold_by})
    assert ("teeth" in keys) == (entry.toothing is not None)
    toothed = {one.key for one in fields({"belt": belt | {"teeth": 100, "length": 1.0}}, ("belt",))}
    assert toothed >= {"teeth", "length"}  # what the file has is shown
    assert "nominal_length" not in toothed


@pytest.mark.parametrize(("profile", "label"), [("PK", "ribs"), ("SPB", "belts"), ("XPZ", "belts")])
def test_what_a_profile_is_counted_in(profile: str, label: str) -> None:
    """V-belts have no ribs; a key of any other group has its own name."""
    (counted,) = (one for one in fields({"belt": {"profile": profile}}, ("belt",)) if one.key == "ribs")
    assert counted.label == label
    assert {one.key: one.label for one in fields({"belt": {}}, ("contact",))}["creep_ratio"] == "creep ratio"


@pytest.mark.parametrize("profile", ["EP 400/3 5+2", "a profile of a catalogue of one's own"])
def test_a_profile_that_is_not_listed_is_shown(profile: str) -> None:
    shown = next(one for one in fields({"belt": {"profile": profile}}, ("belt",)) if one.key == "profile")
    assert shown.value == profile
    assert shown.choices[:2] == (profile, "PH")


def test_groups_within_groups_have_the_keys_of_their_kind(data: dict[str, Any]) -> None:
    keys = {one.key: one for one in fields(data, ("pulley", 0, "speed"))}
    assert keys["values"].unit == "rad/s"
    assert keys["values"].text("mm") == "0, 1600, 1600, 800"
    assert keys["values"].text("SI") == "0, 167.5516, 167.5516, 83.7758"
    assert {one.key for one in fields(data, ("pulley", 4, "hub", 1))} >= {"stiffness", "damping", "inertia"}
    assert {one.key for one in fields(data, ("pulley", 0, "harmonics", 1))} == {"order", "amplitude", "phase"}


def test_kinds_are_those_of_the_model_without_functions(data: dict[str, Any]) -> None:
    assert kinds(data, ("tensioner", 0)) == ("fixed", "rotary", "sliding")
    assert "induction_motor" in kinds(data, ("pulley", 0, "load", 0))
    assert "function" not in kinds(data, ("pulley", 0, "load", 0))
    assert kinds(data, ("pulley", 0, "harmonics", 0)) == ()


def test_a_tensioner_carries_one_of_the_pulleys(data: dict[str, Any]) -> None:
    one = next(one for one in fields(data, ("tensioner", 0)) if one.key == "pulley")
    assert one.choices == tuple(each["name"] for each in data["pulley"])


def test_of_the_drive_itself_only_keys_are_listed(data: dict[str, Any]) -> None:
    assert [one.key for one in fields(data, ())] == ["name", "description", "project", "author", "rotation", "gravity"]


@pytest.mark.parametrize(
    ("form", "text", "value"),
    [
        ("number", " 0.5", 0.5),
        ("number", "25 mm", "25 mm"),
        ("number", "6", 6),
        ("text", "6", "6"),
        ("point", "[0.1, 20 mm]", [0.1, "20 mm"]),
        ("numbers", "0, 1,", [0, 1]),
        ("number", "", None),
        ("flag", "true", True),
    ],
)
def test_what_is_typed_is_read(form: Any, text: str, value: Any) -> None:
    assert as_value(form, text) == value
    assert as_value(form, as_text(value)) == value


def test_what_is_not_there_is_nothing(data: dict[str, Any]) -> None:
    assert value_at(data, ("pulley", 99, "name")) is None
    assert value_at(data, ("belt", "ribs", "x")) is None

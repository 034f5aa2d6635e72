"""Tables of keys, for pages and the terminal."""

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Belt, Contact, Limits, Pulley, Simulation, Steady
from beltdyn.model.belt_form import Nominal, Sold
from beltdyn.model.pulley import Diameter
from beltdyn.parts.part import Part
from beltdyn.show.key_tables import Key, described, groups_for, key_groups


def key(group: str, name: str) -> Key:
    return next(key for key in key_groups()[group].keys if key.name == name)


@pytest.mark.parametrize(
    ("part", "group"),
    [
        *((part, part.__name__.lower()) for part in (Belt, Pulley, Contact, Simulation, Steady, Limits)),
        *((Nominal, "belt"), (Sold, "sold"), (Diameter, "pulley")),
    ],
)
def test_groups_have_every_key_with_its_description(part: type[Part], group: str) -> None:
    for name, field in part.model_fields.items():
        assert described(str(field.description))[1:] in key(group, field.alias or name).meaning


def test_defaults_choices_limits_and_units() -> None:
    assert key("contact", "friction_law").default == "`relative_creep`"
    assert "`stribeck`" in key("contact", "friction_law").meaning
    assert "at least 1 and at most 64" in key("contact", "quadrature_points").meaning
    assert key("contact", "stiffness").default == "chosen"
    assert key("simulation", "duration").unit == "s"


def test_a_profile_supplies_what_is_required_without_it() -> None:
    supplied = {each.name for each in key_groups()["belt"].keys if each.default == "from the profile"}
    assert supplied > {"width", "thickness", "density", "wedge_angle", "friction"}
    assert key("belt", "installed_tension").default == ""
    assert key("pulley", "name").default == "required"


@pytest.mark.parametrize(
    ("word", "groups"),
    [
        ("belt", ["belt", "sold"]),
        ("load.fan", ["load.fan", "load.shared"]),
        ("[pulley.load.fan]", ["load.fan", "load.shared"]),
        ("least_slip_safety", ["limits"]),
    ],
)
def test_groups_are_named_by_group_kind_or_key(word: str, groups: list[str]) -> None:
    assert list(groups_for(word)) == groups


def test_a_key_is_shown_alone() -> None:
    assert [each.name for each in groups_for("pulley.inertia")["pulley"].keys] == ["inertia"]


def test_unknown_words_are_refused() -> None:
    with pytest.raises(ModelError, match=r'no group or key "lenght"\. Choose one of drive, belt, '):
        groups_for("lenght")

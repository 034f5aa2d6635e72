"""Every argument of every part is told of in `help()`: meaning, unit, default and limits."""

import inspect
import re

import pytest

import beltdyn.model as model
from beltdyn.contact.normal import LAWS
from beltdyn.model import Belt, Contact, Drive, Harmonic, Pulley
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import unit_of

PARTS = [one for one in vars(model).values() if isinstance(one, type) and issubclass(one, Part)]


def entries(part: type[Part]) -> dict[str, tuple[str, str]]:
    """Names of the arguments, each with its type and its description."""
    text = inspect.getdoc(part) or ""
    found = re.findall(r"^(\w+) : (.*)\n((?:    .*\n?)+)", text, flags=re.MULTILINE)
    return {name: (kind, " ".join(told.split())) for name, kind, told in found}


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_help_and_signature_name_every_argument(part: type[Part]) -> None:
    arguments = {field.alias or name for name, field in part.model_fields.items()}
    assert arguments <= entries(part).keys() == inspect.signature(part).parameters.keys()


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_what_has_a_dimension_names_its_unit(part: type[Part]) -> None:
    fields = {field.alias or name: field for name, field in part.model_fields.items()} | dict(part.alternatives())
    for name, (kind, told) in entries(part).items():
        if kind.startswith("float or text with a unit"):
            unit = next(found for one in (fields[name].annotation, *fields[name].metadata) if (found := unit_of(one)))
            printed = unit.replace("**", "^").replace("*", " ").replace("degC", "°C")
            assert re.search(rf"\bin {re.escape(printed)}(?![\w/^])", told.replace("*", " ")), name


def test_defaults_and_limits_are_those_of_the_fields() -> None:
    assert entries(Belt)["elements"] == (
        "int, optional",
        "The number of belt elements; the least one of meshes that are refined. At least 3 and at most 10000.",
    )
    assert entries(Belt)["youngs_modulus"] == (
        "float or text with a unit",
        "Young's modulus of the belt, in Pa. Above 0.",
    )
    others = ", ".join(f'"{name}"' for name in LAWS if name != "no_pull")
    assert entries(Contact)["normal_law"][0] == f'{{"no_pull", {others}}}, default "no_pull"'
    assert entries(Harmonic)["order"][0] == "float"
    assert entries(Drive)["pulley"][0] == "list of Pulley"
    assert entries(Pulley)["center"][0] == "(float or text with a unit, float or text with a unit)"


def test_the_signature_outlives_the_first_use() -> None:
    Belt.model_validate({"profile": "PK", "ribs": 6, "installed_tension": 300.0})
    assert "profile" in inspect.signature(Belt).parameters


def test_forms_of_a_belt_are_arguments_too() -> None:
    parameters = inspect.signature(Belt).parameters
    assert {"profile", "ribs", "axial_stiffness", "mass_per_length"} <= parameters.keys()
    assert parameters["density"].default is None  # a profile stands in for it
    assert inspect.signature(Harmonic).parameters["order"].default is inspect.Parameter.empty

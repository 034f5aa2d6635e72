"""Contact: the parameters of the laws that are chosen, and no others."""

from typing import Any

import pytest

from beltdyn.contact.friction import LAWS as FRICTION_LAWS
from beltdyn.contact.friction import CoefficientSlope, ForceSlope, RelativeCreep
from beltdyn.contact.normal import LAWS as NORMAL_LAWS
from beltdyn.contact.normal import NoPull
from beltdyn.errors import ModelError
from beltdyn.model import Contact

GIVEN: dict[str, Any] = {
    "stiffness": 1e7,
    "damping": 10.0,
    "friction": 1.2,
    "friction_law": "force_slope",
    "creep_rate_factor": 1e5,
}


def test_the_laws_get_what_is_given() -> None:
    contact = Contact(**GIVEN)
    assert contact.friction_parameters == ForceSlope(1e5)
    assert contact.normal_parameters == NoPull(1e7, 10.0)
    other = {key: value for key, value in GIVEN.items() if key != "creep_rate_factor"}
    changed = Contact(**other | {"friction_law": "coefficient_slope", "creep_velocity": 0.01})
    assert changed.friction_parameters == CoefficientSlope(0.01)


@pytest.mark.parametrize("law", NORMAL_LAWS)
def test_every_law_of_the_normal_force_can_be_chosen(law: str) -> None:
    own = {parameter.name: parameter.example for parameter in NORMAL_LAWS[law].parameters}
    found = Contact(**GIVEN, normal_law=law, **own).normal_parameters
    assert isinstance(found, NORMAL_LAWS[law].record)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"allowed_penetration": 1e-4}, "stiffness and allowed_penetration exclude each other. Remove one of them"),
        ({"creep_rate_factor": None}, 'creep_rate_factor is missing, but the friction law "force_slope" needs it'),
        (
            {"creep_velocity": 0.1},
            'creep_velocity belongs to the friction law "coefficient_slope", not to "force_slope"',
        ),
        ({"friction": -0.1}, "must be at least 0"),
        ({"stiffness": 0.0}, "must be greater than 0"),
        ({"quadrature_points": 65}, "must be at most 64"),
        ({"friction_law": "dry"}, "is not a valid choice"),
    ],
)
def test_what_does_not_belong_together_is_refused(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        Contact(**GIVEN | changes)
    assert sentence in str(caught.value)


def test_a_law_that_is_not_chosen_leaves_its_parameters_open() -> None:
    contact = Contact(**GIVEN)
    chosen = {parameter.name for parameter in FRICTION_LAWS["force_slope"].parameters}
    for law in FRICTION_LAWS.values():
        for parameter in law.parameters:
            assert (getattr(contact, parameter.name) is None) == (parameter.name not in chosen)


def test_numbers_of_computation_may_be_left_open() -> None:
    contact = Contact(friction=0.4)
    assert contact.open_keys == ("stiffness", "damping", "creep_ratio", "standstill_creep")
    with pytest.raises(ModelError, match=r"contact\.creep_ratio is open; .* Use prepare\(drive\)\.contact"):
        _ = contact.friction_parameters
    with pytest.raises(ModelError, match=r"contact\.stiffness is open"):
        _ = contact.normal_parameters
    assert Contact(**GIVEN).open_keys == ()
    given = Contact(stiffness=1e8, damping=0.0, creep_ratio=1e-3, standstill_creep=1e-6)
    assert given.friction_parameters == RelativeCreep(1e-3, 1e-6)

"""Every family is made from its list of kinds: what a drive file may choose, constants and kernels."""

from types import ModuleType
from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.machines import links, loads, profiles, tensioners
from beltdyn.machines.family import kinds_in
from beltdyn.machines.links.registry import LINK
from beltdyn.machines.loads.registry import SHAFT_LOAD
from beltdyn.machines.tensioners.registry import TENSIONER
from beltdyn.model import Pulley

LOADS = {
    *("angle_speed_table", "angle_table", "band_brake", "brake", "fan", "function", "generator"),
    *("induction_motor", "motor", "pump", "resistance", "servo_motor", "table"),
}
FREE: dict[str, Any] = {"name": "free", "center": (0, 0), "radius": 1, "inertia": 1}


@pytest.mark.parametrize(
    ("module", "kinds"),
    [
        (loads, LOADS),
        (links, {"friction_clutch", "isolator", "one_way_clutch"}),
        (tensioners, {"fixed", "rotary", "sliding"}),
        (profiles, {"constant", "cosine_ramp", "cosine_ramp_published", "ramp", "step", "table"}),
    ],
    ids=["loads", "links", "tensioners", "profiles"],
)
def test_a_family_has_the_kinds_that_its_module_imports(module: ModuleType, kinds: set[str]) -> None:
    assert kinds_in(module).keys() == kinds


@pytest.mark.parametrize("kind", kinds_in(loads).values())
def test_the_row_of_a_load_has_room_for_every_kind(kind: Any) -> None:
    assert SHAFT_LOAD[kind.model_fields["kind"].annotation.__args__[0]] == kind.constants


@pytest.mark.parametrize("kind", kinds_in(links).values())
def test_the_row_of_a_link_has_room_for_every_kind(kind: Any) -> None:
    assert LINK[kind.model_fields["kind"].annotation.__args__[0]] == kind.constants


def test_a_fixed_tensioner_has_no_row() -> None:
    assert {"sliding", "rotary"} == set(TENSIONER.names or ()) & kinds_in(tensioners).keys()


def test_a_wrong_kind_is_told_of_with_those_that_there_are() -> None:
    with pytest.raises(ModelError, match="Choose one of band_brake, brake, function"):
        Pulley(**FREE, load=[{"kind": "nothing"}])

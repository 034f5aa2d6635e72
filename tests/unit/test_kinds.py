"""Registries of kinds, and the call that adds a kind: what is refused, what replaces, and what follows."""

from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import pytest
from pydantic import Field

import beltdyn as bd
from beltdyn.analyses import ANALYSES, Analysis
from beltdyn.arrays import record
from beltdyn.contact.friction import LAWS, FrictionLaw
from beltdyn.errors import ModelError
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, Registry, register
from beltdyn.machines.links import LINK
from beltdyn.machines.links.link import LINKS
from beltdyn.machines.loads import SHAFT_LOAD
from beltdyn.machines.loads.load import LOADS, Load, LoadTorque
from beltdyn.machines.profiles.profile import PROFILES
from beltdyn.machines.tensioners import TENSIONER
from beltdyn.machines.tensioners.tensioner import TENSIONERS
from beltdyn.model import Drive, Pulley
from beltdyn.parts.quantity import quantity
from beltdyn.results import Result, Variable, build_result

OF_THE_PACKAGE = {
    "load": {
        *("angle_speed_table", "angle_table", "band_brake", "brake", "fan", "function", "generator"),
        *(
            "holdback",
            "induction_motor",
            "motor",
            "pump",
            "resistance",
            "servo_motor",
            "speed_trim",
            "table",
            "torque_trim",
        ),
    },
    "hub coupling": {"friction_clutch", "isolator", "one_way_clutch"},
    "tensioner": {"fixed", "rotary", "sliding"},
    "profile": {"constant", "cosine_ramp", "cosine_ramp_published", "ramp", "step", "table"},
}
FREE: dict[str, Any] = {"name": "free", "center": (0, 0), "radius": 1, "inertia": 1}
NUMBERS = record(pull="f8")


class Slope(NamedTuple):
    slope: float


@kernel
def sloped(law: Slope, slip: float, normal: float, friction: float, rim: float) -> tuple[float, float, float, float]:
    return -law.slope * slip, -law.slope, 0.0, 0.0


@kernel
def pulled(constants: np.record, _numbers: Any, _shaft: Any) -> LoadTorque:
    return LoadTorque(constants.pull, 0.0, 0.0, 0.0)


def friction_law(name: str, *parameters: Parameter, force: Any = sloped) -> FrictionLaw:
    return FrictionLaw(name, Slope, force, parameters)


@pytest.mark.parametrize("registry", [LOADS, LINKS, TENSIONERS, PROFILES], ids=lambda one: one.family)
def test_a_family_has_the_kinds_of_the_package(registry: Registry[Any]) -> None:
    assert registry.keys() >= OF_THE_PACKAGE[registry.family]
    assert not any(map(registry.is_own, registry))


@pytest.mark.parametrize("kind", LOADS)
def test_the_row_of_a_load_has_room_for_every_kind(kind: str) -> None:
    assert SHAFT_LOAD[kind] == LOADS[kind].constants


@pytest.mark.parametrize("kind", LINKS)
def test_the_row_of_a_link_has_room_for_every_kind(kind: str) -> None:
    assert LINK[kind] == LINKS[kind].constants


def test_a_fixed_tensioner_has_no_row() -> None:
    assert set(TENSIONERS) - set(TENSIONER.names or ()) == {"fixed"}


def test_a_wrong_kind_is_told_of_with_those_that_there_are() -> None:
    with pytest.raises(ModelError, match=r"Choose one of .*band_brake"):
        Pulley(**FREE, load=[{"kind": "nothing"}])


def test_a_registered_kind_is_in_its_family_with_its_module() -> None:
    law = friction_law("sloped", Parameter("slope", "kg/(m*s)", "the slope"))
    assert register(law) is law
    assert LAWS["sloped"] is law
    assert LAWS.is_own("sloped")
    assert LAWS.origins["sloped"] == __name__


def test_a_kind_of_one_name_replaces_the_one_before() -> None:
    register(friction_law("sloped"))
    register(other := friction_law("sloped", Parameter("slope", "", "the slope")))
    assert LAWS["sloped"] is other


def widths(drive: Drive, *, times: float = 1.0) -> Result:
    """Give the width of the belt."""
    return build_result("widths", drive, {"width": (Variable((), "m", "Width"), times * drive.belt.width)}, {})


def test_an_analysis_of_a_script_works_where_those_of_the_package_do(tmp_path: Path) -> None:
    register(Analysis(f"{__name__}:widths", "Give the width."))
    drive, points = bd.example("two_pulley"), [0.01, 0.02]
    assert "widths" in dir(bd)
    assert bd.widths(drive, times=2.0).dataset.width.item() == pytest.approx(2.0 * drive.belt.width)  # type: ignore[attr-defined]
    plan = bd.ParameterStudy(
        analysis="widths", number=[{"path": "belt.width", "values": points}], results=["width"], options={"times": 3.0}
    )
    assert bd.study(plan, drive, jobs=1).dataset.width.values.tolist() == pytest.approx([0.03, 0.06])
    ANALYSES["widths"].write(drive, tmp_path / "widths.nc")
    assert bd.open_result(tmp_path / "widths.nc").dataset.width.item() == pytest.approx(drive.belt.width)


def test_a_class_is_registered_by_the_decorator() -> None:
    @register
    class Pull(Load):
        constants = NUMBERS
        torque_at = pulled

        kind: Literal["pull"] = Field("pull", description="the kind of load")
        pull: Annotated[float, quantity("N*m")] = Field(description="the torque, in N*m")

    assert LOADS["pull"] is Pull
    (load,) = Pulley(**FREE, load=[{"kind": "pull", "pull": "3 N m"}]).load
    assert isinstance(load, Pull)
    assert load.torque_over(np.zeros(2), 5.0).tolist() == [3.0, 3.0]


@pytest.mark.parametrize(
    ("law", "sentence"),
    [
        (friction_law("force_slope"), "beltdyn has one of this name. Rename yours"),
        (friction_law("my law"), "its name must begin with a letter"),
        (friction_law("plain", force=lambda *_: (0.0,) * 4), "force must be a kernel. Decorate its function with"),
        (friction_law("other", Parameter("stiffness", "", "x")), r"stiffness is another key of \[contact\]. Rename it"),
    ],
    ids=["name", "letters", "kernel", "key"],
)
def test_what_cannot_be_registered_is_refused(law: FrictionLaw, sentence: str) -> None:
    before = dict(LAWS)
    with pytest.raises(ModelError, match=sentence):
        register(law)
    assert dict(LAWS) == before


def test_a_key_that_hides_an_attribute_is_refused() -> None:
    with pytest.warns(UserWarning, match="shadows an attribute"):

        class Hidden(Load):
            constants = NUMBERS
            torque_at = pulled

            kind: Literal["hidden"] = Field("hidden", description="the kind of load")
            factor: float = 1.0  # type: ignore[assignment]

    with pytest.raises(ModelError, match=r"its key factor has the name of an attribute of Load. Rename it"):
        register(Hidden)


def test_a_kind_of_the_package_stays() -> None:
    with pytest.raises(ModelError, match=r'the friction law "force_slope" belongs to beltdyn and cannot be removed'):
        LAWS.forget("force_slope")
    register(friction_law("sloped"))
    LAWS.forget("sloped")
    assert "sloped" not in LAWS


def test_what_belongs_to_no_family_is_refused() -> None:
    with pytest.raises(ModelError, match=r"it belongs to no family of kinds. Make it one of .*FrictionLaw"):
        register(Slope(1.0))

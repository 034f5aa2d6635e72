"""Fields that choose a kind follow its registry, also in drives that are read after others were used."""

import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any, Literal, NamedTuple, cast

import numpy as np
import pytest
from numpy.typing import ArrayLike
from pydantic import Field

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.extend import FrictionLaw, Load, LoadTorque, Parameter, Stretching, StretchLaw, kernel, record, register
from beltdyn.model import Drive
from beltdyn.parts.kind_fields import chosen_kinds

NUMBERS = record(pull="f8")


class Slope(NamedTuple):
    slope: float
    shift: float


class Cubic(NamedTuple):
    stiffness: float
    growth: float
    limit: float

    def tension(self, stretch: ArrayLike) -> Any:
        strain = np.asarray(stretch) - 1.0
        return self.stiffness * (strain + self.growth * strain**3)

    def stretch(self, tension: ArrayLike) -> Any:
        return 1.0 + np.asarray(tension) / self.stiffness


@kernel
def sloped(law: Slope, slip: float, normal: float, friction: float, rim: float) -> tuple[float, float, float, float]:
    return -law.slope * slip, -law.slope, 0.0, 0.0


@kernel
def cubic(law: Cubic, metric: float) -> Stretching:
    return Stretching(law.stiffness * metric, law.stiffness, 0.0)


@kernel
def pulled(constants: np.record, _numbers: Any, _shaft: Any) -> LoadTorque:
    return LoadTorque(constants.pull, 0.0, 0.0, 0.0)


@pytest.fixture
def own(drive: Drive) -> Drive:
    """The paper's drive with an own friction law, stretch law and load, registered behind its first use."""
    slope = Parameter("slope", "kg/(m*s)", "the slope of the friction force")
    shift = Parameter("shift", "m/s", "the shift", above=None, default=0.5)
    register(FrictionLaw("sloped", Slope, sloped, (slope, shift)))
    growth, limit = Parameter("growth", "", "the growth of the stiffness"), Parameter("limit", "N", "the limit")
    register(StretchLaw("cubic", "stiffening", Cubic, cubic, (growth, limit)))

    @register
    class Pull(Load):
        constants = NUMBERS
        torque_at = pulled
        kind: Literal["pull"] = Field("pull", description="the kind of load")
        pull: float = Field(description="the torque, in N*m")

    driver, driven = drive.pulleys
    return drive.replace(
        belt=drive.belt.replace(stretch_law="cubic", growth=30.0, limit="2 kN"),
        contact=drive.contact.replace(friction_law="sloped", slope="3e4 kg/(m*s)", creep_rate_factor=None),
        pulley=[driver, driven.replace(torque=None, load=[{"kind": "pull", "pull": -2.0}])],
    )


def test_own_laws_take_their_keys_and_a_drive_file_holds_them(own: Drive) -> None:
    friction, stretch = cast(Slope, own.contact.friction_parameters), cast(Cubic, own.belt.stretch_parameters)
    assert friction == Slope(3e4, 0.5)
    assert stretch == Cubic(own.belt.youngs_modulus * own.belt.area, 30.0, 2000.0)
    text = bd.dumps(own)
    assert 'stretch_law = "cubic"' in text
    assert bd.loads(text) == own


@pytest.mark.slow
def test_a_belt_of_a_profile_takes_the_keys_of_an_own_law(own: Drive) -> None:
    given: dict[str, Any] = {"profile": "PJ", "ribs": 6, "length": 1.0, "stretch_law": "cubic"}
    belt = bd.Belt(**given | {"growth": 9.0, "limit": 5.0})
    for one in (belt, belt.replace(ribs=4)):
        assert cast(Cubic, one.stretch_parameters)[1:] == (9.0, 5.0)


@pytest.mark.slow
def test_schema_and_help_have_own_kinds(own: Drive) -> None:
    schema = bd.model.json_schema()["$defs"]
    assert "sloped" in schema["Contact"]["properties"]["friction_law"]["enum"]
    assert "growth" in schema["Belt"]["properties"]
    assert schema["Pull"]["properties"]["kind"]["const"] == "pull"
    assert "slope : float or text with a unit" in str(bd.Contact.__doc__)


def test_messages_have_the_keys_of_own_kinds(own: Drive) -> None:
    with pytest.raises(ModelError, match=r'growth is missing, but the stretch law "cubic" needs it'):
        own.belt.replace(growth=None)
    with pytest.raises(ModelError, match=r'slope belongs to the friction law "sloped", not to "relative_creep"'):
        bd.Contact(friction=0.3, slope=2.0)
    with pytest.raises(ModelError, match=r"contact.slop is not a known key. Did you mean \"slope\""):
        bd.loads(bd.dumps(own).replace("slope =", "slop ="))


@pytest.mark.slow
def test_parts_from_before_lack_the_keys(drive: Drive, own: Drive) -> None:
    assert drive.contact.slope is None
    assert drive.contact.replace(friction=0.2).friction == 0.2


def test_the_kinds_of_a_drive_are_found_and_go_to_other_processes(drive: Drive, own: Drive) -> None:
    assert {str(kind) for kind in own.own_kinds} == {
        'friction law "sloped"',
        'stretch law "cubic"',
        'load "pull"',
    }
    assert 'integrator "generalized_alpha"' in map(str, chosen_kinds(drive))
    assert drive.own_kinds == []
    function, arguments = own.__reduce__()
    assert arguments == (own.text, (__name__,))
    assert pickle.loads(pickle.dumps(own)) == own
    assert function(*arguments) == own


SCRIPT = """
import beltdyn as bd
from typing import NamedTuple
from beltdyn.extend import FrictionLaw, Parameter, kernel, register

class Slope(NamedTuple):
    slope: float

@kernel
def sloped(law, slip, normal, friction, rim):
    return -law.slope * slip, -law.slope, 0.0, 0.0

register(FrictionLaw("sloped", Slope, sloped, (Parameter("slope", "kg/(m*s)", "the slope"),)))
"""
BATCH = """
drive = bd.example("two_pulley")
drive = drive.replace(contact=drive.contact.replace(friction_law="sloped", slope=3.0, creep_rate_factor=None))
try:
    bd.simulate_all({"one.nc": drive})
except bd.ModelError as error:
    print(error)
"""


@pytest.mark.slow
def test_other_processes_say_that_they_do_not_run_the_script(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(SCRIPT + BATCH, encoding="utf-8")
    done = subprocess.run([sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.startswith('the friction law "sloped" is registered by the script itself, which other processes')
    assert "Move it to a module beside the script and import that" in done.stdout


@pytest.mark.slow
def test_other_processes_import_the_module_that_registers_a_kind(tmp_path: Path) -> None:
    (tmp_path / "laws.py").write_text(SCRIPT, encoding="utf-8")
    program = """
import beltdyn as bd, laws
from beltdyn.designs.processes import LocalProcesses
drive = bd.example("two_pulley")
drive = drive.replace(contact=drive.contact.replace(friction_law="sloped", slope=3.0, creep_rate_factor=None))
workers = LocalProcesses(1)
print(workers.submit(getattr, drive, "friction_parameters").result())
workers.close()
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "Slope(slope=3.0)", done.stderr

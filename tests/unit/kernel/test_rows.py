"""Kernels chosen by the kind of a row; laws from outside, kept on disk and compiled anew where they changed."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from beltdyn.arrays import record, row
from beltdyn.kernel import CACHE_VARIABLE, PLAIN_VARIABLE, choice, interpreted, kernel

_LAW = """
from typing import NamedTuple

from beltdyn.extend import FrictionLaw, Parameter, kernel, register
from slopes import doubled

class Slope(NamedTuple):
    slope: float

FACTOR = {factor}

@kernel
def sloped(law, slip, normal, friction, rim):
    return -FACTOR * doubled(law.slope) * slip, -FACTOR * law.slope, 0.0, 0.0

register(FrictionLaw("sloped", Slope, sloped, (Parameter("slope", "kg/(m*s)", "the slope"),)))
"""
_SLOPES = """
from beltdyn.extend import kernel

@kernel
def doubled(slope):
    return {double} * slope
"""
_CALL = """
from beltdyn.contact.friction import friction_force
print(friction_force(Slope(3.0), 0.5, 10.0, 0.4, 1.0)[0])
"""
_LOAD = """
from typing import Literal

import numpy as np
from pydantic import Field

from beltdyn.extend import Load, LoadTorque, kernel, record, register

NUMBERS = record(pull="f8")

def own_load(factor):
    @kernel
    def pulled(constants, _numbers, shaft):
        return LoadTorque(factor * constants.pull, 0.0, 0.0, 0.0)

    class Pull(Load):
        constants = NUMBERS
        torque_at = pulled
        kind: Literal["pull"] = Field("pull", description="the kind of load")
        pull: float = Field(2.0, description="the torque, in N*m")

    return register(Pull)

from beltdyn.machines.loads.load import ShaftState
from beltdyn.machines.loads import SHAFT_LOADS, torque_of_kind
from beltdyn.arrays import row

for factor in (3.0, 5.0):
    kind = own_load(factor)
    made = row(SHAFT_LOADS.row_type([kind]))
    SHAFT_LOADS.fill(made, kind, kind().values())
    print(torque_of_kind(made, np.zeros(0), ShaftState(0.0, 0.0, 1.0, 0.0, 0.0)).torque)
"""


def run(folder: Path, script: str, plain: bool = False, module: bool = False) -> list[str]:
    file = folder / ("own_law.py" if module else "script.py")
    file.write_text(script, encoding="utf-8")
    environment = os.environ | {CACHE_VARIABLE: str(folder / "cache"), PLAIN_VARIABLE: "1" if plain else ""}
    environment |= {"PYTHONDONTWRITEBYTECODE": "1"}  # Python takes bytecode of the same second and size for its own
    program = ["-c", "from own_law import Slope" + _CALL] if module else [str(file)]
    command = [sys.executable, "-W", "ignore", *program]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def kept(folder: Path) -> int:
    return len(list((folder / "cache").rglob("*.kernel")))


@pytest.mark.parametrize("module", [pytest.param(False, marks=pytest.mark.slow), True], ids=["script", "module"])
def test_a_law_is_compiled_once_and_again_where_it_has_changed(tmp_path: Path, module: bool) -> None:
    """Its own code, a number of its module, and a kernel of another module that it calls."""
    found, counts = [], []
    for factor, double in ((1.0, 2.0), (1.0, 2.0), (4.0, 2.0), (4.0, 3.0), (1.0, 2.0)):
        (tmp_path / "slopes.py").write_text(_SLOPES.format(double=double), encoding="utf-8")
        script = _LAW.format(factor=factor) + ("" if module else _CALL)
        found += run(tmp_path, script, module=module)
        counts.append(kept(tmp_path))
    assert found == ["-3.0", "-3.0", "-12.0", "-18.0", "-3.0"]
    assert counts == [1, 1, 2, 3, 3]


@pytest.mark.slow
def test_plain_compilation_knows_a_changed_law(tmp_path: Path) -> None:
    (tmp_path / "slopes.py").write_text(_SLOPES.format(double=2.0), encoding="utf-8")
    found = [run(tmp_path, _LAW.format(factor=factor) + _CALL, plain=True)[0] for factor in (1.0, 4.0)]
    assert found == ["-3.0", "-12.0"]


def test_a_load_that_is_registered_again_replaces_the_one_before_in_kernels(tmp_path: Path) -> None:
    """As when a cell of a notebook is run again, and from the disk."""
    assert [run(tmp_path, _LOAD), run(tmp_path, _LOAD)] == [["6.0", "10.0"]] * 2
    assert kept(tmp_path) == 2


LINE, CIRCLE = record(slope="f8"), record(radius="f8")
SHAPE = record(kind="i8", line=LINE, circle=CIRCLE)


@kernel
def line_height(line: np.record, x: float) -> float:
    return float(line.slope * x)


@kernel
def circle_height(circle: np.record, x: float) -> float:
    return float(np.sqrt(circle.radius * circle.radius - x * x))


height = choice("height", {"line": line_height, "circle": circle_height}, ["x"])


@kernel
def twice_the_height(shape: np.record, x: float) -> float:
    return float(2.0 * height(shape, x))


@pytest.mark.parametrize(
    ("kind", "numbers", "expected"), [(0, {"line": {"slope": 0.5}}, 1.5), (1, {"circle": {"radius": 5.0}}, 4.0)]
)
def test_the_kind_of_the_row_chooses(kind: int, numbers: dict[str, dict[str, float]], expected: float) -> None:
    shape = row(SHAPE, kind=kind, **numbers)
    assert height(shape, 3.0) == expected
    assert twice_the_height(shape, 3.0) == 2.0 * expected


def test_a_kind_that_this_process_does_not_know_is_refused() -> None:
    """A process that compiles for another one may lack the module: the row would be taken for one of another kind."""
    foreign = row(record(kind="i8", line=record(slope="f8"), parabola_1a2b=record(focus="f8")), kind=1)
    with pytest.raises(TypeError, match="height knows no kind parabola_1a2b"):
        height(foreign, 3.0)


def test_python_runs_a_kernel_and_those_that_it_calls_without_the_compiler() -> None:
    program = """
import sys
import numpy as np
from beltdyn.kernel import interpreted
from beltdyn.machines.tensioners import tensioner_force
from beltdyn.machines.tensioners import TENSIONER
from beltdyn.arrays import row
spring = {"preload": 20.0, "rate": 30.0, "creep_speed": 0.1, "lower": -np.inf, "upper": np.inf}
tensioner = row(TENSIONER, kind=1, sliding={"spring": spring})
print(interpreted(tensioner_force)(tensioner, 0.1, 0.0).force, "numba" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["17.0", "False"]


def test_an_interpreted_kernel_takes_arrays() -> None:
    line = row(LINE, slope=2.0)

    @kernel
    def doubled(given: np.record, x: float) -> float:
        return given.slope * x  # type: ignore[no-any-return]

    np.testing.assert_array_equal(interpreted(doubled)(line, np.array([1.0, 2.0])), [2.0, 4.0])  # type: ignore[arg-type]

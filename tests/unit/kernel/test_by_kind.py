"""Kernels chosen by the kind of a row, and kernels that Python runs without compiling them."""

import subprocess
import sys

import numpy as np
import pytest

from beltdyn.kernel import choice, interpreted, kernel
from beltdyn.records import record, row

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


def test_python_runs_a_kernel_and_those_that_it_calls_without_the_compiler() -> None:
    program = """
import sys
import numpy as np
from beltdyn.kernel import interpreted
from beltdyn.machines.tensioners.tensioner_rows import tensioner_force
from beltdyn.machines.tensioners.tensioner_rows import TENSIONER
from beltdyn.records import row
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

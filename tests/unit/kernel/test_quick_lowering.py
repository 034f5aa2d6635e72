"""Named tuples that kernels pass by reference have the values that Python gives them."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from llvmlite.binding import get_host_cpu_features, get_host_cpu_name

from beltdyn.arrays import FloatArray
from beltdyn.kernel import compiles_quickly, kernel

pytestmark = pytest.mark.skipif(not compiles_quickly(), reason="plain compilation")


class Point(NamedTuple):
    x: float
    y: float


class Rod(NamedTuple):
    begin: Point
    end: Point
    number: int
    masses: FloatArray


@kernel
def length(begin: Point, end: Point) -> float:
    return float(np.hypot(end.x - begin.x, end.y - begin.y))


@kernel
def moved(rod: Rod, by: float) -> Rod:
    return Rod(Point(rod.begin.x + by, rod.begin.y), rod.end, rod.number + 1, rod.masses)


@kernel
def of_one_twice(rod: Rod) -> float:
    return length(rod.begin, rod.begin) + length(rod.end, rod.begin)


@kernel
def previous_in_a_loop(rod: Rod) -> float:
    """The tuple before is kept while the next one is made."""
    total, before = 0.0, rod
    for step in range(5):
        after = moved(before, 0.5 * step)
        total += length(before.begin, after.end) * after.number + length(after.begin, rod.begin)
        before = after
    return total + before.number


@kernel
def exchanged(rod: Rod) -> float:
    first, second = rod.begin, rod.end
    for _ in range(3):
        first, second = second, first
    return first.x + 10.0 * second.y + length(first, second)


@kernel
def argument_assigned_to(rod: Rod) -> float:
    """What the caller gave stays as it was."""
    if rod.number > 0:
        rod = moved(rod, 2.0)
    return rod.begin.x + rod.number


@kernel
def given_stays(rod: Rod) -> float:
    changed = argument_assigned_to(rod)
    return changed + 100.0 * rod.begin.x + rod.number


@kernel
def chosen(rod: Rod) -> float:
    end = rod.begin if rod.number > 5 else rod.end
    rod.masses[0] += end.x
    return float(end.y + rod.masses.sum())


@pytest.mark.parametrize(
    "function", [of_one_twice, previous_in_a_loop, exchanged, argument_assigned_to, given_stays, chosen]
)
def test_values_are_those_of_python(function: Callable[[Rod], float]) -> None:
    def rod() -> Rod:
        return Rod(Point(1.0, 2.0), Point(4.0, 6.5), 3, np.array([1.0, 2.0]))

    own: Any = function
    assert function(rod()) == pytest.approx(own.py_func(rod()), rel=1e-15)


def test_a_kernel_returns_a_named_tuple() -> None:
    rod = Rod(Point(1.0, 2.0), Point(4.0, 6.5), 3, np.array([1.0, 2.0]))
    found = moved(rod, 0.25)
    assert found[:3] == (Point(1.25, 2.0), Point(4.0, 6.5), 4)
    assert found.masses is rod.masses or np.array_equal(found.masses, rod.masses)


@pytest.mark.skipif(not compiles_quickly(), reason="plain compilation is for the processor at hand")
def test_machine_code_is_that_of_a_level_of_processors() -> None:
    from beltdyn.kernel.quick import TARGET

    _, name, features = TARGET.target_context.codegen().magic_tuple()
    host = get_host_cpu_features()
    if host.get("avx2") and host.get("bmi2") and host.get("fma"):
        assert (name, features) == ("x86-64-v3", "")
    else:
        assert name == get_host_cpu_name()

"""Kernels compiled of those needed, as reports tell."""

from typing import NamedTuple

from beltdyn.kernel import by_type, kernel, report_compilation, watch_compilation
from beltdyn.kernel.dispatch import CompilationCount, _kernels_below


class Disc(NamedTuple):
    radius: float


class Square(NamedTuple):
    side: float


@kernel
def squared(length):  # type: ignore[no-untyped-def]
    return length * length


@kernel
def disc_area(disc):  # type: ignore[no-untyped-def]
    return 3.0 * squared(disc.radius)


@kernel
def square_area(square):  # type: ignore[no-untyped-def]
    return squared(square.side)


area = by_type({Disc: disc_area, Square: square_area}, "area")


@kernel
def volume(shape, height):  # type: ignore[no-untyped-def]
    return area(shape) * height


def test_kernels_are_counted_with_those_they_call_and_choose() -> None:
    below = _kernels_below(volume.py_func, frozenset({Disc}))  # type: ignore[attr-defined]
    assert {function.__name__ for function in below} == {"volume", "disc_area", "squared"}


def test_reports_end_with_as_many_kernels_as_are_needed() -> None:
    told = list[tuple[int, int]]()
    count = CompilationCount()
    with watch_compilation(lambda done, total: told.append((done, total))):
        count.begin(volume.py_func, frozenset({Square}))  # type: ignore[attr-defined]
        count.begin(squared.py_func, frozenset())  # type: ignore[attr-defined]
        count.end()
        count.end()
    first = told[0]
    assert [(done - first[0], total - first[1]) for done, total in told] == [(0, 0), (0, 0), (1, 0), (3, 0)]
    assert told[-1][0] == told[-1][1]


def test_processes_add_up() -> None:
    told = list[tuple[int, int]]()
    with watch_compilation(lambda done, total: told.append((done, total))):
        report_compilation("one", 2, 5)
        report_compilation("other", 1, 7)
    (done, total), (later, all_of_them) = told
    assert (later - done, all_of_them - total) == (1, 7)
    report_compilation("one", 5, 5)
    report_compilation("other", 7, 7)

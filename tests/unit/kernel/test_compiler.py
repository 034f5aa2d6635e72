"""What becomes machine code, and what runs as Python."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numba
import pytest

from beltdyn.kernel import CACHE_VARIABLE, kernel, kernel_cache
from beltdyn.kernel.compiler import OPTIONS, new_dispatcher


@pytest.fixture(autouse=True)
def cache_of_this_test(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    kernel_cache.cache_clear()
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    yield
    kernel_cache.cache_clear()


def test_only_kernels_that_python_calls_become_machine_code(tmp_path: Path) -> None:
    @kernel(inline=True)
    def _half(x: float) -> float:
        return 0.5 * x

    @kernel
    def inner(x: float, power: int) -> float:
        return _half(x) ** power

    @kernel
    def outer(x: float) -> float:
        return inner(x, 1) + inner(x, 2)

    assert outer(6.0) == 12.0
    assert [path.name.split("-")[0].split(".")[-1] for path in tmp_path.rglob("*.kernel")] == ["outer"]
    assert inner(6.0, 2) == 9.0


_ROWS = """
import numpy as np
from beltdyn.kernel import kernel

@kernel
def second(row):
    return row.last

@kernel
def total(rows):
    found = 0.0
    for k in range(len(rows)):
        found += second(rows[k])
    return found

short = [("first", "f8"), ("last", "f8")]
print(total(np.ones(3, short)), total(np.full(3, 2.0, [*short, ("more", "f8")])))
"""


def test_rows_that_begin_as_others_are_compiled_for_their_own_type_without_a_word(tmp_path: Path) -> None:
    (tmp_path / "rows.py").write_text(_ROWS, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-W", "ignore:Numba .* compiles", "rows.py"],
        cwd=tmp_path,
        env=os.environ | {CACHE_VARIABLE: str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert (done.stdout, done.stderr) == ("3.0 6.0\n", "")


def test_without_compilation_kernels_run_as_python(monkeypatch: pytest.MonkeyPatch) -> None:
    """With NUMBA_DISABLE_JIT=1: what could never be compiled is done."""
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    seen: list[float] = []

    @kernel
    def note(x: float) -> float:
        seen.append(x)
        return 2.0 * x

    assert note(3.0) == 6.0
    assert seen == [3.0]


def test_numbers_are_divided_as_numpy_does() -> None:
    """By zero they make an infinite number or none; no error stops compiled code."""

    @kernel
    def divide(x: float, y: float) -> float:
        return x / y

    assert divide(1.0, 0.0) == float("inf")
    assert OPTIONS["error_model"] == "numpy"


def test_a_function_is_its_own_dispatcher_without_compilation(monkeypatch: pytest.MonkeyPatch) -> None:
    def double(x: float) -> float:
        return 2.0 * x

    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    assert new_dispatcher(double, inline=False) is double

"""Kernels are compiled quickly where Numba's internals are known, and plainly anywhere else."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from beltdyn.kernel import CACHE_VARIABLE, PLAIN_VARIABLE, compiles_quickly
from beltdyn.kernel import fingerprint as version

_PROGRAM = """
import sys, warnings
import numpy as np
from beltdyn.kernel import kernel

@kernel(inline=True)
def square(x: float) -> float:
    return x * x

@kernel
def norm(values, scale: float) -> float:
    total = 0.0
    for value in values:
        total += square(scale * value)
    return total

print("numba" in sys.modules)
with warnings.catch_warnings(record=True) as said:
    print(norm(np.array([3.0, 4.0]), 2.0), square(1.5))
print(*(f"{w.category.__name__}: {w.message}" for w in said), sep="|")
"""


@pytest.fixture(autouse=True)
def forget_the_choice() -> Iterator[None]:
    compiles_quickly.cache_clear()
    yield
    compiles_quickly.cache_clear()


@pytest.mark.parametrize(
    ("numba", "quick"), [("0.60.0", True), ("0.68.1", True), ("0.59.1", False), ("0.99.0rc1", False), ("1.0.0", False)]
)
def test_an_unknown_numba_is_used_by_its_public_face(monkeypatch: pytest.MonkeyPatch, numba: str, quick: bool) -> None:
    monkeypatch.delenv(PLAIN_VARIABLE, raising=False)
    monkeypatch.setattr(version, "version", lambda _: numba)
    assert compiles_quickly() is quick


def test_plain_compilation_can_be_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PLAIN_VARIABLE, "1")
    assert not compiles_quickly()


@pytest.mark.slow
@pytest.mark.parametrize("plain", ["", "1"])
def test_both_ways_give_the_same_numbers_and_the_slow_one_says_so_once(tmp_path: Path, plain: str) -> None:
    program = tmp_path / "norms.py"
    program.write_text(_PROGRAM, encoding="utf-8")
    environment = os.environ | {CACHE_VARIABLE: str(tmp_path / "cache"), PLAIN_VARIABLE: plain}

    def run() -> list[str]:
        command = [sys.executable, str(program)]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.splitlines()

    first, second = run(), run()
    assert first[:2] == second[:2] == ["False", "100.0 2.25"]
    assert second[2] == ""
    assert first[2].count("PlainCompilationWarning") == bool(plain)
    assert ("public decorator" in first[2]) == bool(plain)

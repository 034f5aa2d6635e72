"""Areas of two figures by one name, from Python and from a kernel, in both ways of compilation."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from beltdyn.kernel import CACHE_VARIABLE, PLAIN_VARIABLE

_AREAS = """
from typing import NamedTuple
import numpy as np
from beltdyn.kernel import by_type, kernel

class Rectangle(NamedTuple):
    sides: tuple[float, ...]

class Square(NamedTuple):
    side: float

class Tiles(NamedTuple):
    count: np.ndarray
    tile: NamedTuple

@kernel
def rectangle_area(rectangle, count):
    product = 1.0
    for k in range(len(rectangle.sides)):
        product *= rectangle.sides[k]
    return count[0] * product

@kernel(inline=True)
def square_area(square, count):
    return count[0] * square.side**2

area = by_type({Rectangle: rectangle_area, Square: square_area}, "area")

@kernel
def tiled(tiles):
    return area(tiles.tile, tiles.count)
"""
_CALLS = """
three = np.array([3.0])
print(tiled(Tiles(three, Rectangle((2.0, 5.0)))), tiled(Tiles(three, Square(2.0))), area(Square(4.0), three))
"""
_WRONG = """
try:
    tiled(Tiles(np.ones(1), (1.0, 2.0)))
except TypeError as error:
    print(error)
"""


def output(code: str, cache: Path, plain: bool) -> list[str]:
    environment = os.environ | {CACHE_VARIABLE: str(cache), PLAIN_VARIABLE: "1" if plain else ""}
    (cache / "areas.py").write_text(_AREAS + code)  # a file, since Numba keeps no code of others
    command = [sys.executable, "-W", "ignore", str(cache / "areas.py")]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.splitlines()


@pytest.mark.parametrize("plain", [False, True], ids=["quick", "plain"])
def test_the_type_chooses(tmp_path: Path, plain: bool) -> None:
    """Compiled first, then from the disk."""
    for _ in range(2):
        assert output(_CALLS, tmp_path, plain) == ["30.0 12.0 48.0"]
    assert list(tmp_path.rglob("*tiled*.nbi" if plain else "*tiled*.kernel"))


@pytest.mark.parametrize("plain", [False, True], ids=["quick", "plain"])
def test_unknown_types_are_refused(tmp_path: Path, plain: bool) -> None:
    (message,) = output(_WRONG, tmp_path, plain)
    assert message == "area takes Rectangle, Square, not UniTuple(float64 x 2). Register a kernel for it."

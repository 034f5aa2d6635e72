"""Drives whose belt cannot mesh."""

import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from tests.unit.model.test_toothing import BELT, drive


def test_a_belt_too_short_to_mesh() -> None:
    with pytest.raises(
        ModelError, match=r"belt.teeth = 97 is too short to mesh: .* has 100.16 pitches of 8 mm. Give 100"
    ):
        drive({"teeth": 97})


def test_a_belt_whose_teeth_nothing_holds() -> None:
    smooth = [{"name": n, "center": [x, 0.0], "radius": 0.04, "speed": 1.0} for n, x in (("a", 0.0), ("b", 0.28))]
    with pytest.raises(ModelError, match="the belt has 100 teeth, but no pulley has any"):
        bd.Drive(belt=BELT, pulley=smooth, contact={"friction": 0.3}, simulation={"duration": 1.0})

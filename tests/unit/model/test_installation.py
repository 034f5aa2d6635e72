from math import sqrt

import pytest

from beltdyn.model import Drive, layer_lengths


def test_layer_lengths(drive: Drive) -> None:
    bending, sinking = layer_lengths(drive, 1600.0)
    assert bending == pytest.approx(sqrt(drive.belt.bending_stiffness / 1600.0))
    assert sinking == pytest.approx(sqrt(1600.0 / 1e7))

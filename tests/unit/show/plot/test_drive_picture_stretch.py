"""Tension over strain of a belt of the catalogue."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.model import read_catalogue
from beltdyn.show import plot

CURVE = """
[elastic]
width = "2 mm"
thickness = "3 mm"
bending_stiffness = 2e-4
mass_per_length = 0.009
title = "Elastic belt of ours"
source = "our rig"
stretch_curve = { strains = [0.01, 0.03], tensions = [10.0, 20.0] }
"""


def test_a_measured_curve_goes_through_its_points(tmp_path: Path, ax: Axes) -> None:
    (tmp_path / "mine.toml").write_text(CURVE)
    entry = read_catalogue("mine.toml", tmp_path)["elastic"]
    plot.stretch(entry, ax=ax)
    lines = {str(line.get_label()): np.asarray(line.get_xydata()) for line in ax.lines}
    np.testing.assert_allclose(lines["measured"], [[1.0, 10.0], [3.0, 20.0]])
    drawn = lines["in a drive"]
    np.testing.assert_allclose(np.interp([1.0, 3.0], *drawn.T), [10.0, 20.0], rtol=1e-3)
    assert ax.get_title(loc="left") + ax.get_title() == "Elastic belt of ours"


def test_a_belt_without_a_curve_is_a_straight_line(ax: Axes, tmp_path: Path) -> None:
    entry = read_catalogue()["PK"]
    plot.stretch(entry, "PK, 1 rib", ax)
    np.testing.assert_allclose(np.asarray(ax.lines[0].get_xydata())[-1], [1.0, 0.01 * entry.axial_stiffness])
    assert plot.save_stretch(entry, tmp_path / "pk.png").stat().st_size > 1000
    with pytest.raises(ModelError, match=r"\.txt is not a format for figures"):
        plot.save_stretch(entry, tmp_path / "pk.txt")

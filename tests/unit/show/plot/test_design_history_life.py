"""Figures of the life of a belt."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.patches import Rectangle

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.points.life import life
from beltdyn.results import Result
from beltdyn.show import plot


@pytest.fixture(scope="module")
def found(fatigue_drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Result:
    table = tmp_path_factory.mktemp("life") / "duty.csv"
    table.write_text("duration [h], load\n1, 1\n1, 0.8\n", encoding="utf-8")
    return life(fatigue_drive, table=table)


def test_histories(found: Result) -> None:
    ax = plot.belt_history(found, "bending_strain")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Length of belt passed [turns]", "Bending strain inside [%]")
    lines = [line for line in ax.lines if len(np.asarray(line.get_xdata())) > 2]
    np.testing.assert_allclose(np.asarray(lines[1].get_ydata()), 100.0 * found.dataset.bending_strain.values[1])
    assert [text.get_text() for text in ax.texts] == ["small", "large"]
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["row 1", "row 2"]


def test_an_unknown_history(found: Result) -> None:
    with pytest.raises(ModelError, match="Choose one of tension, bending_strain"):
        plot.belt_history(found, "slip")


def test_shares(found: Result) -> None:
    ax = plot.damage_shares(found)
    heights = [patch.get_height() for patch in ax.patches if isinstance(patch, Rectangle)]
    shares = [*found.dataset.cord_share.values, *found.dataset.rib_share.values]
    np.testing.assert_allclose(heights, 100.0 * np.array(shares))
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["small", "large"]


def test_both_are_saved(found: Result, tmp_path: Path) -> None:
    assert sorted(path.stem for path in plot.save_all(found, tmp_path)) == ["belt_history", "damage_shares"]

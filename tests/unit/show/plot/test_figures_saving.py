"""Figures in files: marked as ours, so that no other picture is replaced."""

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results.atomic import is_marked
from beltdyn.show.plot.figures import save


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_a_figure_of_ours_is_replaced_and_another_one_is_not(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"figure{suffix}"
    for _ in range(2):
        assert save(Figure(), path) == path
        assert is_marked(path)
    foreign = tmp_path / f"photo{suffix}"
    Figure().savefig(foreign)
    before = foreign.read_bytes()
    with pytest.raises(ModelError, match="already exists and was not written by beltdyn"):
        save(Figure(), foreign)
    assert foreign.read_bytes() == before
    assert is_marked(save(Figure(), foreign, overwrite=True))


def test_a_format_that_is_not_known_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises((ModelError, ValueError)):
        save(Figure(), tmp_path / "figure.nothing")
    assert not list(tmp_path.iterdir())

"""Panels in rows."""

from collections.abc import Callable

import pytest
from matplotlib.axes import Axes

from beltdyn.results import Run
from beltdyn.show import plot
from beltdyn.show.plot.style import one_panel
from beltdyn.show.plot.style import panels as lay_out
from beltdyn.show.plot.style import rows as in_rows


@pytest.mark.parametrize(
    ("pulleys", "columns", "rows"), [(1, 1, 2), (2, 2, 2), (3, 3, 2), (4, 2, 4), (5, 3, 4), (7, 3, 6)]
)
def test_panels_of_many_pulleys_are_in_rows(pulleys: int, columns: int, rows: int) -> None:
    """Two kinds of force for each block of pulleys, no more than three beside each other."""
    blocks = in_rows(list(range(pulleys)))
    assert [number for block in blocks for number in block] == list(range(pulleys))
    figure = lay_out([[lambda ax: ax for _ in block] for block in blocks for _ in range(2)])
    assert len(figure.axes) == 2 * pulleys
    assert figure.get_size_inches().tolist() == pytest.approx([3.7 * columns, 2.7 * rows])


def test_panels_of_a_row_share_their_scale() -> None:
    def draw(height: float) -> Callable[..., Axes]:
        def on(ax: Axes) -> Axes:
            ax.plot([0.0, height])
            ax.set_ylabel("height")
            return ax

        return on

    calls = [[draw(1.0), draw(5.0)], [draw(2.0)]]
    shared = lay_out(calls).axes
    assert shared[0].get_ylim() == shared[1].get_ylim() != shared[2].get_ylim()
    assert [one.get_ylabel() for one in shared] == ["height", "", "height"]
    own = lay_out(calls, sharey=False).axes
    assert own[0].get_ylim() != own[1].get_ylim()
    assert [one.get_ylabel() for one in own] == ["height"] * 3


def test_one_panel_is_a_page_of_its_own(run: Run) -> None:
    page = one_panel(plot.speeds, run, None)
    (panel,) = page.axes
    assert panel.get_ylabel() == "Pulley speed [rad/s]"

"""Legends: above what is drawn, in as many columns as fit, or once for all panels."""

import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from beltdyn.show.plot.style import name_lines, name_once, new_figure, styled

LARGEST_SHARE = 0.2
"""Part of a page that a legend takes at most."""


def page_of(names: list[str]) -> tuple[Figure, Axes]:
    page = new_figure()
    ax = page.add_subplot()
    for number, name in enumerate(names):
        ax.plot([0, 1], [0, number], label=name)
    return page, ax


@styled
def name(ax: Axes) -> None:
    name_lines(ax)


@pytest.mark.parametrize("count", [1, 2, 7, 12])
@pytest.mark.parametrize("length", [5, 12, 25, 40])
def test_a_legend_leaves_the_axes_their_width_and_most_of_the_height(count: int, length: int) -> None:
    page, ax = page_of([f"{number} {'tensioner-pump' * 3}"[:length] for number in range(count)])
    page.draw_without_rendering()
    alone = ax.get_window_extent()
    name(ax)
    page.draw_without_rendering()
    legend = ax.get_legend()
    assert legend is not None
    area = legend.get_window_extent()
    assert ax.get_window_extent().width > 0.97 * alone.width
    assert area.width <= page.bbox.width
    assert area.y0 >= ax.get_window_extent().y1
    if count <= 7 and length <= 12:
        assert area.width * area.height < LARGEST_SHARE * page.bbox.width * page.bbox.height


def test_a_title_stands_above_the_legend() -> None:
    page, ax = page_of(["one", "other"])
    ax.set_title("span 1", loc="left")
    name(ax)
    page.draw_without_rendering()
    legend = ax.get_legend()
    assert legend is not None
    title = next(one for one in ax.findobj(Text) if one.get_text() == "span 1")
    assert title.get_window_extent().y0 >= legend.get_window_extent().y1


def test_names_longer_than_the_axes_stand_below_the_figure() -> None:
    page, ax = page_of(["a" * 90, "b" * 90])
    name_lines(ax)
    assert ax.get_legend() is None
    assert len(page.legends) == 1


def test_axes_without_lines_have_no_legend(ax: Axes) -> None:
    name_lines(ax)
    assert ax.get_legend() is None


def test_panels_share_a_legend_in_which_each_name_stands_once() -> None:
    page = new_figure()
    for ax, names in zip(page.subplots(1, 3), (("a", "b"), ("b", "c"), ()), strict=True):
        for name in names:
            ax.plot([0, 1], label=name)
        name_lines(ax)
    name_once(page)
    assert all(ax.get_legend() is None for ax in page.axes)
    (shared,) = page.legends
    assert [text.get_text() for text in shared.get_texts()] == ["a", "b", "c"]

"""The style of figures: in force while they are drawn, and labels from the dataset."""

import io

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes

from beltdyn import plot
from beltdyn.plot.style import (
    COLORS,
    DASHES,
    axes_or_new,
    color,
    dash,
    label,
    name_lines,
    polar_or_new,
    set_log_scale,
    styled,
    tension_colors,
    unit,
)
from beltdyn.results import Run


def test_new_axes_are_made_and_the_style_is_left_alone(run: Run) -> None:
    before = dict(mpl.rcParams)
    ax = plot.speeds(run)
    assert ax.get_figure() is plt.gcf()
    assert dict(mpl.rcParams) == before


def test_labels_are_a_meaning_and_a_unit(run: Run) -> None:
    torque = run.dataset["pulley_torque"]
    assert unit(torque) == "N·m"
    assert label(torque) == f"{torque.attrs['long_name']} [N·m]"
    assert label(torque.assign_attrs(long_name="Capstan margin", units="1")) == "Capstan margin"


def test_every_line_of_a_figure_can_be_told_from_its_neighbours() -> None:
    """By color or by dashes, however many there are."""
    for number in range(40):
        assert color(number) == color(number + len(COLORS))
        assert dash(number) == dash(number + len(DASHES))
        assert color(number) != color(number + 1)
        assert dash(number) != dash(number + 1)
    looks = {(color(number), dash(number)) for number in range(28)}
    assert len(looks) == 28


def test_axes_of_the_caller_are_used(ax: Axes) -> None:
    assert axes_or_new(ax) is ax
    assert polar_or_new(ax) is ax
    assert polar_or_new(None).name == "polar"


@pytest.mark.parametrize(
    ("names", "beside"), [(["a", "b"], False), (["a", "b", "c", "d", "e"], True), (["a" * 40, "b" * 40], True)]
)
def test_a_legend_stands_above_unless_its_names_are_many_or_long(ax: Axes, names: list[str], beside: bool) -> None:
    for name in names:
        ax.plot([0, 1], label=name)
    name_lines(ax)
    legend = ax.get_legend()
    assert legend is not None
    corner = legend.get_bbox_to_anchor().transformed(ax.transAxes.inverted())
    assert (corner.x0, corner.y0) == pytest.approx((1.0, 0.5) if beside else (0.0, 1.0))


def test_dollars_in_names_are_no_formulas() -> None:
    """As in names of files: matplotlib cannot set every one of them."""

    @styled
    def draw() -> Axes:
        ax = axes_or_new(None)
        set_log_scale(ax)
        for name in ("$$E = mc^2$$", "$a", "$x_$"):
            ax.plot([1.0, 1000.0], label=name)
        ax.set_title("$$")
        name_lines(ax)
        return ax

    ax = draw()
    plt.gcf().savefig(io.BytesIO(), format="svg")
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["$$E = mc^2$$", "$a", "$x_$"]
    assert "1000" in [text.get_text() for text in ax.get_yticklabels()]


def test_axes_without_lines_have_no_legend(ax: Axes) -> None:
    name_lines(ax)
    assert ax.get_legend() is None


def test_tensions_grow_lighter_and_are_seen_on_white() -> None:
    lightness = tension_colors()(np.linspace(0.0, 1.0, 20))[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert np.all(np.diff(lightness) > 0.0)
    assert lightness[-1] < 0.85

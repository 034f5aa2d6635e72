"""The style of figures: in force while they are drawn, and labels from the dataset."""

import io

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb

from beltdyn.results import Run
from beltdyn.show import plot
from beltdyn.show.plot.style import (
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


def test_new_axes_are_made_and_the_style_is_left_alone(run: Run) -> None:
    before = dict(mpl.rcParams)
    ax = plot.speeds(run)
    assert ax.get_figure() is plt.gcf()
    assert dict(mpl.rcParams) == before


def test_labels_are_a_meaning_and_a_unit(run: Run) -> None:
    torque = run.dataset["pulley_torque"]
    assert unit(torque) == "N·m"
    assert label(torque) == f"{torque.attrs['long_name']} [N·m]"
    assert label(torque.assign_attrs(long_name="Slip safety", units="1")) == "Slip safety"


def test_every_line_of_a_figure_can_be_told_from_its_neighbours() -> None:
    """By color or by dashes, however many there are."""
    for number in range(40):
        assert color(number) == color(number + len(COLORS))
        assert dash(number) == dash(number + len(DASHES))
        assert color(number) != color(number + 1)
        assert dash(number) != dash(number + 1)
    looks = {(color(number), dash(number)) for number in range(20)}
    assert len(looks) == 20


def test_axes_of_the_caller_are_used(ax: Axes) -> None:
    assert axes_or_new(ax) is ax
    assert polar_or_new(ax) is ax
    assert polar_or_new(None).name == "polar"


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


def test_tensions_grow_lighter_and_are_seen_on_white() -> None:
    lightness = tension_colors()(np.linspace(0.0, 1.0, 20))[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert np.all(np.diff(lightness) > 0.0)
    assert lightness[-1] < 0.85


def lab(tint: str) -> np.ndarray:
    """CIE L*a*b* of a color, white of D65."""
    linear = np.array(to_rgb(tint))
    linear = np.where(linear <= 0.04045, linear / 12.92, ((linear + 0.055) / 1.055) ** 2.4)
    matrix = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
    ratio = matrix @ linear / np.array([0.95047, 1.0, 1.08883])
    root = np.where(ratio > 216 / 24389, np.cbrt(ratio), (24389 / 27 * ratio + 16) / 116)
    return np.array([116 * root[1] - 16, 500 * (root[0] - root[1]), 200 * (root[1] - root[2])])


def test_colors_are_distinct() -> None:
    """By 25 in CIE L*a*b*, ten times what is just noticed; and on white by a luminance contrast of 2."""
    places = [lab(tint) for tint in COLORS]
    apart = [np.linalg.norm(one - other) for k, one in enumerate(places) for other in places[:k]]
    assert min(apart) > 25.0
    assert max(place[0] for place in places) < 72.0


def test_a_pulley_has_one_color_in_all_figures(run: Run) -> None:
    """In lines over time, polar paths, bars, pressures and the name in the picture of the drive; so has its span."""
    found = {
        "speeds": plot.speeds(run).lines[1].get_color(),
        "torques": plot.torques(run).lines[1].get_color(),
        "slip": plot.slip(run).lines[1].get_color(),
        "safeties": plot.slip_safety(run).lines[1].get_color(),
        "powers": plot.powers(run).lines[1].get_color(),
        "hub loads": plot.hub_load_sizes(run).lines[1].get_color(),
        "directions": plot.hub_loads(run, "driven").lines[-1].get_color(),
        "wear": plot.wear_by_arc(run).lines[1].get_color(),
        "span": plot.span_tensions(run).lines[1].get_color(),
        "pressure": plot.contact_pressure(run, "driven").lines[0].get_color(),
        "forces": plot.contact_forces(run, "driven").lines[0].get_color(),
        "losses": plot.losses(run).patches[1].get_facecolor(),
        "picture": next(one for one in plot.configuration(run).texts if one.get_text() == "driven").get_color(),
    }
    assert {name: to_hex(tint) for name, tint in found.items()} == dict.fromkeys(found, COLORS[1])
    plt.close("all")

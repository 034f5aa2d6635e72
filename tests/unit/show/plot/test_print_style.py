from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import Collection
from matplotlib.colors import to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.results import Result, Run
from beltdyn.show.plot.figures import FIGURES, Choice, chosen_by_default
from beltdyn.show.plot.print_style import GREYS, figure_style, make_grey, prints
from beltdyn.show.plot.style import DASHES, new_figure, styled

MM = 25.4
"""Of an inch."""


def colors_of(page: Figure) -> list[tuple[float, ...]]:
    """Every color of a figure that is not transparent."""
    found = list[np.ndarray]()
    values: list[Any]
    for artist in page.findobj():
        if isinstance(artist, Line2D):
            values = [artist.get_color(), artist.get_markerfacecolor(), artist.get_markeredgecolor()]
        elif isinstance(artist, Text):
            values = [artist.get_color()]
        elif isinstance(artist, Patch):
            values = [artist.get_facecolor(), artist.get_edgecolor()]
        elif isinstance(artist, Collection):
            shades = artist.get_cmap()([0.0, 0.5, 1.0]) if artist.get_array() is not None else artist.get_facecolor()
            values = [shades, artist.get_edgecolor()]
        else:
            continue
        found += [to_rgba_array(value) for value in values if not isinstance(value, str) or value != "none"]
    return [tuple(row[:3]) for row in np.concatenate(found) if row[3] > 0.0]


def drawn(name: str, result: Result) -> Figure:
    with figure_style("print"):
        return FIGURES[name].arrange(result, Choice())


def test_all_figures_of_a_run_are_grey_and_as_wide_as_a_column_or_a_page(run: Run) -> None:
    for name in (*chosen_by_default([run]), "arc_forces", "contact_forces", "wear_by_arc"):
        page = drawn(name, run)
        assert round(MM * page.get_figwidth()) in (84, 174), name
        assert all(len(set(np.round(color, 6))) == 1 for color in colors_of(page)), name
        assert page.get_suptitle() == "", name


def test_lines_of_a_figure_differ_in_print(run: Run) -> None:
    """In grey, or in their style; those of the energies have colors alone on the screen."""
    for name in ("speeds", "span_tensions", "energy", "torques"):
        for ax in drawn(name, run).axes:
            named = [line for line in ax.lines if not str(line.get_label()).startswith("_")]
            looks = [(line.get_color(), line.get_linestyle()) for line in named]
            solid = [line for line in named if line.get_linestyle() == "-"]
            assert len(solid) <= 1, name
            assert len({str(look) for look in looks}) == len(looks), name


def test_twenty_numbers_give_twenty_looks() -> None:
    assert np.gcd(len(GREYS), len(DASHES)) == 1
    values = sorted(to_rgba_array(list(GREYS))[:, 0])
    assert np.diff(values).min() > 0.1


def test_legends_show_the_styles_of_their_lines(run: Run) -> None:
    page = drawn("energy", run)
    (ax,) = page.axes
    box = ax.get_legend() or page.legends[0]
    styles = {str(line.get_label()): line.get_linestyle() for line in ax.lines}
    for text, handle in zip(box.get_texts(), box.legend_handles, strict=True):
        assert isinstance(handle, Line2D)
        assert handle.get_linestyle() == styles[text.get_text()]


def test_what_is_drawn_elsewhere_keeps_its_style(run: Run) -> None:
    before = dict(mpl.rcParams)
    drawn("speeds", run)
    assert dict(mpl.rcParams) == before
    assert not prints()
    ax = bd.plot.speeds(run)
    assert ax.lines[0].get_color() not in GREYS
    assert ax.figure.figure.get_figwidth() > 5.0
    plt.close(ax.figure.figure)


def test_labels_fit_into_a_column() -> None:
    @styled
    def long_label() -> Figure:
        page = new_figure()
        ax = page.add_subplot()
        ax.set_title("coupled: arm of tensioner, tensioner, alternator, and more of them than a column has room for")
        ax.set_xlabel("Power lost [W] and its share of the power input, mean over a window that has a long name")
        return page

    with figure_style("print"):
        page = long_label()
        (ax,) = page.axes
        page.draw_without_rendering()
        extent = ax.xaxis.label.get_window_extent()
        assert "\n" in ax.get_xlabel()
        assert extent.width <= page.bbox.width
        assert "\n" in ax.get_title(loc="left")


def test_luminance_and_opacity_stay() -> None:
    line = Line2D([], [], color=(1.0, 0.0, 0.0, 0.5), markerfacecolor="none")
    make_grey([line])
    np.testing.assert_allclose(to_rgba_array(line.get_color())[0], [0.2126, 0.2126, 0.2126, 0.5])
    assert line.get_markerfacecolor() == "none"


def test_files_for_print_are_pdf_as_wide_as_a_column(run: Run, tmp_path: Path) -> None:
    (file,) = bd.plot.save_all(run, tmp_path, ["speeds"], style="print")
    assert file.name == "speeds.pdf"
    content = file.read_bytes()
    assert content.startswith(b"%PDF")
    box = content.partition(b"/MediaBox [")[2].partition(b"]")[0].split()
    assert float(box[2]) / 72.0 * MM == pytest.approx(84.0, abs=0.01)
    assert b"STIXGeneral" in content
    assert b"/Subtype /Image" not in content  # vectors alone


def test_an_unknown_style_draws_nothing(run: Run, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r'style = "poster" is unknown. Choose screen or print'):
        bd.plot.save_all(run, tmp_path / "figures", style="poster")
    assert not (tmp_path / "figures").exists()

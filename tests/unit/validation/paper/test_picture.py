"""Figures inside a page: as text of their bytes, the same each time."""

import base64
from collections.abc import Callable

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from beltdyn.show.plot.style import INK
from validation.paper.picture import picture
from validation.paper.statement import Picture


def drawing(height: float = 1.0) -> Figure:
    figure = Figure(figsize=(2.0, 1.0))
    figure.add_subplot().plot([0.0, height])
    figure.text(0.5, 0.5, mpl.rcParams["text.color"])
    return figure


@pytest.fixture
def drawn() -> Callable[..., Picture]:
    return picture("A caption.")(drawing)


def test_a_figure_is_a_picture_with_its_caption(drawn: Callable[..., Picture]) -> None:
    assert drawn().caption == "A caption."
    kind, data = drawn().source.split(",")
    assert kind == "data:image/svg+xml;base64"
    text = base64.b64decode(data).decode()
    assert text.rstrip().endswith("</svg>")
    assert INK in text


def test_the_same_figure_has_the_same_bytes(drawn: Callable[..., Picture]) -> None:
    assert drawn() == drawn()
    assert drawn(2.0) != drawn()


def test_figures_of_many_points_are_pixels() -> None:
    kind, data = picture("", "png")(drawing)().source.split(",")
    assert kind == "data:image/png;base64"
    assert base64.b64decode(data).startswith(b"\x89PNG")

"""Figures of studies: each sampling has its own."""

from collections.abc import Callable
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Rectangle

from beltdyn.designs.study import study
from beltdyn.errors import ModelError
from beltdyn.model import Drive, ParameterStudy
from beltdyn.results import Result
from beltdyn.show.plot import parallel_coordinates, sobol_indices, study_contour, study_lines, tornado
from beltdyn.show.plot.figures import FIGURES, Choice, chosen_by_default

WIDTH = {"path": "belt.width", "values": "10..20 mm", "steps": 3}
RADIUS = {"path": "pulley[driven].radius", "values": "81..81.5 mm", "steps": 2}
MODULUS = {"path": "belt.youngs_modulus", "values": "90..110 MPa", "steps": 2}


@pytest.fixture
def make(drive: Drive) -> Callable[..., Result]:
    def made(*numbers: dict[str, Any], **more: Any) -> Result:
        given = ParameterStudy(
            number=list(numbers), analysis="equilibrium", results=["tension", "hub_load[driven]"], **more
        )
        return study(given, drive, jobs=1)

    return made


Make = Callable[..., Result]


def test_one_number_is_a_line_in_shown_units(make: Make) -> None:
    result = make(WIDTH)
    assert chosen_by_default([result]) == ("study_lines",)
    ax = study_lines(result)
    (line,) = ax.get_lines()
    assert np.asarray(line.get_xdata()) == pytest.approx([10.0, 15.0, 20.0])
    assert np.asarray(line.get_ydata()) == pytest.approx(result.dataset["tension"].values)
    assert (ax.get_xlabel(), ax.get_title("left")) == ("belt.width [mm]", "tension [N]")
    plt.close("all")


def test_two_numbers_are_lines_and_contours(make: Make) -> None:
    result = make(WIDTH, RADIUS)
    assert chosen_by_default([result]) == ("study_lines", "study_contour")
    ax = study_lines(result, "hub_load[driven]")
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["81 mm", "81.5 mm"]
    assert study_contour(result).get_title("left") == "tension [N]"
    with pytest.raises(ModelError, match='Did you mean "tension"'):
        study_lines(result, "tensoin")
    with pytest.raises(ModelError, match="is not a varying parameter"):
        study_lines(result, over="belt.length")
    plt.close("all")


def test_panels_stand_in_pairs_with_one_legend(drive: Drive) -> None:
    """Their words are long: four beside each other could not be read."""
    results = ["tension", "hub_load[driven]", "hub_load[driver]"]
    given = ParameterStudy(number=[WIDTH, RADIUS], analysis="equilibrium", results=results)
    page = FIGURES["study_lines"].arrange(study(given, drive, jobs=1), Choice())
    first, second, third = (ax.get_position() for ax in page.axes)
    assert first.y0 == pytest.approx(second.y0)
    assert third.y1 < first.y0
    assert [ax.get_legend() for ax in page.axes] == 3 * [None]
    assert len(page.legends) == 1


def test_many_numbers_are_parallel_axes(make: Make) -> None:
    result = make(WIDTH, RADIUS, MODULUS, sampling="latin_hypercube", points=6)
    assert chosen_by_default([result]) == ("parallel_coordinates",)
    ax = parallel_coordinates(result)
    assert len(ax.collections[0].get_paths()) == 6
    assert len(ax.get_xticks()) == 5
    with pytest.raises(ModelError, match="contours need two varying parameters"):
        study_contour(result)
    plt.close("all")


def test_a_tornado_has_the_largest_bar_on_top(make: Make) -> None:
    result = make(WIDTH, MODULUS, sampling="one_at_a_time")
    assert chosen_by_default([result]) == ("tornado",)
    ax = tornado(result)
    assert [text.get_text().partition(" ")[0] for text in ax.get_yticklabels()] == ["belt.youngs_modulus", "belt.width"]
    ends = [bar.get_x() + bar.get_width() for bar in ax.patches if isinstance(bar, Rectangle)]
    assert max(ends) == pytest.approx(float(result.dataset["tension"].max()))
    with pytest.raises(ModelError, match="saltelli"):
        sobol_indices(result)
    plt.close("all")


@pytest.mark.slow
def test_sobol_indices_add_up_where_numbers_act_alone(make: Make) -> None:
    """The tension is the product of width and modulus, whose logarithms add up."""
    result = make(WIDTH, MODULUS, sampling="saltelli", points=32)
    assert chosen_by_default([result]) == ("parallel_coordinates", "sobol_indices")
    ax = sobol_indices(result)
    widths = [bar.get_width() for bar in ax.patches if isinstance(bar, Rectangle)]
    assert widths[0] > 0.8
    assert sum(widths[:2]) == pytest.approx(1.0, abs=0.25)  # 32 base points
    with pytest.raises(ModelError, match="one_at_a_time"):
        tornado(result)
    plt.close("all")

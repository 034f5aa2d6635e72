"""Figures of studies with gaps: whatever is known is drawn, and what is missing is said."""

import re
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from beltdyn.analyses import ANALYSES, Analysis
from beltdyn.designs.study import study
from beltdyn.errors import ModelError
from beltdyn.model import Drive, ParameterStudy
from beltdyn.results import Result
from beltdyn.show import plot
from beltdyn.show.plot.figures import FIGURES, Choice, chosen_by_default
from beltdyn.show.plot.gaps import explain_empty, gaps, mark_isolated
from beltdyn.show.plot.style import NOTE
from beltdyn.show.report import write_report
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import as_text

Make = Callable[..., Result]

NUMBERS: tuple[dict[str, Any], ...] = (
    {"path": "belt.width", "values": "10..20 mm", "steps": 3},
    {"path": "pulley[driven].radius", "values": "81..81.5 mm", "steps": 3},
    {"path": "belt.youngs_modulus", "values": "90..110 MPa", "steps": 3},
    {"path": "belt.temperature", "values": [10.0, 30.0, 50.0]},
)
"""The drive file gives no temperature: its base has none."""
START = {"path": "simulation.start", "values": ["equilibrium", "steady"]}


@pytest.fixture
def make(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> Make:
    """Studies by formulas."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    if "formula" not in ANALYSES:
        ANALYSES.add(Analysis("formula_analysis:formula", "Give results by formulas."), __name__)

    def made(
        *numbers: dict[str, Any], seed: int = 0, failing: float = 0.0, unknown: float = 0.0, **more: Any
    ) -> Result:
        options = {"seed": seed, "failing": failing, "unknown": unknown}
        return study(ParameterStudy(number=list(numbers), analysis="formula", options=options, **more), drive, jobs=1)

    return made


def random_study(make: Make, seed: int) -> Result:
    """A study of one to three numbers with any sampling, and gaps of any size."""
    random = Random(seed)
    sampling = random.choice(("factorial", "together", "one_at_a_time", "latin_hypercube", "saltelli"))
    numbers = random.sample(
        NUMBERS if sampling in ("factorial", "one_at_a_time") else NUMBERS[:3], random.choice((1, 2, 2, 3))
    )
    failing, unknown = random.choice((0.0, 0.3, 0.6, 0.9, 1.0)), random.choice((0.0, 0.3, 0.9))
    return make(
        *numbers,
        sampling=sampling,
        points=8 if sampling != "saltelli" else 2,
        seed=seed,
        failing=failing,
        unknown=unknown,
    )


def known(result: Result, name: str) -> int:
    """Number of points at which a result is known."""
    return int(np.isfinite(result.dataset[name].values).sum())


def complete(result: Result, names: list[str]) -> int:
    """Number of points at which results are all known."""
    return int(np.isfinite([result.dataset[name].values for name in names]).all(axis=0).sum())


def marks(ax: Axes) -> int:
    """Number of points that are drawn as marks, crosses aside."""
    lines = [line for line in ax.lines if line.get_marker() in ("o", ".")]
    drawn = [
        np.isfinite(np.column_stack([line.get_xdata(), line.get_ydata()]).astype(float)).all(axis=1) for line in lines
    ]
    return int(sum(map(np.sum, drawn))) + sum(
        len(np.asarray(one.get_offsets()))
        for one in ax.collections
        if one.get_array() is not None and len(one.get_paths()) == 1
    )


def bars(ax: Axes) -> list[Rectangle]:
    """Bars of axes."""
    return [one for one in ax.patches if isinstance(one, Rectangle)]


def said(ax: Axes) -> str:
    """What is written below axes, and in empty ones."""
    return "\n".join(text.get_text() for text in ax.texts if text.get_gid() == NOTE)


def check(result: Result, folder: Path) -> None:
    """Draw all that suits a study, and compare with what is known of it."""
    names, size = str(result.dataset.attrs["results"]).splitlines(), result.dataset.sizes["point"]
    drawn = [name for name in names if known(result, name)]
    if not chosen_by_default([result]):
        with pytest.raises(ModelError, match=r"there is nothing to draw|is drawn by default"):
            plot.save_all(result, folder)
    for figure in chosen_by_default([result]):
        page = FIGURES[figure].arrange(result, Choice())
        for name, ax in zip(drawn, (one for one in page.axes if one.get_label() != "<colorbar>"), strict=False):
            missing = size - (known(result, name) if figure != "parallel_coordinates" else complete(result, drawn))
            assert f"at {missing} of" in said(ax) if missing else "no value at" not in said(ax)
            if figure in ("study_lines", "study_contour"):
                assert "".join(re.split(r"\n| \[.*", ax.get_title("left"))) == name
                assert marks(ax) == known(result, name)
    assert "belt slips" in write_report(result, folder / "report.html", True).read_text("utf-8") or not gaps(result)
    assert ("known at" in as_text(sheet(result))) == any(known(result, name) < size for name in names)


@pytest.mark.parametrize("seed", range(4))
def test_what_is_known_is_drawn_and_what_is_missing_is_said(make: Make, tmp_path: Path, seed: int) -> None:
    check(random_study(make, seed), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4, 60))
def test_what_is_known_of_many_studies_is_drawn(make: Make, tmp_path: Path, seed: int) -> None:
    check(random_study(make, seed), tmp_path)


def without(result: Result, *points: int, of: str = "stiffness") -> Result:
    """A study without a result at some points."""
    dataset = result.dataset.copy(deep=True)
    dataset[of][list(points)] = np.nan
    return Result(dataset, result.drive)


def test_known_points_along_a_line_are_drawn_without_contours(make: Make) -> None:
    """Triangles of points on a line have no area."""
    ax = plot.study_contour(without(make(*NUMBERS[:2]), 3, 4, 5, 6, 7, 8))
    assert marks(ax) == 3
    assert said(ax) == "no value at 6 of 9 points"


def test_a_tornado_without_a_base_runs_between_known_values(make: Make, ax: Axes) -> None:
    result = make(NUMBERS[0], NUMBERS[2], sampling="one_at_a_time")
    (base,) = np.flatnonzero(
        [
            not one
            for one in np.any(
                [
                    result.dataset[path] != float(result.dataset[path].attrs["base"])
                    for path in ("belt.width", "belt.youngs_modulus")
                ],
                axis=0,
            )
        ]
    )
    plot.tornado(without(result, int(base)), ax=ax)
    ends = [edge for bar in bars(ax) for edge in (bar.get_x(), bar.get_x() + bar.get_width())]
    moved = np.delete(result.dataset["stiffness"].values, base)
    assert (min(ends), max(ends)) == pytest.approx((moved.min(), moved.max()))
    assert said(ax) == "no value at the point of the drive file"


def test_a_number_without_a_value_in_the_drive_file_has_a_bar(make: Make, ax: Axes) -> None:
    result = make(NUMBERS[0], NUMBERS[3], sampling="one_at_a_time")
    values = result.dataset["stiffness"].values + np.arange(result.dataset.sizes["point"])
    dataset = result.dataset.assign(stiffness=result.dataset["stiffness"].copy(data=values))
    plot.tornado(Result(dataset, result.drive), ax=ax)
    assert {text.get_text().partition(" ")[0] for text in ax.get_yticklabels()} == {"belt.width", "belt.temperature"}
    assert all(np.isfinite([bar.get_x(), bar.get_width()]).all() for bar in bars(ax))
    assert said(ax) == ""


def test_results_known_at_different_points_are_lines_of_what_is_known(make: Make, ax: Axes) -> None:
    result = make(*NUMBERS[:3], sampling="latin_hypercube", points=4)
    parts = without(without(result, 0, 1), 2, 3, of="speed")
    plot.parallel_coordinates(parts, ax=ax)
    (lines,) = (one for one in ax.collections if isinstance(one, LineCollection))
    assert len(lines.get_paths()) == 4
    assert said(ax) == "not all values at 4 of 4 points"


def test_words_are_places_along_an_axis(make: Make, ax: Axes) -> None:
    result = make(START)
    assert chosen_by_default([result]) == ("study_lines",)
    plot.study_lines(result, ax=ax)
    assert [text.get_text() for text in ax.get_xticklabels()] == ["equilibrium", "steady"]


def test_nothing_known_says_why(make: Make, tmp_path: Path) -> None:
    result = make(*NUMBERS[:2], failing=1.0)
    assert gaps(result) == "9 of 9 points failed"
    for work in (lambda: plot.save_all(result, tmp_path / "figures"), lambda: plot.study_lines(result)):
        with pytest.raises(ModelError, match=r"nothing to draw.*9 of 9 points failed\. The first: the belt slips"):
            work()
    assert not (tmp_path / "figures").exists()
    assert "nothing to draw" in write_report(result, tmp_path / "report.html").read_text("utf-8")


def test_results_without_a_value_at_any_point_are_named(make: Make, tmp_path: Path) -> None:
    result = make(NUMBERS[0], unknown=1.0)
    assert result.warnings == ["no value at any point: stiffness, speed, level."]
    with pytest.raises(ModelError, match="nothing to draw"):
        plot.study_lines(result)
    assert make(NUMBERS[0]).warnings == []


def test_a_study_of_one_point_names_its_figures(make: Make, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"no figure of study is drawn by default here. Choose some of"):
        plot.save_all(make({"path": "belt.width", "values": [0.01]}), tmp_path)


def test_points_between_gaps_are_marked(ax: Axes) -> None:
    (line,) = ax.plot(range(7), [1.0, np.nan, 2.0, np.nan, 3.0, 4.0, np.nan])
    (whole,) = ax.plot(range(3), [1.0, 2.0, 3.0])
    ax.plot([], [])
    mark_isolated(ax)
    assert (line.get_marker(), line.get_markevery()) == ("o", [0, 2])
    assert whole.get_marker() == "None"


def test_results_that_no_figure_compares_are_refused(make: Make, tmp_path: Path) -> None:
    result = make(NUMBERS[0])
    with pytest.raises(ModelError, match=r"no figure shows several results of study together. Plot each separately"):
        plot.save_all([result, result], tmp_path)
    assert "Plot each separately" in write_report([result, result], tmp_path / "both.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("draw", "empty"),
    [
        (lambda ax: ax.plot([1.0, 2.0], [np.nan, np.nan]), True),
        (lambda ax: ax.axhline(1.0), True),
        (lambda ax: ax.bar([0.0, 1.0], [np.nan, np.nan]), True),
        (lambda ax: ax.fill_between([0.0, 1.0], [np.nan, np.nan], 1.0), True),
        (lambda ax: ax.plot([1.0, 2.0], [np.nan, 0.0], "o"), False),
        (lambda ax: ax.bar([0.0, 1.0], [0.0, np.nan]), False),
        (lambda ax: ax.scatter([1.0], [1.0]), False),
    ],
)
def test_axes_without_values_say_so(make: Make, draw: Callable[[Axes], Any], empty: bool) -> None:
    ax = Figure().add_subplot()
    draw(ax)
    explain_empty(ax, make(NUMBERS[0], failing=1.0))
    assert (said(ax) == "") != empty

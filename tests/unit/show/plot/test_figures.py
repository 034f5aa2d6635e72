"""Figures register themselves by the name of what draws them."""

import matplotlib as mpl
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.show import plot
from beltdyn.show.plot.figures import FIGURES, Choice, always, figure, on_request, over_time
from beltdyn.show.plot.style import INK, axes_or_new


def test_a_figure_is_known_by_the_name_of_its_function_and_drawn_in_the_style(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(FIGURES, "_kinds", dict(before := dict(FIGURES)))
    seen = []

    @figure(always, of=("modes", "run"))
    def mine(run: Run, ax: Axes | None = None) -> Axes:
        """Draw nothing."""
        seen.append(mpl.rcParams["text.color"])
        return axes_or_new(ax)

    assert set(FIGURES) - set(before) == {"mine"}
    assert (mine.__doc__, plot.mine) == ("Draw nothing.", mine)
    made = FIGURES["mine"]
    assert (made.of, made.by_default) == (("modes", "run"), always)
    assert isinstance(made.arrange(run, Choice()), Figure)
    assert seen == [INK]
    assert mpl.rcParams["text.color"] != INK


def test_a_figure_lays_itself_out_for_what_is_chosen(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FIGURES, "_kinds", {})
    asked = []

    def arrange(draw: object, run: Run, choice: Choice) -> Figure:
        asked.append(choice)
        return Figure()

    @figure(on_request, arrange)
    def mine(run: Run, ax: Axes | None = None) -> Axes:
        raise AssertionError

    FIGURES["mine"].arrange(run, Choice(1, "belt_speed"))
    assert asked == [Choice(1, "belt_speed", ("driver", "driven"))]


def test_what_is_drawn_where_nothing_is_chosen(run: Run) -> None:
    one = Run(run.dataset.isel(time=slice(1)), run.drive)
    assert [rule(some) for rule in (always, over_time, on_request) for some in (run, one)] == [
        *(True, True),
        *(True, False),
        *(False, False),
    ]


def test_the_result_may_be_named(run: Run) -> None:
    """Wherever it stands among the keywords."""
    ax = Figure().add_subplot()
    assert plot.speeds(ax=ax, run=run) is ax
    assert len(ax.lines) == 2


def test_a_figure_of_one_result_refuses_several(run: Run) -> None:
    with pytest.raises(ModelError, match=r"'configuration' shows one result, but there are 2.*speeds, torques"):
        plot.configuration([run, run])  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="at least one result"):
        plot.speeds([])  # type: ignore[arg-type]

"""Several results in one figure."""

from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.show import plot
from beltdyn.show.plot.headline import headlines, names_of_results


def named(run: Run, path: str) -> Run:
    """The same results, from a file of this name."""
    return Run(run.dataset, run.drive, Path(path))


@pytest.fixture
def pair(run: Run, make_run: Callable[..., Run]) -> list[Run]:
    """A run, and one whose driven pulley is slower."""
    turning = {name: run.dataset[name].values * [1.0, 0.9] for name in ("pulley_speed", "pulley_angle")}
    slower = make_run(**turning)
    return [named(run, "one.nc"), named(slower, "other.nc")]


def legend(ax: Axes) -> list[str]:
    box = ax.get_legend()
    assert box is not None
    return [text.get_text() for text in box.get_texts()]


def test_a_color_for_each_pulley_and_a_line_style_for_each_run(pair: list[Run], ax: Axes) -> None:
    assert plot.speeds(pair, ax) is ax  # type: ignore[arg-type]
    assert legend(ax) == ["driver", "driven", "one", "other"]
    for number, run in enumerate(pair):
        for pulley in (0, 1):
            line = ax.lines[2 * number + pulley]
            np.testing.assert_array_equal(line.get_ydata(), run.dataset["pulley_speed"][:, pulley])
            assert (line.get_linestyle() == "-") == (number == 0)
    hue, paler = (np.array(to_rgb(ax.lines[number].get_color())) for number in (1, 3))
    np.testing.assert_allclose(1.0 - paler, 0.75 * (1.0 - hue))


def test_what_differs_is_named_after_its_run(pair: list[Run], ax: Axes) -> None:
    """The slip of the driven pulley is a part of its name; notes are written once."""
    plot.slip(pair, ax)  # type: ignore[arg-type]
    names = legend(ax)
    assert names[0] == "driver 0.000%"
    assert [name.split(", ")[1] for name in names[1:3]] == ["one", "other"]
    assert len(ax.texts) == 1


@pytest.mark.parametrize("order", [slice(None), slice(None, None, -1)])
@pytest.mark.parametrize("name", ["hub_load_sizes", "slip", "span_tensions"])
def test_the_scale_has_room_for_all_results(
    run: Run, make_run: Callable[..., Run], ax: Axes, name: str, order: slice
) -> None:
    """The first may be the smaller, or the larger one."""
    more = make_run(
        hub_force=1.5 * run.dataset["hub_force"].values,
        span_tension=1.5 * run.dataset["span_tension"].values,
        pulley_speed=run.dataset["pulley_speed"].values * [1.0, 0.9],
    )
    draw = getattr(plot, name)
    alone = [draw(one).get_ylim() for one in (run, more)]
    low, high = draw([named(run, "a.nc"), named(more, "b.nc")][order], ax).get_ylim()
    assert low <= min(bottom for bottom, _ in alone)
    assert high >= 0.99 * max(top for _, top in alone)
    plt.close("all")


@pytest.mark.slow
def test_a_page_of_several_runs_has_their_names_above(pair: list[Run], tmp_path: Path) -> None:
    page = plot.FIGURES["powers"].arrange(pair, plot.figures.Choice())
    assert page.get_suptitle() == "one, other"
    names = [path.stem for path in plot.save_all(pair, tmp_path)]
    expected = ["speeds", "span_tensions", "slip", "hub_load_sizes", "slip_safety", "torques", "powers", "losses"]
    assert names == expected


def test_runs_of_one_drive_are_told_by_their_files(pair: list[Run]) -> None:
    """A name that all have stands above, once."""
    same = [Run(one.dataset, one.drive.replace(name="Fan"), one.path) for one in pair]
    assert names_of_results(same) == ["one", "other"]
    assert headlines(same) == "Fan"
    other = [Run(one.dataset, one.drive.replace(name=name), one.path) for one, name in zip(pair, "AB", strict=True)]
    assert names_of_results(other) == ["A", "B"]


def test_runs_in_memory_are_named_by_what_differs(run: Run) -> None:
    stiffer = run.drive.replace(belt=run.drive.belt.replace(elements=30))
    assert names_of_results([run, Run(run.dataset, stiffer)]) == ["belt.elements = 20", "belt.elements = 30"]
    assert names_of_results([run, run]) == ["result 1", "result 2"]


def test_runs_are_named_by_what_was_given_and_not_by_what_was_found(run: Run) -> None:
    """The belt's length follows from the tension."""
    given = [run.drive.replace(belt=run.drive.belt.replace(installed_tension=tension)) for tension in (40.0, 50.0)]
    runs = [Run(run.dataset.assign_attrs(drive_as_given=one.text), run.drive) for one in given]
    assert names_of_results(runs) == ["belt.installed_tension = 40.0", "belt.installed_tension = 50.0"]


def test_contact_forces_of_two_runs_differ_in_line_style(pair: list[Run], ax: Axes) -> None:
    plot.contact_forces(pair, "driven", ax=ax)  # type: ignore[arg-type]
    assert legend(ax) == ["driven", "one", "other"]
    first, other = (line for line in ax.lines if line.get_label() == "driven")
    assert (first.get_linestyle() == "-") != (other.get_linestyle() == "-")


def test_what_cannot_be_compared_is_refused(pair: list[Run]) -> None:
    with pytest.raises(ModelError, match=r"'configuration' shows one result.* Draw each separately"):
        plot.configuration(pair)  # type: ignore[arg-type]


def test_panels_of_several_runs_share_a_legend_of_line_styles(pair: list[Run]) -> None:
    """Each panel has its whole width: what it shows stands in its title."""
    page = Figure(layout="constrained")
    for ax in page.subplots(1, 2):
        plot.contact_forces(pair, "driven", ax=ax)  # type: ignore[arg-type]
    (shared,) = page.legends
    assert [text.get_text() for text in shared.get_texts()] == ["one", "other"]
    assert [ax.get_legend() for ax in page.axes] == [None, None]


def test_long_names_stand_below_the_figure(make_run: Callable[..., Run]) -> None:
    runs = [make_run(), make_run()]
    for run, name in zip(runs, ("before", "after"), strict=True):
        run.path = Path(f"a drive with a name as long as this one, {name}.nc")
    ax = plot.speeds(runs)  # type: ignore[arg-type]
    assert legend(ax) == ["driver", "driven"]
    (below,) = ax.figure.figure.legends
    assert [text.get_text().rsplit(" ", 1)[1] for text in below.get_texts()] == ["before", "after"]


def test_drives_of_different_pulleys_have_a_panel_for_each(run: Run, make_run: Callable[..., Run]) -> None:
    """The second drive has one pulley in common with the first; each keeps its line style in all panels."""
    other = Run(make_run().dataset, run.drive.with_({"pulley[driven].name": "fan"}), Path("other.nc"))
    page = plot.FIGURES["contact_forces"].arrange([named(run, "one.nc"), other], plot.figures.Choice())
    titles = [ax.get_title(loc="left").partition(",")[0] for ax in page.axes]
    assert titles[:3] == ["driver", "driven", "fan"]
    shown = [[line for line in ax.lines if line.get_label() in titles] for ax in page.axes[:3]]
    assert [len(lines) for lines in shown] == [2, 1, 1]
    assert [lines[0].get_linestyle() == "-" for lines in shown] == [True, True, False]
    with pytest.raises(ModelError, match="'crank' is not in this drive"):
        plot.contact_forces([run, other], "crank")  # type: ignore[arg-type]


def test_titles_and_notes_keep_what_is_true_of_all(run: Run, make_run: Callable[..., Run], ax: Axes) -> None:
    """A run that ends later has other means."""
    time = run.dataset["time"]
    later = named(Run(run.dataset.assign_coords(time=(2.0 * time).assign_attrs(time.attrs)), run.drive), "later.nc")
    plot.hub_load_sizes([named(run, "one.nc"), later], ax)  # type: ignore[arg-type]
    assert [text.get_text() for text in ax.texts] == ["numbers: means at the end"]


def test_long_names_of_results_are_told_by_their_line_styles(pair: list[Run]) -> None:
    for run, name in zip(pair, ("before", "after"), strict=True):
        run.path = Path(f"a drive with a name as long as this one, {name}.nc")
    ax = plot.slip(pair)  # type: ignore[arg-type]
    assert all(len(name) < 20 for name in legend(ax))
    assert len(ax.figure.figure.legends) == 1

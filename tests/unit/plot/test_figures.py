from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from beltdyn import plot
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.plot.panels import panels as lay_out
from beltdyn.plot.panels import rows as in_rows
from beltdyn.results import Run, summarize
from beltdyn.results.derived import slips


@pytest.mark.parametrize(
    ("draw", "variable", "ylabel"),
    [
        (plot.speeds, "pulley_speed", "Pulley speed [rad/s]"),
        (plot.torques, "pulley_torque", "Torque of the belt on the pulley [N·m]"),
        (plot.span_tensions, "span_tension", "Span tension [N]"),
    ],
)
def test_histories(run: Run, ax: Axes, draw: Callable[..., Axes], variable: str, ylabel: str) -> None:
    assert draw(run, ax) is ax
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Time [s]", ylabel)
    values = run.dataset[variable]
    for number, line in enumerate(ax.lines):
        np.testing.assert_array_equal(line.get_ydata(), values[:, number])
        assert line.get_label() == str(values[values.dims[1]][number].item())


def test_energy(run: Run, ax: Axes) -> None:
    plot.energy(run, ax)
    assert ax.get_ylabel() == "Energy [J]"
    assert ax.get_title(loc="left") + ax.get_title() == "Closure error up to 1.0e-04 of the energy put in"
    assert {str(line.get_label()) for line in ax.lines} >= {"Kinetic energy", "Work of the drivers", "Loss in friction"}


def test_new_axes_are_made_and_the_style_is_left_alone(run: Run) -> None:
    before = dict(mpl.rcParams)
    ax = plot.speeds(run)
    assert ax.get_figure() is plt.gcf()
    assert dict(mpl.rcParams) == before


def test_single_output_is_a_point(make_run: Callable[..., Run], ax: Axes) -> None:
    plot.speeds(make_run(outputs=1), ax)
    assert all(line.get_marker() == "o" for line in ax.lines)


def test_configuration(run: Run, ax: Axes) -> None:
    plot.configuration(run, time=0.501, ax=ax)
    assert ax.get_title() + ax.get_title(loc="left") == "t = 0.5 s"
    instant = run.fields_at(0.5)
    (belt,) = (artist for artist in ax.collections if isinstance(artist, LineCollection))
    np.testing.assert_array_equal(belt.get_array(), instant["belt_tension"])
    starts = np.array([segment[0] for segment in belt.get_segments()])
    np.testing.assert_allclose(starts, instant["node_position"], atol=1e-12)
    rims = [patch for patch in ax.patches if isinstance(patch, Circle) and patch.radius == 0.08125]
    assert [rim.center for rim in rims] == [pulley.center for pulley in run.drive.pulleys]
    assert [text.get_text() for text in ax.texts] == ["driver", "driven"]


def test_configuration_of_a_drive_at_rest(make_run: Callable[..., Run], ax: Axes) -> None:
    plot.configuration(make_run(outputs=1), ax=ax)
    assert all(isinstance(patch, Circle) for patch in ax.patches)


@pytest.mark.parametrize(("pulley", "rising"), [("driver", False), ("driven", True), (1, True)])
def test_normal_force_falls_on_the_driver(run: Run, ax: Axes, pulley: str | int, rising: bool) -> None:
    plot.contact_forces(run, pulley, ax=ax)
    distance, force = (np.asarray(data) for data in ax.lines[0].get_data())
    assert distance[0] == 0.0
    assert np.all(np.diff(distance) > 0)
    assert distance[-1] == pytest.approx(np.pi * 0.08125, abs=0.015)
    assert np.all(np.diff(force) > 0) == rising
    assert force.min() > 0
    assert ax.get_ylabel() == "Normal force on the belt [N/m]"
    assert ax.get_xlabel().endswith("[m]")


def test_friction_with_its_limits(run: Run, ax: Axes) -> None:
    plot.contact_forces(run, "driven", kind="friction", ax=ax)
    (limits,) = ax.collections
    assert isinstance(limits, LineCollection)
    upper, lower = (np.asarray(segment) for segment in limits.get_segments())
    np.testing.assert_allclose(upper[:, 1], -lower[:, 1])
    force = np.asarray(ax.lines[0].get_ydata())
    assert np.all(np.abs(force) < upper[:, 1])
    assert force.max() < 0


@pytest.mark.parametrize("pulley", ["idler", 2, -1])
def test_unknown_pulley_is_a_model_error(run: Run, ax: Axes, pulley: str | int) -> None:
    with pytest.raises(ModelError, match="Its pulleys are: driver, driven"):
        plot.contact_forces(run, pulley, ax=ax)


@pytest.mark.parametrize("draw", [plot.configuration, plot.energy, lambda run: plot.contact_forces(run, 0)])
def test_nothing_to_draw_is_a_model_error(run: Run, draw: Callable[..., Any]) -> None:
    with pytest.raises(ModelError, match="before its first output"):
        draw(Run(run.dataset.isel(time=slice(0)), run.drive))


def test_save_all(tmp_path: Path, run: Run) -> None:
    paths = plot.save_all(run, tmp_path / "figures")
    names = ["configuration", "contact_forces", "contact_pressure", "speeds", "torques", "span_tensions", "energy"]
    names += ["slip", "capstan_margins", "powers", "losses", "hub_loads"]
    assert [path.name for path in paths] == [f"{name}.png" for name in names]
    assert sorted((tmp_path / "figures").iterdir()) == sorted(paths)
    assert not plt.get_fignums()


def test_save_all_of_one_output(tmp_path: Path, make_run: Callable[..., Run]) -> None:
    paths = plot.save_all(make_run(outputs=1), tmp_path)
    assert [path.stem for path in paths] == ["configuration", "contact_forces", "contact_pressure"]


def test_chosen_figures(tmp_path: Path, run: Run) -> None:
    chosen = ["mid_spans", "wear_by_arc", "wear_by_belt", "tension_spectrum", "contact_pressure"]
    paths = plot.save_all(run, tmp_path, chosen, pulley="driven")
    assert [path.stem for path in paths] == chosen


def test_unknown_figure_is_a_model_error(tmp_path: Path, run: Run) -> None:
    with pytest.raises(
        ModelError, match=r"figure 'speed' is not known\. Choose out of configuration, contact_forces, "
    ):
        plot.save_all(run, tmp_path / "figures", ["slip", "speed"])
    assert not (tmp_path / "figures").exists()


def tensioned_run(run: Run) -> Run:
    """A run whose driver sits on an arm that turns as its shaft does."""
    place = run.dataset["shaft_angle"][:, :1].rename(pulley="tensioner")
    x, y = run.drive.pulleys[0].center
    arm = {"kind": "rotary", "pulley": "driver", "pivot": (x, y + 1.0), "preload": 1.0, "inertia": 1.0}
    dataset = run.dataset.assign(tensioner_position=place.assign_attrs(units="m, rad", long_name="Tensioner position"))
    return Run(dataset, run.drive.replace(tensioner=[arm]))


def test_the_place_of_an_arm_is_drawn_in_degrees(run: Run, ax: Axes) -> None:
    plot.tensioners(tensioned_run(run), ax)
    assert ax.get_ylabel() == "Tensioner position [°]"
    np.testing.assert_allclose(np.asarray(ax.lines[0].get_ydata()), np.degrees(run.dataset["shaft_angle"].values[:, 0]))


def test_what_vibrates_is_drawn_without_dashes(make_run: Callable[..., Run], ax: Axes) -> None:
    """Six whole swings as high as the figure do, four do not."""
    time = np.linspace(0.0, 1.0, 101)
    swings = make_run(span_tension=50.0 + 9.0 * np.sin(2.0 * np.pi * np.outer(time, (4.0, 6.0))))
    plot.span_tensions(swings, ax)
    assert [line.get_linewidth() for line in ax.lines] == [1.7, 0.8]


def test_slip_in_vibration_is_drawn_as_means_over_a_turn(make_run: Callable[..., Run], run: Run, ax: Axes) -> None:
    speed = run.dataset["pulley_speed"].values.copy()
    speed[60:, 1] *= 1.0 + 0.1 * (-1.0) ** np.arange(41)
    shaken = make_run(pulley_speed=speed)
    plot.slip(shaken, ax)
    np.testing.assert_allclose(np.asarray(ax.lines[1].get_ydata()), slips(shaken)["slip"][:, 1])
    assert ax.lines[1].get_label() == f"driven {summarize(shaken).pulleys[1].slip:.3%}"


def test_all_figures_of_a_drive_with_a_tensioner(tmp_path: Path, run: Run) -> None:
    """Those of a sweep need more turns than this run has, and are tried elsewhere."""
    tensioned = tensioned_run(run)
    chosen = [name for name in plot.FIGURES if name not in ("waterfall", "orders")]
    assert [path.stem for path in plot.save_all(tensioned, tmp_path, chosen)] == chosen
    assert "tensioners" in [path.stem for path in plot.save_all(tensioned, tmp_path)]


@pytest.mark.parametrize(
    ("pulleys", "columns", "rows"), [(1, 1, 2), (2, 2, 2), (4, 4, 2), (5, 3, 4), (7, 4, 4), (9, 3, 6)]
)
def test_panels_of_many_pulleys_are_in_rows(pulleys: int, columns: int, rows: int) -> None:
    """Two kinds of force for each block of pulleys, no more than four beside each other."""
    blocks = in_rows(list(range(pulleys)))
    assert [number for block in blocks for number in block] == list(range(pulleys))
    figure = lay_out([[lambda ax: ax for _ in block] for block in blocks for _ in range(2)])
    assert len(figure.axes) == 2 * pulleys
    assert figure.get_size_inches().tolist() == pytest.approx([4.2 * columns, 2.9 * rows])


def test_figures_that_cannot_be_written_are_a_model_error(tmp_path: Path, run: Run) -> None:
    (tmp_path / "speeds.png").mkdir()
    with pytest.raises(ModelError, match="cannot be written"):
        plot.save_all(run, tmp_path)
    assert not any(path.name.startswith(".") for path in tmp_path.iterdir())


def test_what_the_mesh_does_not_resolve_is_marked(run: Run, fine_drive: Drive) -> None:
    for draw in (lambda one: plot.contact_forces(one, "driver"), plot.span_tensions):
        assert not draw(Run(run.dataset, fine_drive)).texts
        (note,) = draw(run).texts
        assert "20 elements" in note.get_text()

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from beltdyn.analyses import RUN
from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, RotaryTensioner
from beltdyn.results import Run, summarize
from beltdyn.results.derived import slips
from beltdyn.show import plot


@pytest.mark.parametrize("draw", [plot.configuration, plot.energy, lambda run: plot.contact_forces(run, 0)])
def test_nothing_to_draw_is_a_model_error(run: Run, draw: Callable[..., Any]) -> None:
    with pytest.raises(ModelError, match="before its first output"):
        draw(Run(run.dataset.isel(time=slice(0)), run.drive))


@pytest.mark.slow
def test_save_all(tmp_path: Path, run: Run) -> None:
    paths = plot.save_all(run, tmp_path / "figures")
    names = ["configuration", "speeds", "span_tensions", "slip", "hub_load_sizes", "hub_loads", "slip_safety"]
    names += ["torques", "powers", "losses", "energy", "contact_pressure"]
    assert [path.name for path in paths] == [f"{name}.png" for name in names]
    assert sorted((tmp_path / "figures").iterdir()) == sorted(paths)
    assert not plt.get_fignums()


def test_save_all_of_one_output(tmp_path: Path, make_run: Callable[..., Run]) -> None:
    paths = plot.save_all(make_run(outputs=1), tmp_path)
    assert [path.stem for path in paths] == ["configuration", "contact_pressure"]


def test_chosen_figures(tmp_path: Path, run: Run) -> None:
    chosen = ["mid_spans", "wear_by_arc", "wear_by_belt", "tension_spectrum", "contact_pressure"]
    paths = plot.save_all(run, tmp_path, chosen, pulley="driven")
    assert [path.stem for path in paths] == chosen


def test_unknown_figure_is_a_model_error(tmp_path: Path, run: Run) -> None:
    with pytest.raises(
        ModelError, match=r"figure 'speed' is unknown\. Choose from configuration, carriage_error, contact_forces, "
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


def arm_angles(drive: Drive, positions: ArrayLike) -> FloatArray:
    """Angles of the arm from the x axis, °; positive positions turn it so that the path lengthens."""
    (arm,) = drive.moving_tensioners
    assert isinstance(arm, RotaryTensioner)
    number = drive.number_of(arm.pulley)
    away = np.subtract(drive.pulleys[number].center, arm.pivot)
    lengthens = drive.path.gradient(number) @ np.array([-away[1], away[0]])
    nominal = np.arctan2(away[1], away[0])
    return np.asarray(np.degrees(nominal + np.sign(lengthens) * np.asarray(positions)))


def test_the_place_of_an_arm_is_drawn_in_degrees(run: Run, ax: Axes) -> None:
    plot.tensioners(tensioned_run(run), ax)
    assert ax.get_ylabel() == "Arm angle [°]"
    np.testing.assert_allclose(
        np.asarray(ax.lines[0].get_ydata()),
        arm_angles(tensioned_run(run).drive, run.dataset["shaft_angle"].values[:, 0]),
    )


def test_stops_are_drawn_inside_the_axes_or_named_at_their_edge(run: Run, ax: Axes) -> None:
    """The upper one is just reached, the lower one so far off that it would squeeze the motion."""
    swung = tensioned_run(run)
    (arm,), place = swung.drive.tensioners, 0.01 * swung.dataset["tensioner_position"]
    dataset = swung.dataset.assign(tensioner_position=place.assign_attrs(swung.dataset["tensioner_position"].attrs))
    reached = float(place.max())
    stopped = arm.replace(stops=(-9.0 * reached, reached), stop_stiffness=1e4)
    plot.tensioners(Run(dataset, swung.drive.replace(tensioner=[stopped])), ax)
    lower, upper = (float(arm_angles(swung.drive, stop)) for stop in (-9.0 * reached, reached))
    far = "↓" if lower < upper else "↑"
    assert {text.get_text() for text in ax.texts} == {
        f"driver: upper stop {upper:.4g}°",
        f"driver: lower stop {lower:.4g}° {far}",
    }
    (line,) = (one for one in ax.lines if str(one.get_label()).startswith("_"))
    assert line.get_ydata() == pytest.approx([upper, upper])
    low, high = ax.get_ylim()
    assert low < upper < high
    assert not low < lower < high


def test_slip_in_vibration_is_drawn_as_means_over_a_turn(make_run: Callable[..., Run], run: Run, ax: Axes) -> None:
    speed = run.dataset["pulley_speed"].values.copy()
    speed[60:, 1] *= 1.0 + 0.1 * (-1.0) ** np.arange(41)
    shaken = make_run(pulley_speed=speed)
    plot.slip(shaken, ax)
    np.testing.assert_allclose(np.asarray(ax.lines[1].get_ydata()), slips(shaken)["slip"][:, 1])
    assert ax.lines[1].get_label() == f"driven {summarize(shaken).pulleys[1].slip:.3%}"


_OF_TEETH = ("load_sharing", "transmission_error", "transmission_orders")
_NOT_OF_IT = ("waterfall", "orders", "carriage_error", "nip_pressure", *_OF_TEETH)


@pytest.mark.slow
def test_all_figures_of_a_drive_with_a_tensioner(tmp_path: Path, run: Run) -> None:
    """Those of a sweep need more turns than this run has, others teeth, carriages, nips; they are tried elsewhere."""
    tensioned = tensioned_run(run)
    chosen = [name for name, one in plot.FIGURES.items() if RUN in one.of and name not in _NOT_OF_IT]
    assert [path.stem for path in plot.save_all(tensioned, tmp_path, chosen)] == chosen
    assert "tensioners" in [path.stem for path in plot.save_all(tensioned, tmp_path)]


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

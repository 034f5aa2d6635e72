"""Figures of operating points."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PathCollection

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.points.operating_points import OperatingPoints
from beltdyn.results import Result, Variable
from beltdyn.show import plot
from beltdyn.show.plot.figures import chosen_by_default


def made(drive: Drive, kind: str, **sizes: int) -> Result:
    """A table with numbers that grow along it."""
    units = {"speed": "rad/s"}
    axes = {
        name: (Variable((name,), units.get(name, "1"), name.capitalize()), np.linspace(0.1, 1.0, size))
        for name, size in sizes.items()
    }
    points = OperatingPoints(kind, drive, axes)
    for values in points.arrays.values():
        if values.dtype.kind == "f":
            values[...] = np.arange(values.size).reshape(values.shape)
    more = {}
    if kind == "traction":
        line = np.linspace(0.0, 1.0, sizes["slip"])
        more = {
            name: (Variable(("slip",), "1", name), line) for name in ("torque", "elastic", "added", "capstan_torque")
        }
    points.derive = lambda arrays: more
    points.attributes = {"pulley": "driven"}
    return points.result()


def test_over_speed(drive: Drive) -> None:
    ax = plot.operating_points(made(drive, "operating_map", speed=4), "pulley_slip")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Speed [rpm]", "Slip [%]")
    assert len(ax.lines) == 2
    np.testing.assert_allclose(np.asarray(ax.lines[1].get_ydata(), dtype=float), 100.0 * np.array([1.0, 3.0, 5.0, 7.0]))
    np.testing.assert_allclose(np.asarray(ax.lines[1].get_xdata(), dtype=float)[-1], 30.0 / np.pi)


def test_large_slip_safeties_are_cut_off_where_there_are_small_ones(drive: Drive) -> None:
    """An axis up to 10 would be empty where all of them are larger."""
    result = made(drive, "operating_map", speed=8)
    top = plot.operating_points(result, "slip_safety").get_ylim()[1]
    assert top == 10.0
    large = Result(result.dataset.assign(slip_safety=result.dataset["slip_safety"] + 20.0), drive)
    assert plot.operating_points(large, "slip_safety").get_ylim()[1] == pytest.approx(1.1 * 35.0)


@pytest.mark.slow
def test_all_of_a_kind_are_saved(drive: Drive, tmp_path: Path) -> None:
    assert [path.stem for path in plot.save_all(made(drive, "operating_map", speed=4), tmp_path)] == [
        "operating_points"
    ]
    both = plot.save_all(made(drive, "operating_map", speed=4, load=3), tmp_path)
    assert sorted(path.stem for path in both) == ["efficiency_map", "operating_points"]
    assert [path.stem for path in plot.save_all(made(drive, "duty", row=3), tmp_path)] == ["operating_points"]
    assert [path.stem for path in plot.save_all(made(drive, "traction", slip=5), tmp_path)] == ["traction_curve"]


def test_traction(drive: Drive) -> None:
    ax = plot.traction_curve(made(drive, "traction", slip=5))
    assert ax.get_xlabel() == "Torque on driven [N·m]"
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == [
        "slip",
        "elastic creep",
        "bending and friction law",
        "Euler's limit 1 N·m",
    ]


def test_a_traction_curve_names_the_pulley_that_slips(drive: Drive) -> None:
    """The driven one, from the fourth slip on: its whole arc slides."""
    table = made(drive, "traction", slip=5)
    wrap, sliding = np.ones((5, 2)), np.full((5, 2), 0.5)
    sliding[3:, 1] = 1.0
    shape = ("slip", "pulley")
    dataset = table.dataset.assign(wrap_angle=(shape, wrap), sliding_arc=(shape, sliding))
    ax = plot.traction_curve(Result(dataset, table.drive))
    (words,) = [text.get_text() for text in ax.texts]
    assert words == "driven slips\nat 0.75 N·m"
    circle = ax.lines[-1]
    assert (float(circle.get_xdata()[0]), float(circle.get_ydata()[0])) == pytest.approx((0.75, 77.5))  # type: ignore[index, arg-type]
    table.dataset["sliding_arc"][:] = 0.0
    table.dataset["wrap_angle"][:] = 1.0
    assert not plot.traction_curve(table).texts


def test_what_cannot_be_drawn(drive: Drive) -> None:
    with pytest.raises(ModelError, match="variable = 'wear' is not a variable of operating points"):
        plot.operating_points(made(drive, "operating_map", speed=4), "wear")
    with pytest.raises(ModelError, match="an efficiency map needs several speeds and loads"):
        plot.efficiency_map(made(drive, "operating_map", speed=4))


def test_a_map_with_failed_points_shows_the_known_ones(drive: Drive) -> None:
    table = made(drive, "operating_map", speed=4, load=3)
    failed = np.zeros((4, 3), dtype=bool)
    failed[0, :2] = failed[2, 1] = failed[3, 2] = True
    values = table.dataset["efficiency"].transpose("speed", "load")
    ax = plot.efficiency_map(Result(table.dataset.assign(efficiency=values.where(~failed)), table.drive))
    (circles,) = (one for one in ax.collections if isinstance(one, PathCollection))
    (crosses,) = ax.lines
    assert (len(np.asarray(circles.get_offsets())), len(np.asarray(crosses.get_xdata()))) == (8, 4)


def test_one_speed_is_drawn_over_the_load(drive: Drive) -> None:
    table = made(drive, "operating_map", speed=1, load=3)
    assert "efficiency_map" not in chosen_by_default([table])
    ax = plot.operating_points(table, "hub_load")
    assert ax.get_xlabel() == "Load"
    assert {len(np.asarray(line.get_xdata())) for line in ax.lines} == {3}

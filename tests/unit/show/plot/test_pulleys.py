from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.derived import contact_arc, hub_loads, slip_safety, slips
from beltdyn.show import plot

MakeRun = Callable[..., Run]


def texts(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts]


def test_slip(run: Run, ax: Axes) -> None:
    plot.slip(run, ax)
    assert ax.get_ylabel() == "Slip [%]"
    driver, driven, _, elastic = ax.lines
    np.testing.assert_array_equal(driven.get_ydata(), slips(run)["slip"][:, 1])
    np.testing.assert_array_equal(elastic.get_ydata(), slips(run)["elastic_creep"][:, 1])
    assert [line.get_label() for line in (driver, driven)] == ["driver 0.000%", "driven 0.500%"]


def test_slip_that_slides_shows_its_creep(make_run: MakeRun, run: Run, ax: Axes) -> None:
    touched = run.dataset["contact_pulley"].values
    slipping = make_run(slip_velocity=np.where(touched == 1, 0.4, 0.0))
    plot.slip(slipping, ax)
    np.testing.assert_array_equal(ax.lines[3].get_ydata(), slips(slipping)["creep"][:, 1])
    assert "dotted: creep" in ax.texts[0].get_text()


def test_safeties_are_cut_off_and_gross_slip_is_marked(run: Run, ax: Axes) -> None:
    plot.slip_safety(run, ax)
    assert ax.get_ylim() == (0.0, 10.0)
    assert texts(ax) == ["gross slip"]
    safeties = slip_safety(run)[:, 1]
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), safeties.where(np.isfinite(safeties)))


def test_hub_loads_wander_in_the_plane(run: Run) -> None:
    ax = Figure().add_subplot(projection="polar")
    plot.hub_loads(run, "driven", ax)
    loads = hub_loads(run)
    early, late, last = ax.lines
    np.testing.assert_array_equal(
        np.append(np.asarray(early.get_ydata())[:-1], late.get_ydata()), loads["hub_load"][:, 1]
    )
    np.testing.assert_array_equal(last.get_xdata(), loads["hub_direction"][-1:, 1])
    assert ax.get_title(loc="left") == "Hub load [N]"
    assert len(plot.hub_loads(run).lines) == 6


def test_hub_loads_need_polar_axes(run: Run, ax: Axes) -> None:
    with pytest.raises(ModelError, match="give polar axes"):
        plot.hub_loads(run, ax=ax)


def test_powers(run: Run, ax: Axes) -> None:
    plot.powers(run, ax)
    assert ax.get_ylabel() == "Power from the shaft [W]"
    assert np.asarray(ax.lines[0].get_ydata())[-1] == pytest.approx(12.0 * 30.0 * 0.08125)


def test_pressure_and_shear_with_what_slides(make_run: MakeRun, run: Run, ax: Axes) -> None:
    touched = run.dataset["contact_pulley"].values
    slipping = make_run(slip_velocity=np.where(touched == 1, 0.4, 0.0))
    plot.contact_pressure(slipping, "driven", ax=ax)
    arc = contact_arc(slipping, "driven")
    pressure, shear, _ = ax.lines
    np.testing.assert_allclose(np.asarray(pressure.get_xdata()), np.degrees(arc["angle"]))
    np.testing.assert_allclose(np.asarray(pressure.get_ydata()), arc["pressure"] / 1e3)
    np.testing.assert_allclose(np.asarray(shear.get_ydata()), arc["shear"] / 1e3)
    (shade,) = ax.patches
    assert shade.get_data().values.all()  # type: ignore[attr-defined]
    assert ax.get_ylabel() == "Contact stress [kPa]"


def test_pressure_where_nothing_touches(make_run: MakeRun, run: Run, ax: Axes) -> None:
    free = np.full_like(run.dataset["contact_pulley"].values, -1)
    plot.contact_pressure(make_run(contact_pulley=free), 0, ax=ax)
    assert np.asarray(ax.lines[0].get_xdata()).size == 0


def test_the_scale_of_slip_is_that_of_the_running_drive(make_run: MakeRun, run: Run, ax: Axes) -> None:
    """The driven pulley stands at first."""
    turning = {name: run.dataset[name].values.copy() for name in ("pulley_speed", "pulley_angle")}
    turning["pulley_speed"][:5, 1] = 0.0
    plot.slip(make_run(**turning), ax)
    low, high = ax.get_ylim()
    assert -1.0 < low < 0.0
    assert 0.5 < high < 1.0


def test_safeties_that_vibrate_are_bands(make_run: MakeRun, run: Run, ax: Axes) -> None:
    ripple = np.where(np.arange(run.dataset.sizes["time"]) % 2, 5.0, -5.0)[:, None]
    names = ("span_tension", "span_tension_at_start", "span_tension_at_end")
    shaken = make_run(
        pulley_torque=run.dataset["pulley_torque"].values[-1] + 0.0 * ripple,
        **{name: run.dataset[name].values[-1] + ripple for name in names},
    )
    plot.slip_safety(shaken, ax)
    assert ax.collections


def test_sizes_of_hub_loads_have_their_values_in_the_legend(run: Run, ax: Axes) -> None:
    plot.hub_load_sizes(run, ax)
    loads = hub_loads(run)["hub_load"]
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), loads[:, 1])
    last = float(loads[-1, 1])
    assert ax.lines[1].get_label() == f"driven {last:.4g} N"
    assert ax.get_ylabel() == "Hub load [N]"

"""What stands above a figure."""

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from beltdyn.results import Run
from beltdyn.show import plot
from beltdyn.show.plot.headline import headline, write_headline


def test_a_run_is_named_with_its_operating_point(run: Run) -> None:
    """The driver turns at 30 rad/s and puts in 29.25 W."""
    named = Run(run.dataset, run.drive, Path("fan.nc"))
    speed = float(run.dataset["pulley_speed"][-1, 0]) * 30.0 / 3.141592653589793
    assert headline(named) == f"fan: driver {speed:.4g} rpm, 29.2 W input at the end"
    assert headline(run) == headline(named).removeprefix("fan: ")


def test_steady_running_has_no_end(run: Run) -> None:
    steady = Run(run.dataset.assign_attrs(belt_parameter=0.0), run.drive)
    assert headline(steady).endswith(" W input")


def test_the_name_of_a_drive_goes_before_that_of_its_file(run: Run) -> None:
    named = Run(run.dataset, run.drive.replace(name="Fan of the paint shop"), Path("fan.nc"))
    assert headline(named).startswith("Fan of the paint shop: driver ")


def test_a_sweep_is_named_with_its_speeds(run: Run) -> None:
    swept = Run(run.dataset.assign_attrs(swept_pulley="driver"), run.drive)
    assert headline(swept).startswith("driver from ")
    assert headline(swept).endswith(" rpm")


def test_own_figures_have_a_headline_and_axes_of_others_have_none(run: Run) -> None:
    own = plot.torques(run).figure.figure
    assert own.get_suptitle() == headline(run)
    plot.torques(run, own.add_subplot())
    assert own.get_suptitle() == headline(run)


def test_long_headlines_take_several_lines() -> None:
    page = Figure(figsize=(4.0, 3.0))
    write_headline(page, "the drive of the paint shop, before and after the motor was changed")
    assert page.get_suptitle() == "the drive of the paint shop, before and after\nthe motor was changed"


@pytest.mark.parametrize("power", [29.25, 2925.0])
def test_large_powers_are_in_kilowatts(run: Run, power: float) -> None:
    torque = run.dataset["shaft_torque"] * power / 29.25
    assert f"{power / 1e3:.3g} kW" in headline(Run(run.dataset.assign(shaft_torque=torque), run.drive)) or power < 1e3

"""Key numbers of results, against values put into datasets by hand."""

import math
from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn.designs.drive_sheet import sheet
from beltdyn.model import Drive
from beltdyn.points.life import life
from beltdyn.results import KeyNumber, Result, Run, key_numbers

LIMITS = {"largest_slip": 0.01, "largest_hub_load": 130.0, "least_slip_safety": 4.0}


def by_key(result: Result) -> dict[str, KeyNumber]:
    return {one.key: one for one in key_numbers(result)}


def test_a_run_is_judged_where_it_is_worst(make_run: Callable[..., Run]) -> None:
    hub_force = np.zeros((101, 2, 2))
    hub_force[40, 1] = (120.0, -50.0)
    run = make_run(hub_force=hub_force)
    drive = run.drive.replace(limits=LIMITS)
    found = by_key(Run(run.dataset, drive))
    assert found["largest_hub_load"].value == pytest.approx(130.0)
    assert found["largest_hub_load"].where == f"driven, at {float(run.dataset['time'][40]):.4g} s"
    assert found["largest_hub_load"].passes
    assert found["largest_slip"].value == pytest.approx(0.005, rel=1e-3)
    assert found["largest_slip"].where == "driven, mean at the end"
    assert found["least_slip_safety"].passes is False
    assert found["least_tension"].value == run.dataset["span_tension"].values.min()
    assert found["least_tension"].passes is None


def test_without_load_there_is_no_slip_safety(make_run: Callable[..., Run]) -> None:
    """Equal tensions at both ends of an arc."""
    run = make_run(span_tension=np.full((101, 2), 45.0), pulley_torque=np.zeros((101, 2)))
    safety = by_key(Run(run.dataset, run.drive.replace(limits=LIMITS)))["least_slip_safety"]
    assert math.isnan(safety.value)
    assert safety.passes is None
    assert safety.name == "least slip safety"


def test_operating_points_are_judged_over_all(drive: Drive) -> None:
    units = {"units": "N"}
    dataset = xr.Dataset(
        {
            "hub_load": (("speed", "pulley"), [[10.0, 20.0], [40.0, np.nan]], units),
            "pulley_slip": (("speed", "pulley"), [[0.0, -0.02], [0.0, 0.01]], {"units": "1"}),
        },
        {"speed": ("speed", [10.0, 100.0 * math.pi], {"units": "rad/s"}), "pulley": ["driver", "driven"]},
        {"kind": "operating_map", "axes": "speed"},
    )
    found = by_key(Result(dataset, drive.replace(limits=LIMITS)))
    assert found.keys() == {"largest_hub_load", "largest_slip"}
    assert (found["largest_hub_load"].value, found["largest_hub_load"].where) == (40.0, "driver, speed 3000 rpm")
    assert (found["largest_slip"].value, found["largest_slip"].passes) == (0.02, False)


def test_a_belt_with_a_strength_is_judged_by_its_largest_tension(make_run: Callable[..., Run], drive: Drive) -> None:
    """A run that changes by the limit of starts and stops, a steady one and points by that of running, rest by none."""
    run = make_run()
    strong = run.drive.with_({"belt.strength": "10 N/mm"}).replace(limits={"least_motion_safety": 1e6})
    force, largest = 1e4 * strong.belt.width, float(run.dataset["largest_span_tension"].max())
    found = by_key(Run(run.dataset, strong))
    assert found["least_motion_safety"].value == pytest.approx(force / largest)
    assert found["least_motion_safety"].passes is False
    assert "least_belt_safety" not in found
    assert "least_motion_safety" not in by_key(run)
    for kind in ("operating_map", "equilibrium"):
        dataset = xr.Dataset(
            {"largest_span_tension": ("span", [5.0, 8.0], {"units": "N"})},
            {"span": ["driver-driven", "driven-driver"]},
            {"kind": kind, "axes": ""},
        )
        table = by_key(Result(dataset, drive.with_({"belt.strength": 1e4})))
        assert ("least_belt_safety" in table) == (kind == "operating_map")
        if kind == "operating_map":
            assert table["least_belt_safety"].value == pytest.approx(1e4 * drive.belt.width / 8.0)
            assert table["least_belt_safety"].where == "driven-driver"


def test_a_traction_curve_goes_on_until_the_belt_slips(drive: Drive) -> None:
    assert key_numbers(Result(xr.Dataset(attrs={"kind": "traction"}), drive)) == ()


def test_a_belt_of_a_rated_profile_is_judged_by_its_utilization(make_run: Callable[..., Run]) -> None:
    run = make_run()
    assert "largest_utilization" not in by_key(run)
    rated = run.drive.with_({"belt.profile": "PJ", "belt.ribs": 3, "belt.installed_tension": 60.0})
    found = by_key(Run(run.dataset, rated.replace(limits={"largest_utilization": 0.5})))["largest_utilization"]
    served = by_key(Run(run.dataset, rated.replace(limits={"service_factor": 1.4})))["largest_utilization"]
    assert found.value > 0.0
    assert found.passes is (found.value <= 0.5)
    assert (found.unit, served.passes) == ("%", None)
    assert served.value == pytest.approx(1.4 * found.value)


def test_lives_are_judged_in_hours(drive: Drive) -> None:
    line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
    limited = drive.replace(belt=drive.belt.replace(cord_fatigue=line), limits={"least_cord_life": "100 h"})
    result = life(limited)
    found = by_key(result)["least_cord_life"]
    assert (found.unit, found.limit) == ("h", 100.0)
    assert found.value == pytest.approx(float(result.dataset.cord_life))
    assert found.passes is (found.value >= 100.0)
    assert "largest share" in found.where
    of_sheet = sheet(limited)
    judged = by_key(of_sheet)["least_cord_life"]
    assert judged.value == pytest.approx(float(of_sheet.dataset.cord_life))
    assert judged.passes is (judged.value >= 100.0)

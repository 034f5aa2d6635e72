"""Monte Carlo on tolerances against the spread by derivatives."""

from typing import Any

import numpy as np
import pytest

from beltdyn.designs import sensitivity as module
from beltdyn.designs.sensitivity import require_points, sensitivity
from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps, loads
from beltdyn.results import Result
from beltdyn.solvers.run_progress import Progress
from validation.published.cases import better, loaded_two_pulley

COUNT = 32


@pytest.fixture(scope="module")
def toleranced() -> Drive:
    drive = better(loaded_two_pulley())
    text = dumps(drive.replace(belt=drive.belt.replace(length=None, installed_tension=600.0)))
    assert text.count("installed_tension = 600.0") == text.count("friction = 1.2") == 1
    return loads(
        text.replace("installed_tension = 600.0", 'installed_tension = "600 ± 12 N"').replace(
            "friction = 1.2", 'friction = "1.2 ± 3 %"'
        )
    )


@pytest.fixture(scope="module")
def found(toleranced: Drive) -> Result:
    numbers = "belt.installed_tension, contact.friction"
    return sensitivity(toleranced, of="hub_load, least_slip_safety, largest_tension", numbers=numbers, sobol=COUNT)


@pytest.mark.slow
def test_both_spreads_agree(found: Result) -> None:
    """Randomized Sobol points of two numbers have a deviation within a few per cent of the true one."""
    values = found.dataset
    assert values.spread_of_points.values == pytest.approx(values.spread.values, rel=0.06)
    assert values.mean_of_points.values == pytest.approx(values["value"].values, rel=2e-3)


@pytest.mark.slow
def test_a_hub_carries_the_tension_twice(found: Result) -> None:
    """Straight spans: dH = 2 dT; friction takes no part in it."""
    spread = float(found.dataset.spread.sel(result="hub_load[driven]"))
    assert spread == pytest.approx(2.0 * 12.0, rel=0.02)


def test_points_at_rest_scatter_as_their_number_does(toleranced: Drive) -> None:
    """The tension is that which is asked for, which scatters by half a tolerance, and hubs carry it twice."""
    progress, count = list[Progress](), 4
    options: dict[str, Any] = {"of": "tension, hub_load[driven]", "numbers": "belt.installed_tension", "about": "rest"}
    result = sensitivity(toleranced, sobol=count, progress=progress.append, **options)
    found = result.dataset
    assert found.tolerance.sel(number="belt.installed_tension") == pytest.approx(12.0)
    spreads = found.spread_of_points.values
    assert spreads[1] / spreads[0] == pytest.approx(2.0, rel=1e-3)
    assert spreads[0] == pytest.approx(12.0, rel=0.3)
    assert found.mean_of_points.values[0] == pytest.approx(600.0, abs=0.3 * 12.0)
    assert not result.warnings
    expected = [Progress(done, float(count), 0.0, done, "operating points") for done in range(1, count + 1)]
    assert [one for one in progress if one.duration == count] == expected


def test_points_that_fail_are_counted(toleranced: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    results = np.array([[590.0], [610.0]])
    monkeypatch.setattr(module, "results_at_points", lambda *_, **__: (results, ["slip", "the belt slips"]))
    found = sensitivity(toleranced, of="tension", numbers="belt.installed_tension", about="rest", sobol=4)
    assert found.warnings == ["2 of 4 points failed. The last one: the belt slips"]
    assert float(found.dataset.spread_of_points[0]) == pytest.approx(2.0 * np.sqrt(200.0))


def test_points_need_tolerances_and_a_power_of_two(toleranced: Drive) -> None:
    with pytest.raises(ModelError, match="sobol = 12 must be a power of two"):
        require_points(12)
    without = better(loaded_two_pulley())
    with pytest.raises(ModelError, match="the drive file has none"):
        sensitivity(without, sobol=4)

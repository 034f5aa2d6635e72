"""One way of finding where a run begins: a run and a simulator begin in the same state."""

from pathlib import Path

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.results import Run
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.transient.beginning import begin_on, instant_of, mesh_of
from beltdyn.transient.simulate import choose_integrator, simulate
from beltdyn.transient.simulator import Simulator


@pytest.mark.parametrize(
    ("frame", "start"),
    [
        ("staying", "equilibrium"),
        ("staying", "earlier"),
        ("travelling", "laid"),
        ("travelling", "equilibrium"),
        pytest.param("travelling", "earlier", marks=pytest.mark.slow),
    ],
)
def test_a_run_and_a_simulator_begin_alike(drive: Drive, frame: str, start: str, tmp_path: Path) -> None:
    given = drive.with_({"simulation.frame": frame, "simulation.start": "equilibrium", "simulation.duration": 2e-3})
    if start == "earlier":
        simulate(given, tmp_path / "run.nc").dataset.close()
        given = given.with_({"simulation.start": {"file": str(tmp_path / "run.nc")}})
    else:
        given = given.with_({"simulation.start": start})
    first, outputs = simulate(given).dataset.isel(time=0), Simulator(given).outputs()
    for name in ("driver", "driven"):
        assert outputs[f"pulley_angle[{name}]"] == float(first.pulley_angle.sel(pulley=name))
        load = float(np.hypot(*first.hub_force.sel(pulley=name)))
        assert outputs[f"hub_load[{name}]"] == pytest.approx(load, rel=1e-12)


def test_the_mesh_that_travels_needs_no_search_where_the_belt_is_laid(drive: Drive) -> None:
    integrator = choose_integrator(drive)
    laid = drive.with_({"simulation.start": "laid"})
    mesh = mesh_of(prepare(laid), integrator)
    assert begin_on(mesh, integrator) is mesh
    rest = begin_on(mesh_of(prepare(drive.with_({"simulation.start": "equilibrium"})), integrator), integrator)
    assert not np.array_equal(rest.state.position, mesh.state.position)


def test_an_instant_is_one_of_the_outputs_along_the_belt(run: Run) -> None:
    times = run.dataset.field_time.values
    step = float(np.diff(times).min())
    assert instant_of(run, None) == times[-1]
    for time in times.tolist():
        assert instant_of(run, time + 1e-7 * step) == time
    for away in (0.5 * step, 1e-5 * step):
        with pytest.raises(ModelError, match="is not an output along the belt of this run"):
            instant_of(run, float(times[1]) + away)
    with pytest.raises(ModelError):
        instant_of(Run(run.dataset.isel(time=slice(0), field_time=slice(0)), run.drive), None)


def test_other_integrators_know_no_flow(drive: Drive) -> None:
    staying = drive.with_({"simulation.frame": "staying", "simulation.start": "equilibrium"})
    method = choose_integrator(drive.with_({"simulation.integrator": "bdf"}))
    assert not isinstance(method, GeneralizedAlpha)
    with pytest.raises(ModelError, match=r'does not support simulation\.frame = "staying"'):
        mesh_of(prepare(staying), method)

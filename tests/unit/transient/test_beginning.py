"""One way of finding where a run begins: a run and a simulator begin in the same state."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.results import Run
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.state.installation import Rest
from beltdyn.state.settling import Beginning, Start
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.frame import centreline_points
from beltdyn.system.meshing import phases
from beltdyn.system.state import State, laid, nodal_coordinates, point_coordinates
from beltdyn.transient import beginning
from beltdyn.transient.beginning import (
    _difference,
    _laid,
    _require_same_mesh,
    _travelling,
    _window,
    begin_on,
    compile_ahead,
    instant_of,
    mesh_of,
    taken_over,
    with_instant,
)
from beltdyn.transient.simulate import choose_integrator, simulate
from beltdyn.transient.simulator import Simulator
from tests.unit.state.test_loaded_teeth import drive as toothed
from tests.unit.state.test_search import solved, two


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


def test_a_run_with_one_output_begins_there(run: Run) -> None:
    """Its instant counts to a millionth, or to a microsecond before 1 s."""
    single = Run(run.dataset.isel(time=slice(30, 31), field_time=slice(30, 31)), run.drive)
    time = float(single.dataset.field_time[0])
    assert 0.1 < time < 0.9
    assert instant_of(single, time + 0.9e-6) == time
    with pytest.raises(ModelError, match=rf"from {time:g} to {time:g} s the nearest at {time:g} s"):
        instant_of(single, time + 1.1e-6)


def test_what_an_earlier_run_must_have(run: Run) -> None:
    for name in ("nodal_velocities", "body_velocity"):
        assert name in run.dataset
        with pytest.raises(ModelError, match=name):
            instant_of(Run(run.dataset.drop_vars(name), run.drive), None)


def test_steady_running_is_no_earlier_run(run: Run, saved_run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = run.drive.with_({"simulation.start": {"file": str(saved_run)}})
    assert with_instant(begun).simulation.start.time == run.dataset.field_time.values[-1]  # type: ignore[union-attr]
    monkeypatch.setattr(beginning, "runs_steadily", lambda dataset: True)
    with pytest.raises(ModelError, match=r'simulation\.start: .*holds steady running, .*Set start = "steady"'):
        with_instant(begun)


@pytest.mark.parametrize(
    ("mine", "other", "words"),
    [
        ({"a": 1, "b": {"c": 2}}, {"b": {"c": 2}, "a": 1}, None),
        ({"a": 1}, {"a": 2}, ("a", "1", "2")),
        ({"b": {"c": [1, 2]}}, {"b": {"c": [1, 3]}}, ("b.c[2]", "2", "3")),
        ({"b": {"c": [1]}}, {"b": {"c": [1, 3]}}, ("b.c", "a list of 1", "a list of 2")),
        ({"b": [1]}, {}, ("b", "a list of 1", "not given")),
        ({}, {"b": "text"}, ("b", "not given", "text")),
        ({"a": [{"name": "x", "k": 1}]}, {"a": [{"name": "x"}]}, ("a[x].k", "1", "not given")),
        ({"a": [1]}, {"a": {"b": 1}}, ("a", "a list of 1", "{'b': 1}")),
    ],
)
def test_the_first_difference_is_told_in_words(mine: Any, other: Any, words: tuple[str, str, str] | None) -> None:
    result = _difference(mine, other)
    assert (result and tuple(each.strip('"') for each in result)) == words


def earlier(system: System, nodes: FloatArray, bodies: int) -> Any:
    """A run with nodes and bodies at some places."""
    dataset = xr.Dataset(coords={"node_coordinate": ("node", nodes), "body": [f"body {n}" for n in range(bodies)]})
    return SimpleNamespace(dataset=dataset, path="earlier.nc", prepared=SimpleNamespace(elements=20))


def test_nodes_and_bodies_are_those_of_the_earlier_run(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    nodes, bodies = point_coordinates(system), system.bodies.size
    _require_same_mesh(system, earlier(system, nodes + 1e-11, bodies))
    for other in (nodes + 1e-6, nodes[:-1], np.append(nodes, 2.0)):
        with pytest.raises(ModelError, match=rf"has {nodes.size} nodes, but that of earlier.nc has {other.size}, or"):
            _require_same_mesh(system, earlier(system, other, bodies))
    for number in (bodies - 1, bodies + 1):
        with pytest.raises(ModelError, match=rf"has {bodies} bodies .* earlier.nc has {number}: body 0"):
            _require_same_mesh(system, earlier(system, nodes, number))


@pytest.mark.parametrize("frame", ["staying", "travelling"])
def test_kernels_of_a_run_are_compiled_ahead(drive: Drive, frame: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """For arrays of the types that the run has."""
    begun, compiled = drive.with_({"simulation.frame": frame, "simulation.start": "equilibrium"}), list[Any]()
    monkeypatch.setattr(beginning, "compile_kernels", lambda *arguments: compiled.append(arguments))
    compile_ahead(begun)
    ((system, state),) = compiled
    mesh = mesh_of(prepare(begun), choose_integrator(begun))
    assert type(system.frame) is type(mesh.system.frame)
    assert state.position.size == system.first_body + system.bodies.size


@pytest.mark.parametrize(("start", "refused"), [("steady", True), ("laid", False)])
def test_a_start_in_steady_running_needs_it(drive: Drive, start: str, refused: bool) -> None:
    """A shaped pulley has none."""
    shaped = {"pulley[driven].surface": {"kind": "eccentric", "eccentricity": 1e-4}, "simulation.start": start}
    begun = drive.with_({"simulation.frame": "travelling"} | shaped)
    if refused:
        with pytest.raises(ModelError, match=r'simulation\.start = "steady" needs steady running, and driven is not'):
            mesh_of(prepare(begun), choose_integrator(begun))
    else:
        assert mesh_of(prepare(begun), choose_integrator(begun)).state.position.size


# Where runs on the travelling mesh begin


@pytest.fixture
def rest(monkeypatch: pytest.MonkeyPatch) -> Callable[[Prepared], Any]:
    """Rest as the belt is laid, with another length, and a state of its own."""

    def at(prepared: Prepared, progress: Any = None) -> Rest:
        longer = prepared.replace(belt=prepared.belt.replace(length=0.999 * prepared.belt_length))
        system = drive_system(longer)
        state = laid(system, longer.path)
        state.position[: system.first_body] += 1e-3
        return Rest(longer, system, state, None, ("driven",))  # type: ignore[arg-type]

    monkeypatch.setattr(beginning, "rest_of", at)
    return at


@pytest.mark.parametrize(("start", "moved"), [("equilibrium", True), ("laid", False)])
def test_a_tension_sets_the_length_also_of_a_belt_as_laid(
    drive: Drive, start: str, moved: bool, rest: Callable[[Prepared], Any]
) -> None:
    begun = drive.with_({"belt.length": None, "belt.installed_tension": 50.0, "simulation.start": start})
    result, at = _travelling(mesh_of(prepare(begun), choose_integrator(begun)), None), rest(prepare(begun))
    assert result.prepared.belt_length == at.prepared.belt_length
    assert result.unstable == ("driven",)
    away = result.state.position - laid(at.system, at.prepared.path).position
    np.testing.assert_allclose(away[: at.system.first_body], 1e-3 if moved else 0.0, atol=1e-12)


@pytest.mark.usefixtures("rest")
@pytest.mark.parametrize("teeth", [True, False])
@pytest.mark.parametrize("start", ["equilibrium", "laid", "steady"])
def test_loads_are_on_teeth_in_equilibrium_alone(
    drive: Drive, start: str, teeth: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = list[str]()

    def loads(prepared: Prepared, system: System, state: State) -> tuple[System, State]:
        calls.append("teeth")
        return system, state

    def steady(rest: Rest) -> tuple[System, State]:
        calls.append("steady")
        return rest.system, rest.state

    monkeypatch.setattr(beginning, "with_loads_on_teeth", loads)
    monkeypatch.setattr(beginning, "steady_state_on", steady)
    begun = (toothed("travelling") if teeth else drive).with_({"simulation.start": start, "simulation.start_at": None})
    prepared = prepare(begun)
    mesh = Beginning(prepared, drive_system(prepared), laid(drive_system(prepared), prepared.path))
    _travelling(mesh, None)
    expected = {"equilibrium": ["teeth"] if teeth else [], "laid": [], "steady": ["steady"]}
    assert calls == expected[start]


def test_teeth_of_a_belt_as_laid_lie_in_grooves() -> None:
    """Wherever these stood before."""
    prepared, result = prepare(toothed("travelling")), list[FloatArray]()
    for turned in (0.0, 0.03, 0.06):
        system = drive_system(prepared)
        phases(system)[:] = turned
        _laid(prepared, system)
        result.append(phases(system).copy())
    np.testing.assert_allclose(result[1:], [result[0]] * 2)
    assert np.all(result[0] != 0.0)


def test_a_run_that_begins_in_steady_running_settles(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    """On the travelling mesh, unless an analysis has another beginning; others begin as they are."""
    begun = list[str]()

    def settles(name: str) -> Any:
        def begin(prepared: Any, system: System, state: State, integrator: Any, progress: Any) -> Start:
            begun.append(name)
            return Start(system, state, {"settling_time": 1.0})

        return begin

    monkeypatch.setattr(beginning, "Held", lambda: settles("held"))
    monkeypatch.setattr(beginning, "_travelling", lambda mesh, progress: mesh)
    integrator = choose_integrator(drive)
    for start, own, expected in (
        ("steady", None, ["held"]),
        ("steady", settles("own"), ["own"]),
        ("equilibrium", None, []),
        ("equilibrium", settles("own"), ["own"]),
    ):
        begun.clear()
        prepared = prepare(drive.with_({"simulation.frame": "travelling", "simulation.start": start}))
        system = drive_system(prepared)
        mesh = Beginning(prepared, system, laid(system, prepared.path), attributes={"mesh": 2.0})
        result = begin_on(mesh, integrator, None, own)
        assert begun == expected
        assert result.attributes == {"mesh": 2.0} | ({"settling_time": 1.0} if expected else {})


@pytest.mark.parametrize(("elements", "passing"), [(20, 5), (21, 5), (3, 1)])
def test_a_window_is_about_a_quarter_turn_of_whole_elements(drive: Drive, elements: int, passing: int) -> None:
    """By the fastest rim of either sense, whose belt passes a part of its path."""
    prepared = prepare(drive.with_({"belt.elements": elements, "simulation.frame": "travelling"}))
    system = drive_system(prepared)
    state = laid(system, prepared.path)
    state.velocity[system.first_body :][:2] = 30.0, -40.0
    window = _window(prepared, system, state)
    passed = window * 40.0 * prepared.rolling_radii[1] / (prepared.path.length / elements)
    assert passed == pytest.approx(passing, rel=1e-12)


def test_steady_running_is_taken_over_by_a_mesh_that_travels() -> None:
    """Its nodes lie on the same curve, and move along it; bodies have the same places and speeds."""
    prepared = prepare(two().with_({"simulation.frame": "travelling"}))
    search = solved(two(), 30)
    system = drive_system(prepared.with_length(search.prepared.belt_length))
    state, result = taken_over(search, system), search.running()
    curve = nodal_coordinates(system, *centreline_points(search.constant, result.position, point_coordinates(system)))
    np.testing.assert_allclose(state.nodes(system), curve.reshape(state.nodes(system).shape), rtol=1e-12)
    np.testing.assert_array_equal(state.velocity[system.first_body :], result.velocity[search.constant.first_body :])
    speeds = np.hypot(*state.velocity[: system.first_body].reshape(system.nodes, -1)[:, :2].T)
    slopes = np.hypot(*state.nodes(system)[:, 2:4].T)
    np.testing.assert_allclose(speeds, search.belt_parameter * slopes, rtol=1e-3)


def test_the_mesh_of_the_earlier_run_is_required(run: Run, saved_run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before its state is taken over."""

    def other(system: System, earlier: Run) -> None:
        assert system.bodies.size == 2
        raise ModelError("other nodes")

    begun = run.drive.with_({"simulation.start": {"file": str(saved_run)}})
    monkeypatch.setattr(beginning, "_require_same_mesh", other)
    with pytest.raises(ModelError, match=r"simulation\.start: other nodes"):
        mesh_of(prepare(with_instant(begun)), choose_integrator(begun))

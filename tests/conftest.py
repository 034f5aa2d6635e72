"""What tests measure for the documentation, and a result made by formulas.

The numbers are listed by ``pytest -v`` at the end.  In the result the belt of a two-pulley drive runs at a steady
creep, without vibration.
"""

import gc
import json
import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import TRACEBACKS
from beltdyn.kinds import Registry
from beltdyn.model import Drive, prepare
from beltdyn.results import Layout, MemoryRecorder, Run, provenance
from beltdyn.results.belt_history import mid_span_displacements
from beltdyn.results.friction_work import FrictionWork, Touch
from beltdyn.results.mechanics import cells
from beltdyn.results.schema import FILTERED, SPAN_TENSIONS
from beltdyn.results.slip_safety import sliding_of_pulleys

Arrays = dict[str, NDArray[Any]]

MEASURED = pytest.StashKey[list[str]]()
CURVES = pytest.StashKey[dict[str, list[dict[str, Any]]]]()
CREEP = 0.005
TIGHT, SLACK = 60.0, 30.0
STATISTICS = {
    "integrator": "generalized_alpha",
    "steps": 1200,
    "rejected_steps": 14,
    "newton_iterations": 4900,
    "wall_time": 0.5,
    "compile_time": 2.5,
}

gc.disable()  # what collection makes stays to the end: to look through it again and again takes a tenth of all the time


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.set_threshold(20_000, 10, 10)
    gc.enable()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--curves", None) is not None:
        others = [item for item in items if "curve" not in getattr(item, "fixturenames", ())]
        config.hook.pytest_deselected(items=others)
        items[:] = [item for item in items if item not in others]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--curves", metavar="FILE", help="run only what draws docs/verification; curves to a JSON file")
    parser.addoption("--compiled", action="store_true", help="compile the kernels of points, elements and machines too")


@pytest.fixture(autouse=True)
def _own_kinds() -> Iterator[None]:
    """What a test registers is forgotten behind it: checkpoints, schemas and kernels know of all kinds."""
    before = {id(registry): set(registry) for registry in Registry.families}
    yield
    for registry in Registry.families:  # some were imported meanwhile
        for name in set(registry) - before.get(id(registry), set()):
            if registry.is_own(name):
                registry.forget(name)


@pytest.fixture(autouse=True)
def _strict_arithmetic(request: pytest.FixtureRequest) -> Iterator[None]:
    """NumPy raises in quick tests, as a user's script may tell it to; numbers below the least one are zero."""
    states: dict[str, Any] = {} if "slow" in request.keywords else {"all": "raise", "under": "ignore"}
    with np.errstate(**states):
        yield


@pytest.fixture(autouse=True, scope="session")
def _tracebacks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where this process, and those that it starts, leave tracebacks of internal errors."""
    file = tmp_path_factory.mktemp("tracebacks") / "internal_errors.txt"
    file.touch()
    os.environ[TRACEBACKS] = str(file)
    return file


@pytest.fixture(autouse=True)
def _no_internal_errors(request: pytest.FixtureRequest, _tracebacks: Path) -> Iterator[None]:
    """A test fails where an internal error is told as a result, unless it is marked to provoke one."""
    before = _tracebacks.stat().st_size
    yield
    text = _tracebacks.read_text(encoding="utf-8")[before:] if _tracebacks.stat().st_size > before else ""
    provokes = request.node.get_closest_marker("provokes_internal_errors")
    assert not text or provokes, f"an internal error was told:\n{text}"


@pytest.fixture
def measured(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Note numbers of a test for docs/verification."""
    notes = request.config.stash.setdefault(MEASURED, [])

    def note(**values: float) -> None:
        notes.append(f"{request.node.name}: " + ", ".join(f"{key} = {value:.5g}" for key, value in values.items()))

    return note


@pytest.fixture
def curve(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Note a curve for a panel "figure/panel" of docs/verification; ``--curves FILE`` collects them."""
    notes = request.config.stash.setdefault(CURVES, {})

    def note(panel: str, x: ArrayLike, y: ArrayLike, label: str, style: str = "o-") -> None:
        values = {"x": np.asarray(x, float).tolist(), "y": np.asarray(y, float).tolist()}
        notes.setdefault(panel, []).append({"label": label, "style": style, **values})

    return note


def pytest_sessionfinish(session: pytest.Session) -> None:
    file = session.config.getoption("--curves", None)
    if file is not None:
        Path(file).write_text(json.dumps(session.config.stash.get(CURVES, {})), encoding="utf-8")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    notes = terminalreporter.config.stash.get(MEASURED, [])
    if notes and terminalreporter.verbosity > 0:
        terminalreporter.section("measured")
        terminalreporter.write_line("\n".join(notes))


@pytest.fixture(scope="session")
def order() -> Callable[[Sequence[int], Sequence[float]], float]:
    """Convergence order: the slope of log error over log element length, fitted."""
    return lambda elements, errors: -float(np.polyfit(np.log(elements), np.log(errors), 1)[0])


@pytest.fixture(scope="session")
def fine_drive(drive: Drive) -> Drive:
    """The drive with a mesh that resolves everything: beside it a result is judged as one of that mesh."""
    return drive.replace(belt=drive.belt.replace(elements=120))


@pytest.fixture(scope="session")
def layout(drive: Drive) -> Layout:
    elements, length = drive.elements, drive.belt_length
    return Layout(
        pulleys=("driver", "driven"),
        spans=("driver-driven", "driven-driver"),
        node_coordinate=np.arange(elements) * length / elements,
        element_coordinate=(np.arange(elements) + 0.5) * length / elements,
        belt_coordinate=(np.arange(5 * elements) + 0.5) * length / (5 * elements),
        coordinate_names=drive.belt.element_kind.coordinates,
        bodies=("driver", "driven"),
    )


@pytest.fixture(scope="session")
def attributes(drive: Drive) -> dict[str, str]:
    return provenance(drive.text, "Two pulleys")


@pytest.fixture(scope="session")
def statistics() -> dict[str, Any]:
    return STATISTICS


@pytest.fixture(scope="session")
def make_chunk(drive: Drive, layout: Layout) -> Callable[[FloatArray], Arrays]:
    def make(time: FloatArray) -> Arrays:
        outputs = _outputs(drive, layout, time)
        nothing = {name: np.zeros(layout.shape(variable, len(time))) for name, variable in layout.recorded.items()}
        spans = dict.fromkeys(SPAN_TENSIONS, outputs["span_tension"])
        return nothing | spans | outputs | _summed_up(drive, layout, outputs)

    return make


@pytest.fixture(scope="session")
def make_run(
    drive: Drive, layout: Layout, attributes: dict[str, str], make_chunk: Callable[[FloatArray], Arrays]
) -> Callable[..., Run]:
    def make(outputs: int = 101, status: Any = "completed", **changed: NDArray[Any]) -> Run:
        recorder = MemoryRecorder(layout, attributes)
        chunk = make_chunk(np.linspace(0.0, 1.0, outputs)) | changed
        chunk |= dict.fromkeys(SPAN_TENSIONS, chunk["span_tension"]) | changed
        recorder.append(chunk | _summed_up(drive, layout, chunk) | changed)
        recorder.close(status, STATISTICS)
        return Run(recorder.dataset(), drive)

    return make


@pytest.fixture(scope="session")
def run(make_run: Callable[..., Run]) -> Iterator[Run]:
    """A run that all tests share, and none may change."""
    made = make_run()
    attributes = dict(made.dataset.attrs)
    yield made
    assert made.dataset.attrs == attributes, "a test has changed the attributes of the shared run"


@pytest.fixture(scope="session")
def saved_run(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of that run, to be copied: to write it takes longer than what most tests do with it."""
    return run.save(tmp_path_factory.mktemp("saved") / "run.nc")


def _outputs(drive: Drive, layout: Layout, time: FloatArray) -> Arrays:
    """Outputs for instants, shape (k,): the load grows with the speed, tension is linear over the arcs."""
    radius, path = drive.pulleys[0].radius, drive.path
    ramp = np.clip((time - 0.05) / 0.55, 0.0, 1.0)
    speed = 12.0 * ramp
    angle = np.where(time < 0.6, 3.3 * ramp**2, 3.3 + 12.0 * (time - 0.6))
    pulleys = np.array([1.0, 1.0 - CREEP])
    stretch = path.length / drive.belt_length
    pull = (TIGHT - SLACK) * ramp
    span, arc = path.span_lengths[0], np.pi * radius
    corners = np.cumsum([0.0, span, arc, span, arc])

    def place(coordinate: FloatArray) -> FloatArray:
        return np.asarray((stretch * coordinate + radius * angle[:, None]) % path.length)

    def trace(follow: Callable[[Any], FloatArray], coordinate: FloatArray) -> FloatArray:
        return follow(place(coordinate).ravel()).reshape(len(time), len(coordinate), 2)

    def tension(coordinate: FloatArray) -> FloatArray:
        return np.asarray(SLACK + pull[:, None] * np.interp(place(coordinate), corners, [0, 0, 1, 1, 0]))

    position, tangent = (trace(follow, layout.node_coordinate) for follow in (path.position, path.tangent))
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    coordinates = np.concatenate([position, stretch * tangent, normal], axis=-1)
    velocities = np.concatenate([radius * speed[:, None, None] * tangent, 0 * tangent, 0 * normal], axis=-1)
    piece = np.clip(np.searchsorted(corners, place(layout.belt_coordinate), side="right") - 1, 0, 3)
    contact_pulley = np.array([-1, 1, -1, 0])[piece]
    side = np.array([0.0, -1.0, 0.0, 1.0])[piece]
    torque = radius * pull[:, None] * np.array([-1.0, 1.0])
    kinetic, still = 0.05 * speed**2, np.zeros_like(time)
    return {
        "time": time,
        "field_time": time,
        "pulley_speed": speed[:, None] * pulleys,
        "pulley_angle": angle[:, None] * pulleys,
        "shaft_speed": speed[:, None] * pulleys,
        "shaft_angle": angle[:, None] * pulleys,
        "pulley_torque": torque,
        "shaft_torque": -torque,
        "hub_force": np.multiply.outer(2 * SLACK + pull, np.array([[1.0, 0.0], [-1.0, 0.0]])),
        "pulley_center": np.tile([pulley.center for pulley in drive.pulleys], (len(time), 1, 1)),
        "friction_power": np.repeat(0.045 * speed[:, None], 2, axis=1),
        "contact_damping_power": np.repeat(0.005 * speed[:, None], 2, axis=1),
        "wrap_angle": np.full((len(time), 2), np.pi),
        "nodal_coordinates": coordinates,
        "nodal_velocities": velocities,
        "belt_tension": tension(layout.element_coordinate),
        "span_tension": np.stack([still + SLACK, SLACK + pull], axis=1),
        "belt_speed": np.repeat(radius * speed[:, None], 2, axis=1),
        "normal_force": np.where(contact_pulley >= 0, tension(layout.belt_coordinate) / radius, 0.0),
        "friction_force": side * pull[:, None] / arc,
        "slip_velocity": -1e-3 * side * ramp[:, None],
        "contact_position": trace(path.position, layout.belt_coordinate),
        "contact_pulley": contact_pulley,
        "kinetic_energy": kinetic,
        "strain_energy": still + 0.5,
        "penalty_energy": still + 0.01,
        "spring_energy": still,
        "potential_energy": still,
        "driver_work": kinetic + 0.6 * angle,
        "torque_work": -0.5 * angle,
        "friction_loss": 0.09 * angle,
        "damping_loss": 0.01 * angle,
        "material_loss": still,
        "stretch_loss": still,
        "bending_loss": still,
        "compression_loss": still,
        "tensioner_loss": still,
        "coupling_loss": still,
        "carrying_loss": still,
        "numerical_loss": still,
        "energy_closure": still + 1e-4,
        "step_size": still + 1e-3,
    }


def _summed_up(drive: Drive, layout: Layout, outputs: Arrays) -> Arrays:
    """What contact along the belt amounts to; with fields at every output."""
    names = ("contact_pulley", "normal_force", "slip_velocity", "contact_position", "pulley_center")
    touched, normal, slip, places, centers = (outputs[name] for name in names)
    work = FrictionWork(prepare(drive), cells(layout.belt_coordinate, drive.belt_length), layout.elements)
    touch = Touch(outputs["time"], centers, places, touched, np.abs(outputs["friction_force"] * slip))
    done = work.take(touch, np.ones(len(touched), dtype=bool))
    scalars = sliding_of_pulleys(prepare(drive), layout.belt_coordinate, touched, normal, slip, outputs["pulley_speed"])
    scalars["mid_span_displacement"] = mid_span_displacements(prepare(drive), centers, places, touched)
    seen = outputs | scalars
    return {
        **scalars,
        **{f"filtered_{name}": seen[name] for name in FILTERED if name in seen},
        "filtered_time": outputs["time"],
        **{
            f"friction_work_on_{place}": np.diff(each, axis=0, prepend=0.0 * each[:1])
            for place, each in zip(("arc", "belt"), done, strict=True)
        },
    }

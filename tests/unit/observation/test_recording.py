"""A recording closes its results whatever happens, and knows where its points are on the belt."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.observation.recording import Recording, result_layout
from beltdyn.results import open_run
from beltdyn.solvers.trajectory import Chunk
from beltdyn.system.arrays import ENERGY_WORKS, System
from beltdyn.system.body_forces import body_forces_history
from beltdyn.system.build import drive_system
from beltdyn.system.state import laid

Change = Callable[..., Drive]


@pytest.fixture
def system(change: Change) -> System:
    return drive_system(prepare(change()))


def chunk(change: Change, system: System, time: float) -> Chunk:
    state = laid(system, change().path)
    return replace(Chunk.start(system, state), time=np.array([time]), step=np.array([1e-4]), reached=time)


@pytest.mark.parametrize(
    ("error", "status"), [(None, "completed"), (KeyboardInterrupt, "interrupted"), (RuntimeError, "failed")]
)
def test_closes_with_its_status(
    change: Change, system: System, tmp_path: Path, error: type[BaseException] | None, status: str
) -> None:
    file = tmp_path / "run.nc"
    recording = Recording(prepare(change()), system, file, "title", None)

    def record() -> None:
        with recording:
            recording.take(chunk(change, system, 0.0))
            recording.take(chunk(change, system, 1e-3))
            if error is not None:
                raise error

    if error is RuntimeError:
        with pytest.raises(RuntimeError):
            record()
    else:
        record()
    for run in (recording.run(), open_run(file)):
        assert run.status == status
        np.testing.assert_array_equal(run.dataset.time, [0.0, 1e-3])
        np.testing.assert_array_equal(run.dataset.step_size, 1e-4)


def test_empty_chunks_only_tell(change: Change, system: System) -> None:
    told: list[float] = []
    with Recording(prepare(change()), system, None, "title", lambda progress: told.append(progress.time)) as recording:
        none, works = np.empty((0, 62)), np.empty((0, len(ENERGY_WORKS)))
        recording.take(Chunk(np.empty(0), np.empty(0), none, none, works, body_forces_history(system, 0), reached=0.5))
    assert told[-1] == 0.5
    assert recording.run().dataset.sizes["time"] == 0


@pytest.mark.parametrize(("joint", "nodes"), [("shared_node", 10), ("multipliers", 11)])
def test_layout(change: Change, joint: str, nodes: int) -> None:
    drive = change(simulation={"joint": joint})
    layout = result_layout(prepare(drive), drive_system(prepare(drive)))
    length = drive.belt_length / 10
    assert layout.pulleys == ("driver", "driven")
    assert layout.spans == ("driver-driven", "driven-driver")
    np.testing.assert_allclose(layout.node_coordinate, length * np.arange(nodes))
    np.testing.assert_allclose(layout.element_coordinate, length * (np.arange(10) + 0.5))
    assert layout.belt_coordinate.size == 50
    assert np.all(np.diff(layout.belt_coordinate) > 0.0)
    np.testing.assert_allclose(layout.belt_coordinate[2::5], layout.element_coordinate)

import matplotlib.pyplot as plt
import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.plot.released_belt import shape_of


@pytest.fixture(scope="module")
def released() -> Result:
    drive = bd.example("two_pulley").with_({"belt.elements": 10, "belt.length": "1.276 m"})
    return bd.release(drive, method="newton")


def test_four_shapes_with_their_fixed_points(released: Result) -> None:
    ax = bd.plot.iterations(released)
    last = released.dataset.iterations.item()
    named = [line for line in ax.lines if not str(line.get_label()).startswith("_")]
    assert [line.get_label() for line in named][::3] == ["initial shape", f"iteration {last}"]
    np.testing.assert_allclose(np.asarray(named[-1].get_xydata(), dtype=float), shape_of(released, last))
    assert [line.get_marker() for line in ax.lines][-2:] == ["_", "^"]  # rightmost in y, leftmost in both
    plt.close(ax.figure.figure)


def test_shapes_are_closed_and_pass_through_their_nodes(released: Result) -> None:
    shape, nodes = shape_of(released, 3), released.dataset.node_position[3].values
    np.testing.assert_array_equal(shape[0], shape[-1])
    distances = np.linalg.norm(shape[:, None] - nodes, axis=2).min(axis=0)
    np.testing.assert_allclose(distances, 0.0, atol=1e-12)


def test_an_iteration_that_does_not_exist(released: Result) -> None:
    with pytest.raises(ModelError, match="there is no iteration 500"):
        bd.plot.iterations(released, [0, 500])


def test_steps_fall_over_the_iterations(released: Result) -> None:
    ax = bd.plot.iteration_steps(released)
    steps = np.asarray(ax.lines[0].get_ydata(), dtype=float)
    assert len(steps) == released.dataset.iterations.item()
    assert steps[-1] < 1e-11 < steps[0]
    plt.close(ax.figure.figure)

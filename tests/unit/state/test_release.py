from math import pi

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive


@pytest.fixture(scope="module")
def slack() -> Drive:
    return bd.example("two_pulley").with_({"belt.elements": 10, "belt.length": "1.276 m"})


@pytest.mark.parametrize(
    ("fixed", "message"),
    [
        ("leftmost xy", "leaves a rigid motion"),
        ("0 x, 3 x, 5 x", "leaves a rigid motion"),
        ("leftmost xy, rightmost x", "leaves a rigid motion"),
        ("10 xy, 0 y", "is no node. Give a number from 0 to 9"),
        ("-1 xy, 0 y", "is no node"),
        ("corner xy", "is no node"),
        ("0 z, 1 xy", "must be a node with x, y or xy"),
        ("", "must be a node with x, y or xy"),
    ],
)
def test_fixed_points_that_do_not_hold_the_belt(slack: Drive, fixed: str, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        bd.release(slack, fixed=fixed)


def test_unknown_method_open_belt_and_odd_start(slack: Drive) -> None:
    with pytest.raises(ModelError, match="method"):
        bd.release(slack, method="bisection")
    with pytest.raises(ModelError, match="applies to closed belts"):
        bd.release(bd.example("band_brake"))
    with pytest.raises(ModelError, match=r"shape \(10, 6\), not of shape \(3, 6\)"):
        bd.release(slack, start=np.zeros((3, 6)))


def test_a_search_that_fails_names_the_other_method(slack: Drive) -> None:
    folded = bd.release(slack).dataset["nodal_coordinates"][0].values.copy()
    folded[:, :2] *= [1.0, 0.02]
    with pytest.raises(ConvergenceError, match='Choose method = "globalized"'):
        bd.release(slack, method="newton", start=folded)


@pytest.mark.parametrize("fixed", ["leftmost xy, rightmost y", "0 xy, 3 y", "2 x, 2 y, 7 x"])
def test_fixed_points_stay_and_do_not_change_the_shape(slack: Drive, fixed: str) -> None:
    """Without weight the supports carry nothing: any three of them leave the same circle."""
    dataset = bd.release(slack, fixed=fixed).dataset
    held, places = dataset.fixed.values.astype(bool), dataset.node_position.values
    assert held.sum() == 3
    np.testing.assert_allclose(places[-1][held], places[0][held], rtol=0.0, atol=1e-9)
    radii = np.linalg.norm(places[-1] - places[-1].mean(axis=0), axis=1)
    np.testing.assert_allclose(radii, slack.belt_length / (2.0 * pi), rtol=3e-4)


@pytest.mark.parametrize("kind", ["three-node-beam", "quintic"])
def test_other_elements_that_bend(slack: Drive, kind: str) -> None:
    """Links cut the circle into a polygon, whose corners lie on it or halfway out of it."""
    dataset = bd.release(slack.with_({"belt.discretization": kind})).dataset
    radii = np.linalg.norm(dataset.node_position[-1] - dataset.node_position[-1].mean("node"), axis=1)
    np.testing.assert_allclose(radii, slack.belt_length / (2.0 * pi), rtol=2e-2)


def test_weight_hangs_the_belt_from_its_fixed_points(slack: Drive) -> None:
    """The center of gravity of a stiff belt sinks, twice as far under twice the weight."""
    stiff = slack.with_({"belt.bending_factor": 1.0})

    def height(gravity: float) -> float:
        found = bd.release(stiff.with_({"gravity": [0.0, -gravity]}))
        return float(found.dataset.node_position[-1].sel(axis="y").mean())

    half, whole = (height(0.0) - height(gravity) for gravity in (5.0, 10.0))
    assert half > 1e-5  # m
    assert whole == pytest.approx(2.0 * half, rel=0.01)


def test_a_saved_result_is_read_again(slack: Drive, tmp_path: object) -> None:
    found = bd.release(slack)
    again = bd.open_result(found.save(f"{tmp_path}/release.nc"))
    assert again.kind == "release"
    np.testing.assert_array_equal(again.dataset.fixed.values, found.dataset.fixed.values)
    np.testing.assert_array_equal(again.dataset.node_position, found.dataset.node_position)

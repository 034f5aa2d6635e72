"""Orders, needed unknowns and counts of meshes whose errors are powers of the number of unknowns."""

from collections.abc import Callable
from math import inf, isnan

import numpy as np
import pytest

from validation.paper.statement import Verdict
from validation.paper.statements.model_errors import Errors, Series, half_pulley, unknowns
from validation.paper.statements.model_runs import BEAM, CASES, PAPER, TRUSS, Kind
from validation.published import loaded_two_pulley, two_pulley

MESHES = (20, 40, 80, 160)


@pytest.fixture
def made() -> Callable[..., Series]:
    """A series of meshes with given speed errors; a mesh of n elements has 6 n unknowns and takes n seconds."""

    def make(values: list[float]) -> Series:
        found = [
            Errors(n, 6 * n, n, error, error, error, error, error, float(n), n)
            for n, error in zip(MESHES, values, strict=False)
        ]
        return Series(CASES[0], PAPER, found)

    return make


def test_order(made: Callable[..., Series]) -> None:
    assert made([n**-2.5 for n in MESHES]).order("speed") == pytest.approx(2.5)


def test_order_leaves_out_what_no_longer_falls(made: Callable[..., Series]) -> None:
    series = made([0.01, 0.16, 0.04, 0.01])
    assert [mesh.elements for mesh in series.falling("speed")] == [40, 80, 160]
    assert series.order("speed") == pytest.approx(2.0)
    assert [mesh.elements for mesh in made([0.16, 0.04, 0.01, 0.009]).falling("speed")] == [20, 40, 80]


def test_two_meshes_make_no_order(made: Callable[..., Series]) -> None:
    assert isnan(made([0.16, 0.04, 0.039, 0.038]).order("speed"))


@pytest.mark.parametrize("target", [0.1, 0.05, 0.013])
def test_needed(made: Callable[..., Series], target: float) -> None:
    """For an error of (10 / n)^2, and 6 n unknowns."""
    bracket = made([(10.0 / n) ** 2 for n in MESHES]).bracket("tension", target)
    assert bracket.needed() == pytest.approx(60.0 * target**-0.5)
    assert bracket.needed("elements") == pytest.approx(10.0 * target**-0.5)
    assert bracket.misses is not None
    assert bracket.meets is not None
    assert bracket.misses.tension > target >= bracket.meets.tension


def test_repetitions_are_interpolated_each(made: Callable[..., Series]) -> None:
    bracket = made([(10.0 / n) ** 2 for n in MESHES]).bracket("tension", 0.125)
    np.testing.assert_allclose(bracket.interpolate(np.array([1.0, 4.0]), np.array([4.0, 16.0])), [2.0, 8.0])


def test_a_good_mesh_before_a_bad_one_does_not_count(made: Callable[..., Series]) -> None:
    assert 480.0 < made([0.01, 0.01, 0.3, 0.01]).bracket("speed", 0.02).needed() < 960.0


def test_outside_the_meshes(made: Callable[..., Series]) -> None:
    series = made([0.4, 0.2, 0.1, 0.05])
    assert series.bracket("speed", 0.01).needed() == inf
    assert series.bracket("speed", 0.5).needed() == 120.0
    assert series.bracket("speed", 0.5).misses is None
    assert series.bracket("speed", 0.01).meets is None


@pytest.mark.parametrize(
    ("own", "other", "expected"),
    [
        ([0.5, 0.1, 0.1, 0.1], [0.5, 0.5, 0.5, 0.1], Verdict.HOLDS),  # 40 meets, 80 of the other misses
        ([0.5, 0.5, 0.5, 0.1], [0.5, 0.1, 0.1, 0.1], Verdict.FAILS),  # 80 misses, 40 of the other meets
        ([0.5, 0.5, 0.1, 0.1], [0.5, 0.5, 0.1, 0.1], Verdict.OPEN),  # both between 40 and 80
        ([0.5, 0.1, 0.1, 0.1], [0.5, 0.5, 0.1, 0.1], Verdict.OPEN),  # 40 meets, and 40 misses: perhaps 41 meet
        ([0.1, 0.1, 0.1, 0.1], [0.1, 0.1, 0.1, 0.1], Verdict.OPEN),  # "20 or fewer" against "20 or fewer"
        ([0.1, 0.1, 0.1, 0.1], [0.5, 0.5, 0.5, 0.5], Verdict.HOLDS),  # the other's finest mesh is not good enough
        ([0.5, 0.5, 0.5, 0.5], [0.1, 0.1, 0.1, 0.1], Verdict.FAILS),
    ],
)
def test_fewer_by_more_than_the_distance_between_meshes(
    made: Callable[..., Series], own: list[float], other: list[float], expected: Verdict
) -> None:
    assert made(own).bracket("speed", 0.2).fewer_than(made(other).bracket("speed", 0.2)) is expected


@pytest.mark.parametrize(
    ("kind", "elements", "counted"),
    [("ancf", 20, 30), ("ancf", 30, 42), ("truss", TRUSS, 202), ("three-node-beam", BEAM, 154)],
)
def test_unknowns_on_half_a_pulley_are_those_of_the_paper(kind: Kind, elements: int, counted: int) -> None:
    for drive in (two_pulley(), loaded_two_pulley()):
        belt = drive.belt.replace(discretization=kind, elements=elements)
        assert half_pulley(drive.replace(belt=belt)) == counted


def test_unknowns_of_the_belt() -> None:
    drive = two_pulley()
    assert unknowns(drive) == 120
    truss = drive.belt.replace(discretization="truss", elements=60)
    assert unknowns(drive.replace(belt=truss)) == 120
    beam = drive.belt.replace(discretization="three-node-beam", elements=60)
    assert unknowns(drive.replace(belt=beam)) == 240

"""Kinds and parts of modes, by shares of the energy, and the speeds that these come from."""

import numpy as np
import pytest
from scipy.sparse import csc_array

from beltdyn.arrays import FloatArray
from beltdyn.model import Path, prepare
from beltdyn.model.resolution import Laid
from beltdyn.state.linearized import SmallMotions
from beltdyn.state.settling import with_passage
from beltdyn.state.staying import laid_state
from beltdyn.system.build import flowing_system, staying_system
from beltdyn.vibration.mode_shapes import Shares, belt_points, even_points, shares_of, speeds_of
from tests.unit.model.test_carrying import conveyor

NAMES = ["a-b", "b-a", "a", "b", "arm of b"]


@pytest.mark.parametrize(
    ("given", "kind", "parts"),
    [
        (([0.1, 0.85], [0.02, 0.0], 0.03, 0.0), "span", "b-a"),
        (([0.5, 0.45], [0.05, 0.0], 0.0, 0.0), "span", "a-b, b-a"),
        (([0.1, 0.0], [0.05, 0.6], 0.25, 0.0), "rotational", "b"),
        (([0.0, 0.1], [0.0, 0.05], 0.05, 0.8), "tensioner", "arm of b"),
        (([0.4, 0.0], [0.3, 0.0], 0.0, 0.3), "coupled", "a-b, a, arm of b"),
        (([0.0, 0.0], [0.0, 0.0], 1.0, 0.0), "rotational", "belt"),
    ],
)
def test_kind_and_parts(given: tuple[list[float], list[float], float, float], kind: str, parts: str) -> None:
    spans, pulleys, along, arm = given
    shares = Shares(*(np.array(one) for one in (spans, pulleys, along, [arm])))
    assert shares.kind == kind
    assert shares.parts(NAMES) == parts


SPEED = 3.0
DRUMS = [
    {"name": "head", "center": [0.0, 0.0], "radius": 0.2, "speed": 15.0},
    {"name": "tail", "center": [2.0, 0.7], "radius": 0.25, "inertia": 0.15},
]
ARM = {"kind": "rotary", "pulley": "tail", "pivot": [2.1, -0.1], "inertia": 0.8, "mass": 5.0, "preload": 300.0}
IDLERS = {"kind": "idlers", "span": ["tail", "head"], "spacing": 1.0, "idler_mass": 6.0}
GOODS = {"span": ["tail", "head"], "mass_per_length": 30.0}


@pytest.fixture(scope="module")
def motions() -> SmallMotions:
    """A conveyor on its path, 1 mm deep in its drums, whose belt passes; without matrices."""
    prepared, none = (
        prepare(conveyor(pulley=DRUMS, support=[IDLERS], goods=[GOODS], tensioner=[ARM])),
        csc_array((0, 0)),
    )
    staying, path = staying_system(prepared, prepared.equal_lengths(40)), prepared.path
    drawn_in = Path(path.centers, path.radii - 1e-3)
    laid = laid_state(Laid.on(drawn_in, prepared.belt_length, 0), staying, np.zeros(1))
    state = with_passage(staying, laid, SPEED)
    return SmallMotions(prepared, flowing_system(staying, np.array([1.0, 0.0])), state, none, none, none)


def test_points_have_the_mass_of_belt_goods_and_idlers(motions: SmallMotions) -> None:
    """To the elements that lie on the span in part."""
    prepared = motions.prepared
    span = float(prepared.laid.path.span_lengths[1]) / prepared.laid.stretch
    belt = prepared.belt.mass_per_length * prepared.belt_length
    for points, share in ((belt_points(motions), 0.02), (even_points(motions), 2e-3)):
        assert points.weight.sum() == pytest.approx(belt + 30.0 * span, rel=share)
        assert points.turning.sum() == pytest.approx(6.0 * span, rel=share)


def test_speeds_of_a_belt_that_turns_as_a_whole_while_it_passes(motions: SmallMotions) -> None:
    """Turned by k x r it has s k x r, and c k x r' of the passing belt; a length p that passes adds s p r'."""
    system, points, value, passed = motions.system, belt_points(motions), -0.3 + 7.0j, 0.2 - 0.1j
    nodes = motions.state.position[: system.first_body].reshape(-1, 2)
    turned = np.stack([-nodes[:, 1], nodes[:, 0]], axis=1).ravel()
    bodies = np.zeros(int(motions.bodies.max()) + 1 - system.first_body, complex)
    shaft, arm, flow = (int(motions.bodies[place]) for place in (1, -1, system.frame.place - system.first_body))
    vector = np.concatenate([turned, bodies])
    vector[shaft], vector[arm], vector[flow] = 2.0, 0.5, passed

    def turn(pairs: FloatArray) -> FloatArray:
        return np.stack([-pairs[:, 1], pairs[:, 0]], axis=1)

    velocity = value * (turn(points.place) + passed * points.slope) + SPEED * turn(points.slope)
    across = np.sqrt(points.weight) * np.sum(velocity * points.normal, axis=1)
    along = np.sqrt(points.weight + points.turning) * np.sum(velocity * points.tangent, axis=1)
    found = speeds_of(motions, points, value, vector)
    size = np.abs(np.concatenate([across, along])).max()
    np.testing.assert_allclose(found[0], across, atol=1e-9 * size)
    np.testing.assert_allclose(found[1], along, atol=1e-9 * size)
    for part, later in zip(found, speeds_of(motions, points, value, 1j * vector), strict=True):
        np.testing.assert_allclose(later, 1j * part, atol=1e-9 * size)  # a quarter of a period on
    energies = [np.sum(np.abs(part) ** 2) for part in (across, along)]
    energies += [system.bodies.kinetic[body] * abs(way * value) ** 2 for body, way in ((1, 2.0), (-1, 0.5))]
    shares = shares_of(motions, points, np.array([value]), vector[:, None]).of(0)
    parts = shares.span.sum(), shares.belt, shares.pulley[1], shares.tensioner[0]
    np.testing.assert_allclose(parts, np.array(energies) / sum(energies), rtol=1e-9)

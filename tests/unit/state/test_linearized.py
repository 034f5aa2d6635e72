"""A drive linearized about a state: motions that meet no force, and those that grow."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.model import prepare
from beltdyn.state.linearized import growing, in_motion
from beltdyn.state.static import standing
from beltdyn.state.staying import Standing, bring_to_stand
from beltdyn.system.constant_drive import constant_drive
from beltdyn.system.state import State
from tests.unit.vibration.test_small_motions import RADIUS, loose


def oscillators(*roots: complex) -> Any:
    """Uncoupled motions with roots r and their conjugates, or with pairs of real roots (a, b) written as a + 0j, b."""
    from scipy.sparse import csc_array

    damping, stiffness = [], []
    for root in roots:
        other = root.conjugate() if root.imag else -50.0
        damping.append(-(root + other).real)
        stiffness.append((root * other).real)
    size = len(roots)
    return SimpleNamespace(
        stiffness=csc_array(np.diag(stiffness)),
        damping=csc_array(np.diag(damping)),
        mass=csc_array(np.eye(size)),
        free=np.zeros((size, 0)),
    )


@pytest.mark.parametrize(
    ("roots", "grow"),
    [
        ([-1.0 + 20.0j, -3.0 + 0.0j, 40.0j], []),
        ([0.5 + 30.0j, -1.0 + 20.0j], [0.5 + 30.0j]),
        ([0.3 + 0.0j, 0.5 + 30.0j, -1.0 + 5.0j, 2.0 + 150.0j], [2.0 + 150.0j, 0.5 + 30.0j, 0.3 + 0.0j]),
        ([0.3 + 0.0j, 0.3 + 0.0j, -2.0 + 9.0j], [0.3 + 0.0j]),
        ([1e-5 + 30.0j, -1.0 + 5.0j], []),
        ([100.0 + 5e-5j, -1.0 + 5.0j], [100.0 + 0.0j]),
    ],
    ids=["none", "swings", "three", "twice", "rounding of growth", "rounding of frequency"],
)
def test_motions_that_grow(roots: list[complex], grow: list[complex]) -> None:
    """The fastest first, of each pair one, of equal ones one; what does not swing is real."""
    result = growing(oscillators(*roots))
    np.testing.assert_allclose(result, np.array(grow, complex), rtol=1e-6)
    np.testing.assert_array_equal(result.imag == 0.0, np.array(grow, complex).imag == 0.0)


@pytest.fixture(scope="module")
def rest() -> Standing:
    """Three pulleys that turn freely, with a tensioner, at rest."""
    return bring_to_stand(prepare(loose()))


def test_a_belt_turns_all_its_pulleys_without_force(rest: Standing) -> None:
    """Without friction, where each of them moves freely alone, too: with the speed of the stretched belt."""
    held = constant_drive(standing(rest.system), 0.0)
    smooth = held.pulleys.copy()
    smooth["friction"] = 0.0
    sliding = in_motion(rest.prepared, held._replace(pulleys=smooth), rest.state, 0.0)
    assert sliding.free.shape == (sliding.stiffness.shape[0], 4)
    _, parts = np.linalg.qr(sliding.free)
    assert abs(np.linalg.det(parts)) > 0.0
    together = max((way for way, _ in sliding._turning()), key=lambda way: np.count_nonzero(way))
    stretch = rest.prepared.path.length / rest.prepared.belt_length
    np.testing.assert_allclose(RADIUS * together[sliding.bodies[:3]], stretch * together[sliding.bodies[-2]], rtol=1e-6)


def test_in_motion_hubs_are_twisted_and_tensioners_stay(rest: Standing) -> None:
    """Rims without springs have the angles of their shafts, wherever these stand."""
    before, rims = rest.state, slice(rest.system.first_body, rest.state.position.size - 1)
    state = State(before.position.copy(), before.velocity, before.acceleration)
    state.position[rims] = 9.0
    in_motion(rest.prepared, constant_drive(standing(rest.system), 0.0), state, 0.0)
    np.testing.assert_array_equal(state.position[rims], 0.0)
    assert state.position[-1] == before.position[-1] != 0.0


def test_all_shafts_may_be_free(rest: Standing) -> None:
    """Otherwise prescribed ones are none of the unknowns."""
    held = constant_drive(standing(rest.system), 0.0)
    bodies = held.bodies.copy()
    bodies["unknown"] = [-1, 0, 1, 2]
    held = held._replace(bodies=bodies)
    some, every = (in_motion(rest.prepared, held, rest.state, 0.0, all_shafts=free) for free in (False, True))
    assert (some.bodies[0], every.bodies[0]) == (-1, rest.system.first_body)
    assert every.stiffness.shape[0] == some.stiffness.shape[0] + 1

"""What a roller beside the path sees: forces that add up to those on its hub, width, tensions at the ends, pressing."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import prepare
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build import staying_system
from beltdyn.system.frame import centreline_points
from beltdyn.system.nips import Nips, nip_loads, pressed_on, seen_nips, with_own_rollers
from beltdyn.system.state import State
from tests.unit.model.test_nip import NIP, pressed

ELEMENTS, SPEED, FRICTION = 48, 2.0, 0.4
Running = tuple[System, State]


def running(**belt: Any) -> Running:
    """The belt laid on its path, with a tension that grows along it, at the speed of no roller.

    Contact is integrated over whole elements, so that the points that are seen are those of the forces.
    """
    drive = pressed()
    prepared = prepare(drive.replace(belt=drive.belt.replace(**belt)))
    system = staying_system(prepared, prepared.equal_lengths(ELEMENTS))
    system = system._replace(law=system.law._replace(follow_zone=False))
    state = laid_state(prepared.laid, system, np.zeros(0))
    nodes = state.position[: system.first_body].reshape(system.nodes, -1)
    nodes[:, 2:4] *= 1.0 + 1e-4 * np.arange(system.nodes)[:, None]
    system.frame.speed[0] = SPEED
    state.velocity[system.first_body :] = 10.0
    return system, state


def look(system: System, state: State) -> Nips:
    nips = interpreted(seen_nips)(system, state.position[None], state.velocity[None])
    assert nips is not None
    return nips


def test_forces_at_points_add_up_to_those_on_the_roller() -> None:
    """With the weights of the points that integrate them: force and moment on the hub, and the power of friction."""
    system, state = running(stretch_loss_factor=0.1)
    nips, roller = look(system, state), int(np.flatnonzero(system.pulleys.beside)[0])
    forces = interpreted(body_forces_at)(system, np.zeros(1), state.position[None], state.velocity[None])
    weights = (system.length[:, None] * system.contact.weights).ravel()
    names = ("normal_force", "friction_force", "slip_velocity")
    normal, friction, slip = (getattr(nips, f"nip_{name}")[0, 0] for name in names)
    touched = normal > 0.0
    assert 1 < touched.sum() < 20
    assert not friction[~touched].any()
    assert not slip[~touched].any()
    assert np.all(np.abs(friction[touched]) <= FRICTION * normal[touched] * (1.0 + 1e-9))
    assert weights @ (friction * slip) == pytest.approx(-float(forces.friction[0, roller]), rel=1e-9)
    starts = np.cumsum(system.length) - system.length
    places, _, _ = centreline_points(
        system, state.position, (starts[:, None] + np.outer(system.length, system.contact.points)).ravel()
    )
    away = places - system.pulleys.center[roller]
    outward = away / np.linalg.norm(away, axis=1, keepdims=True)
    along = np.stack([-outward[:, 1], outward[:, 0]], axis=1)
    on_belt = (weights * normal) @ outward + (weights * friction) @ along
    np.testing.assert_allclose(forces.hub[0, roller], -on_belt, rtol=1e-9)


def ends_in_roller(system: System, state: State) -> list[float]:
    """Belt coordinates where the centerline enters and leaves the circle of the roller, m."""
    row = system.pulleys[int(np.flatnonzero(system.pulleys.beside)[0])]

    def away(along: FloatArray) -> FloatArray:
        places, _, _ = centreline_points(system, state.position, np.atleast_1d(along))
        return np.asarray(np.hypot(*(places - row.center).T) - row.radius)

    rough = np.linspace(0.0, float(system.length.sum()), 5000)
    (crossings,) = np.nonzero(np.diff(away(rough) < 0.0))
    return [brentq(lambda x: float(away(np.array(x))[0]), rough[k], rough[k + 1], xtol=1e-13) for k in crossings]


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_width_and_tensions_are_those_of_the_belt_in_the_roller(sense: float) -> None:
    """Where the belt runs the other way, tensions before and after the nip change places."""
    system, state = running()
    system.frame.speed[0] *= 0.2 * sense
    nips = look(system, state)
    ends = ends_in_roller(system, state)
    assert len(ends) == 2
    assert float(nips.nip_width[0, 0]) == pytest.approx(ends[1] - ends[0], rel=1e-6)
    _, slopes, _ = centreline_points(system, state.position, np.array(ends))
    tensions = [float(system.element.section.stretch.tension(np.hypot(*slope))) for slope in slopes]
    assert abs(tensions[1] - tensions[0]) > 100.0
    before, after = float(nips.nip_tension_before[0, 0]), float(nips.nip_tension_after[0, 0])
    assert [before, after] == pytest.approx(tensions[:: int(sense)], rel=1e-6)


def test_hysteresis_pulls_at_both_ends_by_the_same() -> None:
    elastic, lossy = (look(*running(stretch_loss_factor=factor)) for factor in (0.0, 0.3))
    more = [
        float(getattr(lossy, name)[0, 0] - getattr(elastic, name)[0, 0])
        for name in ("nip_tension_before", "nip_tension_after")
    ]
    assert more[0] == pytest.approx(more[1], rel=1e-2)


def test_a_drive_without_nips_sees_none() -> None:
    prepared = prepare(pressed(nip=[], pulley=pressed().pulleys[:2]))
    system = staying_system(prepared, prepared.equal_lengths(12))
    state = laid_state(prepared.laid, system, np.zeros(0))
    assert seen_nips(system, state.position[None], state.velocity[None]) is None
    assert with_own_rollers(system) is system


def test_rollers_move_until_the_belt_carries_their_forces() -> None:
    """A spring in place of the belt: Newton's steps along the line of centers end where it has the nip's force."""
    drive = pressed(belt=pressed().belt.replace(compression_set=0.1))
    places = [one.replace(center=tuple(np.add(one.center, (0.4, 0.3)))) for one in drive.pulleys]
    prepared = prepare(drive.replace(pulley=places))
    given = staying_system(prepared, prepared.equal_lengths(12))
    system, (load,) = with_own_rollers(given), nip_loads(prepared)
    assert (load.force, load.roller, load.pulley) == (2000.0, 2, 0)
    depth = float(prepared.path.indentations[0])
    assert load.stiffness == pytest.approx(
        (load.pair.force(depth + 1e-8) - load.pair.force(depth - 1e-8)) / 2e-8, rel=1e-4
    )
    centers, radii = system.pulleys.center, system.pulleys.radius
    start = centers[2].copy()

    def overlap() -> float:
        return float(radii[0] + radii[2] - np.hypot(*(centers[0] - centers[2])))

    centers[2] -= [2e-4, 0.0]
    moves = 0
    while pressed_on(system, [load], np.array([[0.0, 0.0], [0.0, 0.0], [-load.pair.force(overlap()), 0.0]]), 0.08):
        moves += 1
        assert moves < 20
    assert load.pair.force(overlap()) == pytest.approx(2000.0, rel=1e-6)
    np.testing.assert_allclose(centers[2], start, atol=1e-9)
    assert float(system.pulleys.lasting[2]) == pytest.approx(load.pair.lasting * load.pair.peak(overlap()), rel=1e-9)
    np.testing.assert_array_equal(given.pulleys.center[2], start)


def test_only_nips_with_a_force_are_loaded() -> None:
    gap = {"roller": "press", "pulley": "drum", "gap": "2.4 mm"}
    assert not nip_loads(prepare(pressed(nip=[gap])))
    assert len(nip_loads(prepare(pressed(nip=[NIP])))) == 1

"""A belt at rest on a mesh that stays, and on its way to another one."""

from importlib.resources import files
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.resolution import Laid
from beltdyn.state import staying
from beltdyn.state.installation import looked_at
from beltdyn.state.newton import NOT_FOUND, find_steady
from beltdyn.state.staying import (
    FINER,
    Sampled,
    Standing,
    bring_to_stand,
    carried,
    found_arcs,
    sampled,
    stand,
    stand_like,
    transfer,
)
from beltdyn.system.arc_mesh import base_lengths, fitted, shifts_of
from beltdyn.system.arrays import System
from beltdyn.system.build import staying_system
from beltdyn.system.frame import StayingByArcs, centreline_points
from beltdyn.system.meshing import phases
from beltdyn.system.moving_center import pulley_centers
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import anchor_at
from tests.unit.model.test_carrying import conveyor
from tests.unit.state.test_search import toothed


def lying(system: System, state: State) -> Sampled:
    return sampled(system, state.position, pulley_centers(system, state.position))


def with_length(drive: Drive, length: float) -> Drive:
    return drive.replace(belt=drive.belt.replace(length=length))


def test_dry_friction_of_a_tensioner_is_left_out_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tangent has derivatives by places alone, so that the search ends quadratically and not after 28 steps."""
    taken = list[int]()

    def counted(*arguments: Any) -> tuple[int, int]:
        found = find_steady(*arguments)
        taken.append(found[1])
        return found

    monkeypatch.setattr(staying, "find_steady", counted)
    drive = bd.load(str(files("beltdyn") / "examples" / "accessory_drive.toml"))
    stand(prepare(drive))
    assert sum(taken) <= 10


def test_arcs_of_a_laid_belt(drive: Drive) -> None:
    """Half circles of equal pulleys, with node zero in the middle of a span."""
    laid = Laid.on(drive.path, drive.belt_length, 0)
    span, arc = drive.path.span_lengths[0] / laid.stretch, np.pi * drive.radii[0] / laid.stretch
    expected = [(0.5 * span, 0.5 * span + arc), (1.5 * span + arc, 1.5 * span + 2.0 * arc)]
    np.testing.assert_allclose([one[:2] for one in laid.arcs()], expected)


def test_at_rest_the_tension_is_the_one_asked_for(drive: Drive) -> None:
    wanted = drive.replace(belt=drive.belt.replace(installed_tension=100.0))
    assert bring_to_stand(prepare(wanted)).tension == pytest.approx(100.0, rel=1e-6)


def test_rest_with_a_little_more_tension_is_found_next_to_the_one_before(drive: Drive) -> None:
    """On a mesh in proportion, as from a laid belt."""
    rest, tighter = stand(prepare(drive), 60), with_length(drive, drive.belt_length - 1e-4)
    found = stand_like(prepare(tighter), rest)
    np.testing.assert_allclose(found.system.length, rest.system.length * tighter.belt_length / drive.belt_length)
    assert found.tension > rest.tension
    assert found.tension == pytest.approx(stand(prepare(tighter), 60).tension, rel=1e-8)


def test_where_its_neighbour_leads_nowhere_it_is_found_from_the_laid_belt(
    drive: Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    rest, tighter = stand(prepare(drive), 60), with_length(drive, drive.belt_length - 1e-4)
    expected = stand_like(prepare(tighter), rest)

    def lost(*arguments: Any) -> tuple[Any, Any]:
        system, state = carried(*arguments)
        state.position[: system.first_body] *= 1.5
        return system, state

    monkeypatch.setattr(staying, "carried", lost)
    assert stand_like(prepare(tighter), rest).tension == pytest.approx(expected.tension, rel=1e-8)


@pytest.mark.parametrize(
    ("part", "said"),
    [(0.3, "too soft: on .* Increase contact.stiffness"), (0.03, "elements, near a tension of 100 N. Check")],
)
def test_without_rest_contact_that_is_too_soft_is_told(
    drive: Drive, monkeypatch: pytest.MonkeyPatch, part: float, said: str
) -> None:
    monkeypatch.setattr(staying, "_balance", lambda *_: False)
    stiffness = 100.0 / (part * float(np.min(drive.radii)) ** 2)
    contact = drive.contact.replace(stiffness=stiffness, allowed_penetration=None, damping=None)
    softer = drive.replace(contact=contact, belt=drive.belt.replace(length=None, installed_tension=100.0))
    with pytest.raises(ConvergenceError, match=said):
        stand(prepare(softer))


def test_the_mesh_is_carried_with_the_layout(drive: Drive) -> None:
    """A drive that is moved as a whole carries mesh and curve along; arcs keep their nodes where a radius grows."""
    rest, way = stand(prepare(drive)), np.array([0.3, -0.2])
    nodes = rest.place[: rest.system.first_body]
    moved = drive.replace(pulley=[one.replace(center=tuple(one.center + way)) for one in drive.pulleys])
    system, state = carried(prepare(moved), rest.prepared, rest.system.length, nodes)
    np.testing.assert_allclose(system.length, rest.system.length, rtol=1e-12)
    expected = nodes.reshape(-1, 6) + np.append(way, np.zeros(4))
    np.testing.assert_allclose(state.position[: nodes.size].reshape(-1, 6), expected, atol=1e-9)
    larger = drive.with_({f"pulley[{drive.pulleys[1].name}].radius": 1.01 * float(drive.radii[1])})
    grown = carried(prepare(larger), rest.prepared, rest.system.length, nodes)[0]
    laid = Laid.on(larger.path, larger.belt_length, 0)
    ends = np.append(0.0, np.cumsum(grown.length))
    before = np.append(0.0, np.cumsum(rest.system.length))
    for old, new in zip(Laid.on(drive.path, drive.belt_length, 0).arcs(), laid.arcs(), strict=True):
        inside = (before > old.start) & (before < old.end)
        np.testing.assert_array_equal((ends > new.start) & (ends < new.end), inside)


def test_graded_and_fine_meshes_have_the_same_equilibrium(drive: Drive) -> None:
    """The graded mesh of some 30 elements has the tension of 120 equal ones."""
    graded, fine = stand(prepare(drive)), stand(prepare(drive), 120)
    assert graded.system.nodes < 40
    assert graded.tension == pytest.approx(fine.tension, rel=2e-3)


def test_the_belt_touches_where_it_was_laid(drive: Drive) -> None:
    rest = stand(prepare(drive))
    found, laid = (
        found_arcs(rest.system, lying(rest.system, rest.state)),
        Laid.on(drive.path, drive.belt_length, 0).arcs(),
    )
    np.testing.assert_allclose([one[:2] for one in found], [one[:2] for one in laid], atol=0.02)


def test_a_finer_mesh_takes_the_curve_over(drive: Drive) -> None:
    """Nodes on the curve, and deviations between them far below the penetration of 30 um."""
    rest = stand(prepare(drive))
    lengths = np.repeat(rest.system.length / 2.0, 2)
    finer = staying_system(prepare(drive), lengths)
    moved = transfer(rest.system, rest.state, finer)
    along = np.linspace(0.0, drive.belt_length * 0.999, 500)
    one, other = (
        centreline_points(system, state.position, along)[0]
        for system, state in ((rest.system, rest.state), (finer, moved))
    )
    np.testing.assert_allclose(one, other, atol=1e-12)


def test_a_belt_that_touches_two_pulleys_at_once_is_refused(drive: Drive) -> None:
    prepared = prepare(drive)
    rest = stand(prepared)
    staying.require_one_pulley_at_a_time(prepared, rest.system, lying(rest.system, rest.state))
    pulleys = rest.system.pulleys.copy()
    pulleys["center"][1] = pulleys["center"][0] + [0.0, 0.5 * drive.radii[0]]
    beside = rest.system._replace(pulleys=pulleys)
    with pytest.raises(ConvergenceError, match='touches "driver" and "driven" at the same place'):
        staying.require_one_pulley_at_a_time(prepared, beside, lying(beside, rest.state))


@pytest.mark.parametrize(("elements", "fineness"), [(None, 0.5 * FINER ** np.arange(4.0)), (30, np.array([0.5]))])
def test_graded_meshes_are_made_finer_where_there_is_no_equilibrium(
    drive: Drive, elements: int | None, fineness: FloatArray, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four times; of equal elements there is but one number. The reason is that of the last mesh."""
    tried = list[float]()

    def fails(prepared: Prepared, number: int | None, *, fineness: float) -> Standing:
        assert number == elements
        tried.append(fineness)
        raise ConvergenceError(f"mesh {len(tried)}")

    monkeypatch.setattr(staying, "stand", fails)
    with pytest.raises(ConvergenceError, match=f"mesh {fineness.size}"):
        staying._on_some_mesh(prepare(drive), elements, 0.5)
    np.testing.assert_allclose(tried, fineness)


def tent(along: FloatArray, middle: float, half: float) -> FloatArray:
    """Depth in a pulley whose rim crosses the belt at `half` to both sides of a point."""
    return half - np.abs(along - middle)


@pytest.mark.parametrize("half", [0.23, 0.2, 0.275])
def test_arcs_end_where_the_rim_crosses_the_belt(half: float) -> None:
    """Between samples by their depths; the roller of a nip presses within an arc, and one elsewhere has none."""
    along = np.linspace(0.0, 2.0, 21)
    places = Sampled(along, np.stack([tent(along, 1.3, half), tent(along, 0.5, half), tent(along, 1.3, 0.08)]))
    system: Any = SimpleNamespace(
        rims=SimpleNamespace(radius=np.array([0.1, 0.2, 0.3])), pulleys=SimpleNamespace(beside=np.array([0, 0, 1]))
    )
    first, second = found_arcs(system, places)
    assert (first.start, first.end, first.radius) == pytest.approx((0.5 - half, 0.5 + half, 0.2))
    assert (second.start, second.end, second.radius) == pytest.approx((1.3 - half, 1.3 + half, 0.1))
    assert first.nips == ()
    assert np.ravel(second.nips) == pytest.approx([1.22, 1.38])


def test_grooves_meet_the_teeth_before_equilibrium_is_sought(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever they stand: half a pitch off, a belt would climb onto the teeth of its pulley."""
    prepared = prepare(toothed())
    system = staying_system(prepared, prepared.equal_lengths(40))
    state, seen = staying._lying(prepared, system, 1.0), list[FloatArray]()

    def result(_: Prepared, still: System, *__: Any) -> bool:
        seen.append(phases(still).copy())
        return len(seen) != 2

    monkeypatch.setattr(staying, "_found", result)
    for turned in (0.0, 0.5):
        phases(system)[:] = turned * 2.0 * np.pi / np.array([24.0, 36.0])
        assert staying._balance(prepared, system, state, anchor_at(state, True), 1.0)
    assert len(seen) == 1 + 1 + 4  # the second time with softer teeth, too
    for phase in seen[1:]:
        np.testing.assert_allclose(phase, seen[0])


def test_a_mesh_that_stays_at_every_arc_fits_the_belt_at_rest() -> None:
    """Elements have the lengths of where the state at rest puts their arcs; without it they keep those of the path."""
    prepared = prepare(conveyor())
    rest = stand(prepared, 40)
    assert isinstance(rest.system.frame, StayingByArcs)
    assert np.any(shifts_of(rest.system.frame) != 0.0)
    lengths = rest.system.length.copy()
    fitted(rest.system, rest.state.position)
    np.testing.assert_array_equal(rest.system.length, lengths)
    assert np.abs(lengths - base_lengths(rest.system)).max() > 1e-9


def test_a_finer_mesh_begins_with_the_coarser_one(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    """With 1.4 times the elements, and the tension to the error of the coarser one; or it begins with the laid belt."""
    rest = stand(prepare(drive), fineness=0.6)
    finer = staying._on_finer_mesh(rest)
    assert finer.fineness == pytest.approx(0.84)
    assert finer.system.nodes > 1.2 * rest.system.nodes
    assert finer.tension == pytest.approx(rest.tension, rel=1e-3)
    balanced, tried = staying._balanced, list[int]()

    def lost(*arguments: Any) -> tuple[State, float]:
        tried.append(len(tried))
        if len(tried) == 1:
            raise ConvergenceError("lost")
        return balanced(*arguments)

    monkeypatch.setattr(staying, "_balanced", lost)
    assert staying._on_finer_mesh(rest).tension == pytest.approx(finer.tension, rel=1e-8)


def test_a_search_that_fails_leaves_the_mesh_of_arcs_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    prepared = prepare(conveyor())
    system = staying_system(prepared, prepared.equal_lengths(40))
    state = staying._lying(prepared, system, 1.0)
    fitted(system, state.position)
    lengths, shifts = system.length.copy(), shifts_of(system.frame).copy()

    def lost(still: System, *_: Any) -> tuple[int, int]:
        shifts_of(still.frame)[:] += 1e-3
        fitted(still, state.position)
        assert not np.array_equal(still.length, lengths)
        return NOT_FOUND, 1

    monkeypatch.setattr(staying, "find_steady", lost)
    assert not staying._found(prepared, system, state, anchor_at(state, True))
    np.testing.assert_array_equal(shifts_of(system.frame), shifts)
    np.testing.assert_array_equal(system.length, lengths)


@pytest.mark.parametrize(("torque", "held"), [(2.0, True), (3000.0, False)])
def test_teeth_hold_torques_up_to_a_limit(torque: float, held: bool) -> None:
    """Spans differ by the torque over the radius; what is not held leaves the belt and its grooves as they were."""
    rest = stand(prepare(toothed()), 60)
    before, phase = rest.state.position.copy(), phases(rest.system).copy()
    torques = np.array([-torque * 24.0 / 36.0, torque])
    assert staying.under_torques(rest.prepared, rest.system, rest.state, torques) is held
    if held:
        tensions = looked_at(rest.prepared, rest.system, rest.state).seen.span_tension[0]
        assert abs(np.diff(tensions).item()) == pytest.approx(torque / (36 * 8e-3 / (2.0 * np.pi)), rel=0.02)
    else:
        np.testing.assert_array_equal(rest.state.position, before)
        np.testing.assert_array_equal(phases(rest.system), phase)

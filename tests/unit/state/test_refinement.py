"""Meshes finer and finer: their errors, where refinement ends, and what it goes on with where a search fails."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, prepare
from beltdyn.model.resolution import Arc
from beltdyn.state import refinement
from beltdyn.state.refinement import (
    MeshRule,
    _differences,
    _kinks,
    _mesh,
    _moved,
    against_coarser,
    errors_at_rest,
    is_fine,
    refine,
    refine_at_rest,
    steady_from_rest,
)
from beltdyn.state.staying import FINER, MOST_ELEMENTS, stand

RULE = MeshRule(0.01, 0.6)


@pytest.mark.parametrize(
    ("peak", "tension", "fine"),
    [(0.01, 0.003, True), (0.0101, 0.0, False), (0.0, 0.0031, False), (0.02, 0.02, False), (0.0, 0.0, True)],
)
def test_a_mesh_is_fine_enough_by_pressure_and_tension(peak: float, tension: float, fine: bool) -> None:
    """Of tensions three tenths of the tolerance are allowed; what equals a limit keeps to it."""
    assert is_fine({"peak pressure": peak, "tension": tension, "mean pressure": 9.0, "slip": 9.0}, 0.01) is fine


def solution(depth: Callable[[FloatArray], FloatArray], tensions: list[float], slips: list[float], *arcs: Arc) -> Any:
    return SimpleNamespace(
        depth=depth, arcs=list(arcs), slips=np.array(slips), seen=SimpleNamespace(span_tension=np.array([tensions]))
    )


def arch(along: FloatArray) -> FloatArray:
    """Depth over an arc from 1 to 3 m, negative outside."""
    return 1.0 - (along - 2.0) ** 2


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> None:
    """Depths of a belt are those of a formula."""
    monkeypatch.setattr(refinement, "_depth", lambda result, along: result.depth(along))


@pytest.mark.usefixtures("written")
@pytest.mark.parametrize("factor", [0.9, 1.1])
def test_differences_of_two_meshes(factor: float) -> None:
    """Depth, tensions and slips of the one before over those of the one after; each over its largest value."""
    before = solution(lambda along: factor * arch(along), [99.0, 52.0], [0.0, 0.018])
    after = solution(arch, [100.0, 50.0], [0.0, 0.02], Arc(1.0, 3.0, 0.05))
    errors = _differences(before, after)
    assert errors["peak pressure"] == pytest.approx(0.1, rel=1e-9)
    assert errors["mean pressure"] == pytest.approx(0.1, rel=1e-9)
    assert errors["tension"] == pytest.approx(0.02)
    assert errors["slip"] == pytest.approx(0.1)


@pytest.mark.usefixtures("written")
def test_what_lies_outside_presses_nowhere() -> None:
    """The mesh before has half of the arc outside: its negative depth counts as zero."""
    before = solution(lambda along: np.where(along < 2.0, arch(along), -5.0), [1.0], [0.0])
    errors = _differences(before, solution(arch, [1.0], [0.0], Arc(1.0, 3.0, 0.05), Arc(1.0, 2.0, 0.05)))
    assert errors["mean pressure"] == pytest.approx(0.5, rel=0.01)
    assert errors["peak pressure"] == pytest.approx(1.0, rel=0.01)


@pytest.mark.usefixtures("written")
def test_slip_without_load_is_measured_against_a_ten_thousandth() -> None:
    before, after = (solution(arch, [1.0], [0.0, slip], Arc(1.0, 3.0, 0.05)) for slip in (2e-6, 3e-6))
    assert _differences(before, after)["slip"] == pytest.approx(0.01)


@pytest.mark.usefixtures("written")
def test_a_belt_that_touches_nothing_has_errors_of_tension_alone() -> None:
    before, after = (solution(arch, [tension], [0.0]) for tension in (9.0, 10.0))
    assert _differences(before, after) == {
        "tension": pytest.approx(0.1),
        "mean pressure": 0.0,
        "peak pressure": 0.0,
        "slip": 0.0,
    }


def rubbing(slips: list[float], pulleys: list[int]) -> Any:
    """A belt of two elements with two points each, at 25, 75, 150 and 250 mm, where friction is full at 30 mm/s."""
    saturation = SimpleNamespace(saturation=lambda normal, friction, speed: np.full(len(normal), 0.03))
    system = SimpleNamespace(
        length=np.array([0.1, 0.2]),
        contact=SimpleNamespace(points=np.array([0.25, 0.75])),
        first_body=0,
        pulleys=SimpleNamespace(size=2, friction=np.full(2, 0.5)),
        rims=SimpleNamespace(radius=np.full(2, 0.1)),
        law=SimpleNamespace(friction=saturation),
    )
    seen = SimpleNamespace(
        contact_pulley=np.array([pulleys]), normal_force=np.ones((1, 4)), slip_velocity=np.array([slips])
    )
    return SimpleNamespace(system=system, seen=seen, state=SimpleNamespace(velocity=np.ones(2)))


@pytest.mark.parametrize(
    ("slips", "pulleys", "kinks"),
    [
        ([0.0, 0.01, 0.06, 0.1], [0, 0, 0, 0], [0.075 + 0.075 * 0.4]),
        ([0.0, -0.01, -0.06, -0.1], [0, 0, 0, 0], [0.075 + 0.075 * 0.4]),
        ([0.06, 0.01, 0.0, 0.05], [1, 1, 1, 1], [0.025 + 0.05 * 0.6, 0.15 + 0.1 * 0.6]),
        ([0.06, 0.01, 0.05, 0.0], [1, 1, 0, 0], [0.025 + 0.05 * 0.6, 0.15 + 0.1 * 0.4]),
        ([0.06, 0.06, 0.0, 0.0], [0, 0, 1, 1], []),
        ([0.0, 0.0, 0.0, 0.0], [0, 0, 0, 0], []),
        ([0.0, 0.06, 0.0, 0.06], [0, -1, 0, -1], []),
    ],
)
def test_friction_begins_to_be_full_between_points(slips: list[float], pulleys: list[int], kinks: list[float]) -> None:
    """Where slip, of whatever sense, passes the limit on a pulley, in proportion; sorted along the belt."""
    np.testing.assert_allclose(_kinks(rubbing(slips, pulleys)), kinks)


class Search:
    """A search that fails on its first meshes."""

    def __init__(self, failures: int = 0) -> None:
        self.failures, self.moves, self.iterations, self.prepared, self.tolerance = failures, list[Any](), 0, None, 1e-9

    def move_to(self, mesh: Any) -> None:
        self.iterations += 1
        self.moves.append(mesh)
        if len(self.moves) <= self.failures:
            raise ConvergenceError("not on this mesh")
        self.tolerances = self.tolerance


@pytest.fixture
def meshes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mesh is its rule."""
    monkeypatch.setattr(refinement, "_mesh", lambda prepared, now, rule: rule)


@pytest.mark.usefixtures("meshes")
@pytest.mark.parametrize("failures", [0, 1, 2])
def test_a_finer_mesh_of_another_size_is_tried_where_the_first_leads_nowhere(failures: int) -> None:
    search: Any = Search(failures)
    finer = _moved(search, SimpleNamespace(), RULE)  # type: ignore[arg-type]
    assert finer is not None
    assert finer == search.moves[-1]
    assert finer._replace(fineness=RULE.fineness) == RULE
    tried = [each.fineness / RULE.fineness for each in search.moves]
    assert tried == pytest.approx([FINER, 0.9 * FINER, 1.15 * FINER][: failures + 1])
    assert search.iterations == failures + 1


@pytest.mark.usefixtures("meshes")
def test_a_search_that_finds_no_finer_mesh_stays_as_it_was() -> None:
    search: Any = Search(9)
    assert _moved(search, SimpleNamespace(), RULE) is None  # type: ignore[arg-type]
    assert search.iterations == 3


def standing(nodes: int, **seen: Any) -> Any:
    """A solution with so many nodes, which presses."""
    options = {"normal_force": np.ones((1, 1))} | seen
    return SimpleNamespace(system=SimpleNamespace(nodes=nodes), seen=SimpleNamespace(**options), arcs=[])


@pytest.fixture
def refined(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Refine from 30 nodes on, to finer meshes as long as there are, with an error of a tenth of the one before."""

    def run(rule: MeshRule, tolerance: float, most: int = 99, begin: int = 30) -> Any:
        nodes = [begin]

        def moved(search: Any, now: Any, last: MeshRule) -> MeshRule | None:
            assert now.system.nodes == nodes[-1]
            if len(nodes) > most:
                return None
            nodes.append(round(FINER * nodes[-1]))
            return last.finer()

        def differences(before: Any, after: Any) -> dict[str, float]:
            assert (before.system.nodes, after.system.nodes) == tuple(nodes[-2:])
            return {"peak pressure": 10.0 ** (1 - len(nodes)), "tension": 0.0}

        monkeypatch.setattr(refinement, "_solution", lambda _: standing(nodes[-1]))
        monkeypatch.setattr(refinement, "_moved", moved)
        monkeypatch.setattr(refinement, "_differences", differences)
        errors, result = refine(SimpleNamespace(), rule, tolerance)  # type: ignore[arg-type]
        return errors, result, len(nodes) - 1

    return run


@pytest.mark.parametrize(("tolerance", "steps"), [(0.2, 1), (0.02, 2), (0.002, 3)])
def test_meshes_are_refined_to_a_tolerance(refined: Callable[..., Any], tolerance: float, steps: int) -> None:
    errors, rule, count = refined(RULE, tolerance)
    assert count == steps
    assert errors["peak pressure"] == pytest.approx(10.0**-steps)
    assert rule.fineness == pytest.approx(RULE.fineness * FINER**steps)


def test_equal_elements_are_refined_once(refined: Callable[..., Any]) -> None:
    """Their number was chosen; the finer mesh tells the errors."""
    assert refined(RULE._replace(elements=40), 1e-9)[2] == 1


def test_refinement_ends_with_the_largest_number_of_elements(refined: Callable[..., Any]) -> None:
    assert refined(RULE, 1e-99, begin=MOST_ELEMENTS - 1)[2] == 1
    assert refined(RULE, 1e-99, begin=round(MOST_ELEMENTS / FINER) - 1)[2] == 2


def test_errors_that_are_known_are_kept_where_no_finer_mesh_is_found(refined: Callable[..., Any]) -> None:
    errors, rule, count = refined(RULE, 1e-9, most=2)
    assert count == 2
    assert errors["peak pressure"] == pytest.approx(0.01)
    assert rule.fineness == pytest.approx(RULE.fineness * FINER**2)


def test_without_a_finer_mesh_errors_are_unknown(refined: Callable[..., Any]) -> None:
    with pytest.raises(ConvergenceError, match="found with 30 elements but on no finer mesh, so its errors are"):
        refined(RULE, 0.01, most=0)


@pytest.mark.parametrize("nips", [(), ((1.0, 2.0),)])
def test_a_belt_that_no_pulley_carries_is_refused(nips: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """One that meets its pulleys in points, pressed by nips, is not."""
    result = standing(30, normal_force=np.zeros((1, 5)))
    result.arcs = [Arc(0.0, 0.0, 0.05, nips=nips)]
    monkeypatch.setattr(refinement, "_solution", lambda _: result)
    monkeypatch.setattr(refinement, "_moved", lambda *_: None)
    message = "on no finer mesh" if nips else "lifted off all pulleys"
    with pytest.raises(ConvergenceError, match=message):
        refine(SimpleNamespace(), RULE, 0.01)  # type: ignore[arg-type]


@pytest.mark.usefixtures("meshes")
def test_a_mesh_is_compared_with_a_coarser_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search itself stays; only its iterations are counted."""
    monkeypatch.setattr(refinement, "_solution", lambda search: search)
    monkeypatch.setattr(refinement, "_differences", lambda before, after: {"of": (before, after)})
    search: Any = Search()
    errors, coarser = against_coarser(search, RULE)
    assert errors["of"] == (coarser, search)  # type: ignore[comparison-overlap]
    (coarse,) = coarser.moves  # type: ignore[attr-defined]
    assert coarse.fineness == pytest.approx(RULE.fineness / FINER)
    assert coarser.tolerances == 1e-6  # type: ignore[attr-defined]
    assert coarser.tolerance == search.tolerance == 1e-9
    assert search.iterations == 1


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Steady running from rest, with searches that fail as told: in the run up, in refinement, or not."""

    def run(failures: str, limited: bool = False, nips: tuple[int, ...] = (), elements: int = 0) -> Any:
        rest = SimpleNamespace(
            prepared=SimpleNamespace(path=SimpleNamespace(nips=nips)), system=None, state=None, fineness=1.0
        )
        starts = list[float]()

        class Begun:
            def __init__(self, *_: Any) -> None:
                self.is_limited, self.fails = limited, failures[len(starts)]

            def run(self, place: Any) -> None:
                starts.append(place.fineness)
                if self.fails == "r":
                    raise ConvergenceError(f"start {len(starts)}")

            def friction_band(self) -> dict[str, float]:
                return {"band": 1.0}

        def refined(search: Any, rule: MeshRule, tolerance: float) -> Any:
            if search.fails == "m":
                raise ConvergenceError(f"mesh {len(starts)}")
            return {}, rule.finer()

        monkeypatch.setattr(refinement, "SteadySearch", Begun)
        monkeypatch.setattr(refinement, "refine", refined)
        monkeypatch.setattr(
            refinement, "stand", lambda prepared, fineness: SimpleNamespace(**vars(rest) | {"fineness": fineness})
        )
        rule = MeshRule(0.01, elements=elements)
        result = steady_from_rest(rest, 0.0, lambda at: rule._replace(fineness=at.fineness), 0.01, bands=True)  # type: ignore[arg-type]
        return starts, result

    return run


@pytest.mark.parametrize(("failures", "starts"), [("-", 1), ("r-", 2), ("m-", 2), ("rmr-", 4)])
def test_steady_running_is_sought_from_finer_meshes(begun: Callable[..., Any], failures: str, starts: int) -> None:
    tried, result = begun(failures)
    assert tried == pytest.approx(FINER ** np.arange(starts))
    assert result.rest.fineness == pytest.approx(tried[-1])
    assert result.rule.fineness == pytest.approx(FINER * tried[-1])
    assert result.band == {"band": 1.0}


@pytest.mark.parametrize(
    ("failures", "options", "message"),
    [
        ("rrrr-", {}, "start 4"),
        ("mmmm-", {}, "mesh 4"),
        ("r-", {"limited": True}, "start 1"),
        ("r-", {"elements": 30}, "start 1"),
    ],
    ids=["no start", "no mesh", "a limit of the drive", "equal elements"],
)
def test_a_search_that_has_failed_for_good_says_why(
    begun: Callable[..., Any], failures: str, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ConvergenceError, match=message):
        begun(failures, **options)


@pytest.mark.parametrize(("failures", "options"), [("mr-", {}), ("r-", {"nips": (1,)})], ids=["it ran", "nips"])
def test_a_limit_may_be_one_of_the_mesh(begun: Callable[..., Any], failures: str, options: dict[str, Any]) -> None:
    """What has run on a coarser mesh runs; and a nip on a coarse mesh may slip first."""
    assert len(begun(failures, limited=True, **options)[0]) == len(failures)


def test_meshes_of_equal_elements(drive: Drive) -> None:
    """As many as the rule says, with its factor."""
    prepared = prepare(drive)
    lengths = _mesh(prepared, SimpleNamespace(), MeshRule(0.0, FINER, 30))  # type: ignore[arg-type]
    np.testing.assert_allclose(lengths, prepared.belt_length / 42)


def test_at_rest_errors_fall_as_the_mesh_gets_finer(drive: Drive) -> None:
    """Those of equal elements against 1.4 times as many; graded ones are refined to the tolerance and no further."""
    prepared = prepare(drive)
    coarse, fine = (errors_at_rest(stand(prepared, elements), elements) for elements in (24, 60))
    assert 0.0 < fine["peak pressure"] < 0.7 * coarse["peak pressure"]
    assert set(fine) == {"tension", "mean pressure", "peak pressure"}
    rest, errors = refine_at_rest(prepared, 0.05)
    assert 0.0 < errors["peak pressure"] <= 0.05
    finer = stand(prepared, fineness=FINER * rest.fineness)
    assert finer.system.nodes > rest.system.nodes
    assert abs(finer.tension / rest.tension - 1.0) <= errors["tension"] + 1e-9


def test_where_no_finer_mesh_is_found_at_rest_errors_are_unknown(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    rest = stand(prepare(drive), 12)

    def fails(*_: Any, **__: Any) -> None:
        raise ConvergenceError

    monkeypatch.setattr(refinement, "stand", fails)
    assert errors_at_rest(rest) == {}

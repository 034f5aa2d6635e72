"""The search for the installed tension on laws of tension over length, in place of equilibria."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.state import tightening
from beltdyn.state.tightening import Tightening, begin
from tests.unit.vibration.test_small_motions import loose

WANTED = 100.0
"""Installed tension, N."""
ACCURACY = 1e-6
"""Of the tension that is found, relative: that of the search."""
SLOPE, LENGTH, RADIUS = 8e3, 1.2, 0.08
"""Estimated slope of the tension, N/m, length of the belt, m, and radius of its pulleys, m."""
Law = Callable[[float], float]
"""Tension, N, over how much tighter the belt is, m."""


@dataclass(frozen=True)
class Layout:
    """A drive as the search sees it: a belt of some length, and perhaps springs."""

    carriers: tuple[str, ...] = ()
    belt_length: float = LENGTH
    installed_tension: float | None = None  # for closed forms
    elements: int = 20

    def tightened(self, distance: float) -> "Layout":
        return replace(self, belt_length=self.belt_length - distance)

    @property
    def pulleys(self) -> Any:
        return [SimpleNamespace(name=name) for name in ("driver", "driven")]

    @property
    def drive(self) -> Any:
        return SimpleNamespace(pulleys=self.pulleys)

    @property
    def radii(self) -> Any:
        return np.full(2, RADIUS)


@dataclass(frozen=True)
class Trial:
    """A belt whose tension follows a law; its hub loads are those of spans that turn by an angle at each pulley."""

    prepared: Any
    tension: float
    turn: float = np.pi
    wrap: float = np.pi
    center: float = 0.0

    @property
    def seen(self) -> Any:
        pull = 2.0 * self.tension * np.sin(0.5 * self.turn)
        hub = np.array([[[2.0 * self.tension, 0.0], [pull, 0.0]]])
        centers = np.array([[[3.0, 4.0], [5.0 + self.center, 6.0]]])
        return SimpleNamespace(hub_force=hub, wrap_angle=np.array([[np.pi, self.wrap]]), pulley_center=centers)


@dataclass
class Searched:
    """A search on a law, and the trials that it makes."""

    layout: Any
    law: Law
    kind: Callable[[Any, float, float], Trial] = lambda prepared, tension, tighter: Trial(prepared, tension)
    trials: list[float] = field(default_factory=list)

    def at(self, prepared: Any, near: Trial | None = None) -> Trial:
        tighter = self.layout.belt_length - prepared.belt_length
        self.trials.append(tighter)
        return self.kind(prepared, self.law(tighter), tighter)

    def search(self, wanted: float = WANTED) -> Tightening[Trial]:
        return Tightening(self.layout, wanted, self.at, self.at(self.layout), 0.0)

    def run(self, wanted: float = WANTED) -> Trial:
        return self.search(wanted).run()


@pytest.fixture
def layout(monkeypatch: pytest.MonkeyPatch) -> Layout:
    """A belt around fixed pulleys."""
    monkeypatch.setattr(tightening, "_tension_over_length", lambda _: SLOPE)
    return Layout()


@pytest.fixture
def sprung(layout: Layout) -> Layout:
    """A belt with a tensioner."""
    return replace(layout, carriers=("driven",))


@pytest.fixture(scope="module")
def prepared(drive: Drive) -> Prepared:
    """Two pulleys in closed form."""
    return prepare(drive.replace(belt=drive.belt.replace(length=None, installed_tension=WANTED)))


def slope_of(prepared: Prepared) -> float:
    """Of the tension of a belt of constant length, N/m."""
    return prepared.loaded_belt.axial_stiffness / prepared.belt_length


@pytest.fixture(params=range(6))
def smooth(request: pytest.FixtureRequest) -> Law:
    """A tension that rises as the belt gets tighter, by a slope of 0.3 to 3 times the estimated one that changes."""
    random = np.random.default_rng(request.param)
    slope, start = SLOPE * 3.0 ** random.uniform(-1.0, 1.0), WANTED * random.uniform(0.3, 2.0)
    bend = random.uniform(0.0, 0.9) * slope
    return lambda tighter: start + slope * tighter + bend * 0.01 * np.sin(tighter / 0.01 + request.param)


def test_the_installed_tension_is_met_in_a_few_trials(layout: Layout, smooth: Law) -> None:
    searched = Searched(layout, smooth)
    result = searched.run()
    assert result.tension == pytest.approx(WANTED, rel=ACCURACY)
    assert result.tension == smooth(layout.belt_length - result.prepared.belt_length)
    assert len(searched.trials) < 15


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("missing", [0.5, 30.0])
def test_two_trials_tell_the_slope_of_a_straight_law(layout: Layout, factor: float, missing: float) -> None:
    """The third one meets the tension."""
    searched = Searched(layout, lambda tighter: WANTED - missing + factor * SLOPE * tighter)
    assert searched.run().tension == pytest.approx(WANTED, rel=ACCURACY)
    assert len(searched.trials) == 3


def test_a_belt_that_has_its_tension_is_left_as_it_is(layout: Layout) -> None:
    searched = Searched(layout, lambda tighter: WANTED + SLOPE * tighter)
    assert searched.run().prepared is layout
    assert len(searched.trials) == 1


def test_a_far_tension_is_met_in_steps_of_two_per_cent_of_the_length(layout: Layout) -> None:
    """A belt a hundred times softer than estimated."""
    searched = Searched(layout, lambda tighter: 1.0 + 0.01 * SLOPE * tighter)
    assert searched.run(20.0).tension == pytest.approx(20.0, rel=ACCURACY)
    steps = np.abs(np.diff(searched.trials))
    assert steps.max() == pytest.approx(0.02 * layout.belt_length, rel=1e-6)


def test_a_tension_that_does_not_change_for_a_while_is_passed(layout: Layout) -> None:
    """Between 1 and 3 mm tighter a spring holds the tension."""

    def law(tighter: float) -> float:
        return 90.0 + SLOPE * (min(tighter, 1e-3) + max(tighter - 3e-3, 0.0))

    assert Searched(layout, law).run(120.0).tension == pytest.approx(120.0, rel=ACCURACY)


def with_jump(layout: Layout, height: float) -> Law:
    """A tension that jumps by a height, N, around the one that is wanted, at a belt 1 mm tighter."""
    return lambda tighter: WANTED + SLOPE * (tighter - 1e-3) + (0.7 if tighter > 1e-3 else -0.3) * height


def test_beside_a_small_jump_the_nearer_tension_is_taken(layout: Layout) -> None:
    result = Searched(layout, with_jump(layout, 1.0)).run()
    assert result.tension == pytest.approx(WANTED - 0.3, rel=1e-5)
    assert layout.belt_length - result.prepared.belt_length == pytest.approx(1e-3, rel=1e-3)


def test_a_large_jump_is_told_with_both_tensions(layout: Layout) -> None:
    searched = Searched(layout, with_jump(layout, 10.0))
    message = r"= 100 N cannot be reached with .* jumps from 9[67]\.?\d* to 10[67]\.?\d* N at a length of (\S+) m"
    with pytest.raises(ConvergenceError, match=message):
        searched.run()


def ending(tighter: float, end: float) -> None:
    if tighter > end:
        raise ConvergenceError("no equilibrium beyond")


def test_steps_to_where_no_equilibrium_is_are_halved(layout: Layout) -> None:
    """The tension is met just before equilibria end; from a slope that is too small trials go far beyond."""
    slope = 20.0 * SLOPE
    reach = WANTED / slope

    def law(tighter: float) -> float:
        ending(tighter, 1.05 * reach)
        return 1.0 + slope * tighter

    searched = Searched(layout, law)
    assert searched.run().tension == pytest.approx(WANTED, rel=ACCURACY)
    assert max(searched.trials) > 1.05 * reach


def test_where_equilibria_end_before_the_tension_the_reason_is_told(layout: Layout) -> None:
    def law(tighter: float) -> float:
        ending(tighter, 0.5 * WANTED / SLOPE)
        return 1.0 + SLOPE * tighter

    with pytest.raises(ConvergenceError, match="cannot be reached with 20 elements: no equilibrium beyond"):
        Searched(layout, law).run()


def test_a_pulley_that_the_belt_leaves_is_named_with_the_tension_there(layout: Layout) -> None:
    """At "driven" spans turn by an angle that falls in proportion to the tension, to nothing at 80 N."""

    def kind(prepared: Any, tension: float, tighter: float) -> Trial:
        turn = 1e-2 * (80.0 - tension)
        if turn < 0.05:
            raise ConvergenceError("does not touch")
        return Trial(prepared, tension, turn=turn, wrap=turn)

    searched = Searched(layout, lambda tighter: 20.0 + SLOPE * tighter, kind)
    with pytest.raises(ConvergenceError, match=r'at (\S+) N the belt leaves "driven", which it must touch') as failure:
        searched.run()
    assert float(str(failure.value).split(": at ")[1].split()[0]) == pytest.approx(80.0, rel=1e-3)


def test_a_pulley_about_to_be_left_is_named_with_the_present_tension(layout: Layout) -> None:
    """Its arc of 0.3 degrees is shorter than what a mesh resolves; the other angles do not change."""

    def kind(prepared: Any, tension: float, tighter: float) -> Trial:
        if tighter > 0.5 * WANTED / SLOPE:
            raise ConvergenceError("does not touch")
        return Trial(prepared, tension, wrap=np.radians(0.3))

    with pytest.raises(ConvergenceError, match=r'at (\S+) N the belt leaves "driven"') as failure:
        Searched(layout, lambda tighter: 20.0 + SLOPE * tighter, kind).run()
    assert float(str(failure.value).split(": at ")[1].split()[0]) == pytest.approx(70.0, rel=1e-3)


def turning_law(tighter: float) -> float:
    """With the largest tension, 80 N, of a belt that is 5 mm tighter."""
    return 80.0 - 4e5 * (tighter - 5e-3) ** 2


def test_a_tension_that_a_spring_turns_is_told(sprung: Layout) -> None:
    with pytest.raises(ConvergenceError, match=r"gives (\S+) N with a belt length of \S+ m, and less with") as failure:
        Searched(sprung, turning_law).run()
    assert float(str(failure.value).split("gives ")[1].split()[0]) == pytest.approx(80.0, rel=0.05)


def test_without_springs_no_tension_is_said_to_turn(layout: Layout) -> None:
    with pytest.raises(ConvergenceError) as failure:
        Searched(layout, turning_law).run()
    assert "tensioner force" not in str(failure.value)
    assert "cannot be reached with 20 elements: the tension at rest is" in str(failure.value)


def test_a_spring_that_holds_nearly_the_tension_gives_it(sprung: Layout) -> None:
    """Bending leaves 99.7 N of 100 N, at any length."""
    result = Searched(sprung, lambda tighter: 99.7 + 0.01 * np.tanh(tighter)).run()
    assert result.tension == pytest.approx(99.7, rel=1e-3)


def test_a_spring_that_holds_another_tension_is_told(sprung: Layout) -> None:
    with pytest.raises(ConvergenceError, match=r"= 100 N cannot be set: the tensioner force gives 90 N at any belt"):
        Searched(sprung, lambda tighter: 90.0 + 0.01 * np.tanh(tighter)).run()


def test_a_tensioner_that_jumps_is_named(sprung: Layout) -> None:
    """From one length on its other balance is a radius away."""

    def kind(prepared: Any, tension: float, tighter: float) -> Trial:
        return Trial(prepared, tension, center=1.1 * RADIUS if tighter > 1e-3 else 0.0)

    with pytest.raises(ConvergenceError, match=r'at 5\d\S* N, .* the balance of the tensioner of "driven" ends'):
        Searched(sprung, lambda tighter: 50.0 + SLOPE * tighter, kind).run()


def test_starts_lie_between_lengths_with_too_much_and_too_little_tension(sprung: Layout) -> None:
    """Each with the slope of the chord there; the tension falls, turns, and rises to both sides."""
    step = 0.005 * sprung.belt_length

    def law(tighter: float) -> float:
        return WANTED + 3.0 * ((tighter / step) ** 2 - 10.0)

    starts = list(Searched(sprung, law).search()._brackets())
    assert [np.sign(start.tighter) for start in starts] == [-1.0, 1.0]
    for start in starts:
        side = np.sign(start.tighter)
        assert abs(start.tighter) == pytest.approx(4.0 * step)
        chord = (law(start.tighter) - law(start.tighter - side * step)) / (side * step)
        assert start.slope == pytest.approx(chord, rel=1e-9)


def test_a_tension_that_is_nearly_met_is_no_start(sprung: Layout) -> None:
    """It comes as near as 0.3 N, and turns."""
    step = 0.005 * sprung.belt_length
    assert not list(Searched(sprung, lambda tighter: WANTED + 0.3 + (tighter / step - 5.0) ** 2).search()._brackets())


def test_a_tension_far_from_the_first_length_is_found_where_springs_turn_it(sprung: Layout) -> None:
    """Near the first length it stays above the one that is wanted."""
    step = 0.005 * sprung.belt_length

    def law(tighter: float) -> float:
        return WANTED * (1.3 + 0.1 * math.cos(tighter / step) - (tighter / (9.0 * step)) ** 2)

    assert Searched(sprung, law).run().tension == pytest.approx(WANTED, rel=ACCURACY)


def test_a_search_begins_tighter_or_looser_where_equilibrium_fails(prepared: Prepared) -> None:
    """First at the length of closed forms, then at 5 % more tension, and less, and so on, by the estimated slope."""
    tried = list[float]()

    def at_rest(changed: Prepared) -> Trial:
        tried.append(prepared.belt_length - changed.belt_length)
        if len(tried) < 6:
            raise ConvergenceError("not touched")
        return Trial(changed, WANTED)

    rest, tighter = begin(prepared, at_rest)
    assert prepared.belt_length - rest.prepared.belt_length == pytest.approx(tighter)
    change = WANTED / tightening._tension_over_length(prepared)
    np.testing.assert_allclose(tried[2:], np.array([0.05, -0.05, 0.1, -0.1]) * change, rtol=1e-6)
    assert tried[0] == 0.0
    assert abs(tried[1]) < 0.01 * change


def test_where_no_equilibrium_is_found_the_first_reason_stands(prepared: Prepared) -> None:
    reasons: Iterator[int] = iter(range(100))

    def at_rest(_: Prepared) -> Trial:
        raise ConvergenceError(f"reason {next(reasons)}")

    with pytest.raises(ConvergenceError, match="reason 0"):
        begin(prepared, at_rest)


def test_the_slope_of_the_tension_is_that_of_the_belt_and_its_springs(prepared: Prepared) -> None:
    """E A / L of a belt around fixed pulleys, but for its stretch and contact; far less where a spring yields."""
    assert tightening._tension_over_length(prepared) == pytest.approx(slope_of(prepared), rel=0.05)
    sprung = prepare(loose())
    assert 0.0 < tightening._tension_over_length(sprung) < 0.2 * slope_of(sprung)


def test_without_a_slope_that_rises_that_of_the_belt_is_taken(
    prepared: Prepared, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise ValueError

    monkeypatch.setattr(tightening, "balance_tensioners", fails)
    assert tightening._tension_over_length(prepared) == pytest.approx(slope_of(prepared), rel=1e-3)


@pytest.mark.parametrize(
    ("weight", "bent", "cause"),
    [(0.0, None, "bending stiffness"), (-9.81, None, "weight"), (-9.81, 0.4, "weight"), (-9.81, 0.6, "bending")],
    ids=["no weight", "weight alone holds it", "mostly weight", "mostly bending"],
)
@pytest.mark.parametrize("tension", [0.5, 30.0])
def test_what_tensions_a_belt_as_long_as_its_path(
    weight: float, bent: float | None, cause: str, tension: float
) -> None:
    """Without its weight it keeps a part of its tension, or no balance."""

    def prepared(length: float, gravity: float) -> Any:
        installation = SimpleNamespace(path=SimpleNamespace(length=LENGTH))
        return SimpleNamespace(
            belt_length=length,
            gravity=(0.0, gravity),
            installation=installation,
            replace=lambda gravity: prepared(length, gravity[1]),
        )

    def at_rest(changed: Any, near: Any) -> Any:
        assert changed.gravity == (0.0, 0.0)
        if bent is None:
            raise ModelError("slack")
        return Trial(changed, bent * tension)

    message = tightening._as_long_as_its_path(Trial(prepared(LENGTH, weight), tension), at_rest)
    assert f"by its {cause}" in message
    assert f"still has {tension:g} N" in message
    assert tightening._as_long_as_its_path(Trial(prepared(0.99 * LENGTH, weight), tension), at_rest) == ""

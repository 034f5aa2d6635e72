"""Continuation along a way whose solutions are known."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.state.search import extrapolated, go_on
from beltdyn.state.steady import steady_state


def test_a_parabola_is_met_at_once() -> None:
    """After three solutions guesses on a parabola are exact."""

    def exact(place: float) -> FloatArray:
        return np.array([1.0 + place - 3.0 * place**2, 2.0 * place])

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        off = float(np.abs(guess - exact(place)).max())
        offs.append(off)
        return exact(place) if off < 0.9 else None

    offs = list[float]()
    end = go_on(solve, (0.0, exact(0.0)))
    assert end is not None
    np.testing.assert_array_equal(end, exact(1.0))
    assert max(offs) > 0.9
    assert offs[-1] < 1e-12


def test_earlier_solutions_serve_the_first_guess() -> None:
    guesses = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        guesses.append(float(guess[0]))
        return np.array([place**2])

    known = [(place, np.array([place**2])) for place in (-2.0, -1.0, 0.0)]
    assert go_on(solve, *known) is not None
    assert guesses == pytest.approx([1.0])


@pytest.mark.parametrize("known", [1, 3])
def test_steps_grow_once_there_is_a_parabola(known: int) -> None:
    tried = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        tried.append(place)
        return guess

    assert go_on(solve, *((0.1 * number, np.zeros(1)) for number in range(1 - known, 1)), step=0.125) is not None
    ways = [1.0, 1.0, 2.0, 4.0] if known == 1 else [1.0, 2.0, 4.0, 1.0]
    assert tried == pytest.approx(0.125 * np.cumsum(ways))


def test_a_way_that_ends_before() -> None:
    """No solution beyond a half: steps are halved until they are short."""
    tried = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        tried.append(place)
        return guess if place <= 0.5 else None

    assert go_on(solve, (0.0, np.zeros(1))) is None
    assert 0.5 <= min(place for place in tried if place > 0.5) < 0.51


def test_one_solution_is_its_own_continuation() -> None:
    assert extrapolated([(0.3, np.array([4.0]))], 1.0) == pytest.approx([4.0])


def test_a_drive_without_a_machine_is_told_which_pulleys_could_have_one() -> None:
    belt = {"profile": "PK", "ribs": 6, "installed_tension": 300.0}
    pulleys = [
        {"name": name, "center": [x, 0.0], "radius": 0.05, "inertia": 0.01} for name, x in (("a", 0.0), ("b", 0.3))
    ]
    idle = Drive(belt=belt, pulley=pulleys, contact={"friction": 0.4}, simulation={"duration": 1.0})
    with pytest.raises(ModelError, match='no machine drives the belt: "a" and "b" have neither a speed nor a motor'):
        steady_state(idle)

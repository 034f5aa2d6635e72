"""Continuation along curves that are known in closed form, also around limit points."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.solvers.continuation import Linearized, Solution, extrapolated, follow, turn


def test_a_parabola_is_met_at_once() -> None:
    """After three solutions guesses on a parabola are exact."""

    def exact(place: float) -> FloatArray:
        return np.array([1.0 + place - 3.0 * place**2, 2.0 * place])

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        off = float(np.abs(guess - exact(place)).max())
        offs.append(off)
        return exact(place) if off < 0.9 else None

    offs = list[float]()
    end = follow(solve, Solution(0.0, exact(0.0)))
    assert end is not None
    np.testing.assert_array_equal(end, exact(1.0))
    assert max(offs) > 0.9
    assert offs[-1] < 1e-12


def test_earlier_solutions_serve_the_first_guess() -> None:
    guesses = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        guesses.append(float(guess[0]))
        return np.array([place**2])

    known = [Solution(place, np.array([place**2])) for place in (-2.0, -1.0, 0.0)]
    assert follow(solve, *known) is not None
    assert guesses == pytest.approx([1.0])


@pytest.mark.parametrize("known", [1, 3])
def test_steps_grow_once_there_is_a_parabola(known: int) -> None:
    tried = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        tried.append(place)
        return guess

    assert (
        follow(solve, *(Solution(0.1 * number, np.zeros(1)) for number in range(1 - known, 1)), step=0.125) is not None
    )
    ways = [1.0, 1.0, 2.0, 4.0] if known == 1 else [1.0, 2.0, 4.0, 1.0]
    assert tried == pytest.approx(0.125 * np.cumsum(ways))


def test_a_way_that_ends_before() -> None:
    """No solution beyond a half: steps are halved until they are short."""
    tried = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        tried.append(place)
        return guess if place <= 0.5 else None

    assert follow(solve, Solution(0.0, np.zeros(1))) is None
    assert 0.5 <= min(place for place in tried if place > 0.5) < 0.51


def test_one_solution_is_its_own_continuation() -> None:
    assert extrapolated([Solution(0.3, np.array([4.0]))], 1.0) == pytest.approx([4.0])


def test_the_first_guess_lies_on_the_tangent() -> None:
    guesses = list[float]()

    def solve(place: float, guess: FloatArray) -> FloatArray | None:
        guesses.append(float(guess[0]))
        return np.array([np.sin(place)])

    slope = np.array([1.0])
    assert follow(solve, Solution(0.0, np.zeros(1)), step=0.5, tangent=lambda place: slope) is not None
    assert guesses[0] == 0.5


class Curve:
    """u of p = f(u), with an unknown that follows it, 3 u."""

    weights = np.array([1.0, 0.0])

    def __init__(self, f: Callable[[float], float], slope: Callable[[float], float], u: float) -> None:
        self._f, self._slope, self.u = f, slope, np.array([u, 3.0 * u])

    def unknowns(self) -> FloatArray:
        return self.u.copy()

    def place(self, unknowns: FloatArray) -> None:
        self.u[:] = unknowns

    def linearize(self, place: float) -> Linearized | None:
        steep = self._slope(float(self.u[0]))
        if steep == 0.0:
            return None
        correction = (place - self._f(float(self.u[0]))) / steep
        return Linearized(
            np.array([correction, 3.0 * (self.u[0] + correction) - self.u[1]]), np.array([1.0, 3.0]) / steep
        )

    def add(self, increment: FloatArray) -> None:
        self.u += increment


def test_the_limit_point_of_a_parabola() -> None:
    """p = 1 - (1 - u)^2 / 2 does not grow beyond u = 1, behind which the curve is followed down to a part of it."""
    curve = Curve(lambda u: 0.9 - (1.0 - u) ** 2 / 2.0, lambda u: 1.0 - u, 0.5)
    solutions = turn(curve, 0.775, 1e-12, lambda: False)
    for place, (u, other) in solutions:
        assert place == pytest.approx(0.9 - (1.0 - u) ** 2 / 2.0, abs=1e-10)
        assert other == pytest.approx(3.0 * u, abs=1e-10)
    places = [place for place, _ in solutions]
    assert max(places) == pytest.approx(0.9, rel=3e-3)  # of solutions a step apart
    assert 0 < int(np.argmax(places)) < len(places) - 1
    assert places[-1] < 0.7 * 0.9


def test_two_limit_points_are_passed() -> None:
    """p = u^3 - u + 0.7 has its first limit point at 1.085 and 0.315 its second: the branch beyond reaches 2."""
    scale = 1.2
    curve = Curve(lambda u: (u**3 - 0.3 * u + 0.5) / scale, lambda u: (3.0 * u**2 - 0.3) / scale, -0.9)
    solutions = turn(curve, float((-(0.9**3) + 0.27 + 0.5) / scale), 1e-12, lambda: False)
    places, first = [place for place, _ in solutions], [u for _, (u, _) in solutions]
    assert places[-1] >= 1.0
    assert np.all(np.diff(first) > 0.0)
    assert np.any(np.diff(places) < 0.0)


def test_what_need_not_be_followed_ends_the_curve() -> None:
    curve = Curve(lambda u: u, lambda u: 1.0, 0.0)
    solutions = turn(curve, 0.0, 1e-12, lambda: bool(curve.u[0] > 0.05))
    assert [u > 0.05 for _, (u, _) in solutions[-2:]] == [False, True]

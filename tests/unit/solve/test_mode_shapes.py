"""Kinds and parts of modes, by shares of the energy."""

import numpy as np
import pytest

from beltdyn.solve.mode_shapes import Shapes, kind_of_mode, parts_of_mode

NONE = np.zeros((1, 0), complex)
NAMES = ["a-b", "b-a"], ["a", "b"], ["b"]


def shares(spans: list[float], pulleys: list[float], along: float, arm: float) -> Shapes:
    return Shapes(NONE, NONE, NONE, np.array([spans]), np.array([pulleys]), np.array([along]), np.array([[arm]]))


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
    shapes = shares(*given)
    assert kind_of_mode(shapes, 0) == kind
    assert parts_of_mode(shapes, 0, *NAMES) == parts

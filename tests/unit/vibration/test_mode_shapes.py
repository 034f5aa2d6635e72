"""Kinds and parts of modes, by shares of the energy."""

import numpy as np
import pytest

from beltdyn.vibration.mode_shapes import Shares

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

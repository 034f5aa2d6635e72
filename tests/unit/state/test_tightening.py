"""The search for the tension at rest: where it begins, past what it goes on, and what it says where it ends."""

import re

import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, prepare
from beltdyn.state.staying import bring_to_stand
from tests.lumped.drawn_layouts import layout_at_rest
from tests.lumped.layout_reasons import is_true

ACCURACY = 1.1e-6
"""Of the tension that is found, relative: the search ends at 1e-6."""


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(1475, id="with the estimated take-up the belt leaves a pulley"),
        pytest.param(3701, id="only with a tighter belt all pulleys are touched"),
        pytest.param(2716, id="the tension rises with the length of the belt"),
        pytest.param(3495, id="far from the first length", marks=pytest.mark.slow),
        pytest.param(4633, id="from the laid belt a fine mesh loses a pulley"),
    ],
)
def test_the_tension_is_found(seed: int) -> None:
    given = layout_at_rest(seed)
    assert bring_to_stand(prepare(Drive(**given))).tension == pytest.approx(
        given["belt"]["installed_tension"], rel=ACCURACY
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "reason"),
    [
        pytest.param(2895, r'the belt leaves "pulley 2", which it must touch', id="a pulley of small wrap"),
        pytest.param(
            3318,
            r"the tensioner force gives 5.82\d* N .* and more with other",
            id="the tension turns",
            marks=pytest.mark.slow,
        ),
        pytest.param(2182, 'does not touch "pulley 7"', id="bending holds the belt off a pulley"),
        pytest.param(2899, "its spring gives .* that tension needs", id="a balance beyond the dead centre is none"),
    ],
)
def test_the_reason_is_true(seed: int, reason: str) -> None:
    given = layout_at_rest(seed)
    with pytest.raises((ConvergenceError, ValueError)) as told:
        bring_to_stand(prepare(Drive(**given)))
    assert re.search(reason, str(told.value))
    assert is_true(given, str(told.value))

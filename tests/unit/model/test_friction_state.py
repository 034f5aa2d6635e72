"""States of friction in drive files, beside numbers."""

import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Contact
from beltdyn.model.friction_state import FRICTION_STATES


@pytest.mark.parametrize("name", FRICTION_STATES)
def test_a_state_stands_for_its_coefficient_within_its_range(name: str) -> None:
    state = FRICTION_STATES[name]
    assert Contact(friction=name).friction == state.friction
    assert state.least < state.friction < state.largest
    assert 0.0 < state.kinetic_ratio <= 1.0
    assert "ISO 5048" in state.source or "estimate" in state.source


def test_pulleys_and_belts_take_states(drive: bd.Drive) -> None:
    changed = drive.with_({"pulley[driver].friction": "wet", "belt.friction": "glazed"})
    assert changed.pulleys[0].friction == FRICTION_STATES["wet"].friction
    assert changed.belt.friction == FRICTION_STATES["glazed"].friction
    assert Contact(friction="0.3 ± 0.05").friction == 0.3


@pytest.mark.parametrize("word", ["damp", "oily"])
def test_other_words_are_answered_by_those_known(word: str) -> None:
    with pytest.raises(ModelError, match="must be a number, or one of dry, wet, glazed"):
        Contact(friction=word)

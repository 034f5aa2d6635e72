"""The search for steady running."""

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.state.steady import steady_state


def test_a_drive_without_a_machine_is_told_which_pulleys_could_have_one() -> None:
    belt = {"profile": "PK", "ribs": 6, "installed_tension": 300.0}
    pulleys = [
        {"name": name, "center": [x, 0.0], "radius": 0.05, "inertia": 0.01} for name, x in (("a", 0.0), ("b", 0.3))
    ]
    idle = Drive(belt=belt, pulley=pulleys, contact={"friction": 0.4}, simulation={"duration": 1.0})
    with pytest.raises(ModelError, match='no machine drives the belt: "a" and "b" have neither a speed nor a motor'):
        steady_state(idle)

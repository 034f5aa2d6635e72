"""Jumps of toothed belts in results, in what is told of them, and in the verdict."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Jump, jumps
from beltdyn.results.checks.machines import jumped_teeth
from beltdyn.results.incidents import JUMP, JUMPS, _jumps, jumps_in

EVENTS = {
    JUMPS[0]: np.array([0.1, 0.2, 0.25]),
    JUMPS[1]: np.array([1.0, 1.0, 0.0]),
    JUMPS[2]: np.array([-1.0, -1.0, 1.0]),
}


class Told(dict[str, Any]):
    """A result of which the attributes alone are known."""

    attrs = EVENTS


def test_jumps_are_told_in_order() -> None:
    names = ["driver", "driven"]
    found = jumps_in(Told(), names)
    assert found == (Jump(0.1, "driven", -1), Jump(0.2, "driven", -1), Jump(0.25, "driver", 1))
    alone = SimpleNamespace(attrs={name: values[:1].squeeze() for name, values in EVENTS.items()})
    assert jumps_in(alone, names) == found[:1]
    assert jumps_in(SimpleNamespace(attrs={}), names) == ()


def test_a_jump_is_a_fault() -> None:
    first, second = _jumps(Told(pulley=np.array(["driver", "driven"])))
    assert str(first) == "the belt jumped grooves of driven from 0.1 to 0.2 s, 2 times"
    assert (second.kind, second.severe) == (JUMP, True)


def test_a_jump_is_warned_of() -> None:
    pulleys = [SimpleNamespace(name=name) for name in ("driver", "driven")]
    evidence: Any = SimpleNamespace(recorded=Told(), prepared=SimpleNamespace(pulleys=pulleys))
    (finding,) = jumped_teeth(evidence)
    assert "the belt jumps 2 teeth on driven and 1 tooth on driver, first at 0.1 s." in str(finding)


def test_rest_has_no_jumps() -> None:
    result: Any = SimpleNamespace(kind="equilibrium")
    with pytest.raises(ModelError, match="jumps need results over time"):
        jumps(result)

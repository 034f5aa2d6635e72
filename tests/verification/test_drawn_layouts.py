"""Layouts drawn at random, brought to the tension that is asked for, or refused for a reason that is so.

What was found is held against the balance of the hub forces with the weight of the belt.  What was refused is held
against geometry and statics of their own (`tests/lumped/layout_reasons.py`), or against the remedy: with that the
layout comes to rest.
"""

import re
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, prepare
from beltdyn.state.installation import Rest, bring_to_rest
from beltdyn.state.staying import Standing, bring_to_stand
from tests.lumped.drawn_layouts import layout_at_rest
from tests.lumped.layout_reasons import is_true

NEAR, FAR = 1.1e-6, 0.005
"""Miss of the tension, relative, at most; and beside a jump of a mesh of equal elements."""


@pytest.mark.parametrize("seeds", [range(3, 15), pytest.param(range(15, 5003), marks=pytest.mark.slow)], ids=len)
def test_the_tension_is_reached_or_the_reason_is_true(seeds: range, measured: Callable[..., None]) -> None:
    outcomes = dict[int, str]()
    for seed in seeds:
        outcomes[seed] = outcome(layout_at_rest(seed))
    counts = Counter(one.split(":")[0] for one in outcomes.values())
    measured(**{name.replace(" ", "_"): number for name, number in counts.items()})
    assert not {seed: one for seed, one in outcomes.items() if one.startswith("wrong")}


def outcome(given: dict[str, Any]) -> str:
    """What comes of a layout: "reached", "beside a jump" of the mesh, "refused", or "wrong" with what is."""
    try:
        drive = Drive(**given)
    except BeltdynError as error:
        return "refused" if is_true(given, str(error)) else f"wrong: {error}"
    equal, graded = (
        _at_rest(given, bring) for bring in (partial(bring_to_rest, drive), partial(bring_to_stand, prepare(drive)))
    )
    if "wrong" in equal or ("refused" in (equal, graded) and equal != graded):
        return f"wrong: {equal} on equal elements, {graded} on graded ones"
    return graded if "wrong" in graded else equal


def _at_rest(given: dict[str, Any], bring: Callable[[], Rest | Standing]) -> str:
    try:
        rest = bring()
    except BeltdynError as error:
        true = is_true(given, str(error)) or _is_cured(given, str(error))
        return "refused" if true else f"wrong: {error}"
    miss = abs(rest.tension / given["belt"]["installed_tension"] - 1.0)
    if miss > FAR or (isinstance(rest, Rest) and not _is_balanced(rest)):
        return f"wrong: misses {miss:.1e}, or forces are not in balance"
    return "reached" if miss < NEAR else "beside a jump"


def _is_balanced(rest: Rest) -> bool:
    """Whether pulleys carry the belt with its weight."""
    seen, drive = rest.seen, rest.drive
    weight = drive.belt.mass_per_length * drive.belt_length * np.array(drive.gravity)
    hubs, scale = seen.hub_force[0], rest.tension
    return bool(np.all(np.abs(hubs.sum(axis=0) - weight) < 1e-6 * scale))


def _is_cured(given: dict[str, Any], reason: str) -> bool:
    """Whether a layout comes to rest with the least change that a refusal asks for."""
    harder = re.search(r"contact is too soft: .* to (\S+) N/m\^2", reason)
    tighter = re.search(r"still has (\S+) N, by its", reason)
    if harder:
        changed = given | {"contact": given["contact"] | {"stiffness": 1.5 * float(harder[1])}}
    elif tighter and float(tighter[1]) > given["belt"]["installed_tension"]:
        changed = given | {"belt": given["belt"] | {"installed_tension": 1.02 * float(tighter[1])}}
    else:
        return False
    try:
        bring_to_rest(Drive(**changed))
    except BeltdynError:
        return False
    return True

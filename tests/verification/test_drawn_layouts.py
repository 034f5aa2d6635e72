"""Layouts drawn at random, brought to the tension that is asked for, or refused for a reason that is so.

What was found is held against the balance of the hub forces with the weight of the belt.  What was refused is held
against geometry and statics of their own (`tests/lumped/layout_reasons.py`), or against the remedy: with that the
layout comes to rest.
"""

import re
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, prepare
from beltdyn.state import staying
from beltdyn.state.installation import Rest, bring_to_rest
from beltdyn.state.staying import Standing
from tests.lumped.drawn_layouts import layout_at_rest
from tests.lumped.layout_reasons import is_true

NEAR, FAR = 1.1e-6, 0.005
"""Miss of the tension, relative, at most; and beside a jump of a mesh of equal elements."""
UNVERIFIED = 0.002
"""Share of layouts, at most, that are refused for a reason that neither statics nor its remedy confirms."""
SLOW = pytest.mark.slow
_MOST_REMEDIES = 3

Bring = Callable[[Drive], Rest | Standing]


def bring_to_stand(drive: Drive) -> Standing:
    return staying.bring_to_stand(prepare(drive))


@pytest.mark.parametrize(
    ("bring", "seeds"),
    [
        (bring_to_stand, range(3, 15)),
        pytest.param(bring_to_rest, range(3, 15), marks=SLOW),
        *(pytest.param(bring_to_stand, range(k, min(k + 500, 5003)), marks=SLOW) for k in range(15, 5003, 500)),
        *(pytest.param(bring_to_rest, range(k, min(k + 1000, 5003), 10), marks=SLOW) for k in range(15, 5003, 1000)),
    ],
    ids=lambda entry: f"{entry[0]}-{entry[-1]}" if isinstance(entry, range) else None,
)
def test_the_tension_is_reached_or_the_reason_is_true(
    bring: Bring, seeds: range, measured: Callable[..., None]
) -> None:
    outcomes = {seed: outcome(layout_at_rest(seed), bring) for seed in seeds}
    counts = Counter(one.split(":")[0] for one in outcomes.values())
    measured(**{name.replace(" ", "_"): number for name, number in counts.items()})
    assert not {seed: one for seed, one in outcomes.items() if one.startswith("wrong")}
    unverified = {seed: one for seed, one in outcomes.items() if one.startswith("unverified")}
    if bring is bring_to_rest:  # what neither mesh confirms counts among all layouts, on the staying mesh
        unverified = {seed: unverified[seed] for seed in unverified if _stands(seed)}
    assert len(unverified) <= UNVERIFIED * len(seeds), unverified


def _stands(seed: int) -> bool:
    """Whether a layout is reached, or its reason confirmed, on the staying mesh."""
    return not outcome(layout_at_rest(seed), bring_to_stand).startswith("unverified")


def outcome(given: dict[str, Any], bring: Bring) -> str:
    """What comes of a layout: "reached", "beside a jump" of the mesh, "refused", or "unverified" or "wrong" and why."""
    try:
        rest = bring(Drive(**given))
    except BeltdynError as error:
        true = is_true(given, str(error)) or _is_cured(given, str(error), bring)
        return "refused" if true else f"unverified: {error}"
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


def _is_cured(given: dict[str, Any], reason: str, bring: Bring) -> bool:
    """Whether a layout comes to rest with the least changes that refusals ask for, one after the other."""
    for _ in range(_MOST_REMEDIES):
        changed = _remedied(given, reason)
        if changed is None:
            return False
        try:
            bring(Drive(**changed))
        except BeltdynError as error:
            given, reason = changed, str(error)
        else:
            return True
    return False


def _remedied(given: dict[str, Any], reason: str) -> dict[str, Any] | None:
    """A layout with the least change that a refusal asks for; None without a number to follow."""
    harder = re.search(r"contact is too soft: .* to (\S+) N/m\^2", reason)
    tighter = re.search(r"still has (\S+) N, by its", reason)
    lower = re.search(r"at (\S+) N the belt leaves|the tensioner force gives (\S+) N at any belt length", reason)
    finer = re.search(r"with (\d+) elements: at rest the tension jumps .* Increase belt.elements", reason)
    stronger = re.search(r"Give it preload = (\S+) N", reason)
    if stronger:
        return given | {"tensioner": [given["tensioner"][0] | {"preload": float(stronger[1])}]}
    if harder:
        return given | {"contact": given["contact"] | {"stiffness": 1.5 * float(harder[1])}}
    if tighter and float(tighter[1]) > given["belt"]["installed_tension"]:
        return given | {"belt": given["belt"] | {"installed_tension": 1.02 * float(tighter[1])}}
    if lower:
        limit = 0.98 * float(lower[1]) if lower[1] else float(lower[2])
        return given | {"belt": given["belt"] | {"installed_tension": limit}}
    if "omit contact.stiffness" in reason and "stiffness" in given["contact"]:
        return given | {"contact": {key: value for key, value in given["contact"].items() if key != "stiffness"}}
    if finer:
        return given | {"belt": given["belt"] | {"elements": 2 * int(finer[1])}}
    return None

"""Closed forms within and outside their ranges: a number, or a refusal that names what is outside."""

import inspect
import warnings
from collections.abc import Callable, Iterator
from random import Random
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.parts.ranges import require_above, require_at_least, require_at_most
from beltdyn.stretch import Green, Linear
from beltdyn.theory import creep, nip, rating, span, static_tension
from beltdyn.theory.creep import SlidingBelt
from beltdyn.theory.rating import RatingLaw
from beltdyn.theory.static_tension import Section

MODULES = creep, nip, rating, span, static_tension
TRIALS = 40
SLOW = "fastest_flutter", "creeping_arc"
"""Thousands of waves of `flutter_at`, and an integration: a few trials."""


def closed_forms() -> Iterator[Callable[..., Any]]:
    """All public functions of closed forms."""
    for module in MODULES:
        for name, function in vars(module).items():
            if inspect.isfunction(function) and function.__module__ == module.__name__ and name[0] != "_":
                yield function


def drawn(random: Random, parameter: inspect.Parameter) -> Any:
    """An argument of a closed form: mostly of a usual size, and now and then none that a belt has."""

    def number() -> float:
        if random.random() < 0.15:
            return random.choice((0.0, -1.0, 1.0, -1e-9, 1e9))
        return float(10.0 ** random.uniform(-4.0, 4.0))

    kind = str(parameter.annotation)
    if "StretchParameters" in kind:
        return random.choice((Green, Linear))(10.0 ** random.uniform(2.0, 6.0))
    if "Section" in kind:
        return Section(Linear(1e5), abs(number()) + 1.0, abs(number()))
    if "RatingLaw" in kind:
        return RatingLaw(1379.0, 79.65, 0.1619, 160.8)
    if "SlidingBelt" in kind:
        return SlidingBelt(*(number() for _ in range(6)))
    if "ndarray" in kind or "FloatArray" in kind or "ArrayLike" in kind:
        return np.sort([number(), number()])
    if "tuple" in kind:
        return number(), number()
    return round(number()) if "int" in kind else number()


def _numbers(found: Any) -> Iterator[Any]:
    """The numbers of an answer, of named tuples too; None of what does not exist."""
    for one in found if isinstance(found, tuple) else (found,):
        yield from _numbers(one) if isinstance(one, tuple) else () if one is None else (one,)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("function", list(closed_forms()), ids=lambda function: function.__name__)
def test_closed_forms_give_numbers_or_refuse_by_name(function: Callable[..., Any]) -> None:
    parameters = inspect.signature(function).parameters
    random, refusals = Random(function.__name__), list[str]()
    trials = 3 if function.__name__ in SLOW else TRIALS
    for _ in range(trials):
        given = {name: drawn(random, one) for name, one in parameters.items() if one.kind is not one.VAR_POSITIONAL}
        more = [drawn(random, one) for one in parameters.values() if one.kind is one.VAR_POSITIONAL for _ in "ab"]
        try:
            found = function(*more, **given)
        except ModelError as error:
            refusals.append(str(error))
            continue
        assert all(np.all(np.isfinite(one)) for one in _numbers(found)), given
    assert all(any(word in one for word in ("=", "tension", "stiffness")) for one in refusals)
    assert len(refusals) < trials or function.__name__ in (*SLOW, "static_tension")


def test_ranges() -> None:
    require_above(tension=1e-300, radii=np.array([1.0, 2.0]))
    require_at_least(1.0, ratio=1.0)
    require_at_most(1.0, ratio=1.0)
    with pytest.raises(ModelError, match=r"tension = 0 is outside the range of this closed form: .* above 0"):
        require_above(length=1.0, tension=0.0)
    with pytest.raises(ModelError, match="radii = -1 is outside"):
        require_at_least(radii=np.array([1.0, -1.0]))
    for refuse in (require_above, require_at_least):
        for value in (np.nan, np.inf):
            with pytest.raises(ModelError):
                refuse(value=value)
    with pytest.raises(ModelError, match="at most 2"), warnings.catch_warnings():
        require_at_most(2.0, ratio=3.0)

"""Instants with a unit, on the command line and in functions."""

import re
from inspect import signature

import pytest

from beltdyn.analyses import ANALYSES
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.state.steady import instant_given
from validation.published import two_pulley

_DIMENSION = re.compile(r"[ ,](?:s|m|N|rad/s)[;:.,]")
"""A unit of SI in the text of a parameter."""


@pytest.fixture
def drive() -> Drive:
    return two_pulley(10)


@pytest.mark.parametrize(("at", "instant"), [("20 ms", 0.02), ("0.5 s", 0.5), (0.25, 0.25)])
def test_an_instant_may_have_a_unit(drive: Drive, at: float | str, instant: float) -> None:
    assert instant_given(drive, at) == pytest.approx(instant, rel=1e-15)


def test_the_end_of_the_simulation_is_the_usual_instant(drive: Drive) -> None:
    assert instant_given(drive, None) == drive.simulation.end


def test_an_instant_is_a_time(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"at = '1 m' must be in units of s"):
        instant_given(drive, "1 m")


@pytest.mark.parametrize("name", sorted(ANALYSES))
def test_options_with_a_dimension_take_a_unit(name: str) -> None:
    """A number alone is in SI units; a reader who writes the unit is not refused."""
    function = ANALYSES[name].function
    parameters = (function.__doc__ or "").partition("Parameters\n")[2].partition("Returns\n")[0]
    texts = dict(re.findall(r"^ {4}(\w+)\n((?: {8}.*\n)+)", parameters, flags=re.MULTILINE))
    for key, one in signature(function, eval_str=True).parameters.items():
        if float in (one.annotation, *getattr(one.annotation, "__args__", ())) and _DIMENSION.search(texts[key]):
            assert str in getattr(one.annotation, "__args__", ()), key

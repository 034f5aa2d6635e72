"""Results of analyses as named numbers."""

import re

import numpy as np
import pytest
from numpy.typing import ArrayLike

from beltdyn.designs.named_results import names_in, names_of
from beltdyn.designs.point_work import columns_of, require_reductions
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run, Variable, build_result, summarize
from beltdyn.state.equilibrium import equilibrium


def test_a_variable_gives_a_number_for_each_name(drive: Drive) -> None:
    rest = equilibrium(drive)
    found = columns_of(rest, ["hub_load", "tension", "span_tension[driven-driver]"])
    assert list(found.values) == ["hub_load[driver]", "hub_load[driven]", "tension", "span_tension[driven-driver]"]
    assert found.values["hub_load[driven]"] == float(rest.dataset["hub_load"][1])
    assert found.units["tension"] == "N"
    assert not found.missing


def test_reductions_go_over_time_and_over_what_has_no_names(drive: Drive, run: Run) -> None:
    found = columns_of(run, ["largest(span_tension)", "swing(span_tension[driver-driven])", "last(pulley_speed)"])
    tension = run.dataset["span_tension"].values
    assert found.values["largest(span_tension[driver-driven])"] == tension[:, 0].max()
    assert found.values["swing(span_tension[driver-driven])"] == np.ptp(tension[:, 0])
    assert found.values["last(pulley_speed[driven])"] == float(run.dataset["pulley_speed"][-1, 1])
    assert found.units["largest(span_tension[driver-driven])"] == "N"


def test_plain_names_of_a_run_are_those_of_its_summary(run: Run) -> None:
    found = columns_of(run, ["pulley_slip[driven]", "efficiency"])
    assert found.values["pulley_slip[driven]"] == summarize(run).pulleys[1].slip


def test_all_takes_every_single_number(drive: Drive) -> None:
    variables: dict[str, tuple[Variable, ArrayLike]] = {
        "one": (Variable((), "m", "One"), 1.5),
        "some": (Variable(("mode",), "Hz", "Some"), [2.0, 3.0]),
        "word": (Variable((), "1", "Word", "str"), "no"),
        "field": (Variable(("node",), "m", "Field"), [1.0, 2.0]),
    }
    result = build_result("modes", drive, variables, {"mode": (Variable(("mode",), "1", "Mode"), [1, 2])})
    assert columns_of(result, ["all"]).values == {"one": 1.5, "some[1]": 2.0, "some[2]": 3.0}
    assert columns_of(result, ["largest(field)"]).values == {"largest(field)": 2.0}


def test_what_there_is_not_is_told(drive: Drive) -> None:
    found = columns_of(equilibrium(drive), ["hub_laod", "tension"])
    assert found.values.keys() == {"tension"}
    assert found.missing == "results = 'hub_laod' is not a numerical result. Did you mean \"hub_load\"?"


@pytest.mark.parametrize(
    ("result", "needed"),
    [
        ("cord_life", "[belt.cord_fatigue]"),
        ("rib_life", "passages in [belt.rib_fatigue]"),
        ("utilization", "SPZ or PK"),
    ],
)
def test_what_the_belt_has_no_data_for_says_which(result: str, needed: str, drive: Drive) -> None:
    with pytest.raises(ModelError, match=re.escape(needed)):
        names_in(names_of(drive), result)


@pytest.mark.parametrize("text", ["greatest(span_tension)", "largest(span_tension", "largest()"])
def test_reductions_that_are_none_are_told(text: str) -> None:
    with pytest.raises(ModelError, match="is not a result"):
        require_reductions([text])

"""Results of analyses as named numbers: those that a point has, may have, and cannot have."""

import re

import numpy as np
import pytest
from numpy.typing import ArrayLike

from beltdyn.designs.named_results import names_in, names_of
from beltdyn.designs.study_columns import columns_of, request_of, require_possible
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Result, Run, Variable, build_result, summarize
from beltdyn.state.equilibrium import equilibrium


def test_a_variable_gives_a_number_for_each_name(drive: Drive) -> None:
    rest = equilibrium(drive)
    found = columns_of(rest, ["hub_load", "tension", "span_tension[driven-driver]"])
    assert list(found.values) == ["hub_load[driver]", "hub_load[driven]", "tension", "span_tension[driven-driver]"]
    assert found.values["hub_load[driven]"] == float(rest.dataset["hub_load"][1])
    assert found.units["tension"] == "N"
    assert not found.unknown
    assert not found.absent


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


def test_results_at_rest_are_those_that_are_asked_for(drive: Drive) -> None:
    running, resting = set(names_of(drive)), set(names_of(drive, at_rest=True))
    assert {"efficiency", "hub_load[driven]"} <= running
    assert {"tension", "belt_length", "hub_load[driven]"} <= resting
    assert "efficiency" not in resting
    assert "belt_length" not in running


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
    assert found.unknown == "results = 'hub_laod' is not a numerical result. Did you mean \"hub_load\"?"


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
        request_of(text)
    with pytest.raises(ModelError, match='Did you mean "largest"'):
        request_of("larges(span_tension)")


def of_axis(drive: Drive, axis: str) -> Result:
    """Results along an axis of numbers, and along names."""
    along, coordinate = Variable((axis, "pulley"), "1", "Some"), Variable((axis,), "1", "Axis")
    names = (Variable(("pulley",), "1", "Pulley", "str"), ["a", "b"])
    values, numbers = [[1.0, 2.0], [3.0, np.nan]], [0.1, 0.25]
    return build_result("traction", drive, {"some": (along, values)}, {axis: (coordinate, numbers), "pulley": names})


def test_numbers_that_the_analysis_chooses_are_reduced(drive: Drive) -> None:
    """They differ from point to point, and would make columns that are empty at most points."""
    result = of_axis(drive, "slip")
    assert columns_of(result, ["all"]).values == {}
    assert columns_of(result, ["largest(some)"]).values == {"largest(some[a])": 3.0, "largest(some[b])": 2.0}
    assert columns_of(result, ["some"]).unknown == (
        "results = 'some' varies along slip. Reduce it, such as largest(some)."
    )


def test_numbers_that_the_user_chose_are_parts_of_names(drive: Drive) -> None:
    found = columns_of(of_axis(drive, "slip"), ["all"], axes=["slip"]).values
    assert list(found) == ["some[0.1,a]", "some[0.1,b]", "some[0.25,a]", "some[0.25,b]"]


def test_names_are_those_that_files_take(drive: Drive, run: Run) -> None:
    """A slash in a name of a variable would be a group of a file."""
    found = columns_of(run, ["largest(all)"]).values
    assert not [name for name in found if "/" in name]
    (column,) = columns_of(run, ["largest(nodal_coordinates[dr_x/dx])"]).values
    assert column == "largest(nodal_coordinates[dr_x per dx])"


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ("tooth_load", "needs data that the belt does not have. Give the profile of a toothed belt"),
        ("tensioner_position", "does not exist for this drive."),
        ("last(tensioner_position)", "does not exist for this drive."),
    ],
)
def test_what_other_drives_have_is_absent(run: Run, wanted: str, said: str) -> None:
    found = columns_of(run, [wanted, "efficiency"])
    assert list(found.values) == ["efficiency"]
    assert said in found.absent[0]
    assert not found.unknown


@pytest.mark.parametrize("has_points", [True, False])
def test_other_drives_have_more_at_operating_points(drive: Drive, has_points: bool) -> None:
    """Results of operating points, which note along which axes, may have loads of teeth; others never have them."""
    result = of_axis(drive, "slip")
    result.dataset.attrs |= {"axes": "slip"} if has_points else {}
    found = columns_of(result, ["tooth_load"])
    assert bool(found.absent) is has_points
    assert bool(found.unknown) is not has_points


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ("cord_life", "is not a numerical result"),  # of steady running alone
        ("slip_safty", 'Did you mean "slip_safety"?'),
        ("hub_load[drivn]", 'Did you mean "hub_load[driven]"?'),
        ("last(span_tensoin)", 'Did you mean "span_tension"?'),
        ("last(wall)", "is not a numerical result"),
    ],
)
def test_what_no_run_has_is_unknown(run: Run, wanted: str, said: str) -> None:
    found = columns_of(run, [wanted])
    assert said in found.unknown
    assert not found.absent


def test_what_has_nothing_to_reduce_says_so(drive: Drive) -> None:
    found = columns_of(equilibrium(drive), ["largest(hub_load)"])
    assert found.unknown == "results = 'largest(hub_load)' has nothing to reduce. Write hub_load."


def test_data_that_no_point_can_have_are_refused_before_anything_is_computed(drive: Drive) -> None:
    with pytest.raises(ModelError, match="Give the profile of a toothed belt"):
        require_possible(["largest_tension", "tooth_load"], drive, ["pulley[driven].radius"])
    require_possible(["tooth_load"], drive, ["belt.profile"])

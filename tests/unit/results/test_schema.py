"""The table of variables: units, dimensions and names that belong together."""

import numpy as np
import pytest

from beltdyn.results.schema import (
    AUXILIARY_COORDINATES,
    COORDINATES,
    DERIVED,
    FILTERED,
    PASS_BAND,
    RECORDED,
    STOP_BAND,
    TIMES,
    VARIABLES,
    Variable,
)


def test_names_have_no_unit_and_numbers_have_one() -> None:
    assert Variable(("pulley",), "", "Pulley", "str").attributes == {"long_name": "Pulley"}
    assert Variable(("time",), "N", "Tension").attributes == {"units": "N", "long_name": "Tension"}


@pytest.mark.parametrize("name", VARIABLES)
def test_every_variable_says_what_it_is(name: str) -> None:
    variable = VARIABLES[name]
    assert variable.long_name[0].isupper()
    assert variable.units
    assert np.dtype(variable.dtype).kind in "fi"
    assert set(variable.dims) <= {dim for coordinate in COORDINATES.values() for dim in coordinate.dims}


@pytest.mark.parametrize("name", FILTERED)
def test_what_is_filtered_is_the_same_quantity_at_other_instants(name: str) -> None:
    plain, filtered = VARIABLES[name], VARIABLES[f"filtered_{name}"]
    assert (filtered.units, filtered.long_name, filtered.dims[1:]) == (plain.units, plain.long_name, plain.dims[1:])
    assert (plain.dims[0], filtered.dims[0]) == ("time", "filtered_time")


def test_what_the_filter_leaves_does_not_fold_into_what_it_keeps() -> None:
    """A frequency f above half of the rate shows as 1 - f (Nyquist)."""
    assert 0.0 < PASS_BAND < 0.5 < STOP_BAND
    assert pytest.approx(PASS_BAND, rel=1e-15) == 1.0 - STOP_BAND


def test_times_come_last_and_parts_are_not_recorded() -> None:
    """A file that was cut amid an append holds no instant without its outputs."""
    assert tuple(RECORDED)[-len(TIMES) :] == TIMES
    assert TIMES[-1] == "time"
    assert RECORDED.keys() == (VARIABLES.keys() - set(DERIVED)) | set(TIMES)
    assert {COORDINATES[name].dims for name in AUXILIARY_COORDINATES.values()} == {
        (dim,) for dim in AUXILIARY_COORDINATES
    }

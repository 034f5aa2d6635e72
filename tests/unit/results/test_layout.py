"""Dimensions, coordinates and variables of what is recorded, with tensioners and without."""

from dataclasses import replace

import numpy as np
import pytest

from beltdyn.results import Layout
from beltdyn.results.friction_work import ARC_PARTS
from beltdyn.results.schema import COORDINATES, RECORDED, TIMES


@pytest.fixture
def tensioned(layout: Layout) -> Layout:
    return replace(layout, tensioners=("idler",))


def test_sizes_are_those_of_the_drive(layout: Layout) -> None:
    assert (layout.nodes, layout.elements, layout.contact_points) == (20, 20, 100)
    assert layout.sizes["arc_part"] == ARC_PARTS
    assert {name: layout.sizes[name] for name in ("pulley", "span", "axis")} == {"pulley": 2, "span": 2, "axis": 2}
    assert layout.sizes["node"] == 20


def test_only_a_drive_with_tensioners_has_what_lies_along_them(layout: Layout, tensioned: Layout) -> None:
    assert "tensioner" not in layout.sizes
    assert "tensioner" not in layout.coordinates
    assert tensioned.sizes == layout.sizes | {"tensioner": 1}
    assert tensioned.coordinates["tensioner"].tolist() == ["idler"]
    more = tensioned.recorded.keys() - layout.recorded.keys()
    assert more == {name for name, variable in RECORDED.items() if "tensioner" in variable.dims}


def test_only_a_belt_with_single_teeth_has_what_lies_along_them(tensioned: Layout) -> None:
    toothed = replace(tensioned, tooth_coordinate=(0.0, 8e-3))
    assert toothed.sizes == tensioned.sizes | {"tooth": 2}
    assert toothed.coordinates["tooth_coordinate"].tolist() == [0.0, 8e-3]
    assert toothed.recorded.keys() - tensioned.recorded.keys() == {"tooth_force"}
    of_others = {name for name, one in RECORDED.items() if {"carriage", "nip", "roll"} & set(one.dims)}
    assert toothed.recorded.keys() == RECORDED.keys() - of_others


def test_every_dimension_has_the_size_of_its_coordinate(tensioned: Layout) -> None:
    for name, values in tensioned.coordinates.items():
        (dimension,) = COORDINATES[name].dims
        assert len(values) == tensioned.sizes[dimension], name
        assert COORDINATES[name].dtype == "str" or values.dtype == np.dtype(COORDINATES[name].dtype)


def test_every_variable_grows_over_a_time_and_has_a_shape(tensioned: Layout) -> None:
    for name, variable in tensioned.recorded.items():
        assert variable.dims[0] in TIMES, name
        shape = tensioned.shape(variable, 7)
        assert shape == (7, *(tensioned.sizes[dim] for dim in variable.dims[1:]))
        assert 0 not in shape

"""Tables and facts of results that are no runs, and of teeth; others of runs are seen on the screen."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from beltdyn.model import Drive, example
from beltdyn.results import Result, Run, summarize, tooth_loads
from beltdyn.results.schema import VARIOUS
from beltdyn.show.sheet import _column, _pulleys, sheet
from beltdyn.show.tables import Facts, Table
from beltdyn.state.steady import steady_state


def test_numbers_are_facts_and_names_make_tables(drive: Drive) -> None:
    dataset = xr.Dataset(
        {
            "tension": ((), 45.0, {"units": "N", "long_name": "Mean tension"}),
            "wrap": ("pulley", [math.pi, 0.5 * math.pi], {"units": "rad", "long_name": "Wrap angle, at rest"}),
            "unnamed": ("other", np.zeros(3), {"units": "N", "long_name": "Of nothing with a name"}),
        },
        {"pulley": ("pulley", ["a", "b"], {"long_name": "Pulley"})},
        {"kind": "equilibrium", "title": "Belt drive at rest"},
    )
    found = sheet(Result(dataset, drive))
    assert found.title == "Belt drive at rest"
    assert found.parts == (
        Facts((("Mean tension", "45.000 N"),)),
        Table("", ("Pulley", "Wrap angle\n°"), (("a", "180.00"), ("b", "90.00"))),
    )


def test_modes_are_columns_over_the_places(drive: Drive) -> None:
    dataset = xr.Dataset(
        {
            "mode_frequency": (
                ("place", "mode"),
                [[10.0, 62.5], [12.25, 60.0]],
                {"units": "Hz", "long_name": "Natural frequencies, from the lowest on"},
            ),
            "mode_part": (
                ("place", "mode"),
                [["belt", "carriage"], ["carriage", "belt"]],
                {"units": "1", "long_name": "Part"},
            ),
        },
        {
            "place": ("place", [-0.1, 0.1], {"units": "m", "long_name": "Way"}),
            "mode": ("mode", [1, 2], {"units": "1", "long_name": "Mode"}),
        },
        {"kind": "campbell", "title": "Linear axis over its stroke", "axes": "place", "columns_by": "mode"},
    )
    assert sheet(Result(dataset, drive)).parts == (
        Table(
            "Natural frequencies, Hz",
            ("Way\nm", "Mode 1", "Mode 2"),
            (("-0.10000", "10.000", "62.500"), ("0.10000", "12.250", "60.000")),
        ),
        Table(
            "Part", ("Way\nm", "Mode 1", "Mode 2"), (("-0.10000", "belt", "carriage"), ("0.10000", "carriage", "belt"))
        ),
    )


def test_a_belt_with_teeth_has_their_loads() -> None:
    run = steady_state(example("timing_drive"))
    (found,) = (part for part in sheet(run).parts if isinstance(part, Table) and part.title == "Teeth")
    assert [row[0] for row in found.rows] == ["crankshaft", "camshaft", "water pump"]
    for row, one in zip(found.rows, tooth_loads(run), strict=True):
        shown = [float(cell) for cell in row[1:]]
        assert shown == pytest.approx([one.in_mesh, one.largest, one.allowed, one.jump_margin], rel=0.02)


def test_a_number_that_is_none_is_a_dash() -> None:
    """In columns of one unit, and of the units of their rows."""
    values = xr.DataArray([1.5, np.nan], dims="requirement", attrs={"units": VARIOUS})
    assert _column(values) == ["1.5", "–"]
    assert "nan" not in " ".join(_column(values.assign_attrs(units="N")))


@pytest.mark.parametrize(
    ("ratio", "allowed", "words"),
    [
        (1.25, 43.4, ("1.25", "43")),
        (np.inf, 43.4, (">99", "43")),
        (2.0, np.inf, ("2.00", ">99")),
        (np.nan, 3.0, ("–", "–")),
        (1.0, 1.0, ("–", "–")),
    ],
)
def test_tension_ratios_are_short(ratio: float, allowed: float, words: tuple[str, str], run: Run) -> None:
    """A span without tension has an infinite one."""
    summary = summarize(run)
    pulley = replace(summary.pulleys[1], tension_ratio=ratio, allowed_tension_ratio=allowed)
    table = _pulleys("", replace(summary, pulleys=(pulley,)), np.zeros(1, dtype=bool))
    assert table.rows[0][8:10] == words

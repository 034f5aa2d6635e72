"""The tables of a drive sheet."""

import re

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import Drive, example
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Table, as_text

_NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def test_tables_say_what_suppliers_say() -> None:
    result = bd.sheet(example("alternator_drive"), points=3)
    titles = [part.title for part in sheet(result).parts if isinstance(part, Table)]
    assert titles == [
        *("Pulleys as supplied", "Pulleys", "Tensioner of tensioner", "Belts of standard length", "Operating points"),
        *("Tensions of spans", "Hub loads", "Spans at rest"),
        "First modes, at the largest power, with sliding tensioners",
    ]
    text = as_text(sheet(result))
    assert "mm of path per degree" in text
    assert f"{float(result.dataset.state_tension.sel(state='mean')):.1f}" in text


def test_spans_have_what_alignment_allows_and_angles_if_pulleys_are_out_of_line() -> None:
    drive = example("alternator_drive")
    aligned, skewed = (
        next(part for part in sheet(bd.sheet(one, points=2)).parts if isinstance(part, Table) and "Spans" in part.title)
        for one in (drive, drive.with_({"pulley[alternator].tilt": ["0 ± 0.1 deg", "0.2 deg"]}))
    )
    words = [" ".join(heading.split()) for heading in skewed.headings]
    assert words[2:7] == ["tension mean N", "min N", "max N", "at start N", "at end N"]
    assert words[7:10] == ["deflection mm", "at rest Hz", "at rest N"]
    assert words[10:] == ["fleeting leaving", "angle reaching", "worst, with tolerances", "offset allowed mm"]
    assert [len(row) for row in aligned.rows] == [11] * 3
    less = [float(row[-1]) < float(other[-1]) for row, other in zip(skewed.rows, aligned.rows, strict=True)]
    assert less == [False, True, True]


def tables_of(drive: Drive) -> list[Table]:
    return [part for part in sheet(bd.sheet(drive)).parts if isinstance(part, Table)]


@pytest.mark.parametrize("name", ["alternator_drive", "conveyor_1km"])
def test_a_cell_has_one_number(name: str) -> None:
    """Such as "881 (1058) 26° 2.70", which is four; names may have any."""
    for table in tables_of(example(name)):
        for row in table.rows:
            assert [cell for cell in row[1:] if len(_NUMBER.findall(cell)) > 1] == [], table.title


def test_several_operating_points_have_a_table_of_each_quantity() -> None:
    """With a column for each pulley, and the numbers of the dataset."""
    powers = {"city": 300.0, "hill": 900.0}
    duty = [{"name": name, "share": 0.5, "power": {"alternator": power}} for name, power in powers.items()]
    result = bd.sheet(example("alternator_drive").replace(duty=duty), points=2)
    tables = {part.title: part for part in sheet(result).parts if isinstance(part, Table)}
    loads = tables["Hub load, N"]
    assert loads.headings[1:] == tuple(result.dataset["pulley"].values)
    assert [row[0] for row in loads.rows] == ["city", "hill"]
    shown = np.array([[float(cell) for cell in row[1:]] for row in loads.rows])
    np.testing.assert_allclose(shown, result.dataset["hub_load"].values, atol=0.5)
    assert {"Peak hub load, N", "Direction of the hub load", "Slip safety", "Largest span tension, N"} < tables.keys()

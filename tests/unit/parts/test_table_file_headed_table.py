"""Tables with headings: columns, units, and what is wrong with them."""

from pathlib import Path

import pytest

from beltdyn.errors import ModelError
from beltdyn.parts.table_file import read_headed


def written(folder: Path, text: str) -> Path:
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_columns_and_units(tmp_path: Path) -> None:
    speed, count = read_headed("table", written(tmp_path, "# of today\ncrank speed [rpm], count\n30, 1\n\n60, 2\n"))
    assert (speed.what, speed.unit, count.what, count.unit) == ("crank speed", "rpm", "count", "")
    assert speed.values("rad/s") == pytest.approx([3.141592653589793, 6.283185307179586])
    assert count.values("") == [1.0, 2.0]


def test_a_table_of_a_logger(tmp_path: Path) -> None:
    """Lines above the headings, a row of units, decimal commas; a heading's own unit, and names with brackets, stay."""
    text = "Logger 7\nStart;12:30\ncrank speed;slip[a];force [kN]\n[rpm];%;N\n30,5;1,5;2\n60;2;3\n"
    speed, slip, force = read_headed("table", written(tmp_path, text))
    assert [(one.what, one.unit) for one in (speed, slip, force)] == [
        ("crank speed", "rpm"),
        ("slip[a]", "%"),
        ("force", "kN"),
    ]
    assert slip.values("") == pytest.approx([0.015, 0.02])
    assert force.values("N") == pytest.approx([2000.0, 3000.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a [N]\n", "has no rows"),
        ("a, b\n1\n", "line 2: 1 cells but 2 headings"),
        ("a [N]\nx\n", 'line 2: "x"'),
        ("a [m]\n1\n", "must be in units of"),
        ("a [N]\nnan\n", '"nan" below "a" must be a number'),
    ],
)
def test_what_is_wrong(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        read_headed("table", written(tmp_path, text))[0].values("N")


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"measured = .*nowhere\.csv"):
        read_headed("measured", tmp_path / "nowhere.csv")

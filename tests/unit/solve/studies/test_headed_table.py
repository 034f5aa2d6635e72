"""Tables with headings: columns, units, and what is wrong with them."""

from pathlib import Path

import pytest

from beltdyn.errors import ModelError
from beltdyn.solve.studies.headed_table import read_headed


def written(folder: Path, text: str) -> Path:
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_columns_and_units(tmp_path: Path) -> None:
    speed, count = read_headed("table", written(tmp_path, "# of today\ncrank speed [rpm], count\n30, 1\n\n60, 2\n"))
    assert (speed.what, speed.unit, count.what, count.unit) == ("crank speed", "rpm", "count", "")
    assert speed.values("rad/s") == pytest.approx([3.141592653589793, 6.283185307179586])
    assert count.values("") == [1.0, 2.0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a [N]\n", "has no rows"),
        ("a, b\n1\n", "line 2: 1 cells, and there are 2 headings"),
        ("a [N]\nx\n", 'line 2: "x"'),
        ("a [m]\n1\n", "must be in units of"),
        ("a [N]\nnan\n", '"nan" must be a number'),
    ],
)
def test_what_is_wrong(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        read_headed("table", written(tmp_path, text))[0].values("N")


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"measured = .*nowhere\.csv"):
        read_headed("measured", tmp_path / "nowhere.csv")

"""Tables of pulleys as drive files."""

import tomllib

import pytest

import beltdyn as bd
from beltdyn.app.pulley_table import EXAMPLE, drive_from_table


def test_the_example_is_a_drive() -> None:
    drive = bd.loads(drive_from_table(EXAMPLE))
    assert [one.name for one in drive.pulleys] == ["crank", "idler", "alternator"]
    assert [one.side for one in drive.pulleys] == ["inside", "outside", "inside"]
    assert drive.path.centers.tolist() == [[0.0, 0.0], [0.07, 0.14], [0.0, 0.27]]
    assert drive.pulleys[0].prescribed
    assert drive.pulleys[2].radius == pytest.approx(0.028)


def test_cells_are_pasted_from_a_spreadsheet_with_decimal_commas_and_a_row_of_units() -> None:
    head = "Pulley\tX\tY\tRadius\tSpeed\tTorque\tmaker\n\tin\tmm\tmm\trpm\tNm\t\n"
    text = f"{head}motor\t0\t0\t40,5\t1450\t\tA\nfan\t10\t0\t50\t\t-8\tB\n"
    data = tomllib.loads(drive_from_table(text))
    assert [one["center"] for one in data["pulley"]] == [["0 in", "0 mm"], ["10 in", "0 mm"]]
    assert data["pulley"][0]["radius"] == "40.5 mm"
    assert data["pulley"][0]["speed"]["value"] == "1450 rpm"
    assert data["pulley"][1]["torque"] == {"kind": "constant", "value": "-8 Nm"}
    assert bd.loads(drive_from_table(text)).path.centers[1].tolist() == pytest.approx([0.254, 0.0])


def test_without_headings_the_order_of_columns_is_known() -> None:
    drive = bd.loads(drive_from_table("A; 0; 0; 100\nB; 300; 0; 120,5\n"))
    assert [2e3 * one.radius for one in drive.pulleys] == pytest.approx([100.0, 120.5])


def test_as_few_pulleys_as_possible_are_on_the_back() -> None:
    apart = "name, x, y, diameter\ncrank, 0, 0, 160\nidler, 75, 140, 70\nalternator, 0, 270, 56\n"
    assert [one.side for one in bd.loads(drive_from_table(apart)).pulleys] == ["inside"] * 3
    inmost = "name, x, y, diameter\na, 0, 0, 100\nb, 300, 0, 100\nd, 110, 110, 50\nc, 0, 300, 100\n"
    assert [one.side for one in bd.loads(drive_from_table(inmost)).pulleys] == [*["inside"] * 2, "outside", "inside"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the table is empty"),
        ("a, b\n1, 2\n", "has no column x and y and diameter"),
        ("name, x, y, d\na, 0, 0,\n", "line 2 of the table has no diameter"),
        ("name, x, y, d\na, 0, zero, 5\n", 'line 2 of the table: y = "zero" must be a number in m'),
        ("name, x [parsnips], y, d\na, 1, 1, 5\n", 'unit "parsnips"'),
        ("name, x, y, d, side\na, 1, 1, 5, top\n", 'side = "top" must be "inside" or "outside"'),
    ],
)
def test_what_is_wrong_is_told_with_its_line(text: str, said: str) -> None:
    with pytest.raises(bd.ModelError, match=said):
        drive_from_table(text)

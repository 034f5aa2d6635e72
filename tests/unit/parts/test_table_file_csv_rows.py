"""CSV files as loggers and spreadsheets write them give the same rows, whatever they are written with."""

from pathlib import Path

import pytest

from beltdyn.parts.table_file import read_rows, read_table, row_of_units, unit_in_brackets, without_preamble

ROWS = [["Zeit", "Kraft µ"], ["0.5", "-1.25"], ["1", "2.5e3"]]
GERMAN = "Zeit;Kraft µ\r\n0,5;-1,25\r\n1;2,5e3\r\n"
POINTS = [[0.5, -1.25], [1.0, 2500.0]]


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "logged.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "cp1252", "utf-16"])
@pytest.mark.parametrize(
    "text",
    [
        "Zeit,Kraft µ\n0.5,-1.25\n1,2.5e3\n",
        "# made today\n\nZeit;Kraft µ\n0.5;-1.25\n1;2.5e3\n",
        GERMAN,
        GERMAN.replace(";", "\t"),
        "Zeit\tKraft µ\n0.5\t-1.25\n1\t2.5e3",
        '"Zeit";"Kraft µ"\n"0,5";"-1,25"\n"1";"2,5e3"\n',
    ],
)
def test_the_same_rows_however_they_are_written(tmp_path: Path, text: str, encoding: str) -> None:
    assert [row.cells for row in read_rows(written(tmp_path, text.encode(encoding))).rows] == ROWS


def test_commas_between_thousands_are_no_decimal_commas(tmp_path: Path) -> None:
    """Where another number has a decimal point; the cell stays, and is no number then."""
    path = written(tmp_path, "0.5;1\n1;2,500\n")
    assert read_rows(path).rows[1].cells == ["1", "2,500"]
    with pytest.raises(ValueError, match='line 2, column 2: "2,500" is not a number'):
        read_table(path, None, 2)


def test_a_comma_in_a_few_lines_is_no_separator(tmp_path: Path) -> None:
    text = "Device; A, rev 2\nload;speed\n1;2\n3;4\n"
    assert read_rows(written(tmp_path, text)).separator == ";"


@pytest.mark.parametrize("data", [b"\x89PNG\r\n\x1a\n\x00\x00", b"\x1f\x8b\x08\x00", b"\xff\xfe0,1", b"0,1\n\x81\n"])
def test_what_is_no_text_is_refused(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(ValueError, match="is not a text file"):
        read_rows(written(tmp_path, data))


def test_lines_above_the_headings_are_left_out(tmp_path: Path) -> None:
    text = "Logger 7\nStart;12:30\ntime;speed;torque\ns;rpm;N m\n0,1;2;3\n0,2;3;4\n"
    rows = without_preamble(read_rows(written(tmp_path, text)).rows)
    assert [row.line for row in rows] == [3, 4, 5, 6]
    assert without_preamble([]) == []


@pytest.mark.parametrize(
    ("cells", "units"),
    [
        (["s", "rpm"], ["s", "rpm"]),
        (["[s]", "(N m)", " - "], ["s", "N m", ""]),
        (["", "%"], ["", "%"]),
        (["", "-"], None),
        (["0.5", "rpm"], None),
        (["1", "rpm", "1/min"], ["", "rpm", "1/min"]),
        (["crank", "slip[a]"], None),
        (["s", "Nm", "RPM"], ["s", "Nm", "RPM"]),
    ],
)
def test_a_row_of_units(cells: list[str], units: list[str] | None) -> None:
    assert row_of_units(cells) == units


@pytest.mark.parametrize(("heading", "unit"), [("speed [rpm]", "rpm"), ("slip[driven]", ""), ("load", "")])
def test_a_unit_behind_a_heading(heading: str, unit: str) -> None:
    assert unit_in_brackets(heading) == unit


@pytest.mark.parametrize(
    ("head", "units"),
    [
        ("", ("", "")),
        ("time;speed\n", ("", "")),
        ("t;T\n", ("", "")),
        ("time [s];speed [rpm]\n", ("s", "rpm")),
        ("Logger 7\n\nSample rate;1000\ntime;speed\ns;rpm\n", ("s", "rpm")),
    ],
)
def test_points_below_any_head(tmp_path: Path, head: str, units: tuple[str, str]) -> None:
    """Symbols in the only line of a head are no units, as T of torque."""
    table = read_table(written(tmp_path, f"{head}0,5;-1,25\n1;2,5e3\n"), None, 2)
    assert (table.units, table.rows) == (units, POINTS)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time;speed\n0,5;1\n1;x\n", 'line 3, column 2: "x" is not a number'),
        ("time;speed\n0,5;1\n1;2;3\n", 'line 3: "1,2,3" is not two numbers separated by a semicolon'),
        ("0.O;1\n0,5;1\n", "line 1: is not two numbers"),
        ("time;speed\n", "has no numbers"),
    ],
)
def test_line_and_column_of_what_is_wrong(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ValueError) as error:  # noqa: PT011
        read_table(written(tmp_path, text), None, 2)
    assert said in str(error.value)

"""Tables from files of two columns, and what their points must obey."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from beltdyn.parts.table_file import check_points, describe_file, read_table, take_file, take_grid


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def make(text: str | bytes) -> Path:
        path = tmp_path / "points.csv"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return make


@pytest.mark.parametrize(
    "text",
    [
        "0,1\n2,-3\n",
        "time,torque\n0,1\n2,-3\n",
        "# measured\n\n0.0, 1e0\r\n2, -3.0",
        "\ufefftime,torque\n0,1\n# again\n2,-3",
        '"0","1"\n"2","-3"\n',
    ],
)
def test_two_columns_with_comments_empty_lines_and_a_header(write: Any, text: str) -> None:
    assert read_table(write(text), None, 2).rows == [[0.0, 1.0], [2.0, -3.0]]


def test_a_relative_path_starts_at_the_folder_of_the_drive(write: Any) -> None:
    path = write("0,1\n2,3\n")
    found = read_table(path.name, path.parent, 2)
    assert found == read_table(str(path), None, 2) == (("", ""), [[0.0, 1.0], [2.0, 3.0]])
    with pytest.raises(ValueError, match=r'file = "points\.csv" cannot be read: .* start at the folder of the drive'):
        read_table("points.csv", path.parent / "elsewhere", 2)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0,1\n2;3\n", 'line 2: "2;3" is not two numbers separated by a comma. Correct this line'),
        ("0,1\n\n# x\n2,3,4\n", 'line 4: "2,3,4" is not two numbers'),
        ("time,torque\n1,T\n0,1\n", "line 2: is not two numbers"),
        (b"\xff\xfe0,1", "is not a text file. Save it as CSV in UTF-8"),
        ('0,1\n"' + "x" * 200_000 + '"\n', "is not valid CSV in line 2"),
    ],
)
def test_the_line_that_is_wrong_is_named(write: Any, text: str | bytes, message: str) -> None:
    with pytest.raises(ValueError, match=r'^file = "points\.csv"') as caught:
        read_table("points.csv", write(text).parent, 2)
    assert message in str(caught.value)


def test_a_path_is_text() -> None:
    with pytest.raises(ValueError, match="file = 3 must be the path of a CSV file, as text"):
        read_table(3, None, 2)


def test_a_file_takes_the_place_of_both_columns(write: Any) -> None:
    path = write("0,1\n2,3\n")
    info: Any = SimpleNamespace(context={"base": path.parent})
    taken = take_file({"kind": "table", "file": "points.csv"}, info, "times", "values")
    assert taken == {"kind": "table", "times": [0.0, 2.0], "values": [1.0, 3.0]}
    for data in ({"kind": "table", "times": [0, 1]}, "no table"):
        assert take_file(data, info, "times", "values") is data
    with pytest.raises(ValueError, match="file and times and values exclude each other"):
        take_file({"file": "points.csv", "values": [1]}, info, "times", "values")


def test_columns_of_a_file_may_have_units(write: Any) -> None:
    info: Any = SimpleNamespace(context={"base": write("deg,Nm\n0,1\n90,-3e-7\n").parent})
    table = {"file": "points.csv", "units": ["deg", "N m"]}
    assert take_file(table, info, "angles", "torques") == {
        "angles": ["0.0 deg", "90.0 deg"],
        "torques": ["1.0 N m", "-3e-07 N m"],
    }
    with pytest.raises(ValueError, match="units = deg must be the units of both columns, such as"):
        take_file(table | {"units": "deg"}, info, "angles", "torques")
    with pytest.raises(ValueError, match="units applies to the columns of a file"):
        take_file({"angles": [0.0], "units": ["deg", "N m"]}, info, "angles", "torques")


def test_a_grid_has_the_second_argument_in_its_first_line(write: Any) -> None:
    info: Any = SimpleNamespace(context={"base": write("deg/rpm,100,200\n0,1,2\n90,3,4\n").parent})
    grid = {"file": "points.csv", "units": ["deg", "rpm", ""]}
    assert take_grid(grid, info, "angles", "speeds", "torques") == {
        "angles": ["0.0 deg", "90.0 deg"],
        "speeds": ["100.0 rpm", "200.0 rpm"],
        "torques": [[1.0, 2.0], [3.0, 4.0]],
    }
    with pytest.raises(ValueError, match=r"units = .* must be those of angles, speeds and torques"):
        take_grid(grid | {"units": ["deg"]}, info, "angles", "speeds", "torques")


@pytest.mark.parametrize(
    ("text", "message"),
    [("x,1,2\n0,1\n", 'line 2: "0,1" is not 3 numbers separated by commas'), ("", "has no numbers")],
)
def test_a_grid_with_a_wrong_line(write: Any, text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read_table(write(text), None, None)


def test_points_are_a_function() -> None:
    check_points("times", [0.0, 1e-9, 2.0], "values", [1.0, 1.0, 1.0])
    with pytest.raises(ValueError, match=r"times has 2 numbers but values has 1\. Give one value for each time"):
        check_points("times", [0.0, 1.0], "values", [1.0])
    for second in (1.0, 0.5):
        with pytest.raises(ValueError, match=f"times must increase, but {second:g} follows 1. Sort the points by time"):
            check_points("times", [0.0, 1.0, second], "values", [1.0, 2.0, 3.0])


def test_the_schema_asks_for_the_file_or_for_both_columns() -> None:
    schema: dict[str, Any] = {"properties": {}, "required": ["kind", "times", "values"]}
    describe_file(schema, ("times", "values"), "two columns, times and values")
    assert schema["required"] == ["kind"]
    assert schema["oneOf"] == [{"required": ["file"]}, {"required": ["times", "values"]}]
    assert schema["properties"]["file"]["description"].endswith("two columns, times and values")


def test_units_of_the_head_hold_unless_others_are_given(write: Any) -> None:
    path = write("time [ms],speed [rpm]\n0,1\n2,3\n")
    context: Any = SimpleNamespace(context={"base": path.parent})
    told = take_file({"file": path.name}, context, "times", "values")
    assert told == {"times": ["0.0 ms", "2.0 ms"], "values": ["1.0 rpm", "3.0 rpm"]}
    given = take_file({"file": path.name, "units": ["", "rad/s"]}, context, "times", "values")
    assert given == {"times": [0.0, 2.0], "values": ["1.0 rad/s", "3.0 rad/s"]}

"""What is wrong with a drive file, and where."""

import tomllib
from pathlib import Path

import numpy as np

from beltdyn.app.draft import draft


def test_a_right_file_gives_its_drive(alternator_text: str, tmp_path: Path) -> None:
    found = draft(tomllib.loads(alternator_text), tmp_path)
    assert found.drive is not None
    assert found.told == []


def test_while_something_is_dragged_the_layout_is_enough(alternator_text: str, tmp_path: Path) -> None:
    """It has the same path, and is wrong where no belt can run; the state of the belt is not looked at."""
    data = tomllib.loads(alternator_text)
    whole, quick = (draft(data, tmp_path, only_laid_out=only).drive for only in (False, True))
    assert whole is not None
    assert quick is not None
    np.testing.assert_array_equal(quick.path.span_points, whole.path.span_points)
    data["pulley"][1]["center"] = ["400 mm", "400 mm"]
    assert draft(data, tmp_path, only_laid_out=True).drive is None
    slack = tomllib.loads(alternator_text)
    slack["belt"] = {key: value for key, value in slack["belt"].items() if key != "installed_tension"} | {"length": 9.0}
    assert draft(slack, tmp_path).drive is None
    assert draft(slack, tmp_path, only_laid_out=True).drive is not None


def test_errors_stand_at_their_keys(alternator_text: str, tmp_path: Path) -> None:
    data = tomllib.loads(alternator_text)
    data["pulley"][1]["radius"] = "32 N"
    data["tensioner"][0]["preloat"] = 3.0
    found = draft(data, tmp_path)
    assert found.drive is None
    assert found.told_at(("pulley", 1, "radius"))[0].startswith(
        'pulley[tensioner].radius = "32 N" must be in units of m'
    )
    assert 'Did you mean "preload"?' in found.told_at(("tensioner", 0, "preloat"))[0]
    assert len(found.told_below(("pulley",))) == 1


def test_files_outside_the_folder_are_not_read(alternator_text: str, tmp_path: Path) -> None:
    data = tomllib.loads(alternator_text)
    for path in ("/etc/passwd", "../other.csv", "sub/../../x.csv"):
        data["pulley"][0]["speed"] = {"kind": "table", "file": path}
        found = draft(data, tmp_path)
        assert found.drive is None
        assert [one.location for one in found.told] == [("pulley", 0, "speed", "file")]
        assert "is outside" in found.told[0].sentence


def test_a_link_to_elsewhere_is_not_followed(alternator_text: str, tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    (tmp_path / "speed.csv").write_text("0,0\n1,10\n", encoding="utf-8")
    (folder / "link.csv").symlink_to(tmp_path / "speed.csv")
    data = tomllib.loads(alternator_text)
    data["pulley"][0]["speed"] = {"kind": "table", "file": "link.csv"}
    assert "is outside" in draft(data, folder).told[0].sentence


def test_a_file_in_the_folder_is_read(alternator_text: str, tmp_path: Path) -> None:
    (tmp_path / "speed.csv").write_text("0,0\n1,10\n", encoding="utf-8")
    data = tomllib.loads(alternator_text)
    data["pulley"][0]["speed"] = {"kind": "table", "file": "speed.csv"}
    assert draft(data, tmp_path).drive is not None

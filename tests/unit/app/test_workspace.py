"""The folder of the page, and nothing outside."""

from pathlib import Path

import pytest

from beltdyn.app.workspace import Folder
from beltdyn.errors import ModelError


@pytest.mark.parametrize(
    "name", ["../x.toml", "/etc/x.toml", "a/../../x", "", " ", ".hidden.toml", ".git/x.toml", "a\0b", "x" * 300]
)
def test_names_that_lead_outside_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ModelError, match="is not a file name"):
        Folder(tmp_path).path(name)


def test_links_that_lead_outside_are_refused_and_not_listed(tmp_path: Path) -> None:
    here = tmp_path / "here"
    here.mkdir()
    (tmp_path / "secret.toml").write_text("x = 1\n", encoding="utf-8")
    (here / "link.toml").symlink_to(tmp_path / "secret.toml")
    (here / "drive.toml").write_text("x = 1\n", encoding="utf-8")
    assert Folder(here).files() == ["drive.toml"]
    with pytest.raises(ModelError):
        Folder(here).read("link.toml")


def test_files_are_listed_the_nearest_first(tmp_path: Path) -> None:
    for name in ("z.toml", "sub/a.toml", "a.txt", ".venv/b.toml", "1/2/3/4/deep.toml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("", encoding="utf-8")
    assert Folder(tmp_path).files() == ["z.toml", "sub/a.toml"]
    assert Folder(tmp_path).files(".txt", ".csv") == ["a.txt"]


def test_a_file_is_written_and_replaced_only_as_it_is_known(tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    path = folder.write("new", "a = 1\n")
    assert path == tmp_path.resolve() / "new.toml"
    with pytest.raises(ModelError, match="already exists"):
        folder.write("new.toml", "a = 2\n")
    folder.write("new.toml", "a = 2\n", known="a = 1\n")
    path.write_text("a = 3\n", encoding="utf-8")
    with pytest.raises(ModelError, match="changed by another program"):
        folder.write("new.toml", "a = 4\n", known="a = 2\n")
    assert folder.read("new") == "a = 3\n"
    with pytest.raises(ModelError, match="is not a folder"):
        folder.write("none/x.toml", "")


def test_what_cannot_be_read_is_one_error(tmp_path: Path) -> None:
    (tmp_path / "latin.toml").write_bytes(b"\xff\xfe")
    for name, reason in (("none", "cannot be read"), ("latin", "UTF-8")):
        with pytest.raises(ModelError, match=reason):
            Folder(tmp_path).read(name)

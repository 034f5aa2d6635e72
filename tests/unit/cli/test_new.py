"""`beltdyn new`."""

from collections.abc import Callable
from importlib.resources import files
from inspect import getdoc
from pathlib import Path

import pytest

from beltdyn.cli.new import new
from beltdyn.model import load

RunMain = Callable[[list[str]], tuple[int, str, str]]
EXAMPLES = sorted(file.name.removesuffix(".toml") for file in files("beltdyn").joinpath("examples").iterdir())


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_is_written_as_it_is(name: str, tmp_path: Path, run_main: RunMain) -> None:
    file = tmp_path / "mine.toml"
    code, output, _ = run_main(["new", str(file), "--example", name])
    assert code == 0
    assert f"beltdyn simulate {file}" in output
    assert file.read_bytes() == files("beltdyn").joinpath("examples", f"{name}.toml").read_bytes()
    load(file)


def test_example_names_the_file(tmp_path: Path, run_main: RunMain, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for arguments in (["--example", "slip-through"], []):
        assert run_main(["new", *arguments])[0] == 0
    assert sorted(file.name for file in tmp_path.iterdir()) == ["drive.toml", "slip_through.toml"]


def test_unknown_example_lists_the_names(refuse: Callable[[list[str]], str]) -> None:
    message = refuse(["new", "--example", "tractor"])
    assert f"example 'tractor' does not exist. Choose one of {', '.join(EXAMPLES)}." in " ".join(message.split())


def test_a_file_with_the_name_of_an_example_is_asked_about(
    tmp_path: Path, refuse: Callable[[list[str]], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "`beltdyn new -e conveyor`" in refuse(["new", "conveyor"])
    assert not list(tmp_path.iterdir())


def test_an_existing_file_is_kept(tmp_path: Path, refuse: Callable[[list[str]], str]) -> None:
    file = tmp_path / "drive.toml"
    file.write_text("mine", encoding="utf-8")
    assert "already exists" in refuse(["new", str(file), "--example", "slip_through"])
    assert file.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("name", EXAMPLES)
def test_help_names_every_example(name: str) -> None:
    assert name in str(getdoc(new))


def test_keys_of_a_group_are_printed_with_units_and_defaults(run_main: RunMain) -> None:
    code, output, _ = run_main(["keys", "limits"])
    lines = output.splitlines()
    assert (code, lines[0]) == (0, "[limits]   (limits)")
    assert next(line for line in lines if line.startswith("largest_hub_load")).split()[1] == "N"


def test_without_a_name_groups_of_keys_are_listed(run_main: RunMain) -> None:
    assert '[[pulley.load]] kind = "motor"' in run_main(["keys"])[1]


def test_an_unknown_group_of_keys_is_refused(run_main: RunMain) -> None:
    code, _, error = run_main(["keys", "lenght"])
    assert code == 2
    assert 'no group or key "lenght"' in error

from collections.abc import Callable
from pathlib import Path

from beltdyn.model import load

RunMain = Callable[[list[str]], tuple[int, str, str]]

TASK = ["select", "--power", "7.5 kW", "--speed", "1450 rpm", "--driven-speed", "700 rpm", "--service-factor", "1.2"]


def test_it_lists_drives_and_writes_their_files(run_main: RunMain, tmp_path: Path) -> None:
    code, output, error = run_main([*TASK, "--profiles", "SPA,PL", "--count", "3", "-o", str(tmp_path / "found")])
    assert (code, error) == (0, "")
    files = sorted((tmp_path / "found").iterdir())
    assert [file.name[:9] for file in files] == ["select-1-", "select-2-", "select-3-"]
    for file in files:
        drive = load(file)
        assert drive.belt.value_of("profile") in ("SPA", "PL")
        assert drive.limits.service_factor == 1.2
        assert str(file) in output.replace("\n", "")
    assert "beltdyn rating" in output


def test_it_replaces_no_file(run_main: RunMain, tmp_path: Path) -> None:
    arguments = [*TASK, "--profiles", "SPA", "--count", "1", "-o", str(tmp_path)]
    assert run_main(arguments)[0] == 0
    code, _, error = run_main(arguments)
    assert code == 2
    assert "already exists" in error


def test_what_is_not_possible_ends_with_one_message(run_main: RunMain, tmp_path: Path) -> None:
    code, _, error = run_main([*TASK, "--profiles", "round-85A", "-o", str(tmp_path)])
    assert code == 2
    assert 'profile "round-85A" has no rating' in error
    assert "Traceback" not in error

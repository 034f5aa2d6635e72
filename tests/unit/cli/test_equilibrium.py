"""`beltdyn equilibrium`: what it shows and writes, and what it leaves where there is no equilibrium."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.model import load
from beltdyn.results import Run, open_result
from beltdyn.state.equilibrium import equilibrium

RunMain = Callable[[list[str]], tuple[int, str, str]]


@pytest.fixture
def unbalanced(monkeypatch: pytest.MonkeyPatch) -> None:
    """No search finds an equilibrium."""

    def fail(*_: object) -> None:
        raise ConvergenceError("no equilibrium.")

    monkeypatch.setattr(import_module("beltdyn.state.installation"), "find_equilibrium", fail)


def test_it_shows_and_writes_the_drive_at_rest(run_main: RunMain, drive_file: Path) -> None:
    code, output, _ = run_main(["equilibrium", str(drive_file)])
    assert code == 0
    rest = equilibrium(load(drive_file))
    for words in ("driver-driven", f"{float(rest.dataset.hub_load[0]):.5g}", f"{float(rest.dataset.tension):.5g} N"):
        assert words in output
    assert all(f"warning: {warning}" in output for warning in rest.warnings)
    saved = open_result(drive_file.with_name("drive-equilibrium.nc"))
    assert saved.dataset.span_tension.values.tolist() == rest.dataset.span_tension.values.tolist()


@pytest.mark.parametrize("command", ["equilibrium", "simulate"])
@pytest.mark.usefixtures("unbalanced")
def test_no_equilibrium_leaves_no_file(run_main: RunMain, drive_file: Path, drive_text: str, command: str) -> None:
    drive_file.write_text(drive_text.replace('start = "laid"', 'start = "equilibrium"'), encoding="utf-8")
    output = drive_file.with_name("out.nc")
    code, shown, message = run_main([command, str(drive_file), "-o", str(output)])
    assert code == 3
    assert "No results were kept." in shown
    assert "error: no equilibrium." in message
    assert sorted(path.name for path in drive_file.parent.iterdir()) == [drive_file.name]


@pytest.mark.usefixtures("unbalanced")
def test_an_earlier_result_outlives_a_failed_equilibrium(run_main: RunMain, drive_file: Path, run: Run) -> None:
    output = run.save(drive_file.with_name("drive-equilibrium.nc"))
    before = output.read_bytes()
    assert run_main(["equilibrium", str(drive_file)])[0] == 3
    assert output.read_bytes() == before

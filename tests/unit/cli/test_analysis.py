"""The command of an analysis is made of its function."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from cyclopts import App

from beltdyn.analyses import Analysis
from beltdyn.cli import app as command_line
from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result, open_result

RunMain = Callable[[list[str]], tuple[int, str, str]]


def load_steps(drive: Drive, *, highest: float, steps: int = 3) -> Result:
    """Load a drive step by step.

    Parameters
    ----------
    drive
        The drive.
    highest
        The largest torque, N m.
    steps
        How many steps to take.

    Returns
    -------
    Result
        Slip along ``torque``.
    """
    torque = np.linspace(0.0, highest, steps)
    slip = Variable(("torque",), "1", "Slip")
    return build_result(
        "load_steps",
        drive,
        {"slip": (slip, 1e-3 * torque)},
        {"torque": (Variable(("torque",), "N m", "Torque"), torque)},
        ["slips through at the end"],
    )


@pytest.fixture(autouse=True)
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command line knows this analysis."""
    analysis = Analysis(f"{__name__}:load_steps", "Load a drive.")
    monkeypatch.setattr(Analysis, "function", property(lambda _: load_steps))
    monkeypatch.setattr(command_line, "ANALYSES", {"load_steps": analysis})
    app = App(name="beltdyn", suppress_keyboard_interrupt=False)
    app.command(App(name="load-steps", help=analysis.purpose))
    monkeypatch.setattr(command_line, "app", app)


def test_its_options_are_explained(run_main: RunMain) -> None:
    code, output, _ = run_main(["load-steps", "--help"])
    assert code == 0
    for words in ("Load a drive step by step.", "The drive file, TOML.", "The largest torque, N m.", "[default: 3]"):
        assert words in output
    assert "  drive" not in output


def test_it_writes_a_table_warnings_and_a_file(run_main: RunMain, drive_file: Path) -> None:
    code, output, _ = run_main(["load-steps", str(drive_file), "--highest", "4"])
    assert code == 0
    for words in ("Torque", "Slip", "0.002", "warning: slips through at the end", "drive-load-steps.nc"):
        assert words in output
    assert open_result(drive_file.with_name("drive-load-steps.nc")).dataset.sizes == {"torque": 3}


def test_the_drive_file_is_not_replaced(run_main: RunMain, drive_file: Path) -> None:
    code, _, errors = run_main(["load-steps", str(drive_file), "--highest", "4", "-o", str(drive_file)])
    assert code == 2
    assert "the results would overwrite it" in errors


@pytest.mark.parametrize("options", [[], ["--highest", "much"], ["--highest", "1", "--colour", "red"]])
def test_wrong_options_are_bad_input(run_main: RunMain, drive_file: Path, options: list[str]) -> None:
    assert run_main(["load-steps", str(drive_file), *options])[0] == 2

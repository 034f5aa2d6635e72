"""`beltdyn sweep`, and the figures that it names."""

import importlib
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.results import Run

RunMain = Callable[[list[str]], tuple[int, str, str]]
Refuse = Callable[[list[str]], str]
SPEEDS = ["--pulley", "driver", "--from", "700 rpm", "--to", "6000 rpm"]


def test_a_sweep_takes_quantities_and_names_its_file(
    run_main: RunMain, run: Run, drive_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulated: list[Any] = []

    def record_run(drive: Drive, output: Path, *_: object, begin: object, watch: object, **attributes: str) -> Run:
        simulated.extend([drive, output, attributes])
        run.save(output)
        return run

    monkeypatch.setattr(importlib.import_module("beltdyn.transient.sweep"), "record_run", record_run)
    code, output, _ = run_main(["sweep", str(drive_file), *SPEEDS, "--duration", "2 s"])
    assert code == 0
    drive, path, attributes = simulated
    assert path == drive_file.with_name("drive-sweep.nc")
    assert drive.pulleys[0].speed.at([2.0])[0] == pytest.approx(200.0 * np.pi)
    assert attributes["swept_pulley"] == "driver"
    assert f"beltdyn plot {path}" in output.replace("\n", "")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"--pulley": "idler"}, "pulley = 'idler' is not in this drive. Choose one of driver, driven."),
        (
            {"--pulley": "driven"},
            "pulley = 'driven' turns freely, but a sweep needs a prescribed speed. Choose one of driver.",
        ),
        ({"--from": "700 mm"}, "from = '700 mm' must be in units of rad/s, not \"mm\"."),
        ({"--to": "fast"}, "to = 'fast' must be a number in rad/s."),
        ({"--from": "nan"}, "from = nan must be a finite number."),
        ({"--duration": "0"}, "duration = 0 s must be above zero"),
        ({"--to": "-600"}, "not a run-up: the speeds must differ and have the same sign"),
        ({"--to": "700 rpm"}, "not a run-up: the speeds must differ and have the same sign"),
    ],
)
def test_bad_sweeps(refuse: Refuse, drive_file: Path, changes: dict[str, str], message: str) -> None:
    options = dict(zip(SPEEDS[::2], SPEEDS[1::2], strict=True)) | {"--duration": "5 s"} | changes
    words = [f"{option}={value}" for option, value in options.items()]
    assert message in refuse(["sweep", str(drive_file), *words])


@pytest.fixture
def result_file(saved_run: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(saved_run, tmp_path / "result.nc"))


def test_chosen_figures_of_one_pulley(run_main: RunMain, result_file: Path) -> None:
    arguments = ["plot", str(result_file), "--figures", "hub_loads, slip", "--pulley", "driven"]
    code, output, message = run_main(arguments)
    assert (code, message) == (0, "")
    assert "hub_loads.png, slip.png" in output
    folder = result_file.with_name("result-figures")
    assert {path.name for path in folder.iterdir()} == {"hub_loads.png", "slip.png"}


@pytest.mark.slow
def test_figures_of_several_files(run_main: RunMain, refuse: Refuse, result_file: Path) -> None:
    other = result_file.with_name("other.nc")
    shutil.copy(result_file, other)
    code, _, message = run_main(["plot", str(result_file), str(other), "--figures", "speeds,slip"])
    assert (code, message) == (0, "")
    folder = result_file.with_name("result-and-other-figures")
    assert {path.name for path in folder.iterdir()} == {"speeds.png", "slip.png"}
    files = ["plot", str(result_file), str(other)]
    assert "'energy' shows one result, but there are 2" in refuse([*files, "--figures", "energy"])
    assert "--animate needs the results of one run, or modes, not 2 results" in refuse([*files, "--animate"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            ["--figures", "slips"],
            "figure 'slips' is unknown. Choose from configuration, carriage_error, contact_forces",
        ),
        (["--figures", "slip,"], "figure '' is unknown"),
        (["--pulley", "idler"], "pulley = 'idler' is not in this drive. Choose one of driver, driven."),
        (["--figures", "tensioners"], "this drive has no moving tensioner"),
        (["--figures", "orders"], "orders need 16 or more"),
        (["--figures", "waterfall", "--variable", "energy"], "Choose from: pulley_speed, pulley_angle, shaft_speed"),
    ],
)
def test_figures_that_cannot_be_drawn(refuse: Refuse, result_file: Path, options: list[str], message: str) -> None:
    assert message in refuse(["plot", str(result_file), *options])

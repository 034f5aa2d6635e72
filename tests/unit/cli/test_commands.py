import json
import os
import subprocess
import sys
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from inspect import signature
from math import hypot
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

from beltdyn import __version__
from beltdyn.analyses import ANALYSES
from beltdyn.cli.analysis import analysis_command
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, advise, install, load
from beltdyn.results import FileRecorder, Layout, Run, open_run
from beltdyn.solvers.run_progress import Progress
from beltdyn.state.equilibrium import equilibrium
from beltdyn.state.installation import bring_to_rest
from beltdyn.transient.simulate import simulate

RunMain = Callable[[list[str]], tuple[int, str, str]]


def test_version(run_main: RunMain) -> None:
    assert run_main(["--version"]) == (0, f"{__version__}\n", "")


def test_help_names_every_command(run_main: RunMain) -> None:
    code, output, _ = run_main(["--help"])
    assert code == 0
    for command in ("new", "check", "simulate", "sweep", "equilibrium", "plot", "demo", "catalogue", "schema"):
        assert f" {command} " in output


def test_help_imports_nothing_heavy() -> None:
    script = (
        "import sys\nfrom beltdyn.cli import main\ntry: main(['--help'])\nexcept SystemExit: pass\n"
        "sys.exit(len({'numpy', 'scipy', 'numba', 'xarray', 'matplotlib', 'pint', 'pydantic'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, check=False).returncode == 0


@pytest.mark.parametrize(("chosen", "found"), [({}, "1"), ({"OMP_NUM_THREADS": "2"}, "2")])
def test_linear_algebra_uses_one_thread_unless_told_otherwise(chosen: dict[str, str], found: str) -> None:
    script = (
        "import os, sys\nfrom beltdyn.cli import main\nassert 'numpy' not in sys.modules\n"
        "try: main(['--version'])\nexcept SystemExit: print(os.environ['OMP_NUM_THREADS'])\n"
    )
    others = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    process = subprocess.run(
        [sys.executable, "-c", script], env=others | chosen, capture_output=True, text=True, check=True
    )
    assert process.stdout.split() == [__version__, found]


def test_a_run_imports_nothing_that_it_can_do_without(drive_file: Path, drive_text: str) -> None:
    """Each of these takes a good part of a second."""
    drive_file.write_text(drive_text.replace("duration = 1.0", "duration = 0.001"), encoding="utf-8")
    script = (
        "import sys\nfrom beltdyn.cli import main\n"
        f"try: main(['simulate', {str(drive_file)!r}])\nexcept SystemExit as stop: assert stop.code == 0\n"
        "print(*{'xarray', 'pandas', 'matplotlib', 'pint', 'scipy.integrate', 'jinja2'} & set(sys.modules))"
    )
    process = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert process.stdout.splitlines()[-1] == ""


def test_check_of_the_papers_drive(run_main: RunMain, drive_file: Path) -> None:
    code, output, _ = run_main(["check", str(drive_file)])
    assert code == 0
    tension = float(equilibrium(load(drive_file)).dataset.span_tension.mean())
    for part in ("1.2763 m", "0.281%", "28.19 N", f"{tension:.4g} N (", "5.8%", "180.0°", "0.3829"):
        assert part in output
    assert "warning: the belt has too few elements for peak pressure" in output
    assert "warning: the contact between belt and pulleys is so soft that it reduces the belt tension by 5.8%" in output
    assert f"beltdyn check {drive_file} --figure layout.png" in output


def test_check_of_several_goes_on_after_one_that_is_refused(run_main: RunMain, drive_file: Path) -> None:
    wrong = drive_file.with_name("wrong.toml")
    wrong.write_text("[belt]\nlength = -1\n", encoding="utf-8")
    code, output, message = run_main(["check", str(wrong), str(drive_file)])
    assert code == 2
    assert output.index(str(wrong)) < output.index(str(drive_file)) < output.index("1.2763 m")
    assert all(line.startswith(f"error: {wrong}") for line in message.splitlines() if "error" in line)
    assert f"error: {wrong}" in message
    assert run_main(["check", str(wrong), str(drive_file), "--figure", "a.png"])[0] == 2


def test_check_of_a_belt_of_given_tension(run_main: RunMain, drive_file: Path, drive_text: str) -> None:
    """The tension that was asked for is there; what penetration costs is length."""
    drive_file.write_text(drive_text.replace("length = 1.2727 ", 'installed_tension = "250 N" '), encoding="utf-8")
    code, output, _ = run_main(["check", str(drive_file)])
    assert code == 0
    assert "250 N as specified (" in output
    assert "mm shorter for 250 N than on rigid pulleys" in output


def test_check_tells_what_to_expect_at_rest(run_main: RunMain, drive_file: Path, drive_text: str) -> None:
    """An idler on the back under a spring: sense, speed ratio, hub loads, frequencies, and the picture."""
    idler = (
        '[[pulley]]\nname = "idler"\ncenter = [0.0, -0.09]\nradius = 0.03\nside = "outside"\ninertia = 0.01\n\n'
        '[[pulley]]\nname = "driven"'
    )
    spring = (
        '\n[[tensioner]]\nkind = "sliding"\npulley = "idler"\ndirection = [0, 1]\npreload = 20.0\n'
        "mass = 0.5\nrate = 100.0\nstops = [-0.02, 0.02]\nstop_stiffness = 1e6\n"
    )
    text = (
        drive_text.replace('[[pulley]]\nname = "driven"', idler).replace("length = 1.2727", "length = 1.274") + spring
    )
    drive_file.write_text(text, encoding="utf-8")
    picture = drive_file.with_name("layout.png")
    code, output, message = run_main(["check", str(drive_file), "--figure", str(picture)])
    assert (code, "error" in message) == (0, False)
    installation = bring_to_rest(load(drive_file)).installation
    for part in (
        *("cw", "-2.7083", "driver to idler", "-0.02 m to 0.02 m"),
        f"{installation.tension:.4g} N, set by tensioners",
        f" {installation.span_frequencies[0]:.2f}\n",
        f" {hypot(*installation.hub_loads[1]):.2f} ",
        f"{installation.tensioner_positions[0]:.4g} m",
        f"Layout: {picture}",
    ):
        assert part in output
    assert picture.stat().st_size > 5_000


def test_check_of_a_belt_as_sold(run_main: RunMain, tmp_path: Path) -> None:
    """Both lengths, what measures the nominal one, and the sense of a motor at -600 rpm, which is written short."""
    file = tmp_path / "drive.toml"
    file.write_text(
        '[belt]\nprofile = "PJ-elastic"\nribs = 5\nnominal_length = "1194 mm"\n'
        '[[pulley]]\nname = "motor"\ncenter = [0, 0]\ndiameter = "25 mm"\nspeed = "-600 rpm"\n'
        '[[pulley]]\nname = "drum"\ncenter = ["0.35 m", 0]\ndiameter = "270 mm"\ninertia = 0.3\n'
        '[simulation]\nduration = 1.0\noutput_interval = 0.01\nstart = "steady"\n',
        encoding="utf-8",
    )
    code, output, _ = run_main(["check", str(file)])
    words = " ".join(output.split())
    assert code == 0
    unstretched = (1.194 + 2 * np.pi * 0.0012) / (1 + 125.0 / 5000.0)
    assert f"belt length {unstretched:.5g} m unstretched" in words
    assert "nominal length 1.194 m under 250 N between two pulleys, stretched by 2.500%" in words
    assert "motor prescribed cw" in words
    assert "drum free cw" in words


def test_check_of_pulleys_out_of_line(run_main: RunMain, tmp_path: Path) -> None:
    """Fleeting angles with tolerances, the offset that the belt still allows, and a warning beyond the limit."""
    file = tmp_path / "drive.toml"
    text = (
        '[belt]\nprofile = "PJ"\nribs = 5\ninstalled_tension = 200\n'
        '[[pulley]]\nname = "motor"\ncenter = [0, 0]\ndiameter = "100 mm"\nspeed = "600 rpm"\n'
        '[[pulley]]\nname = "drum"\ncenter = ["0.4 m", 0]\ndiameter = "100 mm"\ninertia = 0.3\n'
        'axial_offset = "OFFSET"\n[simulation]\nduration = 1.0\nstart = "steady"\n'
    )
    file.write_text(text.replace("OFFSET", "2 ± 0.5 mm"), encoding="utf-8")
    code, output, _ = run_main(["check", str(file)])
    assert code == 0
    assert "Fleeting angles (geometry only: the dynamics are planar)" in output
    row = f"motor to drum {np.degrees(0.005):.3f}° {np.degrees(0.005):.3f}° {np.degrees(0.00625):.3f}° 0.5° 0.991"
    assert row in " ".join(output.split())
    file.write_text(text.replace("OFFSET", "4 mm"), encoding="utf-8")
    _, output, errors = run_main(["check", str(file)])
    assert "at a fleeting angle of 0.573°, but the belt allows 0.5°" in " ".join((output + errors).split())


def test_check_tells_where_a_take_up_puts_its_pulley(run_main: RunMain, drive_file: Path, drive_text: str) -> None:
    fixed = '\n[[tensioner]]\nkind = "fixed"\npulley = "driven"\ndirection = [1, 0]\n'
    text = drive_text.replace("length = 1.2727", "length = 1.2727\ninstalled_tension = 50") + fixed
    drive_file.write_text(text, encoding="utf-8")
    code, output, _ = run_main(["check", str(drive_file)])
    assert code == 0
    x, y = bring_to_rest(load(drive_file)).drive.centers[1]
    assert x > 0.1920
    assert f"center of driven [{x:.5g}, {y:.5g}] m after take-up" in " ".join(output.split())
    assert "tension at rest 50 N as specified" in " ".join(output.split())


def test_the_drive_that_new_writes_has_no_warnings(run_main: RunMain, tmp_path: Path) -> None:
    file = tmp_path / "folder" / "mine.toml"
    code, output, _ = run_main(["new", str(file)])
    assert code == 0
    assert str(file) in output
    drive = load(file)
    assert advise(drive, install(drive)) == []


def test_schema_is_json(run_main: RunMain) -> None:
    code, output, _ = run_main(["schema"])
    assert code == 0
    assert "belt" in json.loads(output)["properties"]


def put_in_place_of_simulate(monkeypatch: pytest.MonkeyPatch, stand_in: Callable[..., Run]) -> None:
    """Let `beltdyn simulate` call something else, with the options of `simulate`."""
    monkeypatch.setattr(import_module("beltdyn.transient.simulate"), "simulate", wraps(simulate)(stand_in))


@pytest.mark.parametrize("outputs", [None, 0, 3])
def test_a_simulation_that_cannot_go_on(
    run_main: RunMain,
    drive_file: Path,
    monkeypatch: pytest.MonkeyPatch,
    layout: Layout,
    attributes: dict[str, str],
    make_chunk: Callable[..., Any],
    outputs: int | None,
) -> None:
    """It says where its outputs are; of an equilibrium that was not found there are none, nor in a lost file."""

    def fail(drive: Drive, output: Path, **options: Any) -> Run:
        if outputs is not None:
            recorder = FileRecorder(output, layout, attributes)
            if outputs:
                recorder.append(make_chunk(np.linspace(0.0, 0.1, outputs)))
            recorder.close("failed", {})
        raise ConvergenceError("no convergence at t = 0.1 s. Lower simulation.max_step.")

    put_in_place_of_simulate(monkeypatch, fail)
    code, output, message = run_main(["simulate", str(drive_file)])
    assert code == 3
    assert (f"The results computed so far are in {drive_file.with_suffix('.nc')}" in output) == bool(outputs)
    assert ("No results were kept." in output) != bool(outputs)
    assert "error: no convergence at t = 0.1 s. Lower simulation.max_step." in message


def test_an_interrupted_simulation(
    run_main: RunMain, drive_file: Path, monkeypatch: pytest.MonkeyPatch, make_run: Callable[..., Run]
) -> None:
    run = make_run(status="interrupted")
    out = drive_file.with_name("out.nc")

    def interrupted(drive: Drive, output: Path, **options: Any) -> Run:
        run.save(output)
        return run

    put_in_place_of_simulate(monkeypatch, interrupted)
    code, output, _ = run_main(["simulate", str(drive_file), "-o", str(out)])
    assert code == 130
    assert "Interrupted. The results computed so far are kept." in output
    assert f"Results: {out}" in output


def test_an_interruption_elsewhere(run_main: RunMain, drive_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("beltdyn.model.load", interrupt)
    assert run_main(["check", str(drive_file)]) == (130, "", "error: interrupted\n")


def test_a_run_goes_on_by_its_result_file(drive_file: Path, run_main: RunMain) -> None:
    def stop(progress: Progress) -> None:
        if progress.phase == "integrating" and progress.time > 0.004:
            raise KeyboardInterrupt

    text = drive_file.read_text(encoding="utf-8").replace("duration = 1.0", "duration = 0.01")
    drive_file.write_text(text, encoding="utf-8")
    path = drive_file.with_suffix(".nc")
    simulate(load(drive_file), path, stop, checkpoint=1e-9).dataset.close()
    assert run_main(["simulate", "--resume", str(path)])[0] == 0
    assert open_run(path).outputs == 11
    before = path.read_bytes()
    code, output, _ = run_main(["simulate", "--resume", str(path)])
    assert code == 0
    assert f"{path} is complete: there was nothing left to compute." in output
    assert path.read_bytes() == before


@pytest.mark.parametrize("name", ANALYSES)
def test_an_analysis_has_defaults_of_the_types_that_its_options_read(name: str) -> None:
    """A text for an option that reads a text: what a command line fills in is read as what it is given."""
    command = analysis_command(ANALYSES[name])
    for option in signature(command).parameters.values():
        if isinstance(option.default, float | int) and not isinstance(option.default, bool):
            kinds = get_args(option.annotation) or (option.annotation,)
            assert {float, int} & set(kinds), f"{option.name} = {option.default}"

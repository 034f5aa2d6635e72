"""Web lines, conveyors and guided belts under every command: an answer without NaN, or one clear refusal."""

import re
import shutil
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import pytest

RunMain = Callable[[list[str]], tuple[int, str, str]]

TASKS = Path(__file__).parents[3] / "docs" / "tasks"
EXAMPLES = Path(str(files("beltdyn").joinpath("examples")))
LINES = {
    **{name: TASKS / f"{name}.toml" for name in ("coater", "calender", "calender5", "handrail", "press_roller")},
    **{name: EXAMPLES / f"{name}.toml" for name in ("conveyor_1km", "package_conveyor")},
}
COMMANDS = (
    *(["check"], ["steady-state", "--report"], ["sheet", "--report"], ["operating-map", "--load", "0.5, 1"]),
    *(["duty", "--table", "duty.csv"], ["life"], ["rating"], ["tensioner-sheet"], ["traction"], ["stroke"], ["fmu"]),
    ["sensitivity", "--numbers", "contact.friction"],
)


@pytest.mark.slow
@pytest.mark.parametrize("name", LINES)
def test_every_command_answers_or_refuses(
    name: str, run_main: RunMain, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    drive = Path(shutil.copy(LINES[name], tmp_path / "line.toml"))
    Path("duty.csv").write_text("share [%], load\n50, 1\n50, 0.5\n", encoding="utf-8")
    answered = set[str]()
    for command, *words in COMMANDS:
        code, output, errors = run_main([command, str(drive), *words])
        said = " ".join(errors.split())
        assert code in (0, 2), (command, said)
        assert not re.search(r"\bnan\b", output), (command, output)
        if code == 0:
            answered.add(command)
        else:
            assert len(re.findall(r"\berror: ", said)) == 1, (command, said)
    assert answered >= {"check", "steady-state", "sheet", "operating-map", "duty", "sensitivity"}


@pytest.mark.slow
def test_a_goal_is_said_once(run_main: RunMain, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The largest of largest tensions is the largest tension."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(LINES["package_conveyor"], "line.toml")
    study = '[[number]]\npath = "contact.friction"\nleast = 0.3\nlargest = 0.4\n[goal]\nresult = "largest_tension"\n'
    Path("study.toml").write_text(study, encoding="utf-8")
    code, output, _ = run_main(["optimize", "line.toml", "--study", "study.toml", "--most", "3"])
    assert code == 0
    assert "minimize largest_tension" in output

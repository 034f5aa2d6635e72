"""`beltdyn fmu`, and what it refuses."""

from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest

RunMain = Callable[[list[str]], tuple[int, str, str]]
Refuse = Callable[[list[str]], str]


def test_a_unit_is_written_beside_the_drive_file(run_main: RunMain, drive_file: Path) -> None:
    unit = drive_file.with_suffix(".fmu")
    code, output, _ = run_main(["fmu", str(drive_file)])
    assert (code, output) == (0, f"Written: {unit}   (FMI 2.0, co-simulation)\n")
    assert fmpy.read_model_description(str(unit)).fmiVersion == "2.0"


def test_variables_and_the_version_are_chosen(run_main: RunMain, drive_file: Path, tmp_path: Path) -> None:
    unit = tmp_path / "other.fmu"
    words = ["--input", "pulley[driver].speed", "--output", "shaft_torque", "--output", "pulley_angle[driver]"]
    assert run_main(["fmu", str(drive_file), "-o", str(unit), *words, "--fmi", "3.0"])[0] == 0
    described = fmpy.read_model_description(str(unit))
    names = [one.name for one in described.modelVariables if one.causality in ("input", "output")]
    assert described.fmiVersion == "3.0"
    assert names == [words[1], "shaft_torque[driver]", "shaft_torque[driven]", words[5]]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--input", "pulley[driver].sped"], 'is not an input of this drive. Did you mean "pulley[driver].speed"?'),
        (["--output", "out.fmu"], "'out.fmu' is not an output of this drive. Give the file with -o."),
        (["--output", "slip"], "'slip' is not an output of this drive."),
        (["-o", "drive.toml"], "drive.toml must end in .fmu"),
        (["-o", "theirs.fmu"], "theirs.fmu already exists"),
        (["-o", "missing/drive.fmu"], "cannot be written"),
        (["--fmi", "1.0"], "1.0"),
    ],
)
def test_message(
    words: list[str], sentence: str, refuse: Refuse, drive_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(drive_file.parent)
    Path("theirs.fmu").write_text("mine", encoding="utf-8")
    before = {path: path.read_bytes() for path in Path().rglob("*")}
    message = refuse(["fmu", "drive.toml", *words])
    assert sentence in " ".join(message.split())
    assert {path: path.read_bytes() for path in Path().rglob("*")} == before

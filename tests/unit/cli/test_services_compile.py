"""Compilation in advance: of usual drives, of a drive file, with its progress."""

from collections.abc import Callable
from pathlib import Path

import pytest

from beltdyn.kernel import compiles_quickly, kernel_cache
from beltdyn.model import example, load
from beltdyn.state.installation import is_compiled

RunMain = Callable[[list[str]], tuple[int, str, str]]


def test_kernels_of_usual_drives_are_compiled(run_main: RunMain) -> None:
    code, output, _ = run_main(["compile"])
    assert code == 0
    assert output == f"Kernels are compiled: {kernel_cache()}\n"
    assert is_compiled(example("alternator_drive")) or not compiles_quickly()


@pytest.mark.slow
def test_those_of_a_drive_file_are(run_main: RunMain, tmp_path: Path) -> None:
    file = tmp_path / "drive.toml"
    assert run_main(["new", str(file)])[0] == 0
    assert run_main(["compile", str(file)])[0] == 0
    assert is_compiled(load(file)) or not compiles_quickly()

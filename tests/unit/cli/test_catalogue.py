from collections.abc import Callable
from pathlib import Path

from beltdyn.model import read_catalogue

RunMain = Callable[[list[str]], tuple[int, str, str]]


def test_lists_every_profile_with_its_source(run_main: RunMain) -> None:
    code, output, error = run_main(["catalogue"])
    assert (code, error) == (0, "")
    for name, entry in read_catalogue().items():
        assert f"\n{name}: {entry.title}. Generic values.\n  {entry.source}" in output


def test_lists_ones_own(run_main: RunMain, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        '[mine]\ntitle = "Measured belt"\nwidth = 0.004\nthickness = 0.005\naxial_stiffness = 21e3\n'
        'bending_stiffness = 1e-3\nmass_per_length = 0.02\nwedge_angle = "36 deg"\nsource = "our rig"\n'
    )
    code, output, _ = run_main(["catalogue", "--file", str(file)])
    assert code == 0
    assert "\nmine: Measured belt.\n  our rig" in output
    (row,) = [line for line in output.splitlines() if line.startswith("mine ")]
    assert row.split() == ["mine", "4", "each", "5", "21000", "0.001", "0.02", "36°"]


def test_a_bad_file_is_bad_input(run_main: RunMain, tmp_path: Path) -> None:
    code, output, error = run_main(["catalogue", "--file", str(tmp_path / "nix.toml")])
    assert (code, output) == (2, "")
    assert error.startswith("error: catalogue = ")
    assert "cannot be read" in error

from collections.abc import Callable
from math import pi
from pathlib import Path

import pytest

from beltdyn.model import Entry, install, loads, read_catalogue

RunMain = Callable[[list[str]], tuple[int, str, str]]

MINE = """
[mine]
title = "Measured belt"
width = 0.004
thickness = 0.005
axial_stiffness = 21e3
bending_stiffness = 1e-3
mass_per_length = 0.02
wedge_angle = "36 deg"
bending_damping_time = 2e-5
source = "our rig"
"""


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (
            "A",
            (
                "cord_fatigue 569.4 N at 1e+08 cycles",
                "largest_fleeting_angle 0.5°",
                "Cord fatigue: Durability parameters",
            ),
        ),
        (
            "PK",
            ("rib_fatigue diameter^-5.6, tension^1.13, twice for 23 K, 0.3 at the back", "Rib fatigue: The life grows"),
        ),
    ],
)
def test_fatigue_data_with_their_source(run_main: RunMain, profile: str, words: tuple[str, ...]) -> None:
    _, output, _ = run_main(["catalogue", profile])
    shown = " ".join(output.split())
    assert [one for one in words if one not in shown] == []


def test_lists_every_profile_below_its_kind(run_main: RunMain) -> None:
    code, output, error = run_main(["catalogue"])
    assert (code, error) == (0, "")
    lines = output.splitlines()
    kind = ""
    listed = []
    for name, entry in read_catalogue().items():
        if entry.kind != kind:
            kind = entry.kind
            listed.append(kind)
        listed.append(f"  {name}")
    found = [line for line in lines[2:] if line.rstrip() in listed or line.startswith("  ")]
    assert len(found) == len(listed)
    assert [line for line, name in zip(found, listed, strict=True) if not f"{line} ".startswith(f"{name} ")] == []
    (row,) = [line for line in lines if line.startswith("  SPB ")]
    assert row.split() == ["SPB", "1", "belt", "13", "114", "0.088", "194", "0.3", "38°", "140"]


def test_lists_ones_own_behind(run_main: RunMain, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE)
    code, output, _ = run_main(["catalogue", "--file", str(file)])
    assert code == 0
    (heading, row) = [line for line in output.splitlines() if line.startswith(("Other belts", "  mine "))]
    assert heading.strip() == "Other belts"
    assert row.split() == ["mine", "1", "rib", "5", "21", "0.001", "20", "36°"]
    assert output.index("round-92A") < output.index("mine")


def test_shows_one(run_main: RunMain) -> None:
    code, output, error = run_main(["catalogue", "PJ"])
    assert (code, error) == (0, "")
    entry = read_catalogue()["PJ"]
    assert output.startswith(f"PJ: {entry.title}. Generic values.\n\nValues of 1 rib\n")
    words = " ".join(output.split())
    for fact in (
        *("axial_stiffness 7 kN", "mass_per_length 9 g/m", "pitch_offset 1.2 mm from the inside surface"),
        "diameter = effective diameter; the tension line is 1.2 mm outside",
        "nominal_length = effective length; the tension line is 7.54 mm longer",
        *(
            "smallest pulley 20 mm of effective diameter",
            "friction in grooves 0.936",
            "bending_loss_factor 0.15",
            'profile = "PJ" ribs = 1',
        ),
        " ".join(entry.source.split()),
    ):
        assert fact in words


@pytest.mark.parametrize(
    ("profile", "facts"),
    [
        (
            "SPB",
            (
                "14 mm, the pitch or datum width",
                "diameter = datum diameter; the tension line is at that diameter",
                "of that length",
            ),
        ),
        ("flat-aramid", ("Values of 10 mm width", "diameter = outside diameter", "inside length", 'width = "50 mm"')),
        ("HTD 8M", ("8 mm", "185 N/mm a tooth", "teeth = 100", "Teeth: Stiffness: estimate, shear of a tooth")),
        ("round-85A", ("Values of 6 mm diameter", 'diameter = "8 mm"')),
    ],
)
def test_shows_each_sort(run_main: RunMain, profile: str, facts: tuple[str, ...]) -> None:
    words = " ".join(run_main(["catalogue", profile])[1].split())
    for fact in facts:
        assert fact in words


def test_shows_ones_own(run_main: RunMain, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE)
    code, output, _ = run_main(["catalogue", "mine", "--file", str(file)])
    assert code == 0
    assert output.startswith("mine: Measured belt.\n")
    assert "2e-05 s" in output
    assert "friction" not in output


def test_a_wrong_name_tells_near_ones(run_main: RunMain) -> None:
    code, output, error = run_main(["catalogue", "SPD"])
    assert (code, output) == (2, "")
    assert error == 'error: profile = "SPD" is not in the catalogue. Similar names: SPZ, SPA, SPB, SPC.\n'


def test_a_bad_file_is_bad_input(run_main: RunMain, tmp_path: Path) -> None:
    code, output, error = run_main(["catalogue", "--file", str(tmp_path / "nix.toml")])
    assert (code, output) == (2, "")
    assert error.startswith("error: catalogue = ")
    assert "cannot be read" in error


def written(name: str, entry: Entry) -> str:
    """A drive of two pulleys, twice as large as the smallest, with a belt stretched by 0.3 %, elastic ones by 3 %."""
    size = {"ribs": "ribs = 2", "width": 'width = "30 mm"', "diameter": 'diameter = "6 mm"'}[entry.sold_by]
    times = {"ribs": 2.0, "width": 0.03 / entry.width, "diameter": 1.0}[entry.sold_by]
    soft = entry.axial_stiffness < 1e6 * entry.width
    tension = times * entry.axial_stiffness * (0.03 if soft else 0.003)
    diameter = 2 * (entry.smallest_diameter or 0.08)
    sized = f"diameter = {diameter}"
    if entry.toothing is not None:
        pitch = entry.toothing.pitch
        teeth = round(pi * diameter / pitch)
        sized = f"teeth = {teeth}"
        size += f"\nteeth = {teeth + round(5.0 * diameter / pitch)}"
    pulleys = "".join(
        f'[[pulley]]\nname = "{one}"\ncenter = [{place}, 0]\n{sized}\ninertia = 0.01\n'
        for one, place in (("a", 0.0), ("b", 2.5 * diameter))
    )
    if entry.toothing is not None:
        pulleys += '[[tensioner]]\nkind = "fixed"\npulley = "b"\ndirection = [1.0, 0.0]\n'
    return (
        f'[belt]\nprofile = "{name}"\n{size}\ninstalled_tension = {tension}\n{pulleys}'
        "[contact]\n"
        "[simulation]\nduration = 1\noutput_interval = 0.01\n"
    )


@pytest.mark.parametrize("name", sorted(read_catalogue()))
def test_each_makes_a_drive(name: str) -> None:
    """At rest it has about the tension that stretches it as much."""
    drive = loads(written(name, read_catalogue()[name]))
    wanted = drive.belt.installed_tension
    assert wanted is not None
    assert install(drive).tension == pytest.approx(wanted, rel=1e-6)
    assert drive.belt.toothing or drive.frictions.min() > 0.2


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(read_catalogue()))
def test_each_can_be_checked(run_main: RunMain, tmp_path: Path, name: str) -> None:
    file = tmp_path / "drive.toml"
    file.write_text(written(name, read_catalogue()[name]))
    code, output, _ = run_main(["check", str(file)])
    assert code == 0
    assert "Spans at rest" in output
    assert "No static equilibrium" not in output

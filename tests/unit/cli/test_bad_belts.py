"""Every belt that is not one gives one clear message: the key, the value, the rule and the remedy."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

Refuse = Callable[[list[str]], str]

STIFF = "axial_stiffness = 1e4\nbending_stiffness = 8e-3\nmass_per_length = 0.1\n"
SIZE = "width = 0.01\nthickness = 0.01\n"
GOOD = """[mine]
title = "Belt of ours"
width = "4 mm"
thickness = "5 mm"
axial_stiffness = "20 kN"
bending_stiffness = 1e-3
mass_per_length = 0.02
source = "measured"
"""

CASES: dict[str, tuple[str, tuple[str, ...]]] = {
    # two forms at once
    "material and stiffness": (
        f"{SIZE}{STIFF}youngs_modulus = 1e8",
        ("belt: axial_stiffness and youngs_modulus exclude each other", "Keep one of the forms"),
    ),
    "material and profile": (
        'profile = "PK"\nribs = 6\ndensity = 1000.0',
        ("belt: profile and density exclude each other", "Keep one"),
    ),
    "factor and profile": ('profile = "PK"\nribs = 6\nbending_factor = 0.5', ("profile and bending_factor exclude",)),
    # stiffnesses
    "missing stiffness": (
        f"{SIZE}axial_stiffness = 1e4\nmass_per_length = 0.1",
        ("belt.bending_stiffness is missing",),
    ),
    "missing width": (f"thickness = 0.01\n{STIFF}", ("belt.width is missing", "Give the width of the belt")),
    "negative stiffness": (
        SIZE + STIFF.replace("1e4", "-1e4"),
        ("belt.axial_stiffness = -10000.0 must be greater than 0", "Give the axial stiffness"),
    ),
    "stiffness in Pa": (SIZE + STIFF.replace("1e4", '"10 kPa"'), ("must be in units of N",)),
    "stiffness without end": (SIZE + STIFF.replace("1e4", "1e14"), ("belt.youngs_modulus", "too large")),
    # profile and ribs
    "no ribs": ('profile = "PK"', ("belt: ribs is missing", 'profile "PK" is sold by ribs, each 3.56 mm wide')),
    "zero ribs": ('profile = "PK"\nribs = 0', ("belt.ribs = 0 must be at least 1", "Give the number of ribs")),
    "half a rib": ('profile = "PK"\nribs = 5.5', ("belt.ribs = 5.5 must be a whole number",)),
    "ribs of a flat belt": (
        'profile = "flat-aramid"\nribs = 6\nwidth = 0.02',
        ('ribs = 6 is incompatible with profile "flat-aramid"', "sold by width", "Give width"),
    ),
    "flat belt without width": ('profile = "flat-aramid"', ("width is missing", "is sold by width", "Give it")),
    "round belt without diameter": ('profile = "round-85A"', ("diameter is missing", "is sold by diameter")),
    "round belt of ribs": ('profile = "round-85A"\nribs = 2', ("ribs = 2 is incompatible", "Give diameter instead")),
    "V-belt by diameter": (
        'profile = "SPB"\ndiameter = 0.1',
        ("diameter = 0.1 is incompatible", "Give ribs instead"),
    ),
    "round belt of no diameter": (
        'profile = "round-85A"\ndiameter = 0',
        ("belt.diameter = 0 must be greater than 0", "Give the diameter of a round belt"),
    ),
    "two lengths": (
        'profile = "PJ"\nribs = 2\nnominal_length = 1.1',
        ("belt: length and nominal_length exclude each other", "Keep one of them"),
    ),
    "flat belt of no width": (
        'profile = "flat-aramid"\nwidth = 0',
        ("belt.width = 0 must be greater than 0", "Give the width of the belt"),
    ),
    "ribs of nothing": ("ribs = 6", ("belt.profile is missing", "the name of the belt's profile")),
    "unknown profile": (
        'profile = "PX"\nribs = 6',
        ('profile = "PX" is not in the catalogue', "Similar names: PJ, PK, PL, PM", 'catalogue = "file.toml"'),
    ),
    "profile by number": ("profile = 6\nribs = 6", ("belt.profile = 6 must be text in quotation marks",)),
    # the user's catalogue
    "no such catalogue": (
        'profile = "mine"\nribs = 2\ncatalogue = "nix.toml"',
        ('belt: catalogue = "nix.toml" cannot be read', "no such file", "folder of the drive file"),
    ),
    "catalogue is a folder": ('profile = "mine"\nribs = 2\ncatalogue = "."', ("is a directory",)),
    "catalogue not text": ('profile = "mine"\nribs = 2\ncatalogue = "binary.toml"', ("not UTF-8 text",)),
    "catalogue not TOML": ('profile = "mine"\nribs = 2\ncatalogue = "words.toml"', ("not valid TOML", "line 1")),
    "catalogue by number": ('profile = "mine"\nribs = 2\ncatalogue = 3', ("belt.catalogue = 3 must be text",)),
    "entry is a number": ('profile = "mine"\nribs = 2\ncatalogue = "number.toml"', ("mine must be a group of keys",)),
    "entry without source": (
        'profile = "mine"\nribs = 2\ncatalogue = "unsourced.toml"',
        ('"unsourced.toml", profile mine: entry.source is missing', "the source of the values"),
    ),
    "entry of no stiffness": (
        'profile = "mine"\nribs = 2\ncatalogue = "limp.toml"',
        ("profile mine: entry.axial_stiffness", "must be greater than 0", "Give the axial stiffness"),
    ),
    "misspelled entry": (
        'profile = "mine"\nribs = 2\ncatalogue = "misspelled.toml"',
        ("entry.thicknes is not a known key", '"thickness"'),
    ),
    # wedge and damping
    "wide wedge": (f"{SIZE}{STIFF}wedge_angle = 40", ("belt.wedge_angle = 40 must be at most 3.14159",)),
    "no wedge": (f"{SIZE}{STIFF}wedge_angle = 0", ("belt.wedge_angle = 0 must be greater than 0",)),
    "wedge in meters": (f'{SIZE}{STIFF}wedge_angle = "40 mm"', ("must be in units of rad",)),
    "negative damping": (f"{SIZE}{STIFF}stretch_damping_time = -1", ("must be at least 0", "Give the damping time")),
    "damped truss": (
        f'{SIZE}{STIFF}bending_damping_time = 1e-3\nelements = 21\ndiscretization = "truss"',
        ('bending_damping_time = 0.001 s is incompatible with discretization = "truss"', 'set discretization = "ancf"'),
    ),
    "beam with hysteresis": (
        f'{SIZE}{STIFF}stretch_loss_factor = 0.1\nelements = 21\ndiscretization = "three-node-beam"',
        (
            'stretch_loss_factor = 0.1 is incompatible with discretization = "three-node-beam"',
            "Set stretch_loss_factor = 0",
        ),
    ),
    "large loss factor": (f"{SIZE}{STIFF}bending_loss_factor = 2", ("belt.bending_loss_factor = 2 must be at most 1",)),
    "two losses of bending": (
        f"{SIZE}{STIFF}bending_damping_time = 1e-3\nbending_loss_factor = 0.1",
        ("bending_damping_time = 0.001 s and bending_loss_factor = 0.1 exclude each other", "Keep one of them"),
    ),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "words.toml").write_text("belts of mine")
    (tmp_path / "number.toml").write_text("mine = 3")
    (tmp_path / "unsourced.toml").write_text(GOOD.replace('source = "measured"', ""))
    (tmp_path / "limp.toml").write_text(GOOD.replace('"20 kN"', "0.0"))
    (tmp_path / "misspelled.toml").write_text(GOOD.replace("thickness", "thicknes"))
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00\x01")
    return tmp_path


@pytest.fixture
def with_belt(drive_text: str) -> Callable[[str], str]:
    """The paper's drive with another section of its belt."""
    start, end = drive_text.index("width"), drive_text.index("[[pulley]]")
    return lambda section: f"{drive_text[:start]}{section}\n\n{drive_text[end:]}"


@pytest.mark.parametrize("name", CASES)
def test_message(name: str, with_belt: Callable[[str], str], folder: Path, refuse: Refuse) -> None:
    section, parts = CASES[name]
    file = folder / "drive.toml"
    file.write_text(with_belt(section), encoding="utf-8")
    message = refuse(["check", str(file)])
    for part in parts:
        assert part in message
    assert message.startswith("error: ")
    assert len(message.splitlines()) == 1
    assert not re.search(r"Traceback|pydantic|Input should|ValidationError|tuple|dict", message)


@pytest.mark.parametrize(
    ("gravity", "part"),
    [
        ("9.81", "gravity = 9.81 must be a list"),
        ("[0.0]", "gravity[2] is missing"),
        ('[0.0, "9.81 m"]', "must be in units of m/s^2"),
    ],
)
def test_gravity(gravity: str, part: str, drive_text: str, tmp_path: Path, refuse: Refuse) -> None:
    file = tmp_path / "drive.toml"
    file.write_text(f"gravity = {gravity}\n{drive_text}", encoding="utf-8")
    assert part in refuse(["check", str(file)])


def test_friction_of_a_pulley(drive_text: str, tmp_path: Path, refuse: Refuse) -> None:
    file = tmp_path / "drive.toml"
    file.write_text(drive_text.replace("inertia = 0.1", "inertia = 0.1\nfriction = -1"), encoding="utf-8")
    assert "pulley[driven].friction = -1 must be at least 0" in refuse(["check", str(file)])

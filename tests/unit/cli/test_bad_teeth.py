"""Teeth that cannot mesh give one clear message each: the key, the value, the rule and the remedy."""

from collections.abc import Callable
from pathlib import Path

import pytest

Refuse = Callable[[list[str]], str]

DRIVE = """[belt]
profile = "HTD 8M"
width = "20 mm"
teeth = 60

[[pulley]]
name = "driver"
center = [0, 0]
teeth = 24
speed = "500 rpm"

[[pulley]]
name = "driven"
center = ["144.5 mm", 0]
teeth = 24
inertia = 1e-3

[simulation]
duration = 0.01
"""
DRIVEN = 'name = "driven"'

CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "half teeth of the belt": ("teeth = 60", "teeth = 60.5", ("belt.teeth = 60.5 must be a whole number",)),
    "half teeth of a pulley": ("teeth = 24\nspeed", "teeth = 24.5\nspeed", ("pulley[driver].teeth = 24.5 must be",)),
    "too short to mesh": (
        "144.5 mm",
        "250 mm",
        ("belt.teeth = 60 is too short to mesh", "86.55 pitches of 8 mm", "Give 87 teeth, or move the pulleys closer"),
    ),
    "crossed": ("teeth = 60", "teeth = 60\ncrossed = true", ("crossed = true is incompatible with teeth", "Omit it")),
    "teeth on the back": (
        DRIVEN,
        f'{DRIVEN}\nside = "outside"',
        ('pulley[driven]: teeth = 24 is incompatible with side = "outside"', "Omit teeth"),
    ),
    "twisted": (DRIVEN, f'{DRIVEN}\ntilt = ["90 deg", 0]', ("pulley[driven].tilt", "must be less than 0.5")),
    "mixed pitches": (
        DRIVEN,
        f'{DRIVEN}\ndiameter = "80 mm"',
        ("a pitch of 10.652 mm, but the belt has a pitch of 8 mm", "Omit radius and diameter, which follow"),
    ),
    "no teeth of the belt": ("teeth = 60\n", "", ("belt: teeth is missing", "a pitch of 8 mm", "Give their number")),
    "no teeth of a pulley": (
        "teeth = 24\nspeed",
        "speed",
        ("pulley[driver].radius is missing", "of a toothed one, teeth"),
    ),
    "tension without take-up": (
        "teeth = 60",
        "teeth = 60\ninstalled_tension = 300",
        ("belt.teeth and belt.installed_tension are both given", 'kind = "fixed"', "remove teeth or"),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_message(name: str, tmp_path: Path, refuse: Refuse) -> None:
    old, new, parts = CASES[name]
    assert old in DRIVE
    file = tmp_path / "drive.toml"
    file.write_text(DRIVE.replace(old, new, 1), encoding="utf-8")
    message = refuse(["check", str(file)])
    for part in parts:
        assert part in message
    assert message.startswith("error: ")
    assert len(message.splitlines()) == 1

"""Teeth that cannot mesh give one clear message each: the key, the value, the rule and the remedy."""

from collections.abc import Callable
from importlib.resources import files
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
        ("belt.teeth = 60 is too short to mesh", "86.55 pitches of 8 mm", "Give 86 teeth, or move the pulleys closer"),
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
    "speeds that disagree": (
        DRIVEN,
        f'{DRIVEN}\nspeed = "490 rpm"',
        ("pulley[driven] turns at 490 rpm", "at 500 rpm", 'as "driver" has 24', "Omit one of both speeds"),
    ),
    "senses that disagree": (
        DRIVEN,
        f'{DRIVEN}\nspeed = "-500 rpm"',
        ("pulley[driven] turns at -500 rpm", "at 500 rpm"),
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


AXES = ("printer_axis", "gantry_axis")
OF_STEADY_RUNNING = (
    *(["steady-state"], ["sheet"], ["operating-map", "--speed", "100 rpm"], ["duty", "--table", "duty.csv"]),
    *(["traction"], ["rating"], ["sensitivity"], ["modes"], ["campbell", "--speed", "100 rpm"]),
    *(["response", "--speed", "100 rpm"], ["tensioner-sheet"], ["life"]),
)


@pytest.mark.parametrize("command", OF_STEADY_RUNNING, ids=lambda words: words[0])
@pytest.mark.parametrize("name", AXES)
def test_an_axis_is_refused_where_it_cannot_run_steadily(
    name: str, command: list[str], refuse: Refuse, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two pulleys and a carriage: one message each, from any command."""
    monkeypatch.chdir(tmp_path)
    Path("duty.csv").write_text("share [%], speed [rpm]\n50, 100\n50, 200\n", encoding="utf-8")
    Path("axis.toml").write_text(files("beltdyn").joinpath("examples", f"{name}.toml").read_text("utf-8"), "utf-8")
    said = refuse([command[0], "axis.toml", *command[1:]])
    assert said.count("error: ") == 1


@pytest.mark.slow
def test_a_sheet_of_a_motor_that_stands_asks_for_speeds(
    refuse: Refuse, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("axis.toml").write_text(files("beltdyn").joinpath("examples", "servo_axis.toml").read_text("utf-8"), "utf-8")
    assert 'Give them by speed, such as "100..3000 rpm"' in refuse(["sheet", "axis.toml"])

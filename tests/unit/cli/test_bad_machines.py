"""Every wrong key of what is around the belt gives one clear message: the key, the value, the rule and the remedy."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

Refuse = Callable[[list[str]], str]

FIXED = '[[tensioner]]\nkind = "fixed"\npulley = "driven"\ndirection = [1, 0]\n'
SLIDING = '[[tensioner]]\nkind = "sliding"\npulley = "driven"\ndirection = [1, 0]\nmass = 1\npreload = 100\n'
ROTARY = '[[tensioner]]\nkind = "rotary"\npulley = "driven"\npivot = [0.19, -0.09]\ninertia = 1e-3\npreload = 5\n'
RESISTANCE = 'load = [{ kind = "resistance", linear = 0.1, '
TABLE = 'load = [{ kind = "table", '
MOTOR = 'load = [{ kind = "motor", breakdown_torque = 1, breakdown_slip = 0.1, synchronous_speed = 100 }]'
ISOLATOR = 'hub = [{ kind = "isolator", stiffness = 1, inertia = 0.1 }]'
ONE_WAY = 'hub = [{ kind = "one_way_clutch", locking_damping = 1, inertia = 0.1 }]'
CLUTCH = 'hub = [{ kind = "friction_clutch", locking_damping = 1, capacity = 5, inertia = 0.1 }]'
MAP = '[tensioner]\nkind = "fixed"\npulley = "driven"\ndirection = [1, 0]\n'

PULLEYS: dict[str, tuple[str, str, tuple[str, ...]]] = {
    # harmonics
    "harmonics without speed": (
        "driven",
        "harmonics = [{ order = 2, amplitude = 0.1 }]",
        ("pulley[driven] has harmonics but no speed", "Give the mean speed"),
    ),
    "harmonic without order": ("driver", "harmonics = [{ amplitude = 0.1 }]", ("harmonics[1].order is missing",)),
    "harmonic of order zero": (
        "driver",
        "harmonics = [{ order = 0, amplitude = 0.1 }]",
        ("pulley[driver].harmonics[1].order = 0 must be greater than 0", "waves per turn"),
    ),
    "phase in mm": (
        "driver",
        'harmonics = [{ order = 2, amplitude = 0.1, phase = "3 mm" }]',
        ("harmonics[1].phase", "must be in units of rad"),
    ),
    "amplitude in rpm": (
        "driver",
        'harmonics = [{ order = 2, amplitude = "10 rpm" }]',
        ("harmonics[1].amplitude", "must be a number without a unit", "over the value without harmonics"),
    ),
    "misspelled harmonic": ("driver", "harmonics = [{ order = 2, amplitud = 1 }]", ('Did you mean "amplitude"?',)),
    "one harmonic without list": (
        "driver",
        "harmonics = { order = 2, amplitude = 0.1 }",
        ("pulley[driver].harmonics", "must be a list"),
    ),
    # pulleys
    "negative mass": ("driven", "mass = -1", ("pulley[driven].mass = -1 must be at least 0",)),
    "speed and load": (
        "driver",
        'load = [{ kind = "resistance", linear = 1 }]',
        ("pulley[driver]: speed and load exclude", "Remove one"),
    ),
    "motor and speed": ("driver", MOTOR, ("pulley[driver]: speed and load exclude each other",)),
    # loads
    "load without kind": (
        "driven",
        "load = [{ linear = 1 }]",
        ("load[1]", "has no kind", "motor, power, pump, resistance, servo_motor, speed_trim, table, torque_trim"),
    ),
    "load without list": ("driven", 'load = { kind = "resistance" }', ("must be a list", "[[pulley.load]]")),
    "misspelled load": ("driven", 'load = [{ kind = "resistence" }]', ("load[1].kind", 'Did you mean "resistance"?')),
    "no resistance": ("driven", 'load = [{ kind = "resistance" }]', ("load[1] has no resistance", "Give constant")),
    "negative resistance": (
        "driven",
        f"{RESISTANCE}constant = -1 }}]",
        ("load[1].constant = -1 must be at least 0", "Give the part independent of speed"),
    ),
    "linear resistance in N m": (
        "driven",
        'load = [{ kind = "resistance", linear = "1 N m" }]',
        ("load[1].linear", 'units of N*m*s/rad, not "N m"'),
    ),
    "creep speed of zero": ("driven", f"{RESISTANCE}creep_speed = 0 }}]", ("creep_speed = 0 must be greater than 0",)),
    "uneven table": (
        "driven",
        f"{TABLE}speeds = [0, 1], torques = [0, 1, 2] }}]",
        ("load[1]: speeds has 2 numbers but torques has 3", "Give one torque for each speed"),
    ),
    "table backwards": (
        "driven",
        f"{TABLE}speeds = [1, 0], torques = [0, 1] }}]",
        ("speeds must increase, but 0 follows 1", "Sort the points by speed"),
    ),
    "table twice": (
        "driven",
        f'{TABLE}file = "a.csv", speeds = [0, 1] }}]',
        ("file and speeds and torques exclude each other",),
    ),
    "table of no file": ("driven", f'{TABLE}file = "nix.csv" }}]', ("load[1]", "nix.csv", "no such file")),
    "table without torques": ("driven", f"{TABLE}speeds = [0, 1] }}]", ("load[1].torques is missing",)),
    "motor of all slip": ("driven", MOTOR.replace("0.1", "2"), ("breakdown_slip = 2 must be at most 1", "0 to 1")),
    "motor of no slip": ("driven", MOTOR.replace("0.1", "0"), ("breakdown_slip = 0 must be greater than 0",)),
    "motor that stands": (
        "driven",
        MOTOR.replace("100", "0"),
        ("synchronous_speed = 0 leaves the slip undefined", "Give a speed other than zero"),
    ),
    "motor in hertz": ("driven", MOTOR.replace("100", '"25 Hz"'), ("synchronous_speed", "ambiguous", '"1500 rpm"')),
    # schedules
    "schedule above one": (
        "driven",
        f'{RESISTANCE}schedule = {{ kind = "constant", value = 2 }} }}]',
        ("load[1].schedule.value = 2 must be at most 1",),
    ),
    "schedule below zero": (
        "driven",
        f'{RESISTANCE}schedule = {{ kind = "step", time = 1, before = -1, value = 1 }} }}]',
        ("load[1].schedule.before = -1 must be at least 0",),
    ),
    "schedule of no file": (
        "driven",
        f'{RESISTANCE}schedule = {{ kind = "table", file = "nix.csv" }} }}]',
        ("load[1].schedule", "nix.csv", "no such file", "folder of the drive file"),
    ),
    "schedule as a flag": ("driven", f"{RESISTANCE}schedule = true }}]", ("load[1].schedule = true has no kind",)),
    # hub chains
    "link without kind": ("driven", "hub = [{ inertia = 1 }]", ("hub[1]", "has no kind", "one_way_clutch")),
    "misspelled link": ("driven", 'hub = [{ kind = "clutch" }]', ("hub[1].kind", 'Did you mean "one_way_clutch"?')),
    "negative link": (
        "driven",
        ISOLATOR.replace("stiffness = 1", "stiffness = -1"),
        ("hub[1].stiffness = -1 must be greater than 0", "Give the torque over the twist"),
    ),
    "link in N/m": ("driven", ISOLATOR.replace("= 1,", '= "1 N/m",'), ("hub[1].stiffness", "units of N*m/rad")),
    "link without stiffness": ("driven", ISOLATOR.replace("stiffness = 1, ", ""), ("hub[1].stiffness is missing",)),
    "clutch without inertia": (
        "driven",
        ONE_WAY.replace(", inertia = 0.1", ""),
        ("pulley[driven]: hub[1] has no inertia", "Give an inertia above zero"),
    ),
    "rim without inertia": ("driver", ISOLATOR, ("pulley[driver] has a hub chain but no inertia", "free rim")),
    "clutch of a third sense": (
        "driven",
        ONE_WAY.replace("inertia", 'drives = "ccw", inertia'),
        ("hub[1].drives", '"ccw"', "forward, backward"),
    ),
    "clutch that pulls": (
        "driven",
        ONE_WAY.replace("inertia", "drag_torque = -1, inertia"),
        ("hub[1].drag_torque = -1 must be at least 0",),
    ),
    "clutch of no capacity": ("driven", CLUTCH.replace("= 5", "= 0"), ("capacity = 0 must be greater than 0",)),
    "clutch without capacity": ("driven", CLUTCH.replace("capacity = 5, ", ""), ("hub[1].capacity is missing",)),
    "capacity as schedule": (
        "driven",
        CLUTCH.replace("inertia", 'schedule = { kind = "ramp", start = 0, end = 1, value = "25 N m" }, inertia'),
        ("hub[1].schedule.value", "must be a number without a unit"),
    ),
}

TENSIONERS: dict[str, tuple[str, tuple[str, ...]]] = {
    # all kinds
    "no kind": (
        SLIDING.replace('kind = "sliding"\n', ""),
        ("tensioner[driven]", "has no kind", "rotary, sliding"),
    ),
    "misspelled kind": (SLIDING.replace('"sliding"', '"slide"'), ("tensioner[driven].kind", 'Did you mean "sliding"?')),
    "unknown pulley": (
        SLIDING.replace('"driven"', '"idler"'),
        ('tensioner[1].pulley = "idler" is not the name of a pulley', "driver, driven"),
    ),
    "no pulley": (FIXED.replace('pulley = "driven"\n', ""), ("tensioner[1].pulley is missing",)),
    "two of one pulley": (SLIDING + ROTARY, ('pulley "driven" is carried by 2 tensioners', "Remove the others")),
    "no list": (MAP, ("must be a list", "[[tensioner]]")),
    "key of another kind": (f"{SLIDING}pivot = [0, 0]", ("tensioner[driven].pivot is not a known key", "direction")),
    # fixed
    "fixed without direction": (FIXED.replace("direction = [1, 0]\n", ""), ("tensioner[driven].direction is missing",)),
    "take-up in N": (f'{FIXED}take_up = "1 N"', ("tensioner[driven].take_up", "must be in units of m")),
    "take-up that slackens": (f'{FIXED}take_up = "-5 mm"', ("would hang slack", "Shorten it, or move the pulleys")),
    # sliding
    "no direction at all": (SLIDING.replace("[1, 0]", "[0, 0]"), ("has zero length", "Give the direction")),
    "direction in space": (
        SLIDING.replace("[1, 0]", "[1, 0, 0]"),
        ("[driven].direction", "more than 2 entries"),
    ),
    "direction inwards": (SLIDING.replace("[1, 0]", "[-1, 0]"), ("cannot tension the belt", "Choose a direction")),
    "no preload": (
        SLIDING.replace("preload = 100\n", ""),
        ("[driven].preload is missing", "spring force"),
    ),
    "preload in N m": (SLIDING.replace("100", '"5 N m"'), ("tensioner[driven].preload", 'units of N, not "N m"')),
    "preload that pulls": (
        SLIDING.replace("100", "-100"),
        ('pushes the tensioner of "driven" back', "increase the prel"),
    ),
    "no preload to hold": (SLIDING.replace("100", "0"), ("as placed by the tensioners", "or increase the preload")),
    "preload without end": (SLIDING.replace("100", "1e6"), ("too short", "1803%", "or reduce the preload")),
    "negative rate": (
        f"{SLIDING}rate = -1",
        ("tensioner[driven].rate = -1 must be at least 0", "Give the spring rate"),
    ),
    "rate about a pivot": (f'{SLIDING}rate = "1 N m/rad"', ("tensioner[driven].rate", "must be in units of N/m")),
    "negative dry friction": (f"{SLIDING}yielding_friction = -1", ("yielding_friction = -1 must be at least 0",)),
    "nothing moves": (SLIDING.replace("mass = 1", "mass = 0"), ("has no moving mass", "Give the mass")),
    # stops
    "stops in wrong order": (
        f"{SLIDING}stops = [0.01, -0.01]\nstop_stiffness = 1e5",
        ("tensioner[driven]: stops = [0.01, -0.01] must be a lower and an upper stop", "on both sides of zero"),
    ),
    "stops beside the center": (f"{SLIDING}stops = [0.01, 0.02]\nstop_stiffness = 1e5", ("on both sides of zero",)),
    "one stop": (f"{SLIDING}stops = [0.01]\nstop_stiffness = 1e5", ("tensioner[driven].stops[2] is missing",)),
    "hard stops": (f"{SLIDING}stops = [-0.01, 0.01]", ("stop_stiffness is missing, but stops are springs",)),
    "stiffness of no stops": (f"{SLIDING}stop_stiffness = 1e5", ("tensioner[driven]: stops is missing", "Give stops")),
    "damping of no stops": (f"{SLIDING}stop_damping = 10", ("tensioner[driven]: stops is missing", "Give stops")),
    # rotary
    "no pivot": (ROTARY.replace("pivot = [0.19, -0.09]\n", ""), ("tensioner[driven].pivot is missing",)),
    "pivot at the center": (ROTARY.replace("[0.19, -0.09]", "[0.191441, 0]"), ("is the center of the pulley",)),
    "dead center": (ROTARY.replace("[0.19, -0.09]", "[0, 0]"), ("hardly changes the length", "Move its pivot")),
    "arm without inertia": (ROTARY.replace("inertia = 1e-3\n", ""), ("has no moving mass",)),
    "moment in N": (ROTARY.replace("preload = 5", 'preload = "5 N"'), ("tensioner[driven].preload", "units of N*m")),
    "stops in degrees without unit": (
        f"{ROTARY}stops = [-1, 15]\nstop_stiffness = 100",
        ("tensioner[driven].stops[2] = 15 must be at most 3.14159", "in rad"),
    ),
}

TIGHTENED: dict[str, tuple[str, tuple[str, ...]]] = {
    "sliding": (SLIDING, ("are both given, with 0 fixed tensioners", "Give one [[tensioner]]")),
    "two fixed": (FIXED + FIXED.replace("driven", "driver"), ("with 2 fixed tensioners", "remove length or")),
    "take-up given": (f'{FIXED}take_up = "5 mm"', ('"driven" has take_up = 0.005 m', "Remove one of the three")),
    "across": (FIXED.replace("[1, 0]", "[0, 1]"), ('no take-up of "driven"', "hardly changes", "the direction")),
}


@pytest.fixture
def message(drive_text: str, tmp_path: Path, refuse: Refuse) -> Callable[[str], str]:
    """The one message about a drive file."""

    def read(text: str) -> str:
        file = tmp_path / "drive.toml"
        file.write_text(text, encoding="utf-8")
        said = refuse(["check", str(file)])
        assert text != drive_text
        assert said.startswith("error: ")
        assert len(said.splitlines()) == 1
        assert not re.search(r"Traceback|pydantic|Input should|ValidationError|tuple|dict", said)
        assert [path.name for path in tmp_path.iterdir()] == ["drive.toml"]
        return said

    return read


@pytest.mark.parametrize("name", PULLEYS)
def test_pulley(name: str, drive_text: str, message: Callable[[str], str]) -> None:
    where, keys, parts = PULLEYS[name]
    said = message(drive_text.replace(f'name = "{where}"', f'name = "{where}"\n{keys}'))
    for part in parts:
        assert part in said


@pytest.mark.parametrize("name", TENSIONERS)
def test_tensioner(name: str, drive_text: str, message: Callable[[str], str]) -> None:
    keys, parts = TENSIONERS[name]
    said = message(drive_text.replace("[contact]", f"{keys}\n[contact]"))
    for part in parts:
        assert part in said


@pytest.mark.parametrize("name", TIGHTENED)
def test_belt_of_given_length_and_tension(name: str, drive_text: str, message: Callable[[str], str]) -> None:
    keys, parts = TIGHTENED[name]
    text = drive_text.replace("[contact]", f"{keys}\n[contact]")
    said = message(text.replace("length = 1.2727", "length = 1.2727\ninstalled_tension = 50"))
    for part in parts:
        assert part in said

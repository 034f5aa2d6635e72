"""Every bad input gives one clear message: the key, the value, the rule and the remedy."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

Refuse = Callable[[list[str]], str]


class Case(NamedTuple):
    """A change of the paper's drive file, and what the message must hold."""

    name: str
    old: str
    new: str
    parts: tuple[str, ...]


BELT = "length = 1.2727"
DRIVER = "center = [-0.191441, 0.0]\nradius = 0.08125"
DRIVEN = "center = [0.191441, 0.0]\nradius = 0.08125"
SPEED = 'speed = { kind = "ramp", start = 0.05, end = 0.6, value = 12.0 }'
TORQUE = 'torque = { kind = "cosine_ramp", start = 0.05, end = 0.6, value = 0.0 }'
THIRD = '\n[[pulley]]\nname = "idler"\ninertia = 0.1\n'
FOURTH = THIRD.replace("idler", "low")

CASES = (
    # keys
    Case("misspelled key", "density =", "densitty =", ("belt.densitty", "not a known key", '"density"')),
    Case("misspelled group", "[contact]", "[contacts]", ("contacts is not a known key", '"contact"')),
    Case("unknown key", "friction = 1.2", "friction = 1.2\ncolour = 3", ("contact.colour", "Choose one of stiffness")),
    Case("key of another group", "density =", "radius = 1\ndensity =", ("belt.radius is not a known key",)),
    Case(
        "misspelled profile key",
        "end = 0.6, value = 12.0",
        "stop = 0.6, value = 12.0",
        ("pulley[driver].speed.end is missing", "the end of the rise"),
    ),
    Case("missing length", BELT, "", ("belt.length is missing", "unstretched length", "installed_tension")),
    Case(
        "stiffness twice",
        "stiffness = 1e7",
        'stiffness = 1e7\nallowed_penetration = "20 um"',
        ("contact: stiffness and allowed_penetration exclude each other", "Remove one"),
    ),
    Case(
        "length twice",
        BELT,
        f"{BELT}\ninstalled_tension = 30",
        ("belt.length and belt.installed_tension are both given", "0 fixed tensioners", "Give one [[tensioner]]"),
    ),
    Case("side", DRIVEN, f'{DRIVEN}\nside = "edge"', ("pulley[driven].side", '"edge"', "inside, outside")),
    Case(
        "outside of two",
        DRIVEN,
        f'{DRIVEN}\nside = "outside"',
        ("the belt would cross itself", 'Set side = "inside" for "driven"', "belt.crossed = true"),
    ),
    Case("crossed without crossing", BELT, f"{BELT}\ncrossed = true", ("no spans cross", 'side = "outside"')),
    Case(
        "negative penetration",
        "stiffness = 1e7",
        'allowed_penetration = "-20 um"',
        ("contact.allowed_penetration", "must be greater than 0"),
    ),
    Case(
        "moment arm",
        'moment_arm = "point"',
        'moment_arm = "rims"',
        ("contact.moment_arm", '"rims"', 'Did you mean "rim"?'),
    ),
    Case("crossed by a number", BELT, f"{BELT}\ncrossed = 1", ("belt.crossed = 1 must be true or false",)),
    Case("negative offset", BELT, f"{BELT}\npitch_offset = -1e-3", ("belt.pitch_offset = -0.001", "at least 0")),
    Case("tension in kg", BELT, 'installed_tension = "3 kg"', ("belt.installed_tension", "must be in units of N")),
    Case("missing radius", DRIVEN, "center = [0.191441, 0.0]", ("pulley[driven].radius is missing",)),
    Case("missing name", 'name = "driver"\n', "", ("pulley[1].name is missing", "the name of the pulley")),
    Case("missing friction", "friction = 1.2", "", ("contact.friction is missing", "coefficient of friction")),
    # discretization
    Case(
        "discretisation",
        "elements = 20",
        'discretization = "trus"',
        ('belt.discretization = "trus"', 'Did you mean "truss"?'),
    ),
    Case("sampling", "damping = 10.0", 'sampling = "nodes"', ("contact.sampling", '"nodes"', 'Did you mean "nodal"?')),
    # numbers
    Case(
        "negative length", BELT, "length = -1.2727", ("belt.length = -1.2727", "greater than 0", "unstretched length")
    ),
    Case("zero width", "width = 0.01", "width = 0.0", ("belt.width = 0.0", "greater than 0")),
    Case("zero thickness", "thickness = 0.01", "thickness = 0", ("belt.thickness = 0", "greater than 0")),
    Case("NaN density", "density = 1036.0", "density = nan", ("belt.density = nan", "finite number")),
    Case(
        "infinite modulus",
        "youngs_modulus = 1e8",
        "youngs_modulus = inf",
        ("belt.youngs_modulus = inf", "finite", "Young's modulus"),
    ),
    Case("number too large", "density = 1036.0", f"density = 1{'0' * 400}", ("belt.density = 1000", "too large")),
    Case("length of the sky", BELT, "length = 1e20", ("belt.length = 1e+20", "too large", "1e+15")),
    Case("radius and diameter", DRIVER, f"{DRIVER}\ndiameter = 0.16", ("pulley[driver]: radius and diameter exclude",)),
    Case(
        "negative diameter",
        DRIVER,
        DRIVER.replace("radius = ", "diameter = -"),
        ("pulley[driver].diameter = -0.08125 must be greater than 0",),
    ),
    Case("radius of an atom", DRIVER, DRIVER.replace("0.08125", "1e-20"), ("radius = 1e-20", "too small")),
    Case(
        "Poisson's ratio",
        "poissons_ratio = 0.3",
        "poissons_ratio = 0.5",
        ("belt.poissons_ratio = 0.5", "less than 0.5"),
    ),
    Case("negative factor", "bending_factor = 0.01", "bending_factor = -0.01", ("belt.bending_factor = -0.01", "α₂")),
    Case(
        "two elements", "elements = 20", "elements = 2", ("belt.elements = 2", "at least 3", "number of belt elements")
    ),
    Case("too many elements", "elements = 20", "elements = 10000000", ("belt.elements = 10000000", "at most 10000")),
    Case("half an element", "elements = 20", "elements = 20.5", ("belt.elements = 20.5", "whole number")),
    Case("elements as text", "elements = 20", 'elements = "20"', ('belt.elements = "20"', "whole number")),
    Case("elastic points", "elements = 20", "quadrature_points = 11", ("belt.quadrature_points = 11", "at most 10")),
    Case("true as a number", "width = 0.01", "width = true", ("belt.width = true", "must be a number in m")),
    Case("list as a number", "width = 0.01", "width = [1]", ("belt.width = [1]", "must be a number")),
    Case("date as a number", "width = 0.01", "width = 2006-05-13", ("belt.width", "must be a number")),
    Case(
        "negative radius",
        DRIVER,
        DRIVER.replace("radius = ", "radius = -"),
        ("pulley[driver].radius = -0.08125", "greater than 0"),
    ),
    Case("negative inertia", "inertia = 0.1", "inertia = -0.1", ("pulley[driven].inertia = -0.1", "at least 0")),
    Case(
        "center of one number",
        "center = [-0.191441, 0.0]",
        "center = [-0.191441]",
        ("pulley[driver].center[2] is missing",),
    ),
    Case(
        "center of three",
        "center = [-0.191441, 0.0]",
        "center = [0, 0, 0]",
        ("pulley[driver].center", "[0, 0, 0]", "three coordinates, but drives are planar"),
    ),
    Case("center as a number", "center = [-0.191441, 0.0]", "center = 1.0", ("pulley[driver].center = 1.0", "list")),
    Case(
        "center not a number",
        "center = [-0.191441, 0.0]",
        "center = [nan, 0.0]",
        ("pulley[driver].center[1] = nan", "finite"),
    ),
    Case("negative stiffness", "stiffness = 1e7", "stiffness = -1", ("contact.stiffness = -1", "greater than 0")),
    Case("negative damping", "damping = 10.0", "damping = -10.0", ("contact.damping = -10.0", "at least 0")),
    Case("negative friction", "friction = 1.2", "friction = -1.2", ("contact.friction = -1.2", "at least 0")),
    Case(
        "contact points", "damping = 10.0", "quadrature_points = 65", ("contact.quadrature_points = 65", "at most 64")
    ),
    Case("zero duration", "duration = 1.0", "duration = 0", ("simulation.duration = 0", "greater than 0")),
    Case(
        "spectral radius",
        "duration = 1.0",
        "duration = 1.0\nspectral_radius = 1.1",
        ("simulation.spectral_radius = 1.1", "at most 1"),
    ),
    Case("tolerance", "duration = 1.0", "duration = 1.0\nrtol = 0", ("simulation.rtol = 0", "greater than 0")),
    # units
    Case("unit of a mass", BELT, 'length = "1.2 kg"', ('belt.length = "1.2 kg"', "must be in units of m")),
    Case("unknown unit", BELT, 'length = "1.2 furlogs"', ("belt.length", 'unknown unit "furlogs"', '"1.2 m"')),
    Case("text without unit", BELT, 'length = "1.2727"', ("belt.length", "has no unit", '"1.2727 m"')),
    Case("words", BELT, 'length = "long"', ('belt.length = "long"', "must be a number in m")),
    Case("unit that computes", BELT, 'length = "1 m**9**9**9"', ("belt.length", "has an unreadable unit")),
    Case("decimal comma", BELT, 'length = "1,27 m"', ("belt.length", "1,27 m", "decimal comma")),
    Case("unit of a ratio", "friction = 1.2", 'friction = "1.2 N"', ("contact.friction", "without a unit")),
    Case("speed in hertz", "value = 12.0", 'value = "2 Hz"', ("pulley[driver].speed.value", "ambiguous", '"120 rpm"')),
    Case("torque in newtons", "value = 0.0", 'value = "1 N"', ("pulley[driven].torque.value", "N*m")),
    Case(
        "creep rate in m",
        "creep_rate_factor = 1e5",
        'creep_rate_factor = "1 m"',
        ("contact.creep_rate_factor", "kg/(m*s)"),
    ),
    # choices
    Case(
        "start",
        'start = "laid"',
        'start = "equilibirum"',
        ("simulation.start", '"equilibirum"', 'Did you mean "equilibrium"?'),
    ),
    Case(
        "integrator", 'start = "laid"', 'integrator = "euler"', ("simulation.integrator", '"euler"', "cvode, ida, bdf")
    ),
    Case("joint", 'start = "laid"', "joint = 3", ("simulation.joint = 3", "shared_node, multipliers")),
    Case(
        "friction law",
        'friction_law = "force_slope"',
        'friction_law = "coulomb"',
        ("contact.friction_law", '"coulomb"', "force_slope"),
    ),
    Case(
        "profile kind",
        'kind = "ramp"',
        'kind = "rampe"',
        ('pulley[driver].speed.kind = "rampe"', 'Did you mean "ramp"?'),
    ),
    Case("profile without kind", 'kind = "ramp", ', "", ("pulley[driver].speed", "has no kind")),
    Case("profile as a flag", SPEED, "speed = true", ("pulley[driver].speed = true", "{ kind = ")),
    # what belongs together
    Case("neither speed nor inertia", SPEED, "", ("pulley[driver] has neither speed nor inertia", "Give speed")),
    Case("free without inertia", "inertia = 0.1\n", "", ("pulley[driven] has neither speed nor inertia",)),
    Case(
        "speed and torque", "inertia = 0.1", SPEED, ("pulley[driven]", "speed and torque exclude each other", "Remove")
    ),
    Case("no creep rate", "creep_rate_factor = 1e5", "", ("contact", "creep_rate_factor is missing", "force_slope")),
    Case(
        "no creep velocity",
        'friction_law = "force_slope"',
        'friction_law = "coefficient_slope"',
        ("contact", "creep_rate_factor belongs to", "force_slope"),
    ),
    Case(
        "foreign creep velocity",
        "friction = 1.2",
        "friction = 1.2\ncreep_velocity = 0.1",
        ("creep_velocity belongs to", "coefficient_slope"),
    ),
    Case(
        "ramp backwards",
        "start = 0.05, end = 0.6, value = 12.0",
        "start = 0.6, end = 0.05, value = 12.0",
        ("pulley[driver].speed", "end = 0.05 s", "later than start = 0.6 s"),
    ),
    Case(
        "published ramp before zero",
        'kind = "cosine_ramp", start = 0.05, end = 0.6',
        'kind = "cosine_ramp_published", start = -2, end = -1',
        ("pulley[driven].torque", "later than time zero"),
    ),
    Case(
        "step without time",
        TORQUE,
        'torque = { kind = "step", value = 1.0 }',
        ("pulley[driven].torque.time is missing", "the instant of the step"),
    ),
    Case(
        "step from a speed",
        TORQUE,
        'torque = { kind = "step", time = 0.0, before = "1 rpm", value = 1.0 }',
        ("pulley[driven].torque.before", 'units of N*m, not "rpm"', "Give the value before the step"),
    ),
    Case(
        "rare outputs",
        "output_interval = 1e-3",
        "output_interval = 2",
        ("simulation", "output_interval = 2 s", "longer than duration"),
    ),
    Case(
        "very many outputs",
        "output_interval = 1e-3",
        "output_interval = 1e-9",
        ("output_interval = 1e-09 s", "1e+09 outputs", "Lengthen"),
    ),
    # tables
    Case(
        "table without values",
        TORQUE,
        'torque = { kind = "table", times = [0, 1] }',
        ("pulley[driven].torque.values is missing",),
    ),
    Case(
        "table of unequal lengths",
        TORQUE,
        'torque = { kind = "table", times = [0, 1], values = [1, 2, 3] }',
        ("pulley[driven].torque", "times has 2 numbers but values has 3"),
    ),
    Case(
        "table backwards",
        TORQUE,
        'torque = { kind = "table", times = [1, 0], values = [1, 2] }',
        ("times must increase", "0 follows 1", "Sort"),
    ),
    Case(
        "table of one point",
        TORQUE,
        'torque = { kind = "table", times = [1], values = [1] }',
        ("pulley[driven].torque.times", "at least 2"),
    ),
    Case(
        "table twice",
        TORQUE,
        'torque = { kind = "table", file = "a.csv", times = [0, 1] }',
        ("file and times and values exclude each other",),
    ),
    Case(
        "missing CSV",
        TORQUE,
        'torque = { kind = "table", file = "nix.csv" }',
        ("pulley[driven].torque", "nix.csv", "no such file", "folder of the drive file"),
    ),
    Case(
        "CSV is a folder",
        TORQUE,
        'torque = { kind = "table", file = "." }',
        ("pulley[driven].torque", "is a directory"),
    ),
    Case(
        "CSV of words",
        TORQUE,
        'torque = { kind = "table", file = "words.csv" }',
        ('words.csv", line 3', "is not a number"),
    ),
    Case(
        "CSV of three columns",
        TORQUE,
        'torque = { kind = "table", file = "wide.csv" }',
        ('wide.csv", line 2', '"1,2,3"'),
    ),
    Case(
        "CSV with NaN",
        TORQUE,
        'torque = { kind = "table", file = "nan.csv" }',
        ("pulley[driven].torque.values[2] = nan", "finite"),
    ),
    Case(
        "CSV empty",
        TORQUE,
        'torque = { kind = "table", file = "empty.csv" }',
        ("pulley[driven].torque", "empty.csv", "has no numbers"),
    ),
    Case(
        "CSV not text",
        TORQUE,
        'torque = { kind = "table", file = "binary.csv" }',
        ("binary.csv", "is not a text file"),
    ),
    Case("CSV named by a number", TORQUE, 'torque = { kind = "table", file = 3 }', ("file = 3", "path of a CSV file")),
    # geometry
    Case(
        "slack belt",
        BELT,
        "length = 1.40",
        ("belt.length = 1.4 m is longer than the path around the pulleys (1.2763 m)", "Shorten it"),
    ),
    Case("short belt", BELT, "length = 0.5", ("belt.length = 0.5 m is too short", "155%", "Lengthen it")),
    Case(
        "overlapping pulleys",
        DRIVEN,
        "center = [-0.1, 0.0]\nradius = 0.08125",
        ('pulleys "driver" and "driven" overlap', "0.091441 m apart", "Move them apart"),
    ),
    Case("same name", 'name = "driven"', 'name = "driver"', ('name = "driver" is used 2 times', "Rename one")),
    Case("empty name", 'name = "driven"', 'name = ""', ("pulley[2].name", "letters")),
    Case("name is a number", 'name = "driven"', "name = 2", ("pulley[2].name = 2", "text in quotation marks")),
    Case(
        "wrong order either way round",
        "[contact]",
        f"{THIRD}center = [0, 0.4]\nradius = 0.05\n{FOURTH}center = [0, -0.4]\nradius = 0.05\n[contact]",
        ("not listed in the order", "counter-clockwise", '"driver", "low", "driven", "idler"'),
    ),
    Case(
        "pulley inside",
        "[contact]",
        f"{THIRD}center = [0, 0]\nradius = 0.05\n[contact]",
        ('does not touch pulley "idler"', "Move it outwards"),
    ),
    # files
    Case("not TOML", BELT, "length: 1.2727", ("not valid TOML", "line")),
    Case("key twice", BELT, f"{BELT}\n{BELT}", ("not valid TOML", "line")),
    Case("deep nesting", BELT, f"length = {'[' * 5000}", ("not valid TOML",)),
    Case("long number", BELT, f"length = {'1' * 5000}", ("not valid TOML", "too many digits")),
    Case("group as a number", "[belt]", "contact = 3\n[belt]", ("not valid TOML",)),
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "words.csv").write_text("time,torque\n0,1\nsoon,much\n")
    (tmp_path / "wide.csv").write_text("0,1\n1,2,3\n")
    (tmp_path / "nan.csv").write_text("0,1\n1,nan\n")
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "binary.csv").write_bytes(b"\x89PNG\x00\x01")
    return tmp_path


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_message(case: Case, drive_text: str, folder: Path, refuse: Refuse) -> None:
    assert drive_text.count(case.old) >= 1
    file = folder / "drive.toml"
    file.write_text(drive_text.replace(case.old, case.new, 1), encoding="utf-8")
    message = refuse(["check", str(file)])
    for part in case.parts:
        assert part in message
    assert message.startswith("error: ")
    assert not re.search(r"Traceback|pydantic|Input should|ValidationError|tuple|dict", message)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["demo", "folder", "layout"], 'beltdyn demo takes no argument "layout". See beltdyn demo --help.'),
        (["simulate", "--nosuch", "a.toml"], "--nosuch"),
        (["check"], "FILE requires an argument"),
        (["simulat"], 'Unknown command "simulat"'),
        (["map", "drive.toml"], 'Unknown command "map". Did you mean "operating-map"?'),
        (["run", "drive.toml"], 'Unknown command "run". Did you mean "simulate"?'),
        (["steady", "drive.toml"], 'Unknown command "steady". Did you mean "steady-state"?'),
    ],
)
def test_words_that_do_not_fit_the_command(words: list[str], said: str, refuse: Refuse) -> None:
    message = refuse(words)
    assert message.startswith("error: ")
    assert said in message
